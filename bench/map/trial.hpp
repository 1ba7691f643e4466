// One point of a map: a scheme at its settings on one scene, run for as long as the scene says and judged.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "bench/compare/catalogue.hpp"
#include "bench/compare/compare_plan.hpp"
#include "bench/map/map_file.hpp"
#include "bench/map/verdict.hpp"

namespace jvari::bench::map {

struct Trial {
    const Descriptor* scheme;
    Scene scene;
    Settings settings;
    std::string reference;    // "none"; a name; "": the first of the references that represents the scene
    int reference_modes = 0;  // 0: those of this trial
};

// The trial that the assignments describe; keys as an axis of a map has them. `rate` is 44100 Hz unless set. Rows are taken at the rate
// divided by the whole number that brings it nearest to 44.1 kHz. Throws SceneFileError, BadScene, UsageError.
Trial trial_of(const std::string& scene, const Descriptor&, const std::string& reference, const std::vector<Assignment>&,
               int reference_modes = 0);

double row_rate(double sample_rate);

std::string identity_of(const Trial&);  // JSON: all that its judgement depends on, the program aside

struct Tried {
    Judgement judgement;
    Figures figures;
    std::string reference;  // that was compared with; "" for none
    long steps = 0;         // taken
};

// Runs of references, kept for the trials that share one; in a folder, for those of other processes too.
class Truths {
public:
    explicit Truths(const compare::Catalogue& c, std::filesystem::path folder = {}) : catalogue_(c), folder_(std::move(folder)) {}
    struct Truth {
        std::once_flag once;
        std::string name;  // "": none represents the scene, or none came to the end
        Trace trace;
    };
    const Truth& of(const Trial&, const study::ProgressOf& = {});
    const compare::Catalogue& catalogue() const { return catalogue_; }

private:
    void make(Truth&, const Trial&, const study::ProgressOf&) const;
    const compare::Catalogue& catalogue_;
    const std::filesystem::path folder_;
    std::mutex mutex_;
    std::map<std::string, std::unique_ptr<Truth>> truths_;
};

Tried run_trial(const Trial&, Truths&, const study::ProgressOf& = {});  // what that throws ends it

}  // namespace jvari::bench::map
