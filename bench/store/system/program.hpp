// Runs another program and waits for it: node for pictures, or an external scheme.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace jvari::bench::store {

struct Said {
    // Exit code, 127 if the program was not found, 128 + the signal that ended it, or -errno if it
    // could not be started.
    int code;
    std::string text;  // last 64 kB of standard output and error
};

// `words` begin with a program name, which is searched on the PATH. The program's input is empty.
// Ctrl-C and the signals of failed writing have their default effects on the program.
//
// The program leads a process group. The group is killed when its leader has ended, when `unwanted`
// returns true (polled every few hundredths of a second), and at an interruption. If this program
// ends in any other way, the group is killed too. Processes left behind by the leader are not
// waited for. The elapsed time counts as computing time of this thread (interruption.hpp).
Said run_program(std::vector<std::string> words, const std::function<bool()>& unwanted = {});

}  // namespace jvari::bench::store
