// Module functions for users' own schemes: problem, judge, check, and registering a class to be a
// scheme.
#pragma once

#include "bench/check/promise.hpp"
#include "bench/compare/compare_plan.hpp"
#include "bench/judge/judge.hpp"
#include "bench/store/encoding.hpp"
#include "python/calls.hpp"
#include "python/own_schemes.hpp"

namespace jvari::python {

inline void add_to_plugins(const std::string& guest) {
    if (std::ranges::find(all_plugins(), guest) == all_plugins().end())
        all_plugins().push_back(guest);
}

inline double tap_rate_of(const std::vector<double>& rates, std::optional<double> wanted) {
    compare::CompareRequest r;
    r.tap_rate = wanted;
    return compare::tap_rate_for(r, rates);
}

inline py::object problem_of(const py::object& of, double rate, int modes,
                             std::optional<double> duration, std::optional<double> tap_rate) {
    Scene scene = NamedScene::of(of).scene;
    if (duration) scene.duration = *duration;
    refuse_beyond_arrays(scene);
    return namespace_of(
        Problem(scene, {rate, tap_rate_of({rate}, tap_rate), at_least(0, modes, "modes"), {}})
            .arrays());
}

// Decorator jvari.scheme("mine", ...): takes the class, registers it and returns it unchanged.
inline py::object scheme_decorator(const std::string& name,
                                   const std::vector<std::string>& represents,
                                   const std::string& balance, const std::string& source,
                                   bool compiled) {
    return py::cpp_function([=](const py::object& python_class) {
        const std::string path = "scheme " + name;
        if (!find_guest(path))
            for (const std::string& known : scheme_names())
                if (known == name)
                    throw store::UsageError("scheme \"" + name +
                                            "\": there is a scheme of the name already");
        add_to_plugins(add_class(python_class, name, represents, balance, source, compiled));
        return python_class;
    });
}

inline py::list check_rows_of(const std::string& scheme) {
    const compare::Catalogue catalogue(plugins());
    const Descriptor& d = catalogue.find(scheme);
    const check::Checked checked = unlocked([&] { return check::check(d, {}, PythonListener()); });
    py::list rows;
    for (const check::Answered& a : checked.answers) {
        py::dict row;
        row["promise"] = a.promise->name, row["sentence"] = a.promise->sentence,
        row["scene"] = a.scene;
        row["answer"] = check::name_of(a.verdict.answer), row["why"] = a.verdict.why;
        rows.append(row);
    }
    return rows;
}

// Reads a trace: rows x taps, or only rows for a single tap; or {tap: rows}, ignoring further
// names.
inline Trace trace_of(const py::object& given, const Scene& scene, double tap_rate, double rate) {
    const std::string what = "trace at " + store::text_of(rate) + " Hz";
    std::vector<Numbers> columns;
    for (std::size_t k = 0; k < scene.taps.size(); ++k) {
        const py::str name(scene.taps[k].name);
        if (py::isinstance<py::dict>(given)) {
            if (!given.contains(name))
                throw store::UsageError(what + ": tap " + scene.taps[k].name + " is missing");
            columns.push_back(numbers_of(given[name], what));
        } else {
            const auto all = numbers_of(given, what);
            const bool single = all.ndim() == 1 && scene.taps.size() == 1;
            if (!single &&
                (all.ndim() != 2 || all.shape(1) != static_cast<py::ssize_t>(scene.taps.size())))
                throw store::UsageError(what + ": expected rows x " +
                                        std::to_string(scene.taps.size()) +
                                        " taps, or a dict of taps by name");
            columns.push_back(
                single ? all
                       : numbers_of(all[py::make_tuple(py::slice(0, all.shape(0), 1), py::int_(k))],
                                    what));
        }
        if (columns.back().ndim() != 1 || columns.back().size() != columns.front().size())
            throw store::UsageError(what + ": tap " + scene.taps[k].name +
                                    " has another number of rows than the first");
    }
    Trace t;
    t.tap_rate = tap_rate;
    t.rows = t.stride = columns.empty() ? 0 : static_cast<long>(columns.front().size());
    for (std::size_t k = 0; k < columns.size(); ++k) {
        t.names.push_back(scene.taps[k].name);
        t.tap.insert(t.tap.end(), columns[k].data(), columns[k].data() + columns[k].size());
    }
    return t;
}

inline py::object judge_rows(const py::object& scene, const py::object& traces,
                             const std::string& name, const py::object& cost,
                             const std::vector<std::string>& schemes,
                             std::optional<double> duration, std::optional<double> tap_rate,
                             const std::string& tap, const std::string& reference, int repeats,
                             int jobs) {
    const NamedScene s = NamedScene::of(scene);
    compare::CompareRequest r;
    r.scene = s.name, r.set = s.set, r.schemes = schemes, r.reference = reference,
    r.duration = duration, r.tap_rate = tap_rate, r.tap = tap;
    r.repeats = at_least(1, repeats, "repeats"), r.jobs = at_least(0, jobs, "jobs");
    py::dict by_rate;
    const bool rates = py::isinstance<py::dict>(traces) && py::len(traces) > 0 &&
                       !py::isinstance<py::str>(py::list(traces)[0]);
    if (rates) by_rate = traces;
    else by_rate[py::float_(44100.0)] = traces;
    for (const auto& [rate, trace] : by_rate) r.rates.push_back(rate.cast<double>());
    const Scene judged = compare::load_scene(r);
    const judge::Rows rows = judge::rows_for(r, judged);
    judge::Candidate c;
    c.name = name;
    struct Lent {  // the candidate lives until the process ends, but the traces are freed here
        std::vector<std::shared_ptr<Trace>> traces;
        ~Lent() {
            for (const auto& t : traces) *t = {};
        }
    } lent;
    for (const auto& [rate, given] : by_rate) {
        const double hz = rate.cast<double>();
        Trace t = trace_of(py::reinterpret_borrow<py::object>(given), judged, rows.rate, hz);
        judge::must_be_whole(t, "trace at " + store::text_of(hz) + " Hz", rows.count);
        c.contents.append(reinterpret_cast<const char*>(t.tap.data()),
                          t.tap.size() * sizeof(double));
        c.traces.emplace(hz, lent.traces.emplace_back(std::make_shared<Trace>(std::move(t))));
        if (cost.is_none()) continue;
        c.costs[hz] = py::isinstance<py::dict>(cost)
                          ? cost[py::reinterpret_borrow<py::object>(rate)].cast<double>()
                          : cost.cast<double>();
    }
    c.contents = store::hash_of(c.contents);
    std::vector<std::string> others = plugins();
    std::erase(others, "trace " + name);
    return compared(r, [&](study::Kept& keep) {
        return judge::judge(std::move(c), r, others, PythonListener(), keep);
    });
}

}  // namespace jvari::python
