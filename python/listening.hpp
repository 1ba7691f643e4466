// The engine at work for Python: the interpreter's lock released, Ctrl-C heard, notes as warnings.
#pragma once

#include <pybind11/pybind11.h>

#include <memory>
#include <string>

#include "bench/store/system/listener.hpp"

namespace jvari::python {

namespace py = pybind11;

// What Python wants to raise, and the module raises there. No std::exception: nothing on the way takes it for a failure of its own.
struct Raised {
    py::error_already_set error;
};

// Ctrl-C and other signals of Python, on the thread that called; nothing on any other.
inline void look_for_signals() {
    const py::gil_scoped_acquire lock;
    if (PyErr_CheckSignals() != 0) throw Raised{py::error_already_set()};
}

class Ear : public bench::store::Listener {
    struct Signals : bench::store::Progress {
        void show(double, const std::string&) override { look_for_signals(); }
    };

public:
    void note(const std::string& text) const override {
        const py::gil_scoped_acquire lock;
        if (PyErr_WarnEx(PyExc_UserWarning, text.c_str(), 1) != 0) throw Raised{py::error_already_set()};  // warnings are errors here
    }
    std::unique_ptr<bench::store::Progress> begin(const std::string&) const override { return std::make_unique<Signals>(); }
};

template <class Work>
auto unlocked(Work work) {
    const py::gil_scoped_release released;
    return work();
}

// The same; KeyboardInterrupt says what `kept` says.
template <class Work, class Kept>
auto unlocked(Work work, Kept kept) {
    try {
        return unlocked(work);
    } catch (const Raised& e) {
        if (e.error.matches(PyExc_KeyboardInterrupt)) e.error.value().attr("args") = py::make_tuple("interrupted: " + kept());
        throw;
    }
}

}  // namespace jvari::python
