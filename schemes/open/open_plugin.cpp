// Reads the tables in jvari_scheme.h. It reads no member beyond a structure's declared size, and no
// table from another version.
#include "schemes/open/open_plugin.hpp"

#include <algorithm>
#include <cstring>
#include <deque>
#include <limits>

#include "schemes/making.hpp"
#include "schemes/open/problem.hpp"
#include "schemes/open/shared_object.hpp"

namespace jvari {

namespace {
constexpr std::int64_t most_facts = 256, most_schemes = 1024;

// Copies the structure into this program's form, with 0 for members beyond its declared size.
template <class Struct>
Struct as_far_as_it_goes(const Struct& theirs) {
    Struct ours{};
    std::memcpy(&ours, &theirs, std::min(theirs.size, sizeof ours));
    return ours;
}

struct Table : jvari_scheme {  // a scheme, owned by its guest
    const jvari_scheme* theirs;
    std::deque<std::string> texts;
    std::vector<Option> option_list;
    std::vector<Approximation> approximation_list;
};

class Opened final : public Scheme {
public:
    Opened(const Table& table, const Scene& scene, const Settings& settings)
        : table_(table), problem_(scene, settings) {
        made_.size = sizeof made_;
        state_ = table_.make(table_.theirs, &problem_.arrays(), &made_);
        made_.why[sizeof made_.why - 1] = 0;
        if (state_) return;
        const std::string why = *made_.why ? made_.why : "";
        if (made_.failed) throw BadScheme(why);
        throw Refusal(why.empty()
                          ? std::string(table_.name) + " refuses the scene and does not say why"
                          : why);
    }
    ~Opened() override {
        if (state_) table_.release(state_);
    }
    Opened(const Opened&) = delete;
    Opened& operator=(const Opened&) = delete;

