// The work-precision chart as a Vega-Lite specification (https://vega.github.io/vega-lite), drawn by vl2svg or in a page by vega-embed.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "bench/compare/record/cheapest.hpp"
#include "bench/report/chart_style.hpp"
#include "bench/store/records.hpp"

namespace jvari::bench::report {

struct Axis {
    std::string column, title;
    std::string measure{}, tap{};  // of an error: what the column's name is made of
};

struct Band {  // what is not known better of an error: a tie below the noise floor, no finding below the reference's own certificate
    std::string problem, error;
    double floor, certificate;  // NaN: not known
};

struct Goal {  // an accuracy that is asked for, and who gets there at the least cost
    std::string problem, error;
    double most;
    std::string text;
};

struct WorkPrecision {
    std::string title, subtitle;
    store::Table cells;               // as compare writes them; with `problem` and `series` where they are of several
    std::vector<Axis> errors, costs;  // what a reader can choose between; the first of each is shown
    std::vector<Band> bands;
    std::vector<Goal> goals;
    std::string problem;  // that is shown; "": the first
    Medium medium = Medium::print;
    compare::Controls controls = compare::Controls::stand_beside;  // on the front too
};

// Cost across, error up, both logarithmic: a line per series through its rates with its quartiles of cost, the Pareto front behind, noise
// floor and certificate as bands, the goals across, at the upper edge the runs that failed. The signals `measure_field`, `tap_field`,
// `cost_field` and `problem_field` choose.
std::string work_precision_spec(const WorkPrecision&);

std::vector<Axis> error_axes(const store::Table& cells, const std::vector<std::string>& taps,
                             const std::string& first);  // those with a finite value
std::vector<Axis> cost_axes();

}  // namespace jvari::bench::report
