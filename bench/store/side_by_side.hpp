// Independent things side by side on a few threads, with one progress line for all of them.
#pragma once

#include <atomic>
#include <functional>
#include <string>
#include <vector>

#include "bench/store/listener.hpp"

namespace jvari::bench::store {

using Done = std::atomic<double>;  // how much of a thing is done, from 0 to 1

// work(i, done) for each i below sizes.size(), begun in this order, on `jobs` threads (0: as many as there are cores). `sizes`: how long
// each is expected to take, in any unit; for the progress line alone. Where one throws no further one is begun, and of what was thrown that
// of the lowest i is thrown again: the one that would have ended them if they had gone one by one.
void side_by_side(const std::vector<double>& sizes, int jobs, const Listener&, const std::string& label,
                  const std::function<void(std::size_t i, Done&)>& work);

}  // namespace jvari::bench::store
