// Schemes written in Python, and their input: the problem as NumPy arrays. A class is instantiated
// once per problem and advanced block by block. An exception ends the run and stands in its row as
// the reason.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <exception>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bench/compare/catalogue.hpp"
#include "bench/store/usage.hpp"
#include "python/listening.hpp"
#include "python/values.hpp"
#include "schemes/making.hpp"
#include "schemes/open/problem.hpp"
#include "schemes/registry.hpp"

namespace jvari::python {

inline py::object array_of(const Matrix& m) {
    const auto rows = static_cast<py::ssize_t>(m.rows),
               columns = static_cast<py::ssize_t>(m.columns);
    Column a(m.rows < 0 ? std::vector<py::ssize_t>{columns}
                        : std::vector<py::ssize_t>{rows, columns});
    std::copy_n(m.data, static_cast<std::size_t>(a.size()), a.mutable_data());
    return a;
}
inline py::object array_of(const Words& w) {
    return py::cast(std::vector<std::string>(w.data, w.data + w.count));
}
template <class Plain>
py::object array_of(const Plain& value) {
    return py::cast(value);
}
inline py::object namespace_of(const jvari_problem& p) {
    py::dict members;
    each_member(
        p, [&members](const char* name, const auto& value) { members[name] = array_of(value); });
    return py::module_::import("types").attr("SimpleNamespace")(**members);
}

struct PythonClass {  // class of a scheme, kept until the process ends because its guest is
    std::string name, source;
    py::object python_class;
};

// Calls the code of a scheme, always through this function and with the interpreter's lock. A
// Python Exception becomes a failure of the scheme: BadScheme with the same sentence.
// KeyboardInterrupt and SystemExit are no Exception and end the study.
template <class Act>
auto in_scheme(const std::string& name, Act act) {
    const py::gil_scoped_acquire lock;
    const struct Inside {
        Inside() : before(std::exchange(in_a_scheme(), true)) {}
        ~Inside() { in_a_scheme() = before; }
        bool before;
    } inside;
    try {
        return act();
    } catch (const py::error_already_set& e) {
        if (!e.matches(PyExc_Exception)) calls().raised.emplace(e);
        throw BadScheme(name + ": " + e.what());
    } catch (const py::builtin_exception& e) { throw BadScheme(name + ": " + e.what()); }
}

inline int dofs_of(const py::object& self) {
    const py::object given = self.attr("dofs");
    const Py_ssize_t n = PyNumber_AsSsize_t(given.ptr(), PyExc_OverflowError);
    const bool none = PyErr_Occurred() != nullptr;
    PyErr_Clear();
    if (none || n < 0 || n > std::numeric_limits<int>::max())
        throw py::type_error("dofs: found " + py::repr(given).cast<std::string>() +
                             ", expected a whole number, the doubles of state");
    return static_cast<int>(n);
}

class Interpreted final : public Scheme {
public:
    Interpreted(const PythonClass& of, const Scene& scene, const Settings& settings)
        : of_(of), problem_(scene, settings) {
        refuse_beyond_arrays(scene);
        try {
            make();
        } catch (const BadScheme& e) { throw Refusal(e.what()); }
        dofs_ = in_scheme(of_.name, [this] {
            return py::hasattr(*self_, "dofs") ? dofs_of(*self_)
                                               : 2 * static_cast<int>(problem_.arrays().modes);
        });
    }

