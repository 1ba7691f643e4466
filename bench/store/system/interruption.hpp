// Ctrl-C and its like (SIGINT, SIGTERM, SIGHUP): a file that is being written is finished and no
// further one is begun, last words are said, and the program ends by that same signal, so that its
// caller sees why. A second one ends it where it stands.
#pragma once

#include <functional>
#include <list>

namespace jvari::bench::store {

// Once, before there is any other thread: blocks these signals in this thread and so in all to
// come, and waits for them in one of its own. A signal that the caller has set to be ignored
// (nohup, a script's job in the background) stays ignored.
void heed_interruptions();

// While one lives an interruption waits. Once there is one, whoever ends an Undisturbed or would
// begin one waits for the program's end. Never one within another.
class Undisturbed {
public:
    Undisturbed();
    ~Undisturbed();
    Undisturbed(const Undisturbed&) = delete;
    Undisturbed& operator=(const Undisturbed&) = delete;
};

// Called by an interruption within its life, on another thread, the newest first. It may write to a
// terminal, not to a file.
class WhenInterrupted {
public:
    explicit WhenInterrupted(std::function<void()>);
    ~WhenInterrupted();
    WhenInterrupted(const WhenInterrupted&) = delete;
    WhenInterrupted& operator=(const WhenInterrupted&) = delete;

private:
    std::list<std::function<void()>>::iterator place_;
};

}  // namespace jvari::bench::store
