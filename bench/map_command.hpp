// The maps of a suite, from its file to DIR: maps.csv, boundaries.csv, and minimised reproducers in failures/. The report draws them.
#pragma once

#include <string>
#include <vector>

#include "bench/catalogue.hpp"
#include "bench/suite_file.hpp"

namespace jvari {

class Console;

// Files written; none where the suite has no maps. r.out "": nothing is written, the text is printed all the same.
std::vector<std::string> chart_maps(const Suite&, const Catalogue&, const SuiteRequest& r, const Console&);

}  // namespace jvari
