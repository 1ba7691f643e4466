// The Python module: scenes, runs, comparisons, suites and trims as values. jvari.pyi has the
// types; shapes and units stand in the docstrings. Refusals by the engine become exceptions with
// the same sentence.
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include "bench/store/machine.hpp"
#include "bench/store/system/interruption.hpp"
#include "python/judging.hpp"
#include "python/notebook.hpp"
#include "scenes/pitch.hpp"
#include "schemes/making.hpp"

namespace py = pybind11;
using namespace jvari;

namespace {
// Forbids construction from Python: only the module creates objects of the class, so none is left
// uninitialised.
template <class Class>
void has_no_constructor(const Class& c) {
    reinterpret_cast<PyTypeObject*>(c.ptr())->tp_new = [](PyTypeObject* type, PyObject*,
                                                          PyObject*) -> PyObject* {
        return PyErr_Format(PyExc_TypeError,
                            "%s: no constructor defined; calls of the module give it",
                            type->tp_name);
    };
}

void raise_as(const py::handle& type, const std::exception& e) {
    PyErr_SetString(type.ptr(), e.what());
}

// Exception types belong to the module, which outlives all its callers.
void translate_exceptions(py::module_& m) {
    static const py::handle usage =
        py::exception<bench::store::UsageError>(m, "UsageError", PyExc_ValueError).release();
    static const py::handle scene =
        py::exception<SceneFileError>(m, "SceneError", PyExc_ValueError).release();
    static const py::handle refusal =
        py::exception<Refusal>(m, "Refusal", PyExc_RuntimeError).release();
    usage.attr("__doc__") =
        "A name or a number that cannot be; the sentence says what was expected.";
    scene.attr("__doc__") = "A scene that is none: file, line, key and what was expected.";
    refusal.attr("__doc__") =
        "The scheme cannot represent the scene; the sentence says what is missing.";
    py::register_exception_translator([](std::exception_ptr p) {
        try {
            if (p) std::rethrow_exception(p);
        } catch (const python::Raised& e) {
            py::error_already_set(e.error).restore();
        } catch (const bench::store::UsageError& e) {
            raise_as(usage, e);
        } catch (const bench::store::PastItsLimit& e) {
            raise_as(PyExc_TimeoutError, e);
        } catch (const BadOption& e) { raise_as(usage, e); } catch (const SceneFileError& e) {
            raise_as(scene, e);
        } catch (const BadScene& e) { raise_as(scene, e); } catch (const Refusal& e) {
            raise_as(refusal, e);
        } catch (const py::cast_error&) {
            PyErr_SetString(PyExc_TypeError,
                            "an argument, or a part of one, has another type than jvari.pyi says");
        }
    });
}

void add_scene(py::module_& m) {
    using python::NamedScene;
    py::class_<NamedScene> scene(m, "Scene",
                                 "What vibrates: a scene of the library or a file, with its "
                                 "overrides. A value: set() gives another.");
    has_no_constructor(scene);
    scene
        .def("set", &NamedScene::with, py::arg("key"), py::arg("value"),
             "Another scene, with this key changed: set(\"string.0.tension\", 40) [N].")
        .def_property_readonly(
            "name", [](const NamedScene& s) { return s.scene.name; }, "As the file has it.")
        .def_property_readonly(
            "duration", [](const NamedScene& s) { return s.scene.duration; },
            "How long it lasts [s].")
        .def_property_readonly(
            "period", [](const NamedScene& s) { return 1 / lowest_pitch(s.scene); },
            "Of the first mode of the lowest string [s]: run(..., duration=8 * scene.period).")
        .def_property_readonly(
            "taps",
            [](const NamedScene& s) {
                std::vector<std::string> names;
                for (const Tap& t : s.scene.taps) names.push_back(t.name);
                return names;
            },
            "Names of what is listened to, in the order of a run's columns.")
        .def(
            "toml", [](const NamedScene& s) { return write_scene(s.scene); },
            "The scene as a file that reads back as the same.")
        .def("__repr__", &NamedScene::repr);
    m.def(
        "scene", [](const py::object& name) { return NamedScene::of(name); }, py::arg("name"),
        "A scene file, or a scene of the library. Raises SceneError.");
    m.def("scenes", &library_scenes, "Names of the scenes in the library.");
}

using RunClass = py::class_<python::TakenRun, std::shared_ptr<python::TakenRun>>;

void add_columns(RunClass& taken) {
    using python::TakenRun;
    taken.def("__getitem__", &python::column, py::arg("tap"), "A column, shape (rows,).")
        .def(
            "keys",
            [](const TakenRun& r) {
                std::vector<std::string> names;
                for (const auto& [name, unit] : r.units) names.push_back(name);
                return names;
            },
            "Names of the columns: taps, then energy_stored_J, energy_supplied_J and "
            "energy_dissipated_J where they were probed.")
        .def_property_readonly(
            "units",
            [](const TakenRun& r) {
                py::dict units;
                for (const auto& [name, unit] : r.units) units[py::str(name)] = unit;
                return units;
            },
            "Of each column, by name: \"m\", \"m/s\", \"N\", \"J\".")
        .def_property_readonly("time", &python::time_of, "Instants of the rows, shape (rows,) [s].")
        .def_property_readonly(
            "tap_rate", [](const TakenRun& r) { return r.run.trace.tap_rate; },
            "Rows per second [Hz].");
}

void add_outcome(RunClass& taken) {
    using python::TakenRun;
    taken
        .def_property_readonly(
            "status", [](const TakenRun& r) { return name_of(r.run.status.outcome); },
            "\"ok\", \"diverged\" or \"not_converged\".")
        .def_property_readonly(
            "failed_step", [](const TakenRun& r) { return r.run.status.step; },
            "Where it failed; the rows up to there are valid.")
        .def_property_readonly(
            "facts", &python::facts_of,
            "What the scheme says of its run, by name; `jvari list facts` has meanings and units.")
        .def_property_readonly(
            "dofs", [](const TakenRun& r) { return r.run.dofs; }, "Doubles of state.")
        .def_property_readonly(
            "steps", [](const TakenRun& r) { return r.run.steps; },
            "0 of a reference in continuous time.")
        .def_property_readonly(
            "wall_seconds", [](const TakenRun& r) { return r.run.wall_seconds; },
            "Of the stepping alone [s].")
        .def_property_readonly(
            "processor_seconds",
            [](const TakenRun& r) -> py::object {
                if (std::isnan(r.processor_seconds)) return py::none();
                return py::float_(r.processor_seconds);
            },
            "Processor time of making the scheme and stepping it [s]; None of a reference, which "
            "may have been read back.")
        .def_property_readonly(
            "advice", [](const TakenRun& r) { return python::parsed(r.advice); },
            "How scheme, rate and modes were chosen, a dict; None where they were named.")
        .def_property_readonly(
            "uncertainty", [](const TakenRun& r) { return python::parsed(r.uncertainty); },
            "Of a reference, a dict: taps {tap: {window: relative L2, None where unknown}}, and "
            "`against` and `doubled`, which tell it. None of other runs.")
        .def("to_xarray", &python::to_xarray,
             "xarray.Dataset: a variable per column over `time` [s], each with its units, and the "
             "facts as attributes. Needs xarray.")
        .def("_repr_html_", &python::html_of,
             "The run in a notebook: a picture of each column and the sound of each tap, without "
             "its mean and as loud as possible.");
}

void add_run(py::module_& m) {
    RunClass taken(m, "Run",
                   "What a run produced. run[\"nut\"] is the column of a tap, shape (rows,), in "
                   "units[\"nut\"]: the engine's memory, not a copy, and not to be written.");
    has_no_constructor(taken);
    add_columns(taken);
    add_outcome(taken);
    m.def("run", &python::run_one, py::arg("scene"), py::arg("scheme") = "",
          py::arg("rate") = py::none(), py::arg("modes") = 0, py::arg("duration") = py::none(),
          py::arg("tap_rate") = py::none(), py::arg("energy") = false,
          py::arg("options") = py::dict(), py::kw_only(), py::arg("within") = "",
          py::arg("of") = "", py::arg("tap") = "", py::arg("time_limit") = py::none(),
          "One scheme on one scene. rate [Hz], 44100 where absent, tap_rate [Hz]; duration [s]; "
          "energy=True adds the energy "
          "columns; options {\"compliance\": \"matched\"}. within=\"1%\" chooses scheme, rate and "
          "modes as `jvari run --within`, by the measure `of` of `tap`; so does a run without a "
          "scheme. Raises Refusal, SceneError or UsageError, and TimeoutError after time_limit [s] "
          "of processor.");
    m.def("reference", &python::reference_of, py::arg("scene"), py::arg("reference") = "",
          py::arg("modes") = 0, py::arg("duration") = py::none(), py::arg("tap_rate") = py::none(),
          py::arg("time_limit") = py::none(), py::arg("jobs") = 0,
          "The motion that `compare` measures errors against, with its `uncertainty`. modes 0: "
          "doubled until nothing moves. duration, time_limit [s], tap_rate [Hz].");
    m.def("run_many", &python::run_many, py::arg("scenes"), py::arg("scheme"),
          py::arg("rate") = 44100.0, py::arg("modes") = 0, py::arg("duration") = py::none(),
          py::arg("tap_rate") = py::none(), py::arg("options") = py::dict(), py::arg("jobs") = 0,
          "All scenes, `jobs` at a time (0: one per core). Shape (run, time, tap), in the units of "
          "the taps; NaN after a failure.");
}

void add_studies(py::module_& m) {
    using python::TrimmedRows;
    m.def(
        "compare", &python::compare_rows, py::arg("scene"),
        py::arg("schemes") = std::vector<std::string>(), py::arg("rates") = std::vector<double>(),
        py::arg("modes") = 0, py::arg("reference") = "", py::arg("reference_modes") = 0,
        py::arg("controls") = false, py::arg("duration") = py::none(),
        py::arg("tap_rate") = py::none(), py::arg("options") = py::dict(), py::arg("repeats") = 5,
        py::arg("out") = "", py::arg("jobs") = 0, py::kw_only(), py::arg("cost") = py::dict(),
        py::arg("time_limit") = py::none(),
        "Schemes x modes x rates [Hz] against a reference, as `jvari compare`: modes may be a "
        "number or several, and so may the values of options. A dict per cell, its keys the "
        "columns of cells.csv and the bounds of the errors. None where nothing is known. out: the "
        "folder that gets tables, pictures and report.html, as of `jvari compare --out`. cost: "
        "{scheme: {rate: s per s}} of schemes that are not timed, shown as reported. time_limit: "
        "of each run, of a reference too [s].");
    const py::type list = py::type::of(py::list());
    m.attr("Rows") = py::type::of(list)(
        "Rows", py::make_tuple(list),
        py::dict(py::arg("__doc__") = "The rows of a comparison, which `report` can draw."));
    m.def("report", &python::report_of, py::arg("of"), py::arg("out") = "",
          "Writes tables, pictures and report.html of the rows that compare or judge gave into the "
          "folder `out`: report(rows, \"rep\"). Of a folder alone, page and pictures once more, as "
          "`jvari report`. Returns the files that it wrote.");
    m.def("suite", &python::suite_rows, py::arg("file"), py::arg("out") = "",
          py::arg("resume") = false, py::arg("jobs") = 0,
          "The cells of a suite, a dict each, its maps aside. out: the folder that keeps them, as "
          "`jvari suite --out` does.");
    m.def("suite_tables", &python::suite_tables, py::arg("file"), py::arg("out") = "",
          py::arg("resume") = false, py::arg("jobs") = 0,
          "The tables of a suite by name, each a list of dicts, one per row. \"cells\": the "
          "columns of cells.csv and the bounds of the errors. \"maps\": a row per point, x and y "
          "in the units of x_key and y_key (rate [Hz], duration [s], the scene's in SI), its "
          "outcome and figures: displacement over what the energy allows, energy gained, pull over "
          "the largest contact force, error [1]. \"boundaries\": a row per change of outcome, "
          "between x_low and x_high [the unit of x_key], relative_difference from theory [1]. "
          "out: the folder that keeps cells and points, as `jvari suite --out` does.");
    py::class_<TrimmedRows> trimmed(
        m, "Trimmed", "The cheapest model of a scene within a tolerance, and how it was found.");
    has_no_constructor(trimmed);
    trimmed.def_readonly("found", &TrimmedRows::found, "Whether there is one.")
        .def_readonly("path", &TrimmedRows::path,
                      "A dict per step from the whole scene to the trimmed one, which is the last: "
                      "the columns of path.csv.")
        .def_readonly(
            "needs", &TrimmedRows::needs,
            "A dict per part of the scene, what it is needed for: the columns of needs.csv.")
        .def_readonly("toml", &TrimmedRows::toml,
                      "The trimmed scene as a file; \"\" where there is none.");
    m.def("trim", &python::trim_rows, py::arg("scene"), py::arg("within"),
          py::arg("of") = "l2_50ms", py::arg("tap") = "", py::arg("scheme") = "any",
          py::arg("duration") = py::none(), py::arg("tap_rate") = 44100.0,
          py::arg("reference") = "", py::arg("reference_modes") = 0, py::arg("out") = "",
          py::arg("jobs") = 0,
          "No more than a scene needs, as `jvari trim`: trim(\"tanpura_c3_release\", \"1%\", "
          "scheme=\"modal_two_point\"). duration [s], tap_rate [Hz]; out: the folder that keeps "
          "what was judged.");
}

void add_own_schemes(py::module_& m) {
    m.def("problem", &python::problem_of, py::arg("scene"), py::arg("rate") = 44100.0,
          py::arg("modes") = 0, py::arg("duration") = py::none(), py::arg("tap_rate") = py::none(),
          "The problem that a scheme solves, as NumPy arrays: the members of a file of `jvari "
          "export`, whose shapes, units and equations docs/own-scheme/README.md has. rate, "
          "tap_rate [Hz]; modes 0: every mode below min(20 kHz, rate/2).");
    m.def("judge", &python::judge_rows, py::arg("scene"), py::arg("traces"), py::kw_only(),
          py::arg("name") = "mine", py::arg("cost") = py::none(),
          py::arg("schemes") = std::vector<std::string>(), py::arg("duration") = py::none(),
          py::arg("tap_rate") = py::none(), py::arg("tap") = "", py::arg("reference") = "",
          py::arg("repeats") = 5, py::arg("jobs") = 0,
          "How wrong a trace is that any program made, as `jvari judge`. traces: an array of rows "
          "x taps, a dict of taps by name, or a dict of such by sample rate [Hz]; 44100 where "
          "there is one. cost: computing time per second of sound, a number or by rate, shown as "
          "reported. schemes: run beside it. A dict per cell as compare gives.");
    m.def("scheme", &python::scheme_decorator, py::arg("name"), py::kw_only(),
          py::arg("represents") = std::vector<std::string>(), py::arg("balance") = "none",
          py::arg("source") = "a scheme in Python", py::arg("compiled") = false,
          "A decorator that makes a class a scheme: __init__(self, problem), and advance(self, "
          "rows), which gives rows x taps, or that and rows x 3 energies [J]. represents: features "
          "as `jvari list schemes --json` names them. compiled: its loop is (Numba), and its cost "
          "is compared.");
    m.def("check", &python::check_rows_of, py::arg("scheme"),
          "Whether a scheme keeps what every scheme promises, as `jvari check`: a dict per promise "
          "and scene; `answer` is \"kept\", \"broken\", \"excused\" or \"not asked\".");
}
}  // namespace

PYBIND11_MODULE(jvari, m) {
    m.doc() =
        "Numerical schemes for strings against obstacles, compared by speed and accuracy on the "
        "same scenes. SI units.";
    m.attr("__version__") = bench::store::machine().version;
    translate_exceptions(m);
    py::module_::import("atexit").attr("register")(py::cpp_function(&python::wait_for_calls));
    // A forked child does not have the threads of the parent's calls.
    py::module_::import("os").attr("register_at_fork")(
        py::arg("after_in_child") = py::cpp_function([] { python::calls() = {}; }));
    add_scene(m);
    add_run(m);
    add_studies(m);
    add_own_schemes(m);
    m.def("plugin", &python::add_plugin, py::arg("path"),
          "Loads schemes from a shared object; their names are known from then on.");
    m.def("schemes", &python::scheme_names,
          "Names of schemes and references, plugins' among them.");
    m.def(
        "made_by", [] { return python::parsed(bench::store::indented(bench::store::made_by())); },
        "What results depend on: program, compiler, flags, vector instructions, machine, plugins; "
        "as a manifest begins.");
}
