// Makes two passes over the schema: Names refuses unknown keys (and chooses the alternatives of
// variants), Reader takes the values.
#include <algorithm>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <span>

#include "scenes/barrier.hpp"
#include "scenes/columns.hpp"
#include "scenes/document.hpp"
#include "scenes/material.hpp"
#include "scenes/pitch.hpp"
#include "scenes/scene_file.hpp"
#include "scenes/schema.hpp"
#include "scenes/wording.hpp"

namespace jvari {

namespace {
constexpr std::size_t largest_table = 16u << 20;  // bytes

std::optional<std::size_t> chosen(const Value* v, std::span<const char* const> names) {
    const auto* word = v ? std::get_if<std::string>(&v->content) : nullptr;
    const auto at = word ? std::find(names.begin(), names.end(), *word) : names.end();
    if (at == names.end()) return {};
    return static_cast<std::size_t>(at - names.begin());
}

template <std::size_t I = 0, class... T>
void emplace(std::variant<T...>& v, std::size_t index) {
    if constexpr (I < sizeof...(T)) {
        if (I == index) v.template emplace<I>();
        else emplace<I + 1>(v, index);
    }
}

constexpr const char* rebound_keys[] = {"restitution", "impact_speed"};
constexpr const char* tension_keys[] = {"tension", "frequency", "note"};

// ---- Keys allowed in this table. If the key that chooses an alternative is missing or wrong,
// every alternative's keys are allowed.
struct Names : Pass<Names> {
    const Value& table;
    std::vector<std::string> names{};
    // keys belonging to alternatives that an override has abandoned
    std::vector<std::string> idle{};

    explicit Names(const Value& of) : table(of) {}
    void seen(const char* key) {
        if (std::find(names.begin(), names.end(), key) == names.end()) names.emplace_back(key);
    }
    void material() {
        seen("material");
        seen("diameter");
    }
    void tension(auto&) {
        for (const char* key : tension_keys) seen(key);
    }
    void concert_pitch() { seen("A4"); }
    void rebound() {
        for (const char* key : rebound_keys) seen(key);
    }
    void part(const char* key, auto&) { seen(key); }
    void parts(const char* key, auto&) { seen(key); }
    template <class... T>
    void one_of(const char* key, std::variant<T...>& v, std::span<const char* const> tags) {
        seen(key);
        const auto index = chosen(table.find(key), tags);
        for (std::size_t i = 0; i < sizeof...(T); ++i) {
            if (index && i != *index && table.find(key)->place > 0) continue;
            std::variant<T...> alternative;
            emplace(alternative, i);
            Names other(table);
            std::visit([&other](auto& a) { fields(other, a); }, alternative);
            for (const std::string& name : other.names)
                index&& i != *index ? idle.push_back(name) : seen(name.c_str());
            idle.insert(idle.end(), other.idle.begin(), other.idle.end());
            if (i == index) v = std::move(alternative);
        }
    }
};

// ---- Values of one table
class Reader {
public:
    Reader(const Document& document, const Value& table, std::string path)
        : document_(document), table_(table), path_(std::move(path)) {}

    template <class Part>
    void read(Part& part) {
        if (!std::holds_alternative<TomlTable>(table_.content))
            fail(table_, path_, table_.found(), "a table");
        Names names(table_);
        fields(names, part);
        refuse_unknown(std::get<TomlTable>(table_.content), names);
        fields(*this, part);
    }

