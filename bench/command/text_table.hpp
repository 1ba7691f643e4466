// A table for the terminal: columns as wide as what stands in them.
//
// Where it is wider than the terminal, columns are left out, those of the highest rank first; one
// of rank 0 stays.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "bench/study/cells.hpp"

namespace jvari::bench::command {

struct TextTable {
    struct Column {
        std::string head;
        bool left = false;  // where its fields stand in it
        int rank = 0;
    };
    struct Row {
        char mark;  // in front of the line
        std::vector<std::string> fields;
    };
    std::vector<Column> columns;
    std::vector<Row> rows;

    // each line with its end; a last one says what was left out
    std::string text(std::size_t width) const;
};

// ---- The table of a comparison for the terminal.

// The front marked, and what is not to be trusted; in lines of that width, cost and headline error
// always.
std::string headline_text(const study::Cells&, std::size_t width);

}  // namespace jvari::bench::command
