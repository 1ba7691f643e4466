// All promises of one scheme, asked: what `jvari check` prints, writes and returns.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "bench/check/promise.hpp"
#include "bench/store/system/listener.hpp"

namespace jvari::bench::check {

struct Answered {
    const Promise* promise;
    std::string scene;  // "" where it is asked once
    Verdict verdict;
    double seconds;  // [s]
};

struct Checked {
    std::string scheme, source;
    std::vector<Answered> answers;  // in the order of promises(), then of the scenes
    bool broken() const;
};

// `answered` is told each promise as soon as all its scenes are.
Checked check(const Descriptor&, const store::Listener&,
              const std::function<void(const Checked&, const Promise&)>& answered = {});

std::string line_of(const Checked&, const Promise&);
std::string conclusion_of(const Checked&);
std::string json_of(const std::vector<Checked>&);
// a test suite a scheme, a test case a promise and scene
std::string junit_of(const std::vector<Checked>&);

}  // namespace jvari::bench::check
