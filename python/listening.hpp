// Runs the engine for Python: releases the interpreter's lock, handles Ctrl-C, and issues notes as
// warnings.
#pragma once

#include <pybind11/pybind11.h>

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <type_traits>
#include <utility>

#include "bench/store/system/listener.hpp"
#include "bench/store/usage.hpp"

namespace jvari::python {

namespace py = pybind11;

// Carries a Python exception through the engine to the module, which raises it. Not derived from
// std::exception, so no code in between mistakes it for its own failure.
struct Raised {
    explicit Raised(py::error_already_set e) : error(std::move(e)) {}
    py::error_already_set error;
};

// Calls that compute. Before exit the interpreter waits for them: their threads could not end
// without the interpreter.
struct Calls {
    int under_way = 0;
    bool leaving = false;
    // Exception from within a scheme, where throwing is impossible: the next check raises it.
    std::optional<Raised> raised;
};
inline Calls& calls() {  // accessed only with the interpreter's lock
    static Calls c;
    return c;
}
inline void wait_for_calls() {
    calls().leaving = true;
    while (calls().under_way > 0) {
        const py::gil_scoped_release released;
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
}

// True if Python code of a scheme runs on this thread: a scheme in Python cannot run another,
// because it might run itself without end.
inline bool& in_a_scheme() {
    thread_local bool inside = false;
    return inside;
}

// Raises Ctrl-C and other Python signals on the calling thread; on any other thread only the exit
// of the interpreter.
inline void look_for_signals() {
    const py::gil_scoped_acquire lock;
    if (auto& there = calls().raised) throw Raised(*std::exchange(there, {}));
    if (calls().leaving) PyErr_SetString(PyExc_SystemExit, "the interpreter leaves");
    if (PyErr_Occurred() || PyErr_CheckSignals() != 0) throw Raised(py::error_already_set());
}

class PythonListener : public bench::store::Listener {
    struct Signals : bench::store::Progress {
        void show(double, const std::string&) override { look_for_signals(); }
    };

public:
    void note(const std::string& text) const override {
        const py::gil_scoped_acquire lock;
        // Warnings may be set to be errors.
        if (PyErr_WarnEx(PyExc_UserWarning, text.c_str(), 1) != 0)
            throw Raised(py::error_already_set());
    }
    std::unique_ptr<bench::store::Progress> begin(const std::string&) const override {
        return std::make_unique<Signals>();
    }
};

template <class Work>
auto unlocked(Work work) {
    look_for_signals();
    struct UnderWay {
        UnderWay() { ++calls().under_way; }
        ~UnderWay() {
            if (calls().under_way > 0) --calls().under_way;  // 0 in a forked child
        }
    } const under_way;
    const auto at_work = [&] {
        const py::gil_scoped_release released;
        return work();
    };
    try {
        if constexpr (std::is_void_v<decltype(work())>) {
            at_work();
            look_for_signals();
        } else {
            auto done = at_work();
            look_for_signals();
            return done;
        }
    } catch (...) {
        look_for_signals();  // raised Python exceptions come first
        throw;
    }
}

// Runs unlocked; KeyboardInterrupt gets the text of `kept`.
template <class Work, class Kept>
auto unlocked(Work work, Kept kept) {
    try {
        return unlocked(work);
    } catch (const Raised& e) {
        if (e.error.matches(PyExc_KeyboardInterrupt))
            e.error.value().attr("args") = py::make_tuple("interrupted: " + kept());
        throw;
    }
}

}  // namespace jvari::python
