// What the reference of a comparison may be trusted with: the figures of its certificate, on the
// comparison's own windows.
//
// For a reference: its largest relative L2 difference from any other reference, and from itself at
// another tolerance or by another integrator; with matched compliance no less than with own over 10
// ms. One pair alone can agree by chance where the motion is sensitive. A scheme at a multiple of a
// rate confirms no reference, because its own error is larger. For such a scheme that stands in:
// its estimate of its own error, by Richardson's rule. A window has the figure of the shortest
// certified window that holds it, and none where the certificate ends before.
//
// That is how far the reference solves its model: a string cut off at so many modes, a profile of
// so many points. How far the model is the scene's is another figure: its difference from the
// reference with modes or points doubled, and what all further doublings would change
// (and_further_ones), the two added. An error of the scene is certain to both figures together.
// Where there is no figure the uncertainty is unknown, not zero.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "bench/study/certificate.hpp"
#include "reference/oversampled.hpp"

namespace jvari::bench::study {

struct Trust {
    static constexpr std::array<const char*, 3> columns = {
        "certificate_l2_10ms", "certificate_l2_50ms", "certificate_l2_whole"};
    // by tap of the scene, by window; NaN: none. Empty: no certificate at all
    std::vector<std::array<double, 3>> figure;
    std::vector<std::array<double, 3>> left_out;  // of the model, likewise
    std::string against;                          // "sundials rtol=1e-12"
    // "modes and points"; "": nothing, and left_out is empty
    std::string doubled;
    std::string file, key;  // of the certificate; "" where there is no file
    // false: of other sources, compiler, flags or vector instructions
    bool of_this_program = true;
    std::string missing;  // why there is none
    double in_model(std::size_t tap, std::size_t window) const;
    double of_scene(std::size_t tap, std::size_t window) const;
    bool any() const;
};

// <scene name>*.json in ./results/certificates, where `jvari certify` writes, and in the library:
// that of the sources, else the installed one. $JVARI_CERTIFICATES stands in place of all.
std::vector<std::filesystem::path> certificate_folders();

// The best figures that any certificate of this scene (whatever its duration) at these modes and
// this tap rate has for `reference`, over `until` s. One that this program made comes before one
// with as many figures that another did.
Trust trust_of(const Scene&, const std::string& reference, const Settings&, double until);
Trust trust_of(const Certificate&, const std::string& reference, const Certificate::Options&,
               double until);

Trust trust_of(const Oversampled&, double until);  // of a stand-in; `until`: its last row [s]

std::string file_stem(const std::string& scene_name);  // what its file may be called

}  // namespace jvari::bench::study
