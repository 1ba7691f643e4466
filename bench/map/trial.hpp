// One point of a map: a scheme at its settings on one scene, run for as long as the scene says and
// judged. A trial is what is varied; a job of bench/study is what is run of it.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "bench/compare/catalogue.hpp"
#include "bench/map/map_file.hpp"
#include "bench/study/judgement.hpp"
#include "bench/study/run.hpp"

namespace jvari::bench::map {

struct Trial {
    const Descriptor* scheme;
    Scene scene;
    Settings settings;
    // "none"; a name; "": the first of the references that represents the scene
    std::string reference;
    int reference_modes = 0;  // 0: those of this trial
};

// The trial that the assignments describe; keys as an axis of a map has them. `rate` is 44100 Hz
// unless set. Rows are taken at the rate divided by the whole number that brings it nearest to 44.1
// kHz. Throws SceneFileError, BadScene, UsageError.
Trial trial_of(const std::string& scene, const Descriptor&, const std::string& reference,
               const std::vector<Assignment>&, int reference_modes = 0);

double row_rate(double sample_rate);

// What maps listen to in place of the scene's own taps:
// the displacement of every string at two points, and its nut force. The worst string decides.
Scene listened(Scene);

struct MapRequest {
    std::string program;  // program_identity: counts into the address of what is kept
    // DIR, in whose points/ records are kept, and references in references/; "" for nowhere
    std::filesystem::path folder;
    bool resume = false;  // what lies there is read back
    int jobs = 0;         // 0: as many as there are cores
};

struct Tried {
    study::Record record;
    double error;  // relative L2 of the worst string's nut force, NaN where there is none
    study::Judgement judgement;
};

// Runs trials as jobs. Their references are kept as long as it lives.
class Trials {
public:
    explicit Trials(const compare::Catalogue&, const MapRequest& = {"{}", {}, false, 0});

    // Where another process or thread runs it: what that comes to, or nothing unless `wait`.
    std::optional<Tried> operator()(const Trial&, bool wait);
    Tried operator()(const Trial& t) { return *(*this)(t, true); }
    study::Plan plan_of(const Trial&) const;  // of one job
    int ran() const { return keep_.ran; }

private:
    std::vector<study::ReferenceChoice> references_of(const Trial&) const;
    const compare::Catalogue& catalogue_;
    const MapRequest request_;
    study::References references_;
    study::Kept keep_;
};

}  // namespace jvari::bench::map
