// Schemes written in Python, and what they are made from: the problem as NumPy arrays. A class is made once for a problem and asked for its
// rows, block by block; whatever it raises ends that run and stands in its row as the reason.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bench/compare/catalogue.hpp"
#include "bench/store/usage.hpp"
#include "python/values.hpp"
#include "schemes/making.hpp"
#include "schemes/open/problem.hpp"
#include "schemes/registry.hpp"

namespace jvari::python {

inline py::object array_of(const Matrix& m) {
    const auto rows = static_cast<py::ssize_t>(m.rows), columns = static_cast<py::ssize_t>(m.columns);
    Column a(m.rows < 0 ? std::vector<py::ssize_t>{columns} : std::vector<py::ssize_t>{rows, columns});
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
    each_member(p, [&members](const char* name, const auto& value) { members[name] = array_of(value); });
    return py::module_::import("types").attr("SimpleNamespace")(**members);
}

struct PythonClass {  // of a scheme, kept for the life of the process as its guest is
    std::string name, source;
    py::object made_by;
};

class Interpreted final : public Scheme {
public:
    Interpreted(const PythonClass& of, const Scene& scene, const Settings& settings)
        : name_(of.name), made_by_(of.made_by), problem_(scene, settings) {
        refuse_beyond_arrays(scene);
        const py::gil_scoped_acquire lock;
        try {
            self_ = made_by_(namespace_of(problem_.arrays()));
            dofs_ = py::hasattr(self_, "dofs") ? self_.attr("dofs").cast<int>() : 2 * static_cast<int>(problem_.arrays().modes);
        } catch (py::error_already_set& e) {
            throw Refusal(name_ + ": " + e.what());
        }
        used_ = false;
    }
    ~Interpreted() override {
        const py::gil_scoped_acquire lock;
        self_ = py::object();
    }
    Interpreted(const Interpreted&) = delete;
    Interpreted& operator=(const Interpreted&) = delete;

    // Its own reset(), where it has one; else it is made anew. What it has raised stays the reason of this run.
    void reset() noexcept override {
        row_ = 0;
        if (!std::exchange(used_, false)) return;
        const py::gil_scoped_acquire lock;
        try {
            if (py::hasattr(self_, "reset")) self_.attr("reset")();
            else self_ = made_by_(namespace_of(problem_.arrays()));
        } catch (const std::exception& e) {
            failure_ = e.what();
        }
    }
    Status advance(const Block& out) noexcept override {
        used_ = true;
        const py::gil_scoped_acquire lock;
        try {
            if (failure_.empty()) take(self_.attr("advance")(out.rows), out);
        } catch (const std::exception& e) {
            failure_ = e.what();
        }
        const long step = row_ * problem_.arrays().steps_per_row;
        row_ += out.rows;
        if (failure_.empty()) return {};
        for (int k = 0; k < out.taps; ++k) std::fill_n(out.tap + k * out.stride, out.rows, std::numeric_limits<double>::quiet_NaN());
        return {Outcome::diverged, step};
    }
    int dofs() const override { return dofs_; }
    std::vector<Fact> facts() const override {
        if (!failure_.empty()) throw BadScheme(name_ + ": " + failure_);
        const py::gil_scoped_acquire lock;
        std::vector<Fact> all;
        if (py::hasattr(self_, "facts"))
            for (const auto& [name, value] : self_.attr("facts")().cast<py::dict>())
                all.emplace_back(name.cast<std::string>(), value.cast<double>(), "");
        return all;
    }

private:
    using Rows = py::array_t<double, py::array::forcecast>;
    static void copy(const Rows& from, int rows, int columns, double* to, long stride, const char* what) {
        if (from.ndim() != 2 || from.shape(0) != rows || from.shape(1) != columns)
            throw std::runtime_error(std::string("advance(") + std::to_string(rows) + ") gives " + what + " of another shape than (" +
                                     std::to_string(rows) + ", " + std::to_string(columns) + ")");
        const auto values = from.unchecked<2>();
        for (int n = 0; n < rows; ++n)
            for (int k = 0; k < columns; ++k) to[n + k * stride] = values(n, k);
    }
    static void take(const py::object& given, const Block& out) {
        const bool pair = py::isinstance<py::tuple>(given) && py::len(given) == 2;
        copy(pair ? given[py::int_(0)].cast<Rows>() : given.cast<Rows>(), out.rows, out.taps, out.tap, out.stride, "taps");
        if (!out.energy) return;
        if (pair) copy(given[py::int_(1)].cast<Rows>(), out.rows, 3, out.energy, out.stride, "energies");
        else
            for (int k = 0; k < 3; ++k) std::fill_n(out.energy + k * out.stride, out.rows, 0.0);
    }

    std::string name_;
    py::object made_by_, self_;
    Problem problem_;
    int dofs_ = 0;
    long row_ = 0;
    bool used_ = false;
    std::string failure_;
};

inline Features features_of(const std::vector<std::string>& names) {
    std::vector<std::string> known;
    Features all;
    for (int i = 0; i < feature_count; ++i) known.emplace_back(name_of(static_cast<Feature>(1u << i)));
    for (const std::string& name : names) {
        const auto found = std::ranges::find(known, name);
        if (found == known.end()) throw bench::store::UsageError(bench::store::unknown("feature", name, known));
        all = all | Features(1u << (found - known.begin()));
    }
    return all;
}

// Registers the class in place of one of the same name; returns the path that its guest has.
inline std::string add_class(const py::object& made_by, const std::string& name, const std::vector<std::string>& represents,
                             const std::string& balance, const std::string& source, bool compiled) {
    const auto* kept = new PythonClass{name, source, made_by};  // NOLINT(cppcoreguidelines-owning-memory): as its guest, to the end
    Descriptor d{};
    d.name = kept->name.c_str(), d.source = kept->source.c_str();
    d.represents = features_of(represents);
    if (balance != "exact" && balance != "to tolerance" && balance != "none")
        throw bench::store::UsageError("balance: found \"" + balance + "\", expected \"exact\", \"to tolerance\" or \"none\"");
    d.balance = balance == "exact" ? Balance::exact : balance == "none" ? Balance::none : Balance::to_tolerance;
    d.clock = Clock::stepped;
    d.own = kept;
    d.untimed = compiled ? "" : "interpreted, not compared";
    d.make = [](const Descriptor& of, const Scene& scene, const Settings& settings) -> std::unique_ptr<Scheme> {
        return std::make_unique<Interpreted>(*static_cast<const PythonClass*>(of.own), scene, settings);
    };
    std::string text = name;
    try {
        text += py::module_::import("inspect").attr("getsource")(made_by).cast<std::string>();
    } catch (py::error_already_set&) {  // typed into a console: nothing is kept of it but by its name and this process
        text += std::to_string(reinterpret_cast<std::uintptr_t>(kept));
    }
    std::string path = "scheme " + name;
    add_guest({path, {d}, text, "Python", compiled ? "compiled" : "interpreted"});
    return path;
}

}  // namespace jvari::python
