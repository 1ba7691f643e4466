// jvari check: does a scheme, of this tree or of a plugin, keep what every scheme promises?
#include "bench/check/promise.hpp"

#include <fmt/core.h>

#include "bench/command/console.hpp"
#include "bench/command/verbs.hpp"
#include "bench/compare/catalogue.hpp"
#include "bench/store/fresh_file.hpp"
#include "bench/store/usage.hpp"
#include "schemes/registry.hpp"

namespace jvari::bench::command {

namespace {
struct CheckRequest : Running {
    std::vector<std::string> schemes;  // none: those of the plugins
    std::string junit;
};

int check_command(CheckRequest r) {
    const Console console(r.json, r.quiet);
    const compare::Catalogue catalogue(r.plugins);
    std::vector<const Descriptor*> chosen;
    for (const std::string& name : r.schemes) chosen.push_back(&catalogue.find(name));
    if (chosen.empty())
        for (const Guest* g : guests())
            for (const Descriptor& d : g->schemes) chosen.push_back(&catalogue.find(d.name));
    if (chosen.empty())
        throw store::UsageError(
            "check: expected a scheme, or --plugin LIB.so (see jvari check --help)");
    if (!r.junit.empty()) store::must_be_writable(r.junit);
    std::vector<check::Checked> checked;
    bool broken = false;
    for (const Descriptor* d : chosen) {
        console.print(fmt::format("{}{} ({})", checked.empty() ? "" : "\n", d->name, d->source));
        checked.push_back(
            check::check(*d, console, [&](const check::Checked& c, const check::Promise& p) {
                console.print(check::line_of(c, p));
            }));
        console.print(check::conclusion_of(checked.back()));
        broken = broken || checked.back().broken();
    }
    if (!r.junit.empty()) store::write_fresh(r.junit, check::junit_of(checked));
    console.print_json(check::json_of(checked));
    return broken ? exit_code::run_failed : exit_code::done;
}
}  // namespace

Act check_verb(CLI::App& program) {
    Verb<CheckRequest> v(program, "check",
                         "does a scheme keep what every scheme promises: the contract, and what it "
                         "claims in numbers");
    v.option("schemes", v.r.schemes, {"SCHEME"},
             "schemes or references; absent: those of the plugins");
    v.option("--junit", v.r.junit, {"FILE"},
             "also writes JUnit XML, as continuous integration reads it");
    return v.does(check_command,
                  "Example: jvari check --plugin build/libmy_scheme.so --junit check.xml\n"
                  "\n"
                  "Exit code 4 where a promise is broken.");
}

}  // namespace jvari::bench::command
