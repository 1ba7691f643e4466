// jvari: the verbs, and what their failures mean to the caller.
#include <cstring>

#include "bench/command/commands.hpp"
#include "bench/store/console.hpp"
#include "bench/store/indented.hpp"
#include "bench/store/interruption.hpp"
#include "scenes/scene_file.hpp"
#include "schemes/scheme.hpp"

namespace {
struct Verb {
    int operator()(const jvari::ListRequest& r) const { return jvari::list_command(r); }
    int operator()(const jvari::RunRequest& r) const { return jvari::run_command(r); }
    int operator()(const jvari::CompareCall& r) const { return jvari::compare_command(r); }
    int operator()(const jvari::SuiteRequest& r) const { return jvari::suite_command(r); }
    int operator()(const jvari::CertifyRequest& r) const { return jvari::certify_command(r); }
    int operator()(const jvari::ReportRequest& r) const { return jvari::report_command(r); }
};

int fail(bool json, int code, const char* status, const std::string& message) {
    jvari::tell("jvari: " + message);
    try {
        jvari::Console(json, false).print_json(jvari::indented({{"status", status}, {"message", message}, {"exit_code", code}}));
    } catch (const jvari::Unwritable&) {  // the code says it
    }
    return code;
}
}  // namespace

int main(int argc, char** argv) {
    using namespace jvari;
    hold_standard_streams();
    heed_interruptions();
    bool json = false;
    for (int k = 1; k < argc; ++k) json = json || std::strcmp(argv[k], "--json") == 0;
    try {
        const auto request = read_arguments(argc, argv);
        return request ? std::visit(Verb{}, *request) : static_cast<int>(done);
    } catch (const UsageError& e) {
        return fail(json, bad_usage, "bad_usage", e.what());
    } catch (const SceneFileError& e) {
        return fail(json, bad_usage, "bad_scene", e.what());
    } catch (const BadScene& e) {
        return fail(json, bad_usage, "bad_scene", e.what());
    } catch (const UnknownOption& e) {
        return fail(json, bad_usage, "bad_usage", e.what());
    } catch (const Refusal& e) {
        return fail(json, refused, "refused", e.what());
    } catch (const std::exception& e) {
        return fail(json, run_failed, "error", e.what());
    } catch (...) {  // a plugin may throw what it likes
        return fail(json, run_failed, "error", "something was thrown that is no exception of the standard library");
    }
}
