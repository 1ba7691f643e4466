// The program: reads its arguments and does what they ask for.
#pragma once

namespace jvari::bench::command {

// Returns the exit code, or throws: UsageError, BadScene, SceneFileError (2), Refusal (3).
int call(int argc, const char* const* argv);

}  // namespace jvari::bench::command
