// The terminal: results on standard output, messages and progress on standard error.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "bench/store/system/listener.hpp"
#include "bench/study/cells.hpp"

namespace jvari::bench::command {

namespace exit_code {
constexpr int done = 0, bad_usage = 2, refused = 3, run_failed = 4;
constexpr const char* status(int code) {  // status in the JSON output
    return code == done ? "ok" : code == refused ? "refused" : "failed";
}
}  // namespace exit_code

// Called before any file is opened. Standard streams that the caller closed are filled, so that no
// file gets their numbers. Signals of failed writing, to a pipe without a reader or beyond a limit
// of file size, become an error (Unwritable); by default they would end the program.
// Reserves standard output for print_json: the output of plugins goes to standard error.
void keep_standard_output();
void hold_standard_streams();
// Writes a line to standard error and ignores a failure.
void write_error(const std::string& line, store::Mark = store::Mark::none);

// Wraps lines at 100 columns; continuation lines start below the second column of the broken line.
std::string wrapped(const std::string& text);

class Console : public store::Listener {
public:
    Console(bool json, bool quiet) : json_(json), quiet_(quiet) {}
    bool json() const { return json_; }
    void note(const std::string&) const override;  // to standard error, unless --quiet
    void warn(const std::string&) const override;
    // Prints the result as text to standard output, unless --json or --quiet; throws Unwritable.
    void print(const store::Lines&) const;
    void print(const std::string& text, store::Mark mark = store::Mark::none) const {
        print(store::Lines{{text, mark}});
    }
    // Prints one object to standard output, only with --json; throws Unwritable.
    void print_json(const std::string&) const;

    // Columns of standard output: $COLUMNS, else the width of the terminal, else unlimited.
    static std::size_t width();

    // Starts a progress line, shown once the job has taken 2 s: rewritten in place on a terminal,
    // elsewhere printed every ten seconds. With --quiet nothing is shown.
    std::unique_ptr<store::Progress> begin(const std::string& job) const override;

private:
    bool json_, quiet_;
};

// Writes a line to standard error and, with --json, an object to standard output; returns `code`.
int fail(bool json, int code, const char* status, const std::string& message);

// ---- The program: reads its arguments and runs the verb.

// Returns the exit code, or throws: UsageError, BadScene, SceneFileError (2), Refusal (3).
int call(int argc, const char* const* argv);

// ---- A table for the terminal, with columns as wide as their contents.
//
// If the table is wider than the terminal, columns are left out, the highest rank first; columns
// with rank 0 stay.

struct TextTable {
    struct Column {
        std::string head;
        bool left = false;  // alignment
        int rank = 0;
    };
    struct Row {
        char mark;  // in front of the line
        std::vector<std::string> fields;
    };
    std::vector<Column> columns;
    std::vector<Row> rows;

    // A last line lists the omitted columns.
    store::Lines lines(std::size_t width) const;
    std::string text(std::size_t width) const { return store::text_of(lines(width)); }
};

// ---- The table of a comparison for the terminal.

// Marks the front and untrustworthy rows. Lines fit the width; cost and headline error are always
// shown.
store::Lines headline_lines(const study::Cells&, std::size_t width);

}  // namespace jvari::bench::command
