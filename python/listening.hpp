// The engine at work for Python: the interpreter's lock released, Ctrl-C heard, notes as warnings.
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

// What Python wants to raise, and the module raises there. No std::exception: nothing on the way
// takes it for a failure of its own.
struct Raised {
    explicit Raised(py::error_already_set e) : error(std::move(e)) {}
    py::error_already_set error;
};

// Of calls that compute. The interpreter waits for them before it leaves: their threads could not
// end without it.
struct Calls {
    int under_way = 0;
    bool leaving = false;
    // within a scheme, where nothing can be thrown: the next look raises it
    std::optional<Raised> raised;
};
inline Calls& calls() {  // read and written by who has the interpreter's lock
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

// Whether Python code of a scheme runs on this thread: a scheme in Python cannot run one, or it
// might run itself without end.
inline bool& in_a_scheme() {
    thread_local bool inside = false;
    return inside;
}

// Ctrl-C and other signals of Python, on the thread that called; on any other that the interpreter
// leaves.
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
        // warnings are errors here
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
            if (calls().under_way > 0) --calls().under_way;  // 0 in the child of a fork
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
        look_for_signals();  // what was raised comes first
        throw;
    }
}

// The same; KeyboardInterrupt says what `kept` says.
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
