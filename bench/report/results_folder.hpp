// The folder that results go to: of one comparison, one suite or one trimmed scene, so that no page
// mixes what was measured apart.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bench/compare/compare.hpp"
#include "bench/compare/record/cheapest.hpp"
#include "bench/store/system/file_lock.hpp"
#include "bench/store/system/listener.hpp"
#include "bench/study/record.hpp"

namespace jvari::bench::report {

// Before anything is run. Throws UsageError where the folder holds the results of something else
// than `what` ("comparison of tanpura_c3", "suite smoke", "trim of tanpura_c3"); notes files that
// no such folder has, which stay where they are. A folder that is not there is empty.
void must_be_ours(const std::filesystem::path& folder, const std::string& what,
                  const store::Listener&);

// Where the cells of such a folder are kept, once it is ours: made, found writable, and without the
// parts that a killed run left. "" of nowhere.
std::filesystem::path cells_folder(const std::filesystem::path& folder, const std::string& what,
                                   const store::Listener&);

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
