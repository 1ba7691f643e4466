#include <cmath>
#include <nlohmann/json.hpp>

#include "bench/store/records.hpp"

namespace jvari::bench::store {

namespace {
using Json = nlohmann::ordered_json;

Json json_of(const Table& table) {
    Json rows = Json::array();
    for (const auto& row : table.rows) {
        Json j = Json::object();
        for (std::size_t k = 0; k < row.size(); ++k) {
            const std::string& name = table.columns[k];
            if (name == "scheme" || name == "status" || name == "reason" || name == "flags" || name == "below_floor" || name == "cell" ||
                name == "scene" || name == "options" || name == "reference" || name == "measure" || name == "ties" || name == "run" ||
                name == "as_published" || name == "perhaps" || name == "why" || name == "machine" || name == "governor")
                j[name] = row[k];  // NOLINT(bugprone-branch-clone): the order of the questions counts
            else if (name == "pareto") j[name] = row[k] == "1";
            else if (row[k].find_first_not_of("0123456789") == std::string::npos && !row[k].empty() && row[k].size() < 18)
                j[name] = std::stol(row[k]);
            else if (const double x = number_of(row[k]); std::isnan(x) && !row[k].empty()) j[name] = row[k];
            else j[name] = x;  // "" and infinities become null
        }
        rows.push_back(std::move(j));
    }
    return rows;
}

}  // namespace

std::string rows_json(const Table& cells) {
    return json_of(cells).dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace jvari::bench::store
