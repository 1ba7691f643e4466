// Reads the results in a folder of compare or suite for its report.
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
#include "bench/suite/maps.hpp"
#include "bench/suite/suite.hpp"

namespace jvari::bench::report {

struct Results {
    std::filesystem::path folder;
    std::string manifest;                            // JSON
    std::string name, source, about, date, command;  // command: made the results
    compare::Controls controls = compare::Controls::stand_beside;
    study::Cells cells;
    std::vector<std::string> series;  // for each cell
    store::Table sounds;
    // Further tables that the page draws, including sounds, by file name; empty if the file is
    // absent. The columns `problem` and `series` stand in front, except in the tables of trim, path
    // and needs.
    std::map<std::string, store::Table> tables;
};

// Scene of a trim's manifest; "" for a comparison and for a suite.
std::string trimmed_scene(const nlohmann::ordered_json& manifest);

// Throws UsageError if the folder has no manifest or no cells, map or path, or if a file cannot be
// read.
Results read_results(const std::filesystem::path&);

// Problem: a scene at a single point in a sweep; runs on different problems are not compared.
// Series: a scheme with its options, and with its modes if the table has several numbers of modes
// at the same rate.

// ---- Tables of a report: the folder's own, and derived ones, which say something about each cell,
// each scene and each line. Judgements and statistics are computed once, here; the page's
// JavaScript looks them up and draws them.

// cells:    all figures for each cell except its errors; in front problem and series, behind
//           trusted, may_win, line (its series in the first chart). The line is empty if another
//           number of modes is better for the same scheme.
// errors:   row (in cells), tap, measure, value, floor, certificate; shown, text: for errors with
//           only a bound (compare/bound.hpp).
// scenes:   problem, headline, certificate (from the first cell), busy (from the clock).
// cheapest: problem, then the columns in compare::cheapest_of.
// orders:   problem, series, tap, measure, order, half_width, points: observed over the rates.
std::map<std::string, store::Table> tables_of(const Results&);

// ---- Sounds and spectrograms in the page: 16 bit samples, base64.

nlohmann::ordered_json json_of(const study::Levels&);
nlohmann::ordered_json json_of(const store::Sound&, double longest);  // [s]

// File named in sounds.csv; throws UsageError if it is not below the folder.
std::filesystem::path sound_file(const Results&, std::size_t row);
// Sounds within a total of `limit` bytes, in this order: references, the cheapest runs within an
// accuracy, highest rates, lowest rates, the rest.
nlohmann::ordered_json heard(const Results&, const store::Table& cheapest, double longest,
                             std::size_t limit, nlohmann::ordered_json& left_out);

// ---- Folder for results: it belongs to a single comparison, suite or trimmed scene, so no page
// mixes separate measurements.

// A study's own folder during the study: created, checked to be writable, and cleared of temporary
// files left by killed runs. Any number of processes may share the folder for the same study, but
// no other study may use it meanwhile.
class OwnFolder {
public:
    // Called before any run. `what`: "comparison of tanpura_c3", "suite smoke", "trim of
    // tanpura_c3"; `request`: everything that determines the results. Throws UsageError if the
    // folder has other results than `what`, or if a process is working there on another request.
    // Notes foreign files, which stay.
    OwnFolder(const std::filesystem::path& folder, const std::string& what,
              const std::string& request, const store::Listener&);
    const std::filesystem::path cells;  // folder for cells; "": none

private:
    std::optional<store::SharedLock> lock_;
};

// Writes files into the folder and collects their paths; with the folder "" nothing is written.
class ResultsFolder {
public:
    // Locks the folder: two processes that share the folder write their files one after the other,
    // because the report reads them together.
    ResultsFolder(std::filesystem::path folder, const store::Listener& listener)
        : folder_(std::move(folder)),
          listener_(listener),
          lock_(store::lock_of(folder_.empty() ? folder_ : folder_ / "manifest.json",
                               "writes the tables", listener)) {}
    explicit operator bool() const { return !folder_.empty(); }
    void add(const std::string& name, const std::string& content);
    // Adds cells.csv, facts.csv, errors.csv, cost.csv and, if orders are known, convergence.csv.
    void add_tables(const study::Cells&);
    void add_manifest(const nlohmann::ordered_json&);
    void add_report();  // reports on the files written before
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
    nlohmann::ordered_json files;  // written files
};
// Writes a comparison into the folder named in the request.
Written written(const compare::Comparison&, const compare::CompareRequest&, const store::Listener&);
// Writes a suite into the folder, with its maps, sounds and page; "": nothing.
Written written(const std::filesystem::path& folder, const suite::Suite&, const study::Plan&,
                const study::Study&, const suite::MapRun&, const std::vector<suite::Failure>&,
                const store::Listener&);
nlohmann::ordered_json manifest_of(const suite::Suite&, const study::Plan&);

}  // namespace jvari::bench::report
