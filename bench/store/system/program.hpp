// Runs another program and waits for it: git for the history of results, node for pictures.
#pragma once

#include <string>
#include <vector>

namespace jvari::bench::store {

struct Said {
    int code;  // its exit code, 128 + the signal that ended it, or -errno where it could not be started
    std::string text;
};
enum class Errors { left_out, with_the_rest };  // what it writes to its standard error

// `words` begin with a name to be found on the PATH. Its input is empty. Ctrl-C and signals of failed writing are to it what they are to
// any program.
Said run_program(std::vector<std::string> words, Errors);

}  // namespace jvari::bench::store
