// What lies in a folder of compare or of suite: the tables of results, read for its report.
#pragma once

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "bench/compare/compare.hpp"
#include "bench/compare/record/cheapest.hpp"
#include "bench/store/records.hpp"
#include "bench/store/system/file_lock.hpp"
#include "bench/store/system/listener.hpp"
#include "bench/store/trace_file.hpp"
#include "bench/study/record.hpp"

namespace jvari::bench::report {

struct Results {
    std::filesystem::path folder;
    std::string manifest;                      // JSON
    std::string name, source, about, command;  // command: that made the results
    compare::Controls controls = compare::Controls::stand_beside;
    study::Cells cells;
    std::vector<std::string> series;  // of each cell
    store::Table sounds;
    // What else the page draws, sounds too, by the file's name; empty where the file is absent. All
    // but those of trim, path and needs, have the columns `problem` and `series` in front.
    std::map<std::string, store::Table> tables;
};

// Throws UsageError where there is no manifest.json, none of facts.csv, maps.csv and path.csv, or
// one of the files cannot be read.
Results read_results(const std::filesystem::path&);

// A problem is a scene at one point of what is swept; runs of different problems are not compared.
// A series is a scheme with its options, and with its modes where the table has it with several at
// one rate.

// ---- What the page joins with the folder's tables: what the program says of each cell, each scene
// and each line. Judgements and statistics are made here, once; the page's JavaScript looks them up
// and draws them.

// cells:    what is known of each but its errors, with its problem and series in front, and with
//           trusted, may_win, run (its name in a sentence), line (its series in the first chart;
//           none where another of its scheme's numbers of modes is better) behind
// errors:   row (of cells), tap, measure, value, floor, certificate; shown, text: of those that are
//           no more than bounded (compare/bound.hpp)
// scenes:   problem, headline, certificate (of its first cell), busy (its clock)
// cheapest: problem, then what compare::cheapest_of says
// orders:   problem, series, tap, measure, order, half_width, points: as observed over the rates
std::map<std::string, store::Table> derived_tables(const Results&);

// ---- Sounds and spectrograms as the page carries them: 16 bit samples as base64.

nlohmann::ordered_json json_of(const study::Levels&);
nlohmann::ordered_json json_of(const store::Sound&, double longest);  // [s]

// of sounds.csv; throws UsageError where it is not below the folder
std::filesystem::path sound_file(const Results&, std::size_t row);
// The sounds of the folder that fit into `limit` bytes:
// references, runs that are the cheapest within an accuracy, highest rates, lowest rates, the rest.
nlohmann::ordered_json heard(const Results&, const store::Table& cheapest, double longest,
                             std::size_t limit, nlohmann::ordered_json& left_out);

// ---- The folder that results go to: of one comparison, one suite or one trimmed scene, so that no
// page mixes what was measured apart.

// A study's own folder while it runs: made, found writable, and without the parts that a killed run
// left. Any number of processes of one study may have it, and no other study meanwhile.
class OwnFolder {
public:
    // Before anything is run. `what`: "comparison of tanpura_c3", "suite smoke", "trim of
    // tanpura_c3"; `request`: all that its results depend on. Throws UsageError where the folder
    // holds the results of something else than `what`, or where a process is at work there on
    // another request; notes files that no such folder has, which stay where they are.
    OwnFolder(const std::filesystem::path& folder, const std::string& what,
              const std::string& request, const store::Listener&);
    const std::filesystem::path cells;  // where its cells are kept; "" of nowhere

private:
    std::optional<store::SharedLock> lock_;
};

// What is written into it, and the paths of that; nowhere ("") nothing is.
class ResultsFolder {
public:
    // Two processes that share the folder write its files one after the other: they are read back
    // together, by the report.
    ResultsFolder(std::filesystem::path folder, const store::Listener& listener)
        : folder_(std::move(folder)),
          listener_(listener),
          lock_(store::lock_of(folder_.empty() ? folder_ : folder_ / "manifest.json",
                               "writes the tables", listener)) {}
    explicit operator bool() const { return !folder_.empty(); }
    void add(const std::string& name, const std::string& content);
    // cells.csv, facts.csv, errors.csv, cost.csv and, where there are orders to tell,
    // convergence.csv
    void add_tables(const study::Cells&);
    void add_manifest(const nlohmann::ordered_json&);
    void add_report();  // of what was written before
    nlohmann::ordered_json files = nlohmann::ordered_json::array();

private:
    std::filesystem::path folder_;
    const store::Listener& listener_;
    std::unique_ptr<store::FileLock> lock_;
};

struct Written {
    nlohmann::ordered_json manifest;
    study::Cells cells;
    std::vector<compare::Answer> cheapest;
    nlohmann::ordered_json files;  // that were written
};
// Of a comparison, written into the folder that the request names.
Written written(const compare::Comparison&, const compare::CompareRequest&, const store::Listener&);

}  // namespace jvari::bench::report
