// Random valid scenes through every scheme and every reference: random_scene.hpp draws them,
// random_checks.hpp says what is owed.
//
//   random_scenes COUNT SEED      COUNT scenes, seeds SEED and on
//   random_scenes COUNT FILE      the first COUNT seeds that a file lists, one a line
//   random_scenes scene COUNT SEED|FILE    the same scenes: does a certificate claim too much about
//                                          the scene?
//   random_scenes matched|bar|wide COUNT SEED|FILE  scenes of its own: does compliance=matched do
//   harm?
//   random_scenes string_figures|bar_figures|wide_figures COUNT SEED|FILE   the same scenes: CSV of
//                                          the errors of both compliances (harm_figures.cpp)
//   random_scenes show [matched|bar|wide] SEED      the scene of a seed, as TOML
//
// Each scene has a process of its own: a signal, a run without end or a memory that overflows is a
// finding with its seed, and the next scene goes on. Prints a line per finding and a summary; ends
// with 1 where there was a finding.
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <sstream>
#include <vector>

#include "random_checks.hpp"
#include "scenes/scene_file.hpp"
#include "tests/sanitized.hpp"

namespace jvari::test {
namespace {

constexpr rlim_t seconds_allowed = sanitized ? 600 : 120;  // of CPU, all runs of one scene together
constexpr rlim_t seconds_for_figures = 20;                 // the same, where figures are printed
constexpr rlim_t memory_allowed = rlim_t{4} << 30;         // [bytes]
constexpr std::uint64_t certified_every = 4;               // scenes

// ---- In the process of a scene: lines to a pipe. "@what" is being done, "!finding", "=figures of
// the tally", ",line of CSV".
void send(int pipe, const std::string& line) {
    const std::string whole = line + "\n";
    if (write(pipe, whole.data(), whole.size()) < 0) _exit(3);
}

enum class Asked {
    promises,
    about_scene,
    matched,
    bar,
    wide,
    string_figures,
    bar_figures,
    wide_figures
};
Matching kind_of(Asked kind) {
    return kind == Asked::bar || kind == Asked::bar_figures     ? Matching::bar
           : kind == Asked::wide || kind == Asked::wide_figures ? Matching::wide
                                                                : Matching::string;
}
Asked asked_by(const std::string& word) {
    return word == "scene"            ? Asked::about_scene
           : word == "matched"        ? Asked::matched
           : word == "bar"            ? Asked::bar
           : word == "wide"           ? Asked::wide
           : word == "string_figures" ? Asked::string_figures
           : word == "bar_figures"    ? Asked::bar_figures
           : word == "wide_figures"   ? Asked::wide_figures
                                      : Asked::promises;
}
rlim_t limit_of(Asked kind) {
    return kind >= Asked::string_figures ? seconds_for_figures : seconds_allowed;
}
RandomCase drawn(Asked kind, std::uint64_t seed) {
    return kind >= Asked::matched ? matching_case(seed, kind_of(kind)) : random_case(seed);
}

[[noreturn]] void run_scene(Asked kind, std::uint64_t seed, int pipe) {
    const rlimit time{limit_of(kind), limit_of(kind) + 5}, memory{memory_allowed, memory_allowed},
        none{0, 0};
    setrlimit(RLIMIT_CPU, &time);
    setrlimit(RLIMIT_CORE, &none);
    if (!sanitized) setrlimit(RLIMIT_AS, &memory);
    const auto at = [&](const std::string& what) { send(pipe, "@" + what); };
    const auto finding = [&](const std::string& scheme, const std::string& what) {
        send(pipe, "!" + scheme + ": " + what);
    };
    Tally t;
    at("drawing the scene");
    const RandomCase c = drawn(kind, seed);
    if (kind >= Asked::string_figures)
        harm_figures(c, [&](const std::string& line) { send(pipe, "," + line); });
    else if (kind == Asked::about_scene) check_certificate_about_scene(c, t, finding, at);
    else if (kind >= Asked::matched) check_matching(c, kind_of(kind), t, finding, at);
    else check_schemes(c, t, finding, at);
    if (kind == Asked::promises && seed % certified_every == 0 && !c.extreme)
        check_certificate(c, t, finding, at);
    std::ostringstream line;
    line << "=" << t.runs << ' ' << t.ended << ' ' << t.refused << ' ' << t.failed << ' '
         << t.claims << ' ' << t.judged << ' ' << t.worst_claim << ' ' << t.harmed << ' '
         << t.estimates << ' ' << t.low_estimates << ' ' << t.worst_estimate << ' ' << t.slowest
         << ' ' << t.slowest_at;
    send(pipe, line.str());
    _exit(0);
}

// ---- In the process that stays
long take(Asked kind, std::uint64_t seed, Tally& tally) {
    int ends[2];
    if (pipe(ends) != 0) return std::perror("pipe"), 1;
    std::fflush(nullptr);
    const pid_t child = fork();
    if (child < 0) return std::perror("fork"), 1;
    if (child == 0) close(ends[0]), run_scene(kind, seed, ends[1]);
    close(ends[1]);
    std::string output, line, doing;
    char buffer[4096];
    for (ssize_t n; (n = read(ends[0], buffer, sizeof buffer)) > 0;)
        output.append(buffer, static_cast<std::size_t>(n));
    close(ends[0]);
    int status = 0;
    waitpid(child, &status, 0);
    long findings = 0;
    const auto report = [&](const std::string& what) {
        std::printf("seed %llu: %s\n", static_cast<unsigned long long>(seed), what.c_str());
        ++findings;
    };
    std::istringstream lines(output);
    while (std::getline(lines, line)) {
        if (line[0] == '@') doing = line.substr(1);
        if (line[0] == '!') report(line.substr(1));
        if (line[0] == ',') std::puts(line.c_str() + 1);
        if (line[0] != '=') continue;
        Tally t;
        t.scenes = 1;
        std::istringstream in(line.substr(1));
        in >> t.runs >> t.ended >> t.refused >> t.failed >> t.claims >> t.judged >> t.worst_claim >>
            t.harmed >> t.estimates >> t.low_estimates >> t.worst_estimate >> t.slowest >> std::ws;
        std::getline(in, t.slowest_at);
        tally.add(t);
    }
    if (WIFSIGNALED(status))
        report(doing +
               (WTERMSIG(status) == SIGXCPU
                    ? ": more than " + std::to_string(limit_of(kind)) + " s of CPU for the scene"
                    : std::string(": signal ") + strsignal(WTERMSIG(status))));
    else if (WEXITSTATUS(status) != 0)
        report(doing + ": ended with " + std::to_string(WEXITSTATUS(status)));
    return findings;
}

int all(Asked kind, const std::vector<std::uint64_t>& seeds) {
    Tally tally;
    long findings = 0;
    if (kind >= Asked::string_figures) std::puts(harm_columns);
    for (std::size_t i = 0; i < seeds.size(); ++i) {
        findings += take(kind, seeds[i], tally);
        if (kind >= Asked::string_figures) continue;
        if ((i + 1) % (kind == Asked::promises ? 100 : 10) == 0)
            std::printf("%zu of %zu scenes\n", i + 1, seeds.size()), std::fflush(stdout);
    }
    if (kind >= Asked::string_figures) return findings > 0;
    if (kind == Asked::about_scene) {
        std::printf(
            "%ld scenes, %ld judged, %ld ended by a limit\n%ld figures of certificates about the "
            "scene, true/claimed at most %.3g\n"
            "%ld findings\n",
            tally.scenes, tally.judged, tally.ended, tally.claims, tally.worst_claim, findings);
        return findings > 0 || tally.judged == 0;
    }
    if (kind >= Asked::matched) {
        std::printf(
            "%ld scenes at two rates each, %ld ended by a limit\n%ld runs judged, %ld refused, "
            "matched does harm in %ld\n%ld findings\n",
            tally.scenes, tally.ended, tally.runs, tally.refused, tally.harmed, findings);
        return findings > 0 || tally.judged == 0;
    }
    std::printf(
        "%ld scenes, %ld runs (each twice; %ld of them say that they failed), %ld ended by a "
        "limit, %ld refusals\n",
        tally.scenes, tally.runs, tally.failed, tally.ended, tally.refused);
    std::printf("%ld figures of certificates, true/claimed at most %.3g\n", tally.claims,
                tally.worst_claim);
    std::printf(
        "%ld estimates of stand-ins, %ld below the true error, true/estimate at most %.3g\n",
        tally.estimates, tally.low_estimates, tally.worst_estimate);
    std::printf("slowest run: %.3g s of CPU, %s\n%ld findings\n", tally.slowest,
                tally.slowest_at.c_str(), findings);
    return findings > 0 || tally.scenes == 0;
}
}  // namespace
}  // namespace jvari::test

