// Whatever bytes come, a scene file is read or refused with SceneFileError; what is read is valid and survives being written.
// Built here with scene_fuzz_driver.cpp. With libFuzzer:
//   clang++ -std=c++20 -g -O1 -fsanitize=fuzzer,address,undefined -I. tests/scene_fuzz.cpp scenes/*.cpp $(pkg-config --cflags --libs
//   tomlplusplus gsl)
//           -DJVARI_SOURCE_SCENES='"scenes"' -DJVARI_INSTALLED_SCENES='""' -o scene_fuzz && ./scene_fuzz corpus scenes
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "scenes/columns.hpp"
#include "scenes/scene_file.hpp"
#include "scenes/schema.hpp"

using namespace jvari;

// A text, then overrides, each after a zero byte.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    std::vector<std::string> parts{""};
    for (std::size_t i = 0; i < size; ++i) {
        if (data[i]) parts.back() += static_cast<char>(data[i]);
        else parts.emplace_back();
    }
    const std::string text = parts.front();
    parts.erase(parts.begin());
    try {
        const Scene scene = parse_scene(text, "no_such_directory/scene.toml", parts);
        validate(scene);
        const Scene again = parse_scene(write_scene(scene), "again.toml");
        if (!(again == scene) || scene_hash(again) != scene_hash(scene)) {
            std::fprintf(stderr, "written and read back differs:\n%s\n", write_scene(scene).c_str());
            std::abort();
        }
    } catch (const SceneFileError&) {
    }
    try {
        std::vector<double> x, y;
        read_columns("table.csv", text, Column{"x_m", "x_m", any}, x, Column{"height_m", "height_m", any}, y);
    } catch (const SceneFileError&) {
    }
    return 0;
}
