#include "bench/store/json.hpp"

namespace jvari::bench::store {

namespace {
using Json = nlohmann::ordered_json;

std::string written(const Json& j, int indent) {
    return j.dump(indent, ' ', false, Json::error_handler_t::replace);
}
}  // namespace

std::string as_utf8(const std::string& bytes) { return parsed(compact(bytes)); }
std::string indented(const Json& j) { return written(j, 2); }
std::string compact(const Json& j) { return written(j, -1); }

Json parsed(const std::string& text) {
    constexpr int deepest = 32;
    return Json::parse(text, [](int level, Json::parse_event_t event, const Json&) {
        if (level >= deepest && (event == Json::parse_event_t::object_start ||
                                 event == Json::parse_event_t::array_start))
            throw std::runtime_error("it is nested deeper than 32 levels");
        return true;
    });
}

std::string escaped(const std::string& text) {
    std::string safe;
    for (const char c : text)
        safe += c == '&'                               ? "&amp;"
                : c == '<'                             ? "&lt;"
                : c == '>'                             ? "&gt;"
                : c == '"'                             ? "&quot;"
                : static_cast<unsigned char>(c) < 0x20 ? " "
                                                       : std::string(1, c);
    return safe;
}

Outcome outcome_named(const std::string& name) {
    for (const Outcome o : {Outcome::ok, Outcome::diverged, Outcome::not_converged})
        if (name == name_of(o)) return o;
    throw std::runtime_error("unknown status " + name);
}

std::string kept_text(const std::string& identity, const Json& content, int indent) {
    Json j{{"of", parsed(identity)}};
    j.update(content);
    return sealed(written(j, indent));
}

}  // namespace jvari::bench::store
