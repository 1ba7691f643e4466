// Receives the progress of a long computation. This base class ignores everything: a program that
// uses jvari through the library passes this class, or derives from Listener.
#pragma once

#include <memory>
#include <string>
#include <vector>

namespace jvari::bench::store {

// Progress of a job with several parts. Progress ends with the object's lifetime. Only a single
// thread calls at a time.
class Progress {
public:
    Progress() = default;
    virtual ~Progress() = default;
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;
    // Shows the finished fraction, from 0 to 1, and the present activity. May be called at any
    // frequency: a listener chooses how much to show.
    virtual void show(double /*fraction*/, const std::string& /*what*/ = {}) {}
};

// Lines of a text. A terminal may show their marks by colours.
enum class Mark { none, best, doubtful, error, answer };
struct Line {
    std::string text;
    Mark mark = Mark::none;
};
using Lines = std::vector<Line>;
inline std::string text_of(const Lines& lines) {  // ends with a line break
    std::string text;
    for (const Line& line : lines) text += line.text + "\n";
    return text;
}

class Listener {
public:
    virtual ~Listener() = default;
    // The message has at least a line, without a final line break.
    virtual void note(const std::string& /*text*/) const {}
    virtual void warn(const std::string& text) const { note("warning: " + text); }
    virtual std::unique_ptr<Progress> begin(const std::string& /*job*/) const {
        return std::make_unique<Progress>();
    }
};

}  // namespace jvari::bench::store