    // Calls the scheme's own reset() if it has one; otherwise creates a new instance. An earlier
    // exception stays the reason for this run.
    void reset() noexcept override {
        row_ = 0;
        if (!std::exchange(used_, false)) return;
        attempt([this] {
            if (in_scheme(of_.name, [this] {
                    return py::hasattr(*self_, "reset") && (self_->attr("reset")(), true);
                }))
                return;
            make();
        });
    }
    Status advance(const Block& out) noexcept override {
        used_ = true;
        attempt([&] { in_scheme(of_.name, [&] { take(self_->attr("advance")(out.rows), out); }); });
        if (failure_ && out.stop) wait_for_end(out);
        const long step = row_ * problem_.arrays().steps_per_row;
        row_ += out.rows;
        if (!failure_) return {};
        for (int k = 0; k < out.taps; ++k)
            std::fill_n(out.tap + k * out.stride, out.rows,
                        std::numeric_limits<double>::quiet_NaN());
        return {Outcome::diverged, step};
    }
    int dofs() const override { return dofs_; }
    std::vector<Fact> facts() const override {
        if (failure_) std::rethrow_exception(failure_);
        return in_scheme(of_.name, [this] {
            std::vector<Fact> all;
            if (py::hasattr(*self_, "facts"))
                for (const auto& [name, value] : self_->attr("facts")().cast<py::dict>())
                    all.emplace_back(name.cast<std::string>(), value.cast<double>(), "");
            return all;
        });
    }

private:
    // Waits while a raised exception ends the study, so that no row of the run is kept.
    static void wait_for_end(const Block& out) {
        const auto ends = [] {
            const py::gil_scoped_acquire lock;
            return calls().raised.has_value();
        };
        while (ends() && !out.stopped()) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    void make() {
        self_ = in_scheme(
            of_.name, [this] { return shared(of_.python_class(namespace_of(problem_.arrays()))); });
    }
    template <class Act>
    void attempt(Act act) noexcept {  // does nothing after a failure
        if (failure_) return;
        try {
            act();
        } catch (...) { failure_ = std::current_exception(); }
    }
    static std::shared_ptr<py::object> shared(py::object o) {  // may be released on any thread
        return {new py::object(std::move(o)), [](py::object* it) {
                    const py::gil_scoped_acquire lock;
                    delete it;
                }};
    }
    static void copy(const Numbers& from, int rows, int columns, double* to, long stride,
                     const char* what) {
        if (from.ndim() != 2 || from.shape(0) != rows || from.shape(1) != columns)
            throw std::runtime_error(std::string("advance(") + std::to_string(rows) + ") gives " +
                                     what + " of another shape than (" + std::to_string(rows) +
                                     ", " + std::to_string(columns) + ")");
        const auto values = from.unchecked<2>();
        for (int n = 0; n < rows; ++n)
            for (int k = 0; k < columns; ++k) to[n + k * stride] = values(n, k);
    }
    static void take(const py::object& given, const Block& out) {
        const bool pair = py::isinstance<py::tuple>(given) && py::len(given) == 2;
        copy(numbers_of(pair ? given[py::int_(0)] : given, "advance"), out.rows, out.taps, out.tap,
             out.stride, "taps");
        if (!out.energy) return;
        if (pair)
            copy(numbers_of(given[py::int_(1)], "advance"), out.rows, 3, out.energy, out.stride,
                 "energies");
        else
            for (int k = 0; k < 3; ++k) std::fill_n(out.energy + k * out.stride, out.rows, 0.0);
    }

    const PythonClass& of_;
    Problem problem_;
    int dofs_ = 0;
    long row_ = 0;
    bool used_ = false;
    std::shared_ptr<py::object> self_;
    std::exception_ptr failure_;
};

// Registers the class and replaces a class with the same name; returns the path of its guest.
inline std::string add_class(const py::object& python_class, const std::string& name,
                             const std::vector<std::string>& represents, const std::string& balance,
                             const std::string& source, bool compiled) {
    const auto kept = std::make_shared<const PythonClass>(PythonClass{name, source, python_class});
    Descriptor d{};
    d.name = kept->name.c_str(), d.source = kept->source.c_str();
    d.represents = bench::compare::features_of(represents);
    d.balance = bench::compare::balance_of(balance);
    d.clock = Clock::stepped;
    d.own = kept.get();
    d.untimed = compiled ? "" : "interpreted, not compared";
    d.make = [](const Descriptor& of, const Scene& scene,
                const Settings& settings) -> std::unique_ptr<Scheme> {
        return std::make_unique<Interpreted>(*static_cast<const PythonClass*>(of.own), scene,
                                             settings);
    };
    std::string text = name;
    try {
        text += py::module_::import("inspect").attr("getsource")(python_class).cast<std::string>();
    } catch (py::error_already_set&) {
        // A class typed into a console has no source: only its name and this process identify it.
        text += std::to_string(reinterpret_cast<std::uintptr_t>(kept.get()));
    }
    std::string path = "scheme " + name;
    add_guest({path, {d}, text, kept, "Python", compiled ? "compiled" : "interpreted"});
    return path;
}

}  // namespace jvari::python
