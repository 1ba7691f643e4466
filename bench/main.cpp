// jvari: what it was called with, and what a failure means to the caller.
#include <unistd.h>

#include <cstdlib>
#include <cstring>

#include "bench/command/console.hpp"
#include "bench/store/system/interruption.hpp"
#include "bench/store/usage.hpp"
#include "scenes/scene_file.hpp"
#include "schemes/making.hpp"
#include "schemes/scheme.hpp"

namespace {
bool ended = false;

int code_of(int argc, char** argv, bool json) {
    using namespace jvari;
    namespace exit_code = bench::command::exit_code;
    using bench::command::fail;
    try {
        return bench::command::call(argc, argv);
    } catch (const bench::store::UsageError& e) {
        return fail(json, exit_code::bad_usage, "bad_usage", e.what());
    } catch (const SceneFileError& e) {
        return fail(json, exit_code::bad_usage, "bad_scene", e.what());
    } catch (const BadScene& e) {
        return fail(json, exit_code::bad_usage, "bad_scene", e.what());
    } catch (const BadOption& e) {
        return fail(json, exit_code::bad_usage, "bad_usage", e.what());
    } catch (const Refusal& e) {
        return fail(json, exit_code::refused, "refused", e.what());
    } catch (const std::exception& e) {
        return fail(json, exit_code::run_failed, "error", e.what());
    } catch (...) {  // a plugin may throw what it likes
        return fail(json, exit_code::run_failed, "error",
                    "something was thrown that is no exception of the standard library");
    }
}
}  // namespace

int main(int argc, char** argv) {
    using namespace jvari::bench;
    command::hold_standard_streams();
    store::heed_interruptions();
    bool json = false;
    for (int k = 1; k < argc; ++k) json = json || std::strcmp(argv[k], "--json") == 0;
    if (json) command::keep_standard_output();
    std::atexit([] {
        if (ended) return;
        command::write_error(
            "jvari: a plugin or a library called exit() before the work was done; nothing of it is "
            "to be trusted",
            store::Mark::error);
        _exit(command::exit_code::run_failed);
    });
    const int code = code_of(argc, argv, json);
    ended = true;
    return code;
}
