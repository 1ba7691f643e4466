// The references of a study: each is run by the first job that needs it, and gone with the last.
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <string>

#include "bench/study/job.hpp"
#include "bench/study/truth.hpp"

namespace jvari::bench::study {

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