    void number(const char* key, double& x, const Range& range, const char* unit,
                std::optional<double> absent = {}) {
        if (const auto given = wire_.find(key); given != wire_.end()) {
            x = given->second;
            return;
        }
        const std::string expected = range.says + (*unit ? " [" + std::string(unit) + "]" : "");
        const Value* v = absent ? table_.find(key) : required(key, expected);
        if (!v) x = *absent;
        else if (const auto* d = std::get_if<double>(&v->content)) x = *d;
        else if (const auto* i = std::get_if<std::int64_t>(&v->content))
            x = static_cast<double>(*i);
        else fail(*v, at(key), v->found(), expected);
    }
    // A number that is out of range is refused at once: others follow from it.
    double within(const char* key, const Range& range, const char* unit,
                  std::optional<double> absent = {}) {
        double x = 0;
        number(key, x, range, unit, absent);
        if (!range.holds(x))
            fail(*table_.find(key), at(key), table_.find(key)->found(),
                 range.says + (*unit ? " [" + std::string(unit) + "]" : ""));
        return x;
    }
    void stiffness(const char* key, double& k, const char* unit) {
        const Value* v = table_.find(key);
        const auto* word = v ? std::get_if<std::string>(&v->content) : nullptr;
        if (word && *word == "rigid") k = rigid;
        else number(key, k, positive_or_rigid, unit);
        const auto* d = v ? std::get_if<double>(&v->content) : nullptr;
        if (d && *d == rigid)
            fail(*v, at(key), v->found(), std::string(positive_or_rigid.says) + " [" + unit + "]");
    }
    // Reads a wire by its material, or by its two numbers. If an override brings one form, the
    // other form in the file stays unread.
    void material() {
        const Value *name = table_.find("material"), *width = table_.find("diameter");
        if (!name && !width) return;
        const Material& m = materials[index_of("material", material_names)];
        const double diameter = within("diameter", positive, "m");
        const bool overridden = name->place < 0 || width->place < 0;
        for (const auto& [key, value] :
             {std::pair{"linear_density", linear_density_of(m, diameter)},
              {"bending_stiffness", bending_stiffness_of(m, diameter)}}) {
            const Value* beside = table_.find(key);
            if (beside && (beside->place < 0) == overridden)
                fail(*beside, at(key), beside->found(),
                     "nothing beside material and diameter, which say as much");
            if (!beside || overridden) wire_[key] = value;
        }
    }
    // Reads a contact loss by a restitution at an impact speed. An override of the loss itself
    // leaves both unread.
    void rebound() {
        const Value* loss = table_.find("contact_loss");
        const Value* first = table_.find(rebound_keys[0]);
        if (!first) first = table_.find(rebound_keys[1]);
        if (!first || (loss && loss->place < 0 && first->place > 0)) return;
        const double e = within(rebound_keys[0], fraction, ""),
                     v = within(rebound_keys[1], positive, "m/s");
        if (loss && (loss->place < 0) == (first->place < 0))
            fail(*loss, at("contact_loss"), loss->found(),
                 "nothing beside restitution and impact_speed, which say as much");
        wire_["contact_loss"] = loss_for_rebound(e, v);
    }
    // Reads exactly one among three keys. If an override brings one, the file's other keys stay
    // unread.
    void tension(String& s) {
        const char* chosen = nullptr;
        for (const char* key : tension_keys) {
            const Value* v = table_.find(key);
            if (!v) continue;
            const bool overridden = v->place < 0, before = chosen && table_.find(chosen)->place < 0;
            if (chosen && overridden == before)
                fail(*v, at(key), v->found(),
                     "nothing beside " + std::string(chosen) +
                         ": give one of tension, frequency and note");
            if (!chosen || overridden) chosen = key;
        }
        if (!chosen || chosen == tension_keys[0])
            return number(tension_keys[0], s.tension, not_negative, "N");
        const Value& v = *table_.find(chosen);
        double hertz = 0;
        if (chosen == tension_keys[1]) hertz = within(chosen, positive, "Hz");
        else {
            std::string note;
            text(chosen, note);
            Reader top(document_, document_.root, "");
            const auto frequency = frequency_of_note(note, top.concert_pitch());
            if (!frequency)
                fail(
                    v, at(chosen), v.found(),
                    "a note from \"C-1\" to \"B9\", as in \"C3\", \"F#2\", \"Bb4\" or \"A2 -14c\"");
            hertz = *frequency;
        }
        number("bending_stiffness", s.bending_stiffness, not_negative, "N m^2", 0.0);
        s.tension = 1;  // placeholder: validate() reports the quantities that are out of range
        if (!positive.holds(s.length) || !positive.holds(s.linear_density) ||
            !not_negative.holds(s.bending_stiffness))
            return;
        s.tension = tension_for(s, hertz);
        if (!positive.holds(s.tension))
            fail(v, at(chosen), v.found(),
                 "a pitch that a tension gives: the bending stiffness alone gives " +
                     number_text(slack_pitch(s)) + " Hz");
    }
    double concert_pitch() { return within("A4", positive, "Hz", 440); }
    void count(const char* key, int& n) {
        n = integer(*required(key, "a whole number >= 1"), key, 1);
    }
    void string_index(const char* key, std::optional<int>& n) {
        if (const Value* v = table_.find(key)) n = integer(*v, key, 0);
    }
    void text(const char* key, std::string& s) {
        required(key, "a text");
        optional_text(key, s);
    }
    void optional_text(const char* key, std::string& s) {
        const Value* v = table_.find(key);
        if (!v) return;
        const auto* found = std::get_if<std::string>(&v->content);
        if (!found || found->empty()) fail(*v, at(key), v->found(), "a text");
        s = *found;
    }
    void file(const char* key, std::string& s) {
        optional_text(key, s);
        if (!s.empty()) s = beside(found_from(*table_.find(key), s));
    }
    template <class Enum>
    void choice(const char* key, Enum& e, std::span<const char* const> names) {
        e = static_cast<Enum>(index_of(key, names));
    }
    template <class Enum>
    void choice(const char* key, Enum& e, std::span<const char* const> names, Enum absent) {
        e = absent;
        if (table_.find(key)) choice(key, e, names);
    }
    void refused(const char* key, const char* expected) {
        const Value* v = table_.find(key);
        if (v && !(overridden_ && v->place > 0)) fail(*v, at(key), v->found(), expected);
    }
    std::string table(const char* key, std::string& file, const Column& first,
                      const Column& second) {
        text(key, file);
        file = found_from(*table_.find(key), file);
        return contents_of(key, file,
                           "a CSV file with the columns " + list_of({first.name, second.name}));
    }
    void columns(const char* key, std::string& file, const Column& first, std::vector<double>& a,
                 const Column& second, std::vector<double>& b) {
        const std::string contents = table(key, file, first, second);
        const ColumnTo both[] = {{first, &a}, {second, &b}};
        read_columns(beside(file), contents, both);
    }
    void modes(const char* key, TableDamping& t, const Column& frequency, const Column& decay) {
        const std::string contents = table(key, t.file, frequency, decay);
        modes_from(beside(t.file), contents, frequency, decay, t);
    }
    void start(const char* key, std::optional<Start>& s) {
        const Value* v = table_.find(key);
        const auto* word = v ? std::get_if<std::string>(&v->content) : nullptr;
        if (!word) return;
        if (*word == "rest") return void(s = RestStart{});
        const std::string file = found_from(*v, *word),
                          contents = contents_of(
                              key, file,
                              "\"rest\", a table with a shape, or a CSV file with the columns "
                              "\"x_m\" or \"mode\", \"displacement_m\" and "
                              "\"velocity_m_per_s\"");
        TableStart t = start_from(beside(file), contents);
        t.file = file;
        s = std::move(t);
    }
    void start_table(TableStart&) {}
    void part(const char* key, std::optional<Start>& s) {
        if (!s && table_.find(key)) part(key, s.emplace());
    }
    void force(const char* key, Pluck& p) {
        const Value* v = table_.find(key);
        if (!v) return;
        text(key, p.file);
        overridden_ = v->place < 0;
        p.file = found_from(*v, p.file);
        force_from(beside(p.file),
                   contents_of(key, p.file,
                               "a CSV file with the columns \"time_s\" and \"force_N\", or a "
                               "sound file .wav"),
                   p);
        const Value* amplitude = table_.find("amplitude");
        if (overridden_ && amplitude && amplitude->place > 0) wire_["amplitude"] = p.peak;
    }
    template <class... T>
    void one_of(const char* key, std::variant<T...>& v, std::span<const char* const> tags) {
        index_of(key, tags);  // Names has made the alternative
        std::visit([this](auto& alternative) { fields(*this, alternative); }, v);
    }
    template <class Part>
    void part(const char* key, Part& p) {
        if (const Value* v = table_.find(key)) Reader(document_, *v, at(key)).read(p);
    }
    template <class Part>
    void part(const char* key, std::optional<Part>& p) {
        if (table_.find(key)) part(key, p.emplace());
    }
    template <class Part>
    void parts(const char* key, std::vector<Part>& all) {
        const Value* v = table_.find(key);
        if (!v) return;
        const auto* items = std::get_if<Array>(&v->content);
        if (!items) fail(*v, at(key), v->found(), "an array of tables, [[...]]");
        for (const Value& item : *items)
            Reader(document_, item, at(key) + "." + std::to_string(all.size()))
                .read(all.emplace_back());
    }

private:
    std::string at(const std::string& key) const { return path_.empty() ? key : path_ + "." + key; }

