// Who is told how a long computation goes. This one hears nothing: a program that calls jvari as a
// library passes it, or one of its own.
#pragma once

#include <memory>
#include <string>

namespace jvari::bench::store {

// How far one job of several parts is; it ends with the job. Called by one thread at a time.
class Progress {
public:
    Progress() = default;
    virtual ~Progress() = default;
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;
    // The part that is done, from 0 to 1, and what is going on. As often as one likes: a listener
    // shows what it can.
    virtual void show(double /*fraction*/, const std::string& /*what*/ = {}) {}
};

class Listener {
public:
    virtual ~Listener() = default;
    // a message of one line or more, without its last line's end
    virtual void note(const std::string& /*text*/) const {}
    virtual std::unique_ptr<Progress> begin(const std::string& /*job*/) const {
        return std::make_unique<Progress>();
    }
};

}  // namespace jvari::bench::store
