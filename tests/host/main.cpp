// A string in somebody else's audio callback: modal_two_point at 48 kHz in blocks of 64 rows. Prints the root mean square of the force on
// the nut [N] over the first 0.2 s.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <scenes/scene_file.hpp>
#include <schemes/registry.hpp>
#include <schemes/run.hpp>

int main() {
    using namespace jvari;
    constexpr double rate = 48000;
    constexpr int rows = 64, blocks = 150;
    const Scene scene = read_scene("tanpura_c3_release");  // its first tap is the force on the nut
    const auto all = schemes();
    const auto found = std::find_if(all.begin(), all.end(), [](const Descriptor& d) { return d.name == std::string("modal_two_point"); });
    const auto scheme = make_scheme(*found, scene, {.sample_rate = rate, .tap_rate = rate});

    const int taps = static_cast<int>(scene.taps.size());
    std::vector<double> buffer(taps * rows);  // tap after tap
    const Block block{.rows = rows, .taps = taps, .stride = rows, .tap = buffer.data()};
    const FlushDenormals flush;
    scheme->reset();
    double sum = 0;
    for (int n = 0; n < blocks; ++n) {  // what the callback does: it allocates nothing
        if (scheme->advance(block).outcome != Outcome::ok) return 1;
        for (int row = 0; row < rows; ++row) sum += buffer[row] * buffer[row];
    }
    std::printf("%.12e\n", std::sqrt(sum / (rows * blocks)));
}
