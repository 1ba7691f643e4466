#include "bench/command/suite_shards.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "bench/store/fresh_file.hpp"
#include "bench/store/indented.hpp"
#include "bench/store/machine.hpp"
#include "bench/store/usage.hpp"

namespace jvari::bench::command {

namespace {
namespace fs = std::filesystem;
constexpr double seconds_of_a_task = 300;  // a scheduler takes a second of each
constexpr int most_tasks = 1000;           // of one array; more is refused by many sites

std::string plan_text(const SuiteRequest& r, const suite::Parts& parts) {
    return store::csv(parts_table(parts, store::program_identity(r.plugins)));
}

fs::path keep_references(const SuiteRequest& r, suite::SuitePlan& plan) {
    const fs::path folder = fs::path(r.out) / "references";
    std::error_code error;
    fs::create_directories(folder, error);
    suite::keep_references_in(plan, folder);
    return folder;
}

std::string quoted(const std::string& word) {  // for a shell
    std::string text = "'";
    for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return text + "'";
}

int tasks_of(const suite::Parts& parts) {
    const store::Table t = parts_table(parts, "");
    double all = 0;
    for (std::size_t i = 0; i < t.rows.size(); ++i) all += t.number(i, "seconds");
    const int bundles = static_cast<int>(std::clamp(std::ceil(all / seconds_of_a_task), 1.0, 1.0 * most_tasks));
    return std::max(std::min(bundles, static_cast<int>(t.rows.size())), parts.clocks.empty() ? 1 : 2);
}
}  // namespace

int prepare_suite(const SuiteRequest& r, suite::SuitePlan& plan, const suite::Parts& parts, const Console& console) {
    keep_references(r, plan);
    const int references = suite::make_references(plan, r.jobs, console);
    const fs::path file = fs::path(r.out) / "plan.csv";
    store::write_fresh(file, plan_text(r, parts));  // last: where it lies, all is prepared
    const std::size_t n = plan.cells.size() + parts.clocks.size() + parts.rows.size();
    console.print(fmt::format("{} cells, {} sets to be timed and {} rows of maps, {} references: written: {}", plan.cells.size(),
                              parts.clocks.size(), parts.rows.size(), references, file.string()));
    console.print_json(store::indented({{"status", "ok"}, {"parts", n}, {"references", references}, {"plan", file.string()}}));
    return exit_code::done;
}

int run_shard(const SuiteRequest& r, suite::SuitePlan& plan, const suite::Parts& parts, const compare::Catalogue& catalogue,
              const Console& console) {
    const suite::Shard shard = suite::shard_of(r.shard);
    const fs::path folder = r.out, file = folder / "plan.csv";
    std::error_code error;
    if (!fs::exists(file, error)) throw store::UsageError(fmt::format("--shard: there is no {}: --prepare writes it", file.string()));
    if (store::read_whole(file) != plan_text(r, parts))
        throw store::UsageError(
            fmt::format("--shard: {} was written for another suite, or by another program: this one was compiled by {} and uses {}",
                        file.string(), store::machine().compiler, store::machine().vectors));
    map::Truths truths(catalogue, keep_references(r, plan));
    const suite::Share own = share_of(parts, shard);
    if (!own.rows.empty()) fs::create_directories(folder / "points", error);
    const map::MapRun maps =
        run_maps(own.rows, truths, store::program_identity(r.plugins), folder / "points", map::Points::resumed, r.jobs, console);
    const suite::SuiteRun run = run_suite(plan, own.work, folder / "cells", true, r.jobs, console);
    console.print(fmt::format("shard {}: {} cells and points run, {} cells timed, {} read back", r.shard, run.ran + maps.ran, run.timed,
                              run.read_back + maps.read_back));
    console.print_json(store::indented({{"status", "ok"},
                                        {"shard", r.shard},
                                        {"ran", run.ran + maps.ran},
                                        {"timed", run.timed},
                                        {"read_back", run.read_back + maps.read_back}}));
    return exit_code::done;
}

int print_script(const SuiteRequest& r, const suite::Parts& parts, const Console& console) {
    std::error_code error;
    const auto whole = [&error](const std::string& path) { return fs::exists(path, error) ? fs::absolute(path).string() : path; };
    std::string call = quoted(fs::read_symlink("/proc/self/exe", error).string()) + " suite " + quoted(whole(r.suite)) + " --out " +
                       quoted(fs::absolute(r.out).string());
    for (const std::string& p : r.plugins) call += " --plugin " + quoted(whole(p));
    constexpr const char* script = R"sh(#!/bin/sh
# {name}: prepare, shards, gather, as jobs of Slurm. Written by jvari suite --print slurm.
#
#   sh FILE              submits them; {parts} parts in ${{SHARDS}} tasks of some minutes each
#   SHARDS=40 sh FILE    in so many tasks
#   SBATCH_PARTITION=p SBATCH_TIMELIMIT=60 sh FILE        what else sbatch reads from its environment
#
# What lies in the folder is not run again. So after a loss submit once more: Slurm puts the tasks of a lost node back by itself,
# one that was killed for its memory it does not, and the last job says what is missing.
# Timed sets have a node each to themselves.
#
# Without a folder that all nodes see: run the first line below, copy its folder to where the shards run, copy what they wrote into
# cells/ and points/ back into it, and run the last.
set -eu
prepare() {{ cat <<'END'
#!/bin/sh
exec {call} --prepare --jobs "${{SLURM_CPUS_PER_TASK:-1}}"
END
}}
shard() {{ cat <<'END'
#!/bin/sh
exec {call} --shard "$SLURM_ARRAY_TASK_ID/$JVARI_SHARDS" --jobs "${{SLURM_CPUS_PER_TASK:-1}}"
END
}}
gather() {{ cat <<'END'
#!/bin/sh
exec {call} --gather
END
}}
shards=${{SHARDS:-{shards}}}
timed=$((shards / 2))
[ "$timed" -le {clocks} ] || timed={clocks}
log={log}
mkdir -p "$log"
submit() {{ sbatch --parsable --requeue --open-mode=append --kill-on-invalid-dep=yes "$@"; }}
first=$(prepare | submit --job-name=prepare --output="$log/prepare")
after=--dependency=afterok:$first
all=$(shard | submit --job-name=shard --output="$log/shard-%a" "$after" --export="ALL,JVARI_SHARDS=$shards" --array="1-$((shards - timed))")
[ "$timed" = 0 ] || all=$all:$(shard | submit --job-name=clock --output="$log/shard-%a" "$after" --export="ALL,JVARI_SHARDS=$shards" \
    --exclusive --array="$((shards - timed + 1))-$shards")
gather | submit --job-name=gather --output="$log/gather" --dependency="afterany:$all"
)sh";
    const int shards = tasks_of(parts);
    std::string text = fmt::format(fmt::runtime(script), fmt::arg("name", r.suite),
                                   fmt::arg("parts", parts.plan.cells.size() + parts.clocks.size() + parts.rows.size()),
                                   fmt::arg("call", call), fmt::arg("shards", shards), fmt::arg("clocks", parts.clocks.size()),
                                   fmt::arg("log", quoted((fs::absolute(r.out) / "slurm").string())));
    text.pop_back();
    console.print(text);
    console.print_json(store::indented({{"shards", shards}, {"script", text}}));
    return exit_code::done;
}

}  // namespace jvari::bench::command
