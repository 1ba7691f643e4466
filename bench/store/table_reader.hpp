// What every table of a suite file is read by, so that messages carry file, line and key as those of scenes do.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "bench/store/usage.hpp"
#include "scenes/document.hpp"
#include "scenes/scene_file.hpp"
#include "scenes/wording.hpp"

namespace jvari::bench::store {

class SuiteReader {
public:
    explicit SuiteReader(const Document& d) : document_(d) {}

    [[noreturn]] void refuse(const Value& v, const std::string& key, const std::string& expected) const {
        throw SceneFileError(document_.place(v.place) + ": " + key + ": found " + v.found() + ", expected " + expected);
    }
    void only(const Value& table, const std::string& within, const std::vector<std::string>& known) const {
        for (const Member& m : std::get<TomlTable>(table.content))
            if (std::find(known.begin(), known.end(), m.key) == known.end())
                throw SceneFileError(document_.place(m.value.place) + ": " + within + unknown("key", m.key, known));
    }
    std::string text(const Value& v, const std::string& key) const {
        if (const auto* s = std::get_if<std::string>(&v.content)) return *s;
        refuse(v, key, "a text");
    }
    double positive(const Value& v, const std::string& key) const {
        const auto* whole = std::get_if<std::int64_t>(&v.content);
        const auto* number = std::get_if<double>(&v.content);
        const double x = whole ? static_cast<double>(*whole) : number ? *number : -1;
        if (!(x > 0) || !std::isfinite(x)) refuse(v, key, "a number > 0");
        return x;
    }
    int count(const Value& v, const std::string& key) const {
        const auto* n = std::get_if<std::int64_t>(&v.content);
        if (!n || *n < 1 || *n >= 10'000'000) refuse(v, key, "a whole number > 0");
        return static_cast<int>(*n);
    }
    int none_or(const Value& v, const std::string& key) const {  // 0, or a count
        const auto* n = std::get_if<std::int64_t>(&v.content);
        if (!n || *n < 0 || *n >= 10'000'000) refuse(v, key, "a whole number, 0 or more");
        return static_cast<int>(*n);
    }
    std::string toml(const Value& v, const std::string& key) const {  // a value as it could stand behind --set key=
        if (const auto* s = std::get_if<std::string>(&v.content)) return quote(*s);
        if (const auto* x = std::get_if<double>(&v.content)) return number_text(*x);
        if (std::holds_alternative<TomlTable>(v.content) || std::holds_alternative<Moment>(v.content)) refuse(v, key, "a value");
        if (const auto* items = std::get_if<Array>(&v.content)) {
            std::string text = "[";
            for (const Value& item : *items) text += (text.size() > 1 ? ", " : "") + toml(item, key);
            return text + "]";
        }
        return v.found();
    }
    std::string option_text(const Value& v, const std::string& key) const {
        if (const auto* s = std::get_if<std::string>(&v.content)) return *s;
        if (std::holds_alternative<Array>(v.content)) refuse(v, key, "a text or a number");
        return toml(v, key);
    }
    // One value or an array of at least one.
    template <class One>
    auto several(const Value& v, const std::string& key, One one) const {
        std::vector<decltype(one(v, key))> all;
        const auto* items = std::get_if<Array>(&v.content);
        if (!items) return std::vector{one(v, key)};
        for (std::size_t i = 0; i < items->size(); ++i) all.push_back(one((*items)[i], key + "." + std::to_string(i)));
        if (all.empty()) refuse(v, key, "at least one value");
        return all;
    }
    const TomlTable& table(const Value& v, const std::string& key) const {
        if (const auto* t = std::get_if<TomlTable>(&v.content)) return *t;
        refuse(v, key, "a table");
    }
    std::string place(const Value& v) const { return document_.place(v.place); }

private:
    const Document& document_;
};

}  // namespace jvari::bench::store
