#include "bench/study/certificate_library.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "bench/folders.hpp"
#include "bench/store/records.hpp"
#include "reference/references.hpp"
#include "scenes/excitation.hpp"
#include "scenes/installed.hpp"
#include "schemes/making.hpp"

namespace jvari::bench::study {

namespace fs = std::filesystem;

namespace {
constexpr double slack = 1e-6;  // tolerance for instants [s]: less than a row

// Ends of the comparison's windows [s], NaN if the run is shorter. Certificates read all modes: the
// figure over 50 ms stands for what is heard, too.
Trust::ByWaveform window_ends(double until) {
    const double early = 10e-3 <= until + slack ? 10e-3 : nan,
                 headline = 50e-3 <= until + slack ? 50e-3 : nan;
    return {early, headline, until, headline};
}

// Value for the shortest window that reaches `end`, in a run of length `reached`; NaN if there is
// none.
double covering(const Certificate::ByWindow& values, double end, double reached) {
    if (std::isnan(end) || end > reached + slack) return nan;
    if (end > reached - slack) return values.back();
    for (std::size_t w = 0; w + 1 < values.size(); ++w)
        if (end <= agreement_windows[w] + slack && agreement_windows[w] <= reached + slack)
            return values[w];
    return values.back();
}

}  // namespace

double Trust::in_model(std::size_t tap, std::size_t waveform) const {
    return tap < figure.size() ? figure[tap][waveform] : nan;
}

double Trust::of_scene(std::size_t tap, std::size_t waveform) const {
    return in_model(tap, waveform) + (tap < left_out.size() ? left_out[tap][waveform] : 0);
}

bool Trust::any() const {
    return std::any_of(figure.begin(), figure.end(), [](const auto& tap) {
        return std::any_of(tap.begin(), tap.end(), [](double x) { return !std::isnan(x); });
    });
}

std::string file_stem(const std::string& scene_name) {
    std::string stem;
    for (const char c : scene_name)
        stem += std::isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '_' ? c : '_';
    return stem.empty() ? "scene" : stem;
}

Trust trust_of(const Certificate& c, const std::string& reference,
               const Certificate::Options& options, double until) {
    Trust t;
    t.key = c.key();
    t.of_this_program = c.of_this_program();
    const auto mine = std::find_if(c.entries.begin(), c.entries.end(), [&](const auto& e) {
        return e.reference == reference && e.options == options && e.doubled.empty() &&
               e.reason.empty();
    });
    if (mine == c.entries.end()) {
        t.missing = "the certificate of this scene has no " +
                    store::variant_name(reference, store::options_text(options));
        return t;
    }
    struct Largest {
        double difference = nan;
        const Certificate::Entry* other = nullptr;
    };
    const auto largest = [&](std::size_t tap, double end) {
        Largest most;
        const int index = static_cast<int>(mine - c.entries.begin());
        for (const auto& p : c.pairs) {
            if (p.first != index && p.second != index) continue;
            const Certificate::Entry& other = c.entries[p.first == index ? p.second : p.first];
            if (other.sample_rate > 0 || !other.doubled.empty()) continue;
            const double x = covering(p.taps[tap].relative_l2, end,
                                      std::min(mine->reached, other.reached) - c.from);
            if (!std::isnan(x) && !(x <= most.difference)) most = {x, &other};
        }
        return most;
    };
    t.figure.assign(c.taps.size(), Trust::unknown);
    std::vector<double> at_least(c.taps.size(), nan);
    // Agreement of other references with the same program and own compliance, before a sensitive
    // motion amplifies differences.
    if (is_matched(options)) {
        Certificate::Options own = options;
        std::erase_if(own, [](const auto& o) { return is_matched({o}); });
        const Trust unmatched = trust_of(c, reference, own, until);
        for (std::size_t k = 0; k < unmatched.figure.size(); ++k)
            at_least[k] = unmatched.figure[k][0];
        t.against = unmatched.against;
    }
    const auto ends = window_ends(until - c.from);
    std::vector<std::string> names;
    for (std::size_t k = 0; k < c.taps.size(); ++k)
        for (std::size_t w = 0; w < ends.size(); ++w) {
            const Largest most = largest(k, ends[w]);
            if (!most.other) continue;
            t.figure[k][w] = std::fmax(most.difference, at_least[k]);
            if (const std::string name = most.other->name();
                std::find(names.begin(), names.end(), name) == names.end())
                names.push_back(name);
        }
    for (std::size_t i = 0; i < c.entries.size(); ++i) {
        const Certificate::Entry& e = c.entries[i];
        if (e.doubled.empty()) continue;
        // The doubled reference may be any, because all share the model.
        const auto pair_with = [&](bool matched) {
            return std::ranges::find_if(c.pairs, [&](const Certificate::Pair& p) {
                return p.first == static_cast<int>(i) &&
                       is_matched(c.entries[p.second].options) == matched;
            });
        };
        const auto from = pair_with(is_matched(mine->options)),
                   step = pair_with(is_matched(e.options));
        if (from == c.pairs.end() || step == c.pairs.end()) continue;
        const double further =
            (is_matched(e.options) ? matched_and_further_ones : and_further_ones) - 1;
        t.left_out.resize(c.taps.size(), {0, 0, 0, 0});
        for (std::size_t k = 0; k < c.taps.size(); ++k)
            for (std::size_t w = 0; w < ends.size(); ++w) {
                const auto changed = [&](const Certificate::Pair& p) {
                    return covering(p.taps[k].relative_l2, ends[w],
                                    std::min(mine->reached, e.reached) - c.from);
                };
                t.left_out[k][w] += changed(*from) + further * changed(*step);
            }
        t.doubled += (t.doubled.empty() ? "" : " and ") + e.doubled;
    }
    for (const std::string& name : names) t.against += (t.against.empty() ? "" : ", ") + name;
    if (!t.any())
        t.missing = fmt::format("the certificate of this scene has nothing for {} over {:.6g} s",
                                reference, until);
    return t;
}

std::vector<fs::path> certificate_folders() {
    std::vector<fs::path> folders;
    std::error_code error;
    const char* set = std::getenv("JVARI_CERTIFICATES");
    if (set && *set) return {set};
    if (fs::is_directory("results/certificates", error))
        folders.emplace_back("results/certificates");
    for (const fs::path& folder : {installed("certificates"), fs::path(JVARI_SOURCE_CERTIFICATES),
                                   fs::path(JVARI_INSTALLED_CERTIFICATES)})
        if (fs::is_directory(folder, error)) {
            folders.emplace_back(folder);
            break;
        }
    return folders;
}

Trust trust_of(const Scene& scene, const std::string& reference, const Settings& settings,
               double until) {
    const std::string hash = timeless_hash(scene), stem = file_stem(scene.name);
    const int modes = modes_for(scene, settings);
    Trust best;
    best.missing = "no certificate of this scene at these settings";
    std::error_code error;
    for (const fs::path& folder : certificate_folders()) {
        std::vector<fs::path> files;
        for (const auto& entry : fs::directory_iterator(folder, error))
            if (const std::string name = entry.path().filename().string();
                name.rfind(stem, 0) == 0 && entry.path().extension() == ".json" &&
                entry.path().stem().extension() != ".cost")
                files.push_back(entry.path());
        std::sort(files.begin(), files.end());
        for (const fs::path& file : files) {
            const auto kept = read_certificate(file);
            if (!kept || kept->scene_hash != hash || kept->modes != modes ||
                kept->tap_rate != settings.tap_rate || kept->from != free_from(scene))
                continue;
            Trust t = trust_of(*kept, reference, settings.options, until);
            t.file = file.string();
            const auto figures = [](const Trust& x) {
                int n = 0;
                for (const auto& tap : x.figure)
                    for (const double v : tap) n += !std::isnan(v);
                return n;
            };
            if (best.file.empty() || std::pair(figures(t), t.of_this_program) >
                                         std::pair(figures(best), best.of_this_program))
                best = t;
        }
    }
    return best;
}

Trust trust_of(const Oversampled& o, double until) {
    Trust t;
    if (o.estimates.empty()) {
        t.missing = "one of the three rates failed, so there is no estimate";
        return t;
    }
    const auto ends = window_ends(until);
    for (const auto& tap : o.estimates) {
        auto& figure = t.figure.emplace_back();
        for (std::size_t w = 0; w < ends.size(); ++w) figure[w] = covering(tap, ends[w], until);
    }
    // The estimate covers only the time step, not the modes left out.
    t.left_out.assign(o.estimates.size(), Trust::unknown);
    t.against = fmt::format("Richardson's rule from {:.6g}, {:.6g} and {:.6g} Hz", o.rate / 4,
                            o.rate / 2, o.rate);
    return t;
}

}  // namespace jvari::bench::study
