// Writes a scene in TOML: the writing pass over the schema. Values equal to their default are left
// out.
#include <optional>
#include <span>
#include <type_traits>

#include "scenes/scene_file.hpp"
#include "scenes/schema.hpp"
#include "scenes/wording.hpp"

namespace jvari {

namespace {
struct Writer : Pass<Writer> {
    std::string& out;
    // path: "string.barrier", because a header names the last entry in every array
    Writer(std::string& text, std::string key) : Pass{std::move(key)}, out(text) {}

    void line(const char* key, const std::string& value) {
        out += std::string(key) + " = " + value + "\n";
    }
    static std::string number_value(double x) {
        std::string text = number_text(x);
        // a float, also beyond the range of integers
        return text.find_first_of(".en") == std::string::npos ? text + ".0" : text;
    }

    void number(const char* key, double x, const Range&, const char*,
                std::optional<double> absent = {}) {
        if (x != absent) line(key, number_value(x));
    }
    void stiffness(const char* key, double k, const char* unit) {
        k == rigid ? line(key, quote("rigid")) : number(key, k, positive, unit);
    }
    void tension(const String& s) { number("tension", s.tension, not_negative, "N"); }
    void count(const char* key, int n) { line(key, std::to_string(n)); }
    void string_index(const char* key, const std::optional<int>& n) {
        if (n) line(key, std::to_string(*n));
    }
    void text(const char* key, const std::string& s) { line(key, quote(s)); }
    void file(const char* key, const std::string& s) { optional_text(key, s); }
    void optional_text(const char* key, const std::string& s) {
        if (!s.empty()) text(key, s);
    }
    template <class Enum>
    void choice(const char* key, Enum e, std::span<const char* const> names,
                std::optional<std::type_identity_t<Enum>> absent = {}) {
        if (e != absent) line(key, quote(names[static_cast<std::size_t>(e)]));
    }
    void columns(const char* key, const std::string& file, auto&&...) { text(key, file); }
    void start(const char* key, const std::optional<Start>& s) {
        if (!s) return;
        if (std::holds_alternative<RestStart>(*s)) text(key, "rest");
        if (const auto* t = std::get_if<TableStart>(&*s)) text(key, t->file);
    }
    void force(const char* key, const Pluck& p) { optional_text(key, p.file); }
    void one_of(const char* key, const auto& variant, std::span<const char* const> names) {
        line(key, quote(names[variant.index()]));
        std::visit([this](const auto& alternative) { fields(*this, alternative); }, variant);
    }
    template <class Part>
    void headed(const std::string& header, const std::string& key, const Part& p) {
        out += "\n" + header + "\n";
        Writer inner(out, key);
        fields(inner, p);
    }
    template <class Part>
    void part(const char* key, const Part& p) {
        headed("[" + at(key) + "]", at(key), p);
    }
    template <class Part>
    void part(const char* key, const std::optional<Part>& p) {
        if (p) part(key, *p);
    }
    void part(const char* key, const std::optional<Start>& s) {
        if (s && s->index() < std::size(shape_names)) part(key, *s);
    }
    template <class Part>
    void parts(const char* key, const std::vector<Part>& all) {
        for (const Part& p : all) headed("[[" + at(key) + "]]", at(key), p);
    }
};

// Contents of the tables, for the hash.
struct Tables : Pass<Tables> {
    std::string& out;
    explicit Tables(std::string& text) : out(text) {}
    void columns(const char*, const std::string&, const Column&, const std::vector<double>& a,
                 const Column&, const std::vector<double>& b) {
        write({&a, &b});
    }
    void start_table(const TableStart& t) {
        out += t.of_modes ? "modes\n" : "";
        write({&t.at, &t.displacement, &t.velocity});
    }
    void force(const char*, const Pluck& p) {
        if (!p.time.empty()) write({&p.time, &p.share});
    }
    void write(std::initializer_list<const std::vector<double>*> columns) {
        for (const auto* column : columns) {
            for (const double x : *column) out += number_text(x) + ",";
            out += "\n";
        }
    }
};
}  // namespace

std::string write_scene(const Scene& scene) {
    std::string text;
    Writer writer(text, "");
    fields(writer, scene);
    return text;
}

std::string scene_hash(const Scene& scene) {
    const Scene heard = unfiltered(scene);  // filters do not affect a run, and name files
    std::string text = write_scene(heard);
    // the word by which committed results know a shape
    constexpr std::string_view header = "[string.start]";
    for (std::size_t at = 0; (at = text.find(header, at)) != std::string::npos;)
        text.replace(at, header.size(), "[string.initial]");
    Tables tables(text);
    fields(tables, heard);
    std::uint64_t hash = 0xcbf29ce484222325u;  // FNV-1a, 64 bit
    for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
    std::string hex(16, '0');
    for (auto digit = hex.rbegin(); digit != hex.rend(); ++digit, hash >>= 4)
        *digit = "0123456789abcdef"[hash & 15];
    return hex;
}

}  // namespace jvari
