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
constexpr const char* status(int code) {  // as --json says it
    return code == done ? "ok" : code == refused ? "refused" : "failed";
}
}  // namespace exit_code

// Before any file is opened: none takes the number of a standard stream that the caller closed; and
// what cannot be written, to a pipe that nobody reads or past a limit of file size, is an error of
// writing (Unwritable) where by default it would be a signal and the end.
void keep_standard_output();  // for print_json alone: what a plugin prints goes to standard error
void hold_standard_streams();
// A line to standard error. A failure to write it is ignored.
void write_error(const std::string& line);

// Lines of at most 100 columns; one that is broken goes on below its own second column.
std::string wrapped(const std::string& text);

class Console : public store::Listener {
public:
    Console(bool json, bool quiet) : json_(json), quiet_(quiet) {}
    bool json() const { return json_; }
    void note(const std::string&) const override;  // standard error, unless --quiet
    // standard output, unless --json or --quiet: the result as text; throws Unwritable
    void print(const std::string&) const;
    // standard output, with --json only: one object; throws Unwritable
    void print_json(const std::string&) const;

    // Columns of standard output: $COLUMNS, else those of the terminal, else as many as are wanted.
    static std::size_t width();

    // Once the job has taken 2 s: a line that renews itself on a terminal, elsewhere a line every
    // ten seconds. Nothing with --quiet.
    std::unique_ptr<store::Progress> begin(const std::string& job) const override;

private:
    bool json_, quiet_;
};

// A line to standard error and, with --json, an object to standard output; returns `code`.
int fail(bool json, int code, const char* status, const std::string& message);

// ---- The program: reads its arguments and does what they ask for.

// Returns the exit code, or throws: UsageError, BadScene, SceneFileError (2), Refusal (3).
int call(int argc, const char* const* argv);

// ---- A table for the terminal: columns as wide as what stands in them.
//
// Where it is wider than the terminal, columns are left out, those of the highest rank first; one
// of rank 0 stays.

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
