// The sections of the report, in the order in which they stand. Each is made of what lies in the folder; one without data has neither
// charts nor rows, and does not appear.
#pragma once

#include "bench/report/charts.hpp"
#include "bench/report/page.hpp"
#include "bench/report/results.hpp"

namespace jvari::bench::report {

// What the folder says of each of its scenes: the cheapest scheme for each accuracy and how certain that is, what the truth is, how the
// machine was.
std::vector<Verdict> verdicts_of(const Results&);
// What maps and a trimmed scene come to, in a sentence without its full stop; "" where there is neither.
std::string finding_of_maps(const Results&);
std::string finding_of_trim(const Results&);

Section work_precision_section(const Results&);
Section sweep_section(const Results&);
Section path_section(const Results&);
Section needs_section(const Results&);
Section dispersion_section(const Results&);
Section convergence_section(const Results&);
Section cost_section(const Results&);
Section overview_section(const Results&);  // schemes by maps: the share of runs that are sound
Section map_section(const Results&);
Section spectrogram_section(const Results&);
Section waveform_section(const Results&);
Section picture_section(const Results&, const std::vector<std::string>& own);  // SVGs in the folder that are none of `own`
Section cell_section(const Results&);

// The problems of a chart (signal problem_field), which the page's one menu of scenes chooses from, and the menus of its errors: measure
// and tap. How many pictures are made of one chart at most.
std::vector<Menu> problem_menu(const std::vector<std::string>& problems);
std::vector<Menu> error_menus(const std::vector<Axis>&);
std::vector<std::pair<std::string, std::vector<std::string>>> offers_of(const WorkPrecision&, const std::vector<std::string>& problems);
constexpr std::size_t most_twins = 12;
// "dispersion.svg", with the problem in the name where there are several.
std::string twin_file(const std::string& chart, const std::string& problem, const std::vector<std::string>& problems);
std::string with_unit(const std::string& key);  // "barrier 0 stiffness [N/m^exponent]" of "string.0.barrier.0.stiffness"
std::string rate_text(double hz);               // "44.1 kHz"; "" of NaN
store::Table rows_where(const store::Table&, const std::string& column, const std::string& text);
store::Table without_names(const store::Table&);  // less problem and series, which stand for columns that are there anyway
WorkPrecision work_precision_of(const Results&);  // of all problems

}  // namespace jvari::bench::report
