// Runs of references, kept from one program to the next: a reference may take minutes where a
// scheme takes milliseconds.
//
// A file per run, named by a hash of everything that its numbers depend on: scene, reference and
// settings, sources, compiler, flags and vector instructions. It appears by rename and is believed
// only where it is whole: its key, its checksum and its sizes are looked at. Nothing is kept of a
// run of less than half a second, unless the caller keeps all of its study's.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "schemes/run.hpp"

namespace jvari::bench::study {

// $JVARI_CACHE, else jvari in $XDG_CACHE_HOME, else ~/.cache/jvari;
// may be emptied at any time. "", for nowhere, where JVARI_CACHE is empty.
std::filesystem::path kept_runs_folder();

std::string run_key(const Descriptor&, const Scene&, const Settings&);

// throws UsageError
void write_run(const std::filesystem::path&, const std::string& key, const Run&);
std::optional<Run> read_run(const std::filesystem::path&,
                            // nothing where it is not whole or not of `key`
                            const std::string& key) noexcept;

constexpr double worth_keeping = 0.5;  // [s] of stepping

// The run that is kept there, else what `make` gives, which is kept from then on; waits for another
// process or thread that makes it. A folder that cannot be written to keeps nothing, and nowhere is
// a run kept of less than `least` [s].
Run kept_run(const std::filesystem::path& folder, const std::string& key,
             const std::function<Run()>& make, double least = worth_keeping);

}  // namespace jvari::bench::study
