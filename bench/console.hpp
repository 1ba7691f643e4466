// What is said, and where: results on standard output, messages and progress on standard error.
#pragma once

#include <chrono>
#include <stdexcept>
#include <string>

namespace jvari {

enum Exit { done = 0, bad_usage = 2, refused = 3, run_failed = 4 };

// The caller asked for something that cannot be: the message says what was expected.
struct UsageError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

class Console {
public:
    Console(bool json, bool quiet) : json_(json), quiet_(quiet) {}
    bool json() const { return json_; }
    void note(const std::string&) const;   // standard error, unless --quiet
    void print(const std::string&) const;  // standard output, unless --json: the result as text
    void print_json(const std::string&) const;  // standard output, with --json only: one object

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
        bool shown_, terminal_;
    };

private:
    bool json_, quiet_;
};

// The word nearest to `word` by edit distance where it is near enough to be meant, else "".
template <class Words>
std::string nearest(const std::string& word, const Words& words);
int edit_distance(const std::string& a, const std::string& b);

// "unknown scheme "modal_two": did you mean modal_two_point?", or the list of what there is.
template <class Words>
std::string unknown(const std::string& kind, const std::string& word, const Words& words) {
    std::string all;
    for (const auto& w : words) all += (all.empty() ? "" : ", ") + std::string(w);
    const std::string near = nearest(word, words), said = "unknown " + kind + " \"" + word + "\"";
    if (!near.empty()) return said + ": did you mean " + near + "?";
    return said + ": " + (all.empty() ? "there is none" : "there is " + all);
}

template <class Words>
std::string nearest(const std::string& word, const Words& words) {
    std::string best;
    int least = 1 + static_cast<int>(word.size()) / 2;
    for (const std::string w : words) {
        const bool begins = word.size() > 2 && w.compare(0, word.size(), word) == 0;
        const int distance = begins ? 1 : edit_distance(word, w);
        if (distance < least) {
            least = distance;
            best = w;
        }
    }
    return best;
}

}  // namespace jvari
