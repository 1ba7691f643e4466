#include "bench/store/keys.hpp"

#include <algorithm>
#include <cmath>

#include "scenes/scene_file.hpp"

namespace jvari::bench::store {

void Entry::refuse(const std::string& expected) const {
    fail("found " + value_->found() + ", expected " + expected);
}

void Entry::fail(const std::string& why) const {
    throw SceneFileError(document_->place(value_->place) + ": " +
                         (key_.empty() ? "" : key_ + ": ") + why);
}

std::optional<Entry> Entry::at(const std::string& name) const {
    const Value* v = value_->find(name);
    return v ? std::optional(Entry(*document_, *v, below(name))) : std::nullopt;
}

Entry Entry::need(const std::string& name) const {
    if (auto e = at(name)) return *e;
    fail("the key " + name + " is missing");
}

void Entry::only(const std::vector<std::string>& known) const {
    const auto* table = std::get_if<TomlTable>(&value_->content);
    if (!table) refuse("a table");
    for (const Member& m : *table)
        if (std::find(known.begin(), known.end(), m.key) == known.end())
            Entry(*document_, m.value, key_).fail(unknown("key", m.key, known));
}

std::vector<std::pair<std::string, Entry>> Entry::members() const {
    const auto* table = std::get_if<TomlTable>(&value_->content);
    if (!table) refuse("a table");
    std::vector<std::pair<std::string, Entry>> all;
    for (const Member& m : *table)
        all.emplace_back(m.key, Entry(*document_, m.value, below(m.key)));
    return all;
}

std::vector<Entry> Entry::items() const {
    const auto* array = std::get_if<Array>(&value_->content);
    if (!array) return {*this};
    if (array->empty()) refuse("at least one value");
    return tables("");
}

std::vector<Entry> Entry::tables(const std::string& expected) const {
    const auto* array = std::get_if<Array>(&value_->content);
    if (!array) refuse(expected);
    std::vector<Entry> all;
    for (std::size_t i = 0; i < array->size(); ++i)
        all.emplace_back(*document_, (*array)[i], below(std::to_string(i)));
    return all;
}

std::string Entry::text() const {
    if (const auto* s = std::get_if<std::string>(&value_->content)) return *s;
    refuse("a text");
}

std::optional<double> Entry::number() const {
    if (const auto* n = std::get_if<std::int64_t>(&value_->content)) return static_cast<double>(*n);
    if (const auto* x = std::get_if<double>(&value_->content)) return *x;
    return {};
}

std::optional<std::int64_t> Entry::whole() const { return value_->whole(); }

bool Entry::truth() const {
    if (const auto* b = std::get_if<bool>(&value_->content)) return *b;
    refuse("true or false");
}

std::string Entry::toml() const {
    if (is_text()) return quote(text());
    if (const auto* x = std::get_if<double>(&value_->content)) return number_text(*x);
    if (std::holds_alternative<TomlTable>(value_->content) ||
        std::holds_alternative<Moment>(value_->content))
        refuse("a value");
    if (!is_array()) return value_->found();
    std::string all;
    for (const Entry& item : tables("")) all += (all.empty() ? "" : ", ") + item.toml();
    return "[" + all + "]";
}

std::string Entry::option_text() const {
    if (is_text()) return text();
    if (is_array()) refuse("a text or a number");
    return toml();
}

namespace {
Kind<double> number_that(const char* says, const char* unit, bool (*holds)(double)) {
    const std::string expected = says + (*unit ? " [" + std::string(unit) + "]" : "");
    return {expected, [expected, holds](const Entry& e) {
                const auto x = e.number();
                if (!x || !std::isfinite(*x) || !holds(*x)) e.refuse(expected);
                return *x;
            }};
}
}  // namespace

Kind<std::string> text() {
    return {"a text", [](const Entry& e) { return e.text(); }};
}

Kind<std::string> name_of_file() {
    const char* says = "lower-case letters, digits, _ and -, for it names a file";
    return {
        says, [says](const Entry& e) {
            std::string name = e.text();
            if (name.empty() || name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_-") !=
                                    std::string::npos)
                e.refuse(says);
            return name;
        }};
}

Kind<double> positive(const char* unit) {
    return number_that("a number > 0", unit, [](double x) { return x > 0; });
}

Kind<double> not_negative(const char* unit) {
    return number_that("a number >= 0", unit, [](double x) { return x >= 0; });
}

Kind<int> whole(int least, int most) {
    const std::string says =
        "a whole number from " + std::to_string(least) + " to " + std::to_string(most);
    return {says, [says, least, most](const Entry& e) {
                const auto n = e.whole();
                if (!n || *n < least || *n > most) e.refuse(says);
                return static_cast<int>(*n);
            }};
}

Kind<int> count() { return whole(1, most_counted); }

Kind<bool> yes_or_no() {
    return {"true or false", [](const Entry& e) { return e.truth(); }};
}

Kind<std::string> word(const char* what, const std::vector<std::string>& known) {
    std::vector<std::pair<std::string, std::string>> words;
    words.reserve(known.size());
    for (const std::string& w : known) words.emplace_back(w, w);
    return one_of(what, std::move(words));
}

}  // namespace jvari::bench::store
