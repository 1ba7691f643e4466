// Rows of a table of cells (cells.csv), gathered by what they have in common: the series that fits
// and charts are made of.
#pragma once

#include <string>
#include <vector>

#include "bench/store/records.hpp"

namespace jvari::bench::store {

using Rows = std::vector<std::size_t>;  // of one table, in the order in which they stand

// The columns that name a problem and a scheme: all before the rate, save the cell's own name.
std::vector<std::string> naming_columns(const Table& cells);

// Those of them between `scene` and `scheme`: keys of the scene that are swept. None where the
// table is of one scene and does not say it.
std::vector<std::string> swept_keys(const Table& cells);

// `rows` in groups that have the same in each of `columns`, in the order in which they come.
std::vector<Rows> alike(const Table&, const Rows&, const std::vector<std::string>& columns);

// Groups that differ in the rate alone; where a rate comes twice, the modes tell them apart.
std::vector<Rows> differing_in_rate(const Table& cells, const Rows&,
                                    const std::vector<std::string>& naming);

Rows all_rows(const Table&);

// "modal_two_point compliance=matched, 133 modes at 88.2 kHz"; of a grid, which takes its nodes
// from the rate, without them.
std::string run_name(const Table& cells, std::size_t row);

}  // namespace jvari::bench::store
