// jvari claims: does what a paper says hold, in a folder of results?
#include <fmt/core.h>

#include <filesystem>

#include "bench/command/console.hpp"
#include "bench/command/text_table.hpp"
#include "bench/command/verbs.hpp"
#include "bench/store/fresh_file.hpp"
#include "bench/store/json.hpp"
#include "bench/suite/claims.hpp"

namespace jvari::bench::command {

namespace {
struct ClaimsRequest : Common {
    std::string folder, suite;
};

std::string number_text(const store::Table& t, std::size_t i) {
    const std::string &value = t.at(i, "measured"), &off = t.at(i, "uncertainty"), &unit = t.at(i, "unit");
    return value + (off.empty() ? "" : " \u00b1 " + off) + (value.empty() || unit.empty() ? "" : " " + unit);
}

std::string claims_text(const store::Table& verdicts) {
    TextTable table{{{"verdict", true}, {"claim", true}, {"measured"}, {"expected", true}, {"place", true, 1}, {"rests on", true, 2}}, {}};
    std::string notes;
    for (std::size_t i = 0; i < verdicts.rows.size(); ++i) {
        const auto at = [&](const char* column) { return verdicts.at(i, column); };
        table.rows.push_back({' ', {at("verdict"), at("claim"), number_text(verdicts, i), at("expected"), at("place"), at("rests_on")}});
        if (!at("note").empty() && at("verdict") != "holds") notes += fmt::format("{}: {}\n", at("claim"), at("note"));
    }
    return table.text(Console::width()) + (notes.empty() ? "" : "\n" + notes) + suite::claims_summary(verdicts);
}

int claims_command(ClaimsRequest r) {
    const Console console(r.json, r.quiet);
    const std::filesystem::path folder = r.folder;
    const auto claims = r.suite.empty() ? suite::claims_on(folder) : suite::read_suite(r.suite).claims;
    if (claims.empty()) throw store::UsageError((r.suite.empty() ? "the suite of " + r.folder : r.suite) + " has no [[claim]]");
    const store::Table verdicts = suite::verdicts_on(claims, folder);
    store::write_fresh(folder / suite::claims_file, store::csv(verdicts));
    console.print(claims_text(verdicts) + "\nwritten: " + (folder / suite::claims_file).string());
    console.print_json(store::indented({{"folder", r.folder}, {"claims", store::rows_json(verdicts)}}));
    return exit_code::done;
}
}  // namespace

Act claims_verb(CLI::App& program) {
    Verb<ClaimsRequest> v(program, "claims", "does what a paper says hold? verdicts from a folder of results");
    v.option("folder", v.r.folder, {"DIR"}, "a folder that suite wrote")->required();
    v.option("--suite", v.r.suite, {"FILE"}, "the claims of this suite; absent: of the one that the folder is of");
    return v.does(
        claims_command,
        "Example: jvari claims results/paper-issanchou\n"
        "\n"
        "A [[claim]] of a suite names a statement, the number in the suite's tables that tells, and its limits:\n"
        "\n"
        "  [[claim]]\n"
        "  says = \"from 4L/5 the precursor is more developed\"\n"
        "  place = \"fig. 4\"\n"
        "  table = \"centroid\"\n"
        "  column = \"centroid_hz\"\n"
        "  along = \"time_s\"\n"
        "  from = 0.2\n"
        "  to = 0.8\n"
        "  take = \"mean\"\n"
        "  where = { \"string.0.initial.position\" = 0.8016 }\n"
        "  over = { where = { \"string.0.initial.position\" = 0.2004 } }     # the ratio of the two\n"
        "  at_least = 1.2\n"
        "\n"
        "The verdict is \"holds\" or \"does not hold\" where the number lies within or beyond the limits by more than its uncertainty,\n"
        "else \"cannot be told\". It is written to DIR/claims.csv; `jvari report DIR` shows it. `jvari list keys` explains every key.");
}

}  // namespace jvari::bench::command
