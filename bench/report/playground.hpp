// `report --playground`: the page that ./play builds, folded into a report.
#pragma once

#include <string>

namespace jvari::bench::report {

std::string playground();  // the built page; throws UsageError where there is none
std::string with_playground(const std::string& report, const std::string& play);

}  // namespace jvari::bench::report