int main(int argc, char** argv) {
    using namespace jvari::test;
    if ((argc == 3 || argc == 4) && std::string(argv[1]) == "show") {
        const std::uint64_t seed = std::strtoull(argv[argc - 1], nullptr, 10);
        std::printf("%s", jvari::write_scene(drawn(asked_by(argv[argc - 2]), seed).scene).c_str());
        return 0;
    }
    const std::string mode = argc == 4 ? argv[1] : "";
    const Asked kind = asked_by(mode);
    if (kind != Asked::promises) --argc, ++argv;
    if (argc != 3)
        return std::fprintf(stderr,
                            "usage: random_scenes COUNT SEED | COUNT FILE | scene|matched|bar|wide|"
                            "string_figures|bar_figures|wide_figures COUNT SEED|FILE | show "
                            "[matched|bar|wide] SEED\n"),
               2;
    const std::size_t count = std::strtoull(argv[1], nullptr, 10);
    std::vector<std::uint64_t> seeds;
    if (std::ifstream file(argv[2]); file) {
        for (std::string line; seeds.size() < count && std::getline(file, line);)
            if (!line.empty() && line[0] != '#')
                seeds.push_back(std::strtoull(line.c_str(), nullptr, 10));
    } else {
        for (std::size_t i = 0; i < count; ++i)
            seeds.push_back(std::strtoull(argv[2], nullptr, 10) + i);
    }
    return all(kind, seeds);
}
