// Jobs on points: the request of a study. A point is a scene with its references; a job is a cell
// on a point, with a list of measurements. compare makes the jobs of one point, a suite makes the
// jobs of its file.
#pragma once

#include <cmath>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "bench/study/record.hpp"
#include "bench/study/reference.hpp"
#include "bench/study/truth.hpp"

namespace jvari::bench::study {

struct Point {
    Scene scene;
    std::vector<std::pair<std::string, std::string>> swept;  // key, value
    std::vector<ReferenceChoice> references;
    // 0: found by doubling; none: the only reference has the cells' modes
    std::optional<int> truth_modes = 0;
    int begin = 0;               // first number of modes in the doubling; 0: modes_to_begin_with
    double effort = 1;           // factor on the limits in run_truth
    bool settles_whole = false;  // argument of run_truth
    bool alone = false;          // true: nobody needs the reference's uncertainty
    // true: if the truth has another number of modes, errors from a string with the cell's modes
    // are computed too
    bool in_model = true;
    // full scene, whose motion is the truth, if `scene` is a part of the full scene
    std::optional<Scene> whole{};
    const Scene& true_scene() const { return whole ? *whole : scene; }
    double time_limit = HUGE_VAL;  // limit for each run, including references [s]
    // hashes: the scene's, and the hash for the scene whose motion is the truth
    std::string hash{}, true_hash{};
    // key for the reference's run: points with the same key share the run
    std::string reference_key{};
    // key for the truth's run, with other modes than the cells; "": the point has no such run
    std::string truth_key{};
};

struct Ran {  // Job after its accuracy run, which reached its end or failed.
    const Point& point;
    const Cell& cell;
    const Trace& trace;
    const Trace* reference;  // on the same rows; nullptr if there is no reference
};

struct Job {
    const Point* point;
    Cell cell;
    bool judged = true;  // true: compared with the point's reference
    Measures errors{};   // measures to compute
    // limit for processor time [s]; a longer run is ended and not kept
    double patience = HUGE_VAL;
    bool sounds = false;  // true: stores the sound at the headline's nut tap
    int repeats = 0;      // number of timings; 0: not timed
    // Jobs in the same set are timed in one interleaved run.
    int set = 0;
    std::function<void(const Ran&, Record&)> measure{};  // takes further measurements on the run
    // examines the point, even if the cell fails
    std::function<std::string(const Point&, const Truth*)> beside{};
    std::string measured{};  // JSON for `measure` and `beside`, a part of the identity
    std::string identity{};  // JSON: everything that the result depends on
    std::string id{};        // hash_of the identity
};

struct Plan {
    std::deque<Point> points;  // deque: addresses must not change
    std::vector<Job> jobs;     // each identity once
    std::vector<std::string> notes;
};

// Fills in keys and identities, and keeps each job once. `program`: store::program_identity.
void address(Plan&, const std::string& program);

std::string identity_of(const Plan&);  // covers all jobs, independent of the program

// Text for people: "tanpura_c3_release: modal_two_point at 44100 Hz".
std::string what_of(const Job&);

// References of a study. The first job that needs a reference runs it; the last user deletes it.
class References {
public:
    explicit References(std::span<const Job> = {});  // counts the needs of these jobs
    ~References();

    struct Of {                        // references for one point
        const Truth* truth = nullptr;  // nullptr: no reference could be run
        // reference with the cells' modes; nullptr: could not be run
        const Reference* model = nullptr;
        const Errors* floor = nullptr;  // error of the truth started 1e-12 apart
        std::string refused{};          // reason if there is no truth
        Against against() const;        // empty if there is no truth
    };
    // Runs the missing references with `jobs` threads; waits for runs in another thread or process.
    Of make(const Point&, int jobs, const store::Listener&);
    void hold(const Point&);     // counts one more user
    void release(const Point&);  // counts a user less

private:
    class Shared;
    Shared& of(const std::string& key);
    void each_of(const Point&, void (Shared::*)());
    std::mutex mutex_;                                    // protects `all_`
    std::map<std::string, std::unique_ptr<Shared>> all_;  // by reference_key and truth_key
};

}  // namespace jvari::bench::study
