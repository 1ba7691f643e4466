// Counts every heap allocation by this thread during its lifetime: malloc itself, not only operator
// new. In a program that uses this class, malloc is replaced by a function that counts and
// forwards. With a C library other than GNU's nothing is replaced and nothing counted.
#pragma once

namespace jvari::bench::check {

class Allocations {
public:
    Allocations();
    long count() const;
    static bool counted();  // false: this build cannot count

private:
    long before_;
};

}  // namespace jvari::bench::check
