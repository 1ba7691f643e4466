// A string in somebody else's audio program: modal_two_point at 48 kHz in blocks of 64 rows. host
// FILE.wav plays 0.2 s into a file.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <scenes/scene_file.hpp>
#include <schemes/registry.hpp>
#include <schemes/run.hpp>

int main(int argc, char** argv) {
    using namespace jvari;
    constexpr int rate = 48000, rows = 64, blocks = 150;
    const Scene scene = read_scene("tanpura_c3_release");  // its first tap is the force on the nut
    const auto all = schemes();
    const auto found = std::find_if(all.begin(), all.end(), [](const Descriptor& d) {
        return d.name == std::string("modal_two_point");
    });
    const auto scheme = make_scheme(*found, scene, {.sample_rate = rate, .tap_rate = rate});

    const int taps = static_cast<int>(scene.taps.size());
    std::vector<double> buffer(taps * rows), force;  // tap after tap [N]
    const Block block{.rows = rows, .taps = taps, .stride = rows, .tap = buffer.data()};
    const FlushDenormals flush;
    scheme->reset();
    for (int n = 0; n < blocks; ++n) {  // what an audio callback does: advance() allocates nothing
        if (scheme->advance(block).outcome != Outcome::ok) return 1;
        force.insert(force.end(), buffer.begin(), buffer.begin() + rows);
    }

    const double loudest = std::abs(*std::max_element(
        force.begin(), force.end(), [](double a, double b) { return std::abs(a) < std::abs(b); }));
    std::ofstream wav(argc > 1 ? argv[1] : "string.wav", std::ios::binary);
    // little-endian
    const auto number = [&wav](std::uint32_t x, int bytes) {
        wav.write(reinterpret_cast<const char*>(&x), bytes);
    };
    const auto bytes = static_cast<std::uint32_t>(2 * force.size());
    // PCM, one channel
    wav << "RIFF", number(36 + bytes, 4), wav << "WAVEfmt ", number(16, 4), number(1, 2),
        number(1, 2);
    number(rate, 4), number(2 * rate, 4), number(2, 2), number(16, 2), wav << "data",
        number(bytes, 4);
    for (const double f : force)
        number(static_cast<std::uint32_t>(std::lround(32767 * f / loudest)), 2);
    return wav.flush() ? 0 : 1;
}
