// What `jvari list` says of the seam: schemes and what they represent, their options, the facts
// they report.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "schemes/scheme.hpp"

namespace jvari::bench::command {

// One thing listed in its two forms.
struct Listing {
    nlohmann::ordered_json json;
    std::string text;
};
// What has a unit: "  name  unit  meaning" a line, names and units filled to these widths.
struct Measured {
    std::string name, unit, meaning;
};
Listing list_measured(const char* title, int name_width, int unit_width,
                      const std::vector<Measured>&);

Listing list_descriptors(const char* title, const std::vector<const Descriptor*>&);
Listing list_pairings();
Listing list_options(const std::vector<const Descriptor*>&);
Listing list_facts();
Listing list_columns();  // of cells.csv
Listing list_taps();

}  // namespace jvari::bench::command
