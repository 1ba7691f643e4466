// Runs another program and waits for it: node for pictures, a scheme from outside.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace jvari::bench::store {

struct Said {
    // its exit code, 127 where it could not be found, 128 + the signal that ended it, or -errno
    // where none was started
    int code;
    std::string text;  // what it wrote to its standard output and error: the last 64 kB of it
};

// `words` begin with a name to be found on the PATH. Its input is empty.
// Ctrl-C and signals of failed writing are to it what they are to any program.
//
// It leads a process group, which is killed when it has ended, when `unwanted`, which is asked
// every few hundredths of a second, is true, and at an interruption; it is killed itself however
// else this program ends. What it started and left behind is not waited for. The time that it takes
// counts as computed by this thread (interruption.hpp).
Said run_program(std::vector<std::string> words, const std::function<bool()>& unwanted = {});

}  // namespace jvari::bench::store
