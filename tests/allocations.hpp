// Counts every heap allocation of this thread's process while one of these lives: malloc itself is counted, not only operator new.
#pragma once

namespace jvari {

class Allocations {
public:
    Allocations();
    long count() const;

private:
    long before_;
};

}  // namespace jvari
