// samples SCENE SECONDS PLUGIN: every scheme, and those of a plugin, play a scene of the installed
// library. Prints a line for each row: the scheme, then the taps.
#include <cstdio>
#include <exception>
#include <scenes/installed.hpp>
#include <scenes/scene_file.hpp>
#include <schemes/registry.hpp>
#include <schemes/run.hpp>
#include <schemes/vector_instructions.hpp>
#include <stdexcept>

using namespace jvari;

namespace {
void play(const Descriptor& scheme, const Scene& scene) {
    try {
        const Run r = run(scheme, scene, {.sample_rate = 88200, .tap_rate = 44100});
        for (long n = 0; n < r.trace.rows; ++n) {
            std::printf("%s", scheme.name);
            for (int k = 0; k < r.trace.taps(); ++k)
                std::printf(" %.17g", r.trace.column(k)[static_cast<std::size_t>(n)]);
            std::printf("\n");
        }
    } catch (const Refusal&) { std::printf("%s refuses\n", scheme.name); }
}

bool flushes() {
    volatile double least = 1e-310;
    const FlushDenormals flush;
    return least * 0.5 == 0;
}
}  // namespace

int main(int argc, char** argv) {
    if (argc != 4) return 2;
    try {
        if (installed("scenes").empty()) throw std::runtime_error("finds no installed scenes");
        if (!flushes()) throw std::runtime_error("does not flush denormals to zero");
        std::fprintf(stderr, "vectors: %s\n", vector_instructions().c_str());
        const Scene scene = read_scene(argv[1], {std::string("duration=") + argv[2]});
        for (const Descriptor& scheme : schemes()) play(scheme, scene);
        for (const Descriptor& scheme : load_plugin(argv[3]).schemes) play(scheme, scene);
    } catch (const std::exception& e) {
        std::fprintf(stderr, "%s\n", e.what());
        return 1;
    }
    return 0;
}
