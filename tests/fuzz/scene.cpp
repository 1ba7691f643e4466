// Whatever bytes come, a scene file is read or refused with SceneFileError;
// what is read is valid, survives being written, and keeps its hash.
#include <vector>

#include "fuzz.hpp"
#include "scenes/columns.hpp"
#include "scenes/scene_file.hpp"
#include "scenes/schema.hpp"

using namespace jvari;
using namespace jvari::test;

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
        ++inputs_read;
        validate(scene);
        const std::string written = write_scene(scene);
        const Scene again = parse_scene(written, "again.toml");
        promise(again == scene, "written and read back is the same scene", written);
        promise(scene_hash(again) == scene_hash(scene), "written and read back has the same hash",
                written);
        promise(write_scene(again) == written, "written again is the same text", written);
        needed_by(scene);
    } catch (const SceneFileError&) {}
    try {
        std::vector<double> x, y;
        const ColumnTo both[] = {{{"x_m", "x_m", any}, &x}, {{"height_m", "height_m", any}, &y}};
        read_columns("table.csv", text, both);
    } catch (const SceneFileError&) {}
    try {
        TableDamping modes;
        modes_from("modes.csv", text, {"frequency_hz", "", positive}, {"sigma_per_s", "", any},
                   modes);
        promise(modes.frequency_hz.size() == modes.decay_rate.size(), "a mode has a rate", text);
    } catch (const SceneFileError&) {}
    try {
        const TableStart start = start_from("start.csv", text);
        promise(start.at.size() == start.velocity.size(), "a row has a velocity", text);
    } catch (const SceneFileError&) {}
    for (const char* file : {"force.csv", "force.wav"}) try {
            Pluck pluck;
            force_from(file, std::string(reinterpret_cast<const char*>(data), size), pluck);
            promise(pluck.time.size() == pluck.share.size(), "an instant has a force", text);
        } catch (const SceneFileError&) {}
    return 0;
}
