// Keys in the tables of a suite file. Each key is declared once, with the kind of value, the
// default and the meaning. The declaration serves the reader, error messages with file and line,
// `jvari list keys`, and the documentation.
#pragma once

#include <array>
#include <concepts>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bench/store/usage.hpp"
#include "scenes/document.hpp"
#include "scenes/wording.hpp"

namespace jvari::bench::store {

// A value in a suite file together with its path, so error messages name file, line and key like
// error messages for scenes.
class Entry {
public:
    Entry(const Document& document, const Value& value, std::string key)
        : document_(&document), value_(&value), key_(std::move(key)) {}

    // Throws, for example, "a.toml:3: cells.0.rates: found -1, expected a number > 0 [Hz]".
    [[noreturn]] void refuse(const std::string& expected) const;
    // Throws, for example, "a.toml:3: cells.0: the key scenes is missing".
    [[noreturn]] void fail(const std::string& why) const;

    std::optional<Entry> at(const std::string& name) const;  // member of a table
    Entry need(const std::string& name) const;
    // Requires a table with no other keys than these.
    void only(const std::vector<std::string>& known) const;
    std::vector<std::pair<std::string, Entry>> members() const;  // members of a table
    // Returns a single value, or the elements in a non-empty array.
    std::vector<Entry> items() const;
    std::vector<Entry> tables(const std::string& expected) const;  // array with any length
    bool is_text() const { return std::holds_alternative<std::string>(value_->content); }
    bool is_array() const { return std::holds_alternative<Array>(value_->content); }

    std::string text() const;
    std::optional<double> number() const;  // nothing if the value is no number
    std::optional<std::int64_t> whole() const;
    bool truth() const;
    std::string toml() const;         // text for the command line, behind --set key=
    std::string option_text() const;  // text for a scheme's option

private:
    std::string below(const std::string& name) const {
        return key_.empty() ? name : key_ + "." + name;
    }

    const Document* document_;
    const Value* value_;
    std::string key_;  // "" for the whole file
};

struct KeyWords {
    std::string name, value, absent, meaning;  // absent: the default, "" if there is none
    bool needed = false;
    std::vector<KeyWords> below = {};  // keys in a table
};

template <class T>
struct Kind {          // kind of value
    std::string says;  // for messages ("expected ...") and lists
    std::function<T(const Entry&)> read;
    std::vector<KeyWords> below = {};
};
Kind<std::string> text();
Kind<std::string> name_of_file();              // lower-case letters, digits, _ and -
Kind<double> positive(const char* unit = "");  // finite, like all numbers here
Kind<double> not_negative(const char* unit = "");
constexpr int most_counted = 9'999'999;  // upper bound for modes, repeats and jobs
Kind<int> whole(int least, int most);
Kind<int> count();  // 1 ... most_counted
Kind<bool> yes_or_no();

template <class T>
Kind<std::vector<T>> several(Kind<T> one) {
    return {one.says + " or several",
            [read = one.read](const Entry& e) {
                std::vector<T> all;
                for (const Entry& item : e.items()) all.push_back(read(item));
                return all;
            },
            one.below};
}

template <class T>
Kind<T> one_of(const char* what, std::vector<std::pair<std::string, T>> words) {
    std::vector<std::string> known;
    std::string says;
    for (const auto& [word, value] : words) {
        known.push_back(word);
        says += (says.empty() ? "" : ", ") + word;
    }
    return {says, [what, words, known](const Entry& e) {
                const std::string found = e.text();
                for (const auto& [word, value] : words)
                    if (word == found) return value;
                e.fail(unknown(what, found, known));
            }};
}
Kind<std::string> word(const char* what, const std::vector<std::string>& known);

// A table with keys chosen by the author of the file; `one` reads each value.
template <class T>
Kind<std::vector<T>> by_name(std::string says,
                             std::function<T(const std::string& name, const Entry&)> one) {
    return {std::move(says), [one](const Entry& e) {
                std::vector<T> all;
                for (const auto& [name, value] : e.members()) all.push_back(one(name, value));
                return all;
            }};
}

template <class Part>
struct Key {
    KeyWords words;
    std::function<void(Part&, const Entry&)> read;
};

namespace detail {
template <class T>
std::string default_text(const T& x) {
    if constexpr (std::same_as<T, bool>) return x ? "true" : "false";
    else if constexpr (std::is_arithmetic_v<T>) return number_text(x);
    else return "";
}
template <class Part, class Member, class T>
Key<Part> key(const char* name, Member Part::*member, const Kind<T>& kind, const char* meaning,
              std::string absent, bool needed) {
    return {{name, kind.says, std::move(absent), meaning, needed, kind.below},
            [member, read = kind.read](Part& part, const Entry& e) { part.*member = read(e); }};
}
}  // namespace detail

template <class Part, class Member, class T>
Key<Part> needed(const char* name, Member Part::*member, const Kind<T>& kind, const char* meaning) {
    return detail::key(name, member, kind, meaning, "", true);
}
template <class Part, class Member, class T>
// The default is the member's initial value in Part.
Key<Part> key(const char* name, Member Part::*member, const Kind<T>& kind, const char* meaning) {
    return detail::key(name, member, kind, meaning, detail::default_text(Part{}.*member), false);
}
template <class Part, class Member, class T>
Key<Part> key(const char* name, Member Part::*member, const Kind<T>& kind, const char* meaning,
              const char* absent) {
    return detail::key(name, member, kind, meaning, absent, false);
}

template <class Part>
std::vector<KeyWords> words_of(const std::vector<Key<Part>>& keys) {
    std::vector<KeyWords> all;
    all.reserve(keys.size());
    for (const Key<Part>& k : keys) all.push_back(k.words);
    return all;
}

template <class Part>
void read_keys(const Entry& e, const std::vector<Key<Part>>& keys, Part& part) {
    std::vector<std::string> names;
    names.reserve(keys.size());
    for (const Key<Part>& k : keys) names.push_back(k.words.name);
    e.only(names);
    for (const Key<Part>& k : keys)
        if (k.words.needed) k.read(part, e.need(k.words.name));
        else if (const auto v = e.at(k.words.name)) k.read(part, *v);
}

// A table with these keys; `check` applies rules for several keys together.
template <class Part>
Kind<Part> table(std::vector<Key<Part>> keys, void (*check)(Part&, const Entry&) = nullptr) {
    std::vector<KeyWords> words = words_of(keys);
    return {"a table",
            [keys = std::move(keys), check](const Entry& e) {
                Part part;
                read_keys(e, keys, part);
                if (check) check(part, e);
                return part;
            },
            std::move(words)};
}

// [[name]] tables. No two may have the same name, but for tables without a name.
template <class Part>
Kind<std::vector<Part>> tables(const std::string& name, Kind<Part> one) {
    return {"[[" + name + "]] tables",
            [name, read = one.read](const Entry& e) {
                std::vector<Part> all;
                for (const Entry& item : e.tables("[[" + name + "]] tables")) {
                    all.push_back(read(item));
                    if constexpr (requires(Part p) { p.name; })
                        for (std::size_t k = 0; k + 1 < all.size(); ++k)
                            if (!all.back().name.empty() && all[k].name == all.back().name)
                                item.need("name").refuse("a name of its own");
                }
                return all;
            },
            one.below};
}

}  // namespace jvari::bench::store
