// Files that a run writes: trace or sound, final state, contacts and picture. Each file is checked
// before the run, so that no long run ends without its results.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "bench/command/player.hpp"
#include "bench/report/vega.hpp"
#include "bench/study/cell.hpp"
#include "schemes/impacts.hpp"

namespace jvari::bench::command {

struct RunFiles {  // "": not written
    std::string out, impacts, plot, width, state;
    bool energy = false;  // true: three more columns in the trace
};

class RunOutputs {
public:
    // Throws UsageError: a file cannot be written, or the run would not give its content. `scene`:
    // as loaded. Picture and sound need different taps: the picture shows the scene's own taps, the
    // sound uses others. A run for both has the scene's own taps first.
    RunOutputs(const RunFiles&, const Descriptor&, const Scene& scene, const Settings&);
    const Scene& scene() const { return scene_; }  // with the taps for all files
    RunOptions options();                          // what the run collects for the files
    // During the run: throws UsageError if the scheme reports no contacts but --impacts needs them.
    void check_reports() const;
    // Writes all files, and names them in the run's JSON and text.
    void write(const Run&, const study::Summary&, nlohmann::ordered_json&, std::string& text) const;

private:
    void check_impacts() const;
    void check_state(Settings) const;
    void write_out(const Trace&, nlohmann::ordered_json&, std::string& text) const;
    void write_state(const ModalState&, nlohmann::ordered_json&, std::string& text) const;
    void write_impacts(double seconds, nlohmann::ordered_json&, std::string& text) const;
    void draw(const study::Summary&, const Trace&, nlohmann::ordered_json&,
              std::string& text) const;

    RunFiles files_;
    const Descriptor& scheme_;
    Scene own_, sounding_, scene_;
    std::size_t drawn_;  // number of taps in front of the sound's, if both are written
    std::optional<report::Vega> vega_;
    std::optional<Player> player_;
    std::vector<Impacts> impacts_;  // for each string
};

}  // namespace jvari::bench::command