    void reset() noexcept override { table_.reset(state_); }
    Status advance(const Block& out) noexcept override {
        jvari_rows rows{sizeof rows,
                        out.rows,
                        out.taps,
                        out.stride,
                        out.tap,
                        out.energy,
                        nullptr,
                        const_cast<Block*>(&out),
                        0};
        for (int k = 0; out.energy && k < 3; ++k)  // 0 if a scheme leaves them out
            std::fill_n(out.energy + static_cast<std::ptrdiff_t>(k) * out.stride, out.rows, 0.0);
        if (out.stop)
            rows.stop = [](void* block) {
                return static_cast<const Block*>(block)->stopped() ? 1 : 0;
            };
        const int outcome = table_.advance(state_, &rows);
        return {static_cast<Outcome>(outcome), static_cast<long>(rows.failed_step)};
    }
    int dofs() const override {
        return static_cast<int>(std::clamp<std::int64_t>(
            made_.dofs, std::numeric_limits<int>::min(), std::numeric_limits<int>::max()));
    }
    std::vector<Fact> facts() const override {
        std::vector<Fact> all;
        if (!table_.facts) return all;
        std::vector<jvari_fact> reported(static_cast<std::size_t>(most_facts));
        const std::int64_t count = table_.facts(state_, reported.data(), most_facts);
        if (count < 0)
            throw BadScheme(reported.front().name ? reported.front().name
                                                  : "the scheme cannot tell its facts");
        for (const jvari_fact& f :
             std::span(reported).first(static_cast<std::size_t>(std::min(count, most_facts))))
            if (f.name) all.emplace_back(f.name, f.value, f.unit ? f.unit : "");
        return all;
    }
    std::vector<FreeMode> free_modes() const override {
        std::vector<FreeMode> all;
        for (std::int64_t i = 0; made_.omega && made_.decay && i < made_.free_modes; ++i)
            all.push_back({made_.omega[i], made_.decay[i]});
        return all;
    }

private:
    const Table& table_;
    Problem problem_;
    jvari_made made_{};
    void* state_;
};

std::vector<std::string> split(const std::string& text, const std::string& at) {
    std::vector<std::string> parts;
    for (std::size_t from = 0, to = 0; from < text.size(); from = to + at.size()) {
        to = std::min(text.find(at, from), text.size());
        if (to > from) parts.push_back(text.substr(from, to - from));
    }
    return parts;
}

Feature feature_of(const std::string& name) {
    std::string known;
    for (int i = 0; i < feature_count; ++i) {
        const auto f = static_cast<Feature>(1u << i);
        if (name == name_of(f)) return f;
        known += (i > 0 ? ", " : "") + std::string(name_of(f));
    }
    throw std::runtime_error("knows a feature \"" + name +
                             "\" that this program does not; there are " + known);
}

Balance balance_of(const std::string& text) {
    if (text == "exact") return Balance::exact;
    if (text == "to tolerance") return Balance::to_tolerance;
    if (text == "none") return Balance::none;
    throw std::runtime_error("promises the balance \"" + text +
                             "\"; expected \"exact\", \"to tolerance\" or \"none\"");
}

void must(bool good, const std::string& wrong) {
    if (!good) throw std::runtime_error(wrong);
}

Option option_of(Table& t, const jvari_option& o) {
    Option option{
        o.name ? o.name : "", o.fallback ? o.fallback : "", o.meaning ? o.meaning : "", {}};
    std::size_t k = 0;
    for (const std::string& word : split(o.choices ? o.choices : "", " ")) {
        must(k < std::size(option.choices), "has more choices for its option " +
                                                std::string(option.name) +
                                                " than there is room for");
        option.choices[k++] = t.texts.emplace_back(word).c_str();
    }
    return option;
}

Descriptor descriptor_of(const jvari_scheme& theirs, int place, std::deque<Table>& tables) {
    Table* t = &tables.emplace_back(Table{as_far_as_it_goes(theirs), &theirs, {}, {}, {}});
    must(t->name && *t->name, "has no name for its scheme " + std::to_string(place));
    const std::string name = t->name;
    must(t->source, "has no source for its scheme " + name);
    must(t->make && t->reset && t->advance && t->release,
         "has nothing that makes its scheme " + name + ", or resets, advances or releases it");
    Descriptor d{t->name,        t->source, {}, balance_of(t->balance ? t->balance : "none"),
                 Clock::stepped, nullptr};
    for (const std::string& feature : split(t->represents ? t->represents : "", ", "))
        d.represents = d.represents | feature_of(feature);
    for (std::int64_t k = 0; t->options && k < t->option_count; ++k)
        t->option_list.push_back(option_of(*t, t->options[k]));
    for (const std::string& pair : split(t->approximates ? t->approximates : "", ", ")) {
        const auto parts = split(pair, ": ");
        must(parts.size() == 2,
             "approximates \"" + pair +
                 "\"; expected a feature and a fact, as \"profile barrier: contact_points\"");
        t->approximation_list.push_back(
            {feature_of(parts[0]), FactName{t->texts.emplace_back(parts[1]).c_str(), "", ""}});
    }
    d.options = t->option_list;
    d.approximates = t->approximation_list;
    d.note = t->note ? t->note : "";
    d.own = t;
    d.make = [](const Descriptor& of, const Scene& scene,
                const Settings& settings) -> std::unique_ptr<Scheme> {
        return std::make_unique<Opened>(*static_cast<const Table*>(of.own), scene, settings);
    };
    return d;
}

Guest guest_of(const std::string& path, const jvari_plugin& theirs) {
    const jvari_plugin p = as_far_as_it_goes(theirs);
    must(p.version == JVARI_SCHEME_VERSION,
         "has version " + std::to_string(p.version) + " of jvari_scheme.h, this program has " +
             std::to_string(JVARI_SCHEME_VERSION) + ": compile it with the header of this program");
    must(p.count >= 0 && p.count <= most_schemes,
         "says that it has " + std::to_string(p.count) + " schemes");
    must(p.schemes || p.count == 0,
         "says that it has " + std::to_string(p.count) + " schemes and shows none");
    const auto tables = std::make_shared<std::deque<Table>>();
    Guest guest{path,
                {},
                "",
                tables,
                p.compiler ? p.compiler : "",
                p.flags ? p.flags : "",
                p.optimised != 0};
    for (int k = 0; k < p.count; ++k) {
        must(p.schemes[k], "has nothing for its scheme " + std::to_string(k));
        guest.schemes.push_back(descriptor_of(*p.schemes[k], k, *tables));
    }
    return guest;
}
}  // namespace

Guest open_plugin(const std::string& path) {
    std::string why;
    void* library = load_shared_object(path, why);
    if (!library) throw std::runtime_error("cannot load plugin " + path + ": " + why);
    const auto table =
        reinterpret_cast<decltype(&jvari_schemes)>(symbol_of(library, "jvari_schemes"));
    if (!table && symbol_of(library, "jvari_plugin"))
        throw std::runtime_error("plugin " + path +
                                 " is of an older jvari, which passed C++ objects: compile it with "
                                 "the headers of this program");
    if (!table) throw std::runtime_error("plugin " + path + " does not export jvari_schemes");
    try {
        const jvari_plugin* plugin = table();
        must(plugin, "shows no table of schemes");
        return guest_of(path, *plugin);
    } catch (const std::runtime_error& e) {
        throw std::runtime_error("plugin " + path + " " + e.what());
    }
}

}  // namespace jvari
