// A value of a suite file and the way to it, so that what is wrong is said with file, line and key
// as in scenes.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "scenes/document.hpp"

namespace jvari::bench::store {

class Entry {
public:
    Entry(const Document& document, const Value& value, std::string key)
        : document_(&document), value_(&value), key_(std::move(key)) {}

    // "a.toml:3: cells.0.rates: found -1, expected a number > 0 [Hz]"
    [[noreturn]] void refuse(const std::string& expected) const;
    // "a.toml:3: cells.0: the key scenes is missing"
    [[noreturn]] void fail(const std::string& why) const;

    std::optional<Entry> at(const std::string& name) const;  // of a table
    Entry need(const std::string& name) const;
    // it is a table, with these keys alone
    void only(const std::vector<std::string>& known) const;
    std::vector<std::pair<std::string, Entry>> members() const;  // of a table
    // one value, or an array of at least one
    std::vector<Entry> items() const;
    std::vector<Entry> tables(const std::string& expected) const;  // an array, whatever its length
    bool is_text() const { return std::holds_alternative<std::string>(value_->content); }
    bool is_array() const { return std::holds_alternative<Array>(value_->content); }

    std::string text() const;
    std::optional<double> number() const;  // nothing where it is none
    std::optional<std::int64_t> whole() const;
    bool truth() const;
    std::string toml() const;         // as it could stand behind --set key=
    std::string option_text() const;  // as a scheme reads its option

private:
    std::string below(const std::string& name) const {
        return key_.empty() ? name : key_ + "." + name;
    }

    const Document* document_;
    const Value* value_;
    std::string key_;  // "" of the whole file
};

}  // namespace jvari::bench::store
