// A string in somebody else's audio program: modal_two_moment at 48 kHz in blocks of 64 rows. host
// FILE.wav plays 0.2 s, plucks the ringing string again, tuned up by a semitone, and plays 0.2 s.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <schemes/registry.hpp>
#include <schemes/run.hpp>

using namespace jvari;

Scene tanpura() {  // the string of scenes/tanpura_c3_release.toml
    String s;
    s.length = 1, s.linear_density = 4.83e-4, s.tension = 33.1, s.bending_stiffness = 6.03e-5;
    s.damping = PolynomialDamping{.sigma0 = 0.6, .sigma1 = 6.5e-3, .sigma3 = 5e-6};
    LumpedBarrier bridge;
    bridge.position = 10e-3, bridge.width = 2e-3, bridge.stiffness = {4.39e8};
    s.barriers = {bridge};
    s.thread =
        Thread{.position = 5e-3, .width = 1.2e-3, .stiffness = 1.2e5, .damping = 1.2, .height = 0};
    s.start = ModeShape{.number = 1, .amplitude = 1.9e-3};
    Scene scene;
    scene.strings = {s};
    scene.taps = {{.name = "nut", .quantity = Quantity::nut_force}};
    return scene;
}

int main(int argc, char** argv) {
    constexpr int rate = 48000, rows = 64, blocks = 150;
    const Scene open = tanpura();
    Scene up = open;  // another tension, and a pluck that begins with the scheme
    up.strings[0].tension *= std::pow(2, 2 / 12.0);
    up.strings[0].pluck = Pluck{.amplitude = -0.4, .duration = 50e-3, .skew = 30, .position = 0.5};

    const auto all = schemes();
    const auto found = std::find_if(all.begin(), all.end(), [](const Descriptor& d) {
        return d.name == std::string("modal_two_moment");
    });
    const Settings settings{.sample_rate = rate,
                            .tap_rate = rate,
                            .modes = 133,  // both strings have as many
                            .options = {{"compliance", "matched"}}};
    const auto first = make_scheme(*found, open, settings),
               next = make_scheme(*found, up, settings);

    std::vector<double> buffer(rows), force;  // [N]
    const Block block{.rows = rows, .taps = 1, .stride = rows, .tap = buffer.data()};
    const FlushDenormals flush;
    Scheme* sounding = first.get();
    for (int n = 0; n < 2 * blocks; ++n) {  // what an audio callback does: nothing is allocated
        if (n == blocks && next->start_from(*sounding)) sounding = next.get();
        if (sounding->advance(block).outcome != Outcome::ok) return 1;
        force.insert(force.end(), buffer.begin(), buffer.begin() + rows);
    }

    double loudest = 0;
    for (const double f : force) loudest = std::max(loudest, std::abs(f));
    std::ofstream wav(argc > 1 ? argv[1] : "string.wav", std::ios::binary);
    const auto number = [&wav](std::uint32_t x, int bytes) {  // little-endian
        wav.write(reinterpret_cast<const char*>(&x), bytes);
    };
    const auto bytes = static_cast<std::uint32_t>(2 * force.size());
    wav << "RIFF", number(36 + bytes, 4), wav << "WAVEfmt ";
    number(16, 4), number(1, 2), number(1, 2);  // PCM, one channel
    number(rate, 4), number(2 * rate, 4), number(2, 2), number(16, 2), wav << "data";
    number(bytes, 4);
    for (const double f : force)
        number(static_cast<std::uint32_t>(std::lround(32767 * f / loudest)), 2);
    return wav.flush() ? 0 : 1;
}
