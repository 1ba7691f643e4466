// The folder that results go to: of one comparison, one suite or one trimmed scene, so that no page mixes what was measured apart.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bench/compare/compare.hpp"
#include "bench/store/records.hpp"
#include "bench/store/system/listener.hpp"
#include "bench/study/record.hpp"

namespace jvari::bench::command {

// Before anything is run. Throws UsageError where the folder holds the results of something else than `what` ("comparison of tanpura_c3",
// "suite smoke", "trim of tanpura_c3"); notes files that no such folder has, which stay where they are. A folder that is not there is
// empty.
void must_be_ours(const std::filesystem::path& folder, const std::string& what, const store::Listener&);

// What they write into, once it is ours: made, found writable, and without the parts that a killed run left.
void make_folder(const std::filesystem::path& folder);

// What is written into it, and the paths of that; nowhere ("") nothing is.
class ResultsFolder {
public:
    ResultsFolder(std::filesystem::path folder, const store::Listener& listener) : folder_(std::move(folder)), listener_(listener) {}
    explicit operator bool() const { return !folder_.empty(); }
    void add(const std::string& name, const std::string& content);
    void add_tables(const store::Table& cells);  // cells.csv, errors.csv, cost.csv and, where there are orders to tell, convergence.csv
    void add_manifest(const nlohmann::ordered_json&);
    void add_report();  // of what was written before
    void add_all(const compare::Comparison&, const store::Table& cells, const nlohmann::ordered_json& manifest);
    const std::filesystem::path& path() const { return folder_; }
    nlohmann::ordered_json files = nlohmann::ordered_json::array();

private:
    std::filesystem::path folder_;
    const store::Listener& listener_;
};

// The exit code of a study: done where a run of it was, or where there was nothing to run.
int code_of(const std::vector<study::Record>&);

// What `compare` and `suite` say of their results as JSON, behind what is their own: manifest, cells, cheapest, files.
nlohmann::ordered_json with_results(nlohmann::ordered_json own, const nlohmann::ordered_json& manifest, const store::Table& cells,
                                    const store::Table& cheapest, const nlohmann::ordered_json& files);

}  // namespace jvari::bench::command
