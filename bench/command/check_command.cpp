// jvari check: does a scheme, of this tree or of a plugin, keep what every scheme promises?
#include "bench/check/check.hpp"
#include "bench/command/commands.hpp"
#include "bench/command/console.hpp"
#include "bench/compare/catalogue.hpp"
#include "bench/store/fresh_file.hpp"
#include "bench/store/usage.hpp"
#include "schemes/registry.hpp"

namespace jvari::bench::command {

int check_command(const CheckRequest& r) {
    const Console console(r.json, r.quiet);
    const compare::Catalogue catalogue(r.plugins);
    std::vector<const Descriptor*> asked;
    for (const std::string& name : r.schemes) asked.push_back(&catalogue.find(name));
    if (asked.empty())
        for (const LoadedPlugin& l : loaded_plugins())
            for (const Descriptor& d : l.plugin->schemes()) asked.push_back(&catalogue.find(d.name));
    if (asked.empty()) throw store::UsageError("check: expected a scheme, or --plugin LIB.so (see jvari check --help)");
    if (!r.junit.empty()) store::must_be_writable(r.junit);
    std::vector<check::Checked> checked;
    bool broken = false;
    for (const Descriptor* d : asked) {
        checked.push_back(check::check(*d, console));
        console.print((checked.size() > 1 ? "\n" : "") + check::text_of(checked.back()));
        broken = broken || checked.back().broken();
    }
    if (!r.junit.empty()) store::write_fresh(r.junit, check::junit_of(checked));
    console.print_json(check::json_of(checked));
    return broken ? exit_code::run_failed : exit_code::done;
}

}  // namespace jvari::bench::command
