// What a study asks: jobs on points. A point is one scene and who is its reference; a job is a cell
// on it, and what is measured of that. Compare makes the jobs of one point, a suite those of its
// file.
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
    // 0: found by doubling; none: the reference with the cells' modes is all there is
    std::optional<int> truth_modes = 0;
    int begin = 0;      // modes that the doubling begins with; 0: those of modes_to_begin_with
    double effort = 1;  // of the doubling (run_truth)
    bool settles_whole = false;  // likewise
    bool alone = false;          // nothing is asked of what the reference is uncertain by
    // errors from a string with as many modes are asked for too, where the truth has others
    bool in_model = true;
    // the scene whose motion is the truth, where `scene` is a part of it
    std::optional<Scene> whole{};
    const Scene& true_scene() const { return whole ? *whole : scene; }
    double time_limit = HUGE_VAL;     // of each run, of a reference too [s]
    std::string hash{}, true_hash{};  // of the scene, and of the one whose motion is the truth
    std::string reference_key{};      // points that share it share the reference's run
    // likewise of the truth, whose modes are none of the cells'; "": there is none
    std::string truth_key{};
};

struct Ran {  // a job whose accuracy run reached its end or its failure
    const Point& point;
    const Cell& cell;
    const Trace& trace;
    const Trace* reference;  // on the same rows; nullptr where there is none
};

struct Job {
    const Point* point;
    Cell cell;
    bool judged = true;  // against the point's reference
    Measures errors{};   // by these
    // [s] of processor; a run that takes longer is ended, and not kept
    double patience = HUGE_VAL;
    bool sounds = false;  // its headline's nut tap is to be heard
    int repeats = 0;      // of the clock; 0: it is not timed
    // jobs of one set are timed in one interleaved run
    int set = 0;
    std::function<void(const Ran&, Record&)> measure{};  // whatever else is measured of it
    // what is found out of the point, whatever becomes of the cell
    std::function<std::string(const Point&, const Truth*)> beside{};
    std::string measured{};  // both, as JSON: part of its identity
    std::string identity{};  // JSON: all that its result depends on
    std::string id{};        // hash_of it
};

struct Plan {
    std::deque<Point> points;  // does not move what it holds
    std::vector<Job> jobs;     // each identity once
    std::vector<std::string> notes;
};

// Fills keys and identities, and leaves each job once. `program`: store::program_identity.
void address(Plan&, const std::string& program);

std::string identity_of(const Plan&);  // of all its jobs, whatever program runs them

std::string what_of(const Job&);  // for people: "tanpura_c3_release: modal_two_point at 44100 Hz"

// The references of a study: each is run by the first job that needs it, and gone with the last.
class References {
public:
    explicit References(std::span<const Job> = {});  // holds what they need
    ~References();

    struct Of {                            // one point
        const Truth* truth = nullptr;      // nullptr: none could be run
        const Reference* model = nullptr;  // the reference with the cells' modes; nullptr: likewise
        const Errors* floor = nullptr;     // of the truth started 1e-12 apart
        std::string refused{};             // why there is no truth
        Against against() const;           // empty where there is no truth
    };
    // Runs what is not there yet, on so many threads; waits for what another thread or process
    // runs.
    Of make(const Point&, int jobs, const store::Listener&);
    void hold(const Point&);     // one more needs it
    void release(const Point&);  // one that needed it is done

private:
    class Shared;
    Shared& of(const std::string& key);
    void each_of(const Point&, void (Shared::*)());
    std::mutex mutex_;                                    // of `all_`
    std::map<std::string, std::unique_ptr<Shared>> all_;  // by reference_key and truth_key
};

}  // namespace jvari::bench::study
