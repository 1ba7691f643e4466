#include "bench/compare/record/findings.hpp"

#include <fmt/core.h>
#include <algorithm>
#include <nlohmann/json.hpp>

#include "bench/compare/bound.hpp"
#include "bench/compare/scene_notes.hpp"
#include "bench/store/encoding.hpp"
#include "bench/store/json.hpp"
#include "bench/store/machine.hpp"
#include "scenes/scene_file.hpp"
#include "scenes/wording.hpp"

namespace jvari::bench::compare {

namespace {
using Json = nlohmann::ordered_json;

// Appends without a search. operator[] of an ordered object compares a new key with all keys
// before. With ten thousand taps this takes a third of the processor time in a short comparison.
void append(Json& object, std::string new_key, double value) {
    object.get_ref<Json::object_t&>().emplace_back(std::move(new_key), value);
}

Json certificate_json(const Comparison& c) {
    const study::Trust& t = c.against.trust;
    if (!t.any()) return {{"missing", t.missing}};
    Json figures = Json::object();
    for (std::size_t w = 0; w < study::Trust::columns.size(); ++w) {
        figures[study::Trust::columns[w]] = t.of_scene(c.headline.nut, w);
        for (std::size_t tap = 0; tap < c.scene().taps.size(); ++tap)
            append(figures, study::Trust::columns[w] + ("_" + c.scene().taps[tap].name),
                   t.of_scene(tap, w));
    }
    Json j{{"against", t.against}};
    if (!t.missing.empty()) j["missing"] = t.missing;  // the figures then come from the doublings
    if (!t.doubled.empty()) j["doubled"] = t.doubled;
    if (!t.file.empty()) j["file"] = std::filesystem::path(t.file).filename().string();
    if (!t.key.empty()) j["key"] = t.key, j["of_this_program"] = t.of_this_program;
    j["figures"] = figures;
    return j;
}
}  // namespace

study::Cells cells_of(const Comparison& c) {
    return with_front(study::cells_of(c.plan, c.outcome.records));
}

Json json_of(const Advice& a, const Verdict& v) {
    Json j = json_of(a);
    j["says"] = v.says == Verdict::Says::confirmed ? "held"
                : v.says == Verdict::Says::refuted ? "not_held"
                                                   : "not_known";
    j["error"] = v.bound.error, j["certificate"] = v.bound.certificate;
    j["verdict"] = v.text;
    return j;
}

namespace {
Json schemes_json(const study::Plan& plan) {
    Json schemes = Json::array();
    for (const study::Job& job : plan.jobs) {
        Json options = Json::object();
        for (const auto& [name, value] : job.cell.settings.options) options[name] = value;
        Json form{{"name", job.cell.scheme->name},
                  {"source", job.cell.scheme->source},
                  {"options", options}};
        if (std::find(schemes.begin(), schemes.end(), form) == schemes.end())
            schemes.push_back(std::move(form));
    }
    return schemes;
}
}  // namespace

Json manifest_of(const Comparison& c, const CompareRequest& r) {
    const study::Cells cells = cells_of(c);
    const std::size_t error = headline_error(cells, study::all_rows(cells));
    Json facts = Json::object(), floor = Json::object(), taps = Json::array();
    for (const Fact& f : c.reference_summary.facts) facts[f.name] = f.value;
    facts[facts::smallest_contact_force.name] = c.reference_summary.smallest_contact_force;
    facts[facts::largest_contact_force.name] = c.reference_summary.largest_contact_force;
    facts[facts::deepest_penetration.name] = c.reference_summary.deepest_penetration;
    for (std::size_t k = 0; k < study::measures().size(); ++k)
        floor[study::measures()[k].column] =
            c.against.floor[c.headline.tap(study::measures()[k])][k];
    for (std::size_t tap = 0; tap < c.scene().taps.size(); ++tap) {
        taps.push_back({{"name", c.scene().taps[tap].name},
                        {"quantity", name_of(c.scene().taps[tap].quantity)}});
        for (std::size_t k = 0; k < study::measures().size(); ++k)
            append(floor, study::measures()[k].column + "_" + c.scene().taps[tap].name,
                   c.against.floor[tap][k]);
    }
    Json reference{{"name", c.reference.name()},
                   {"source", c.reference.scheme->source},
                   {"rate", c.reference_summary.rate},
                   {"modes", c.reference_summary.modes},
                   {"status", name_of(c.reference_summary.status.outcome)},
                   {"valid_until_s", c.reference_summary.duration},
                   {"note", c.reference.note},
                   {"doubling", c.against.doubling},
                   {"horizon_of_half_s", c.horizon},
                   {"horizon_of_1e-12_s", study::horizon_of(c.against.floor, c.headline)},
                   {"certificate", certificate_json(c)},
                   {"facts", facts}};
    Json tap_rates = Json::array();
    for (const study::Point& p : c.plan.points)
        tap_rates.push_back(p.references.front().settings.tap_rate);
    Json tunings = Json::array();
    for (const String& string : c.scene().strings) tunings.push_back(tuning_text(string));
    const Json scene{{"name", c.scene().name},
                     {"asked_as", r.scene},
                     {"set", r.set},
                     {"source", c.scene().source},
                     {"hash", scene_hash(c.scene())},
                     {"duration", c.scene().duration},
                     {"strings", tunings},
                     {"taps", taps},
                     {"text", write_scene(c.scene())}};
    Json manifest = store::made_by();
    manifest.update({{"scene", scene},
                     {"tap_rate", c.reference.settings.tap_rate},
                     {"tap_rates", tap_rates},  // for each kind of rows; tap_rate is the first
                     {"schemes", schemes_json(c.plan)},
                     {"reference", reference},
                     {"headline",
                      {{"nut", c.scene().taps.at(c.headline.nut).name},
                       {"bridge", c.scene().taps.at(c.headline.bridge).name},
                       {"error", study::measures()[error].column}}},
                     {"noise_floor", floor},
                     {"controls", r.controls}});
    if (c.advice) manifest["advice"] = json_of(*c.advice, verdict_on(*c.advice, cells));
    return manifest;
}

// ---- Sounds of a comparison

namespace {
constexpr std::size_t most_samples = 12'000'000;  // 24 MB of files

// True if the cell has the lowest or highest rate for its scheme and options.
bool at_an_end(const Comparison& c, const study::Cell& cell) {
    bool lowest = true, highest = true;
    for (const study::Record& r : c.outcome.records) {
        const study::Cell& other = r.cell;
        if (other.scheme != cell.scheme || other.settings.options != cell.settings.options ||
            other.sound.samples.empty())
            continue;
        lowest = lowest && cell.settings.sample_rate <= other.settings.sample_rate;
        highest = highest && cell.settings.sample_rate >= other.settings.sample_rate;
    }
    return lowest || highest;
}

std::string file_of(const study::Cell& cell) {  // "modal_two_point-compliance=matched-88200-133"
    std::string name =
        store::variant_name(cell.scheme->name, store::options_text(cell.settings.options));
    std::ranges::replace(name, ' ', '-');
    if (!unfit_as_file(name).empty())
        // a plugin's option may be a path
        name = fmt::format("{}-{}", cell.scheme->name, store::hash_of(name));
    if (cell.settings.sample_rate > 0) name += fmt::format("-{}", cell.settings.sample_rate);
    return fmt::format("{}-{}", name, cell.modes());
}
}  // namespace

void write_sounds(const Comparison& c, const std::filesystem::path& folder) {
    const Tap& tap = c.scene().taps.at(c.headline.nut);
    std::size_t samples = 0;
    for (const study::Record& r : c.outcome.records) samples += r.cell.sound.samples.size();
    std::vector<store::NamedSound> sounds;
    const bool compared = !c.reference_sound.samples.empty();
    if (compared)
        sounds.push_back({{"reference", "", "", ""},
                          "reference",
                          tap.name,
                          name_of(tap.quantity),
                          &c.reference_sound,
                          ""});
    for (const study::Record& r : c.outcome.records) {
        const study::Cell& cell = r.cell;
        if (cell.sound.samples.empty() || (samples > most_samples && !at_an_end(c, cell))) continue;
        const double rate =
            cell.scheme->clock == Clock::continuous ? nan : cell.settings.sample_rate;
        sounds.push_back(
            {{cell.scheme->name, store::options_text(cell.settings.options), rate, cell.modes()},
             file_of(cell),
             tap.name,
             name_of(tap.quantity),
             &cell.sound,
             compared && cell.sound.rate == c.reference_sound.rate ? "reference" : ""});
    }
    if (!sounds.empty())
        store::write_sounds(folder, {"scheme", "options", "rate", "modes"}, sounds);
}

}  // namespace jvari::bench::compare
