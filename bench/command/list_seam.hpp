// What `jvari list` says of the seam: schemes and what they represent, their options, the facts they report.
#pragma once

#include <string>
#include <vector>

#include "bench/compare/catalogue.hpp"

namespace jvari::bench::command {

// One thing listed in its three forms.
struct Listing {
    std::string json, text, markdown;
};
Listing list_descriptors(const char* title, const std::vector<const Descriptor*>&);  // markdown: the capability table of the README
Listing list_options(const compare::Catalogue&);
Listing list_facts();
Listing list_columns();  // of cells.csv

}  // namespace jvari::bench::command
