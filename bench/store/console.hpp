// What is said, and where: results on standard output, messages and progress on standard error.
#pragma once

#include <chrono>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "bench/store/interruption.hpp"

namespace jvari::bench::store {

enum Exit { done = 0, bad_usage = 2, refused = 3, run_failed = 4 };

// The caller asked for something that cannot be: the message says what was expected.
struct UsageError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

// What was to be written could not be: a full disk, a reader that went away.
struct Unwritable : std::runtime_error {
    using std::runtime_error::runtime_error;
};

// Before any file is opened: none takes the number of a standard stream that the caller closed; and what cannot be written, to a pipe that
// nobody reads or past a limit of file size, is an error of writing (Unwritable) where by default it would be a signal and the end.
void hold_standard_streams();
// A line to standard error. That it could not be written is nowhere to be told.
void tell(const std::string& line);

class Console {
public:
    Console(bool json, bool quiet) : json_(json), quiet_(quiet) {}
    bool json() const { return json_; }
    void note(const std::string&) const;        // standard error, unless --quiet
    void print(const std::string&) const;       // standard output, unless --json: the result as text; throws Unwritable
    void print_json(const std::string&) const;  // standard output, with --json only: one object; throws Unwritable

    // Shows how far a job of several parts is, on a terminal and once it has taken 2 s.
    class Progress {
    public:
        Progress(const Console&, std::string label);
        ~Progress();
        Progress(const Progress&) = delete;
        Progress& operator=(const Progress&) = delete;
        void show(double fraction, const std::string& what = {});

    private:
        std::string label_;
        std::chrono::steady_clock::time_point start_, last_;
        std::optional<WhenInterrupted> shown_;  // the line is cleared at an interruption, too
        bool terminal_;
    };

private:
    bool json_, quiet_;
};

// "unknown scheme "modal_two": did you mean modal_two_point?", or what there is.
std::string unknown(const std::string& kind, const std::string& word, const std::vector<std::string>& known);

}  // namespace jvari::bench::store
