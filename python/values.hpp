// Converts between Python and the engine: keys and options become text, and scenes, tables and
// columns become Python values. Columns are arrays on the trace's memory.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <string>
#include <utility>
#include <vector>

#include "bench/compare/catalogue.hpp"
#include "bench/store/json.hpp"
#include "bench/store/records.hpp"
#include "bench/store/usage.hpp"
#include "scenes/scene_file.hpp"
#include "scenes/wording.hpp"
#include "schemes/run.hpp"

namespace jvari::python {

namespace py = pybind11;

// Refuses an invalid value and quotes it: repr(), shortened.
[[noreturn]] inline void refuse(const std::string& what, const py::handle& found,
                                const std::string& expected) {
    throw bench::store::UsageError(what + ": found " +
                                   found_text(py::repr(found).cast<std::string>()) + ", expected " +
                                   expected);
}
inline int at_least(int least, int n, const char* what) {
    if (n < least)
        refuse(what, py::int_(n), "a whole number, " + std::to_string(least) + " or more");
    return n;
}
inline bool is_path(const py::handle& value) {
    return py::isinstance<py::str>(value) || py::hasattr(value, "__fspath__");
}
inline std::string path_text(const py::handle& value) {
    return py::module_::import("os").attr("fspath")(value).cast<std::string>();
}

// Text for an override or an option.
inline std::string text_of(const py::handle& value, int level = 0) {
    constexpr int deepest = 16;  // same limit in scene files
    if (level > deepest)
        throw bench::store::UsageError("found lists nested deeper than " + std::to_string(deepest));
    if (py::isinstance<py::bool_>(value)) return value.cast<bool>() ? "true" : "false";
    if (is_path(value)) return path_text(value);
    if (py::isinstance<py::list>(value) || py::isinstance<py::tuple>(value)) {
        std::string text;
        for (const py::handle& item : value)
            text += (text.empty() ? "" : ", ") + text_of(item, level + 1);
        return "[" + text + "]";
    }
    if (py::isinstance<py::int_>(value)) return py::str(value).cast<std::string>();
    if (!py::hasattr(value, "__float__"))
        refuse("value", value, "a text, a number, True, False or a list of them");
    return bench::store::text_of(py::float_(py::reinterpret_borrow<py::object>(value)));
}

// {"[SCHEME:]NAME": value}
inline std::vector<bench::compare::SchemeOption> options_of(const py::dict& options) {
    std::vector<bench::compare::SchemeOption> all;
    for (const auto& [key, value] : options) {
        if (!py::isinstance<py::str>(key)) refuse("options", key, "the name of an option");
        const std::string name = key.cast<std::string>();
        const auto add = [&](const py::handle& one) {
            all.push_back(bench::compare::SchemeOption::of(name, text_of(one)));
        };
        const bool several = py::isinstance<py::list>(value) || py::isinstance<py::tuple>(value);
        if (several && py::len(value) == 0) refuse("option " + name, value, "one value at least");
        if (several)
            for (const auto& one : value) add(one);
        else add(value);
    }
    return all;
}

struct NamedScene {  // a scene with its name and overrides
    std::string name;
    std::vector<std::string> set;  // "key.path=value"
    Scene scene;

    static NamedScene of(const std::string& name, std::vector<std::string> set) {
        Scene scene = read_scene(name, set);
        return {name, std::move(set), std::move(scene)};
    }
    static NamedScene of(const py::object& o) {
        if (is_path(o)) return of(path_text(o), {});
        if (!py::isinstance<NamedScene>(o)) refuse("scene", o, "a Scene, a name or a path");
        return o.cast<NamedScene>();
    }
    NamedScene with(const std::string& key, const py::object& to) const {
        auto all = set;
        all.push_back(key + "=" + text_of(to));
        return of(name, std::move(all));
    }
    std::string repr() const {
        std::string text = "jvari.scene('" + name + "')";
        for (const std::string& o : set)
            text += ".set('" + o.substr(0, o.find('=')) + "', '" + o.substr(o.find('=') + 1) + "')";
        return text;
    }
};

inline py::object parsed(const std::string& json) {  // of nothing None
    if (json.empty()) return py::none();
    return py::module_::import("json").attr("loads")(json);
}
inline py::object rows_of(const bench::store::Table& t) {
    return parsed(bench::store::indented(bench::store::rows_json(t)));
}

using Column = py::array_t<double>;

// Accepts real numbers without a mask. Others are refused, because a conversion would silently lose
// data.
using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;
inline Numbers numbers_of(const py::object& given, const std::string& what) {
    const bool masked = py::module_::import("numpy.ma").attr("isMaskedArray")(given).cast<bool>();
    const py::array all = masked ? py::array() : py::array::ensure(given);
    if (!all) PyErr_Clear();
    if (masked || !all || std::string("fiub").find(all.dtype().kind()) == std::string::npos)
        throw py::type_error(what + ": found " +
                             (masked ? "a masked array"
                              : !all ? "no array"
                                     : py::str(all.dtype()).cast<std::string>()) +
                             ", expected real numbers");
    return all.cast<Numbers>();
}

struct TakenRun {  // run and the units for all columns
    Run run;
    // Names and units by column: taps, then the probed energies.
    std::vector<std::pair<std::string, std::string>> units;
    // JSON, or "": how the settings were chosen; the uncertainty of a reference.
    std::string advice{}, uncertainty{};
    double processor_seconds = std::numeric_limits<double>::quiet_NaN();

    TakenRun(Run r, const Scene& scene) : run(std::move(r)) {
        for (const Tap& t : scene.taps) units.emplace_back(t.name, unit_of(t.quantity));
        if (!run.trace.energy.empty())
            for (const char* name : {"energy_stored_J", "energy_supplied_J", "energy_dissipated_J"})
                units.emplace_back(name, "J");
    }
};

// Returns an array on the trace's memory: the array keeps the run alive.
inline Column column(const py::object& self, const std::string& name) {
    const auto& taken = self.cast<const TakenRun&>();
    const Trace& trace = taken.run.trace;
    std::vector<std::string> names;
    for (const auto& [column_name, unit] : taken.units) {
        const int k = static_cast<int>(names.size());
        names.push_back(column_name);
        if (column_name != name) continue;
        const auto values =
            k < trace.taps() ? trace.column(k) : trace.energy_column(k - trace.taps());
        Column a(static_cast<py::ssize_t>(values.size()), values.data(), self);
        a.attr("setflags")(py::arg("write") = false);
        return a;
    }
    throw py::key_error(bench::store::unknown("tap", name, names));
}

inline Column time_of(const TakenRun& r) {
    Column t(r.run.trace.rows);
    for (long n = 0; n < r.run.trace.rows; ++n)
        t.mutable_data()[n] = static_cast<double>(n) / r.run.trace.tap_rate;
    return t;
}

inline py::dict facts_of(const TakenRun& r) {
    py::dict facts;
    for (const Fact& f : r.run.facts) facts[py::str(f.name)] = f.value;
    return facts;
}

inline py::object to_xarray(const py::object& self) {
    const auto& r = self.cast<const TakenRun&>();
    const py::module_ xarray = py::module_::import("xarray");
    py::dict columns, coordinates;
    for (const auto& [name, unit] : r.units)
        columns[py::str(name)] =
            py::make_tuple("time", column(self, name), py::dict(py::arg("units") = unit));
    coordinates["time"] = py::make_tuple("time", time_of(r), py::dict(py::arg("units") = "s"));
    return xarray.attr("Dataset")(columns, coordinates, facts_of(r));
}

}  // namespace jvari::python