    [[noreturn]] void fail(const Value& v, const std::string& key, const std::string& found,
                           const std::string& expected) const {
        throw SceneFileError(document_.place(v.place) + ": " + (key.empty() ? "" : key + ": ") +
                             "found " + found + ", expected " + expected);
    }
    const Value* required(const char* key, const std::string& expected) const {
        const Value* v = table_.find(key);
        if (!v) fail(table_, at(key), "nothing", expected);
        return v;
    }
    std::string beside(const std::string& file) const {
        return (std::filesystem::path(document_.file).parent_path() / file).string();
    }
    // A file named by an override is found from the program's working directory, and its place is
    // kept.
    std::string found_from(const Value& v, const std::string& file) const {
        return v.place < 0 ? (std::filesystem::current_path() / file).string() : file;
    }
    std::string contents_of(const char* key, const std::string& file,
                            const std::string& expected) const {
        const std::string path = beside(file);
        std::error_code error;
        try {
            if (file.find('\0') == std::string::npos &&
                std::filesystem::is_regular_file(path, error))
                return text_of_file(path, largest_table);
            throw std::runtime_error("is not a file");
        } catch (const std::runtime_error& e) {
            fail(*table_.find(key), at(key), found_text(file) + ", which " + e.what(), expected);
        }
    }
    int integer(const Value& v, const char* key, int least) const {
        const auto i = v.whole();
        if (!i || *i < least || *i > std::numeric_limits<int>::max())
            fail(v, at(key), v.found(), "a whole number >= " + std::to_string(least));
        return static_cast<int>(*i);
    }
    std::size_t index_of(const char* key, std::span<const char* const> names) const {
        const std::vector<std::string> words(names.begin(), names.end());
        const std::string expected = "one of " + list_of(words);
        const Value* v = required(key, expected);
        const auto index = chosen(v, names);
        if (index) return *index;
        const auto* word = std::get_if<std::string>(&v->content);
        const std::string near = word ? nearest(word->substr(0, 100), words) : "";
        fail(*v, at(key), v->found(),
             expected + (near.empty() ? "" : "; did you mean " + quote(near) + "?"));
    }
    void refuse_unknown(const TomlTable& members, const Names& names) const {
        const auto& known = names.names;
        const auto among = [](const std::vector<std::string>& keys, const Member& m) {
            return std::find(keys.begin(), keys.end(), m.key) != keys.end();
        };
        std::vector<Member> unknown;
        for (const Member& m : members)
            if (!among(known, m) && !(m.value.place > 0 && among(names.idle, m)))
                unknown.push_back(m);
        if (unknown.empty()) return;
        const Member& m = unknown[0];
        std::string others;
        for (std::size_t k = 1; k < std::min<std::size_t>(unknown.size(), 9); ++k)
            others += (k > 1 ? ", " : "; unknown as well: ") + found_text(unknown[k].key);
        const bool bare = !m.key.empty() &&
                          m.key.find_first_not_of(
                              "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-") ==
                              std::string::npos &&
                          m.key.size() <= 60;
        const bool start =
            m.key == "initial" && std::find(known.begin(), known.end(), "start") != known.end();
        const std::string near = start ? "start" : nearest(m.key.substr(0, 100), known);
        throw SceneFileError(document_.place(m.value.place) + ": " +
                             at(bare ? m.key : found_text(m.key)) + ": unknown key; " +
                             (start          ? "it is called \"start\""
                              : near.empty() ? "known here: " + list_of(known)
                                             : "did you mean " + quote(near) + "?") +
                             others);
    }

    const Document& document_;
    const Value& table_;
    std::string path_;
    bool overridden_ = false;  // an override brings the force: the file's keys stay unread
    // numbers that follow from material and diameter, from a force, or from a restitution
    std::map<std::string, double, std::less<>> wire_;
};
}  // namespace

Scene scene_of(const Document& document) {
    Scene scene;
    Reader(document, document.root, "").read(scene);
    return scene;
}

}  // namespace jvari
