// Trust in the reference of a comparison: the figures from its certificate, on the comparison's own
// windows.
//
// The figure for a reference is its largest relative L2 difference from any other reference, and
// from itself at another tolerance or with another integrator. With matched compliance the figure
// is at least the one with own compliance over 10 ms. A single pair would not be enough, because
// two references can agree by chance if the motion is sensitive. A scheme at a multiple of a rate
// confirms no reference, because its own error is larger. A scheme that stands in has its own
// estimate, by Richardson's rule. Each window takes the figure of the shortest certified window
// that contains it, and none if the certificate ends earlier.
//
// This figure tells how accurately the reference solves its model: a string cut off at so many
// modes, a profile with so many points. A second figure tells how far the model is from the scene.
// It adds two parts: the difference from the reference with doubled modes or points, and the
// estimate for all further doublings (and_further_ones). The uncertainty of an error of the scene
// is the sum of both figures. Without a figure the uncertainty is unknown, not zero.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "bench/study/certificate.hpp"
#include "reference/oversampled.hpp"

namespace jvari::bench::study {

struct Trust {
    // for the waveforms, the first of measures()
    static constexpr std::array<const char*, 4> columns = {
        "certificate_l2_10ms", "certificate_l2_50ms", "certificate_l2_whole",
        "certificate_l2_heard"};
    using ByWaveform = std::array<double, columns.size()>;
    static constexpr ByWaveform unknown = {nan, nan, nan, nan};
    // by tap of the scene, by waveform; NaN: none. Empty: no certificate
    std::vector<ByWaveform> figure;
    // effect of the modes and points left out, likewise
    std::vector<ByWaveform> left_out;
    std::string against;  // "sundials rtol=1e-12"
    // "modes and points"; "": nothing, and left_out is empty
    std::string doubled;
    std::string file, key;  // file and key of the certificate; "" without a file
    // false: other sources, compiler, flags or vector instructions
    bool of_this_program = true;
    std::string missing;  // reason why there is none
    double in_model(std::size_t tap, std::size_t waveform) const;
    double of_scene(std::size_t tap, std::size_t waveform) const;
    bool any() const;
};

// Folders with <scene name>*.json: ./results/certificates, where `jvari certify` writes, and the
// library (in the sources, else the installed one). $JVARI_CERTIFICATES replaces them all.
std::vector<std::filesystem::path> certificate_folders();

// Best figures for `reference` over `until` s, from any certificate of this scene (at any duration)
// with these modes and this tap rate. With equally many figures, a certificate from this program
// comes before a certificate from another.
Trust trust_of(const Scene&, const std::string& reference, const Settings&, double until);
Trust trust_of(const Certificate&, const std::string& reference, const Certificate::Options&,
               double until);

// Trust in a stand-in; `until`: its last row [s].
Trust trust_of(const Oversampled&, double until);

std::string file_stem(const std::string& scene_name);  // file name for the scene

}  // namespace jvari::bench::study
