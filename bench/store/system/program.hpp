// Runs another program and waits for it: node for pictures, a scheme from outside.
#pragma once

#include <string>
#include <vector>

namespace jvari::bench::store {

struct Said {
    int code;          // its exit code, 128 + the signal that ended it, or -errno where it could not be started
    std::string text;  // what it writes to its standard output and error
};

// `words` begin with a name to be found on the PATH. Its input is empty.
// Ctrl-C and signals of failed writing are to it what they are to any program.
Said run_program(std::vector<std::string> words);

}  // namespace jvari::bench::store
