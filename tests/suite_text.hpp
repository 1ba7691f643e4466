// The message that reading a suite gives.
#pragma once

#include <string>

#include "bench/suite/suite_file.hpp"
#include "scenes/scene_file.hpp"

namespace jvari::test {

inline std::string refusal_of(const std::string& text) {
    try {
        bench::suite::parse_suite(text, "a.toml");
    } catch (const SceneFileError& e) {
        return e.what();
    }
    return "read";
}

}  // namespace jvari::test
