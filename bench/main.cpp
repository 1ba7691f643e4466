// jvari: the verbs, and what their failures mean to the caller.
#include <cstring>

#include "bench/command/commands.hpp"
#include "bench/command/console.hpp"
#include "bench/store/indented.hpp"
#include "bench/store/system/interruption.hpp"
#include "bench/store/usage.hpp"
#include "scenes/scene_file.hpp"
#include "schemes/scheme.hpp"

namespace {
struct Verb {
    int operator()(const jvari::bench::command::NewRequest& r) const { return jvari::bench::command::new_command(r); }
    int operator()(const jvari::bench::command::ListRequest& r) const { return jvari::bench::command::list_command(r); }
    int operator()(const jvari::bench::command::RunRequest& r) const { return jvari::bench::command::run_command(r); }
    int operator()(const jvari::bench::command::CompareCall& r) const { return jvari::bench::command::compare_command(r); }
    int operator()(const jvari::bench::command::SuiteRequest& r) const { return jvari::bench::command::suite_command(r); }
    int operator()(const jvari::bench::command::TrimCall& r) const { return jvari::bench::command::trim_command(r); }
    int operator()(const jvari::bench::command::CertifyRequest& r) const { return jvari::bench::command::certify_command(r); }
    int operator()(const jvari::bench::command::ReportRequest& r) const { return jvari::bench::command::report_command(r); }
    int operator()(const jvari::bench::command::DiffRequest& r) const { return jvari::bench::command::diff_command(r); }
    int operator()(const jvari::bench::command::CheckRequest& r) const { return jvari::bench::command::check_command(r); }
};

int fail(bool json, int code, const char* status, const std::string& message) {
    jvari::bench::command::tell("jvari: " + message);
    try {
        jvari::bench::command::Console(json, false)
            .print_json(jvari::bench::store::indented({{"status", status}, {"message", message}, {"exit_code", code}}));
    } catch (const jvari::bench::store::Unwritable&) {  // the code says it
    }
    return code;
}
}  // namespace

int main(int argc, char** argv) {
    using namespace jvari;
    bench::command::hold_standard_streams();
    bench::store::heed_interruptions();
    bool json = false;
    for (int k = 1; k < argc; ++k) json = json || std::strcmp(argv[k], "--json") == 0;
    try {
        if (argc < 2) {
            bench::command::Console(false, false).print(bench::command::welcome());
            return bench::command::exit_code::bad_usage;
        }
        const auto request = bench::command::read_arguments(argc, argv);
        return request ? std::visit(Verb{}, *request) : bench::command::exit_code::done;
    } catch (const bench::store::UsageError& e) {
        return fail(json, bench::command::exit_code::bad_usage, "bad_usage", e.what());
    } catch (const SceneFileError& e) {
        return fail(json, bench::command::exit_code::bad_usage, "bad_scene", e.what());
    } catch (const BadScene& e) {
        return fail(json, bench::command::exit_code::bad_usage, "bad_scene", e.what());
    } catch (const BadOption& e) {
        return fail(json, bench::command::exit_code::bad_usage, "bad_usage", e.what());
    } catch (const Refusal& e) {
        return fail(json, bench::command::exit_code::refused, "refused", e.what());
    } catch (const std::exception& e) {
        return fail(json, bench::command::exit_code::run_failed, "error", e.what());
    } catch (...) {  // a plugin may throw what it likes
        return fail(json, bench::command::exit_code::run_failed, "error",
                    "something was thrown that is no exception of the standard library");
    }
}
