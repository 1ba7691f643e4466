// Counts every heap allocation of this thread while one of these lives: malloc itself, not only
// operator new. A program that uses this has its malloc replaced by one that counts and hands on;
// on another C library than GNU's nothing is replaced and nothing counted.
#pragma once

namespace jvari::bench::check {

class Allocations {
public:
    Allocations();
    long count() const;
    static bool counted();  // false: this build cannot tell

private:
    long before_;
};

}  // namespace jvari::bench::check
