#include "bench/study/job.hpp"

#include <fmt/core.h>

#include <nlohmann/json.hpp>
#include <set>

#include "bench/store/checksum.hpp"
#include "scenes/scene_file.hpp"

namespace jvari::bench::study {

namespace {
using Json = nlohmann::ordered_json;

Json settings_json(const Settings& s) {
    return {{"rate", store::text_of(s.sample_rate)},
            {"tap_rate", store::text_of(s.tap_rate)},
            {"modes", s.modes},
            {"options", s.options}};
}

Json references_json(const Point& p) {
    Json references = Json::array();
    for (const ReferenceChoice& c : p.references)
        references.push_back({{"name", c.name()}, {"settings", settings_json(c.settings)}});
    return references;
}
}  // namespace

void address(Plan& plan, const std::string& of_program) {
    const Json program = Json::parse(of_program);
    for (Point& p : plan.points) {
        const Json references = references_json(p);
        const std::string limit = store::text_of(p.time_limit);
        p.hash = scene_hash(p.scene);
        if (p.true_hash.empty()) p.true_hash = p.whole ? scene_hash(*p.whole) : p.hash;
        p.reference_key = p.true_hash + references.dump() + limit;
        if (!p.truth_modes) continue;
        Json modeless = references;
        for (Json& r : modeless) r["settings"].erase("modes");
        p.truth_key = std::to_string(*p.truth_modes) + p.true_hash + modeless.dump() + limit;
    }
    std::set<std::string> seen;
    std::vector<Job> once;
    for (Job& job : plan.jobs) {
        const Point& p = *job.point;
        Json identity{{"program", program},
                      {"scene", p.scene.name},
                      {"scene_hash", p.hash},
                      {"scheme", job.cell.scheme->name},
                      {"settings", settings_json(job.cell.settings)},
                      {"sounds", job.sounds},
                      {"measured", job.measured}};
        if (job.judged) identity["references"] = references_json(p);
        if (job.judged && p.truth_modes) identity["reference_modes"] = *p.truth_modes;
        if (!job.errors.empty()) identity["errors"] = job.errors;
        if (p.whole) identity["part_of"] = p.true_hash;
        if (!p.in_model) identity["in_model"] = false;
        if (p.alone) identity["reference_alone"] = true;
        if (job.repeats > 0) identity["repeats"] = job.repeats;
        if (!std::isinf(p.time_limit)) identity["time_limit_s"] = p.time_limit;
        job.identity = identity.dump();
        job.id = store::hash_of(job.identity);
        if (seen.insert(job.identity).second) once.push_back(std::move(job));
    }
    plan.jobs = std::move(once);
}

std::string what_of(const Job& job) {
    std::string text = job.point->scene.name;
    for (const auto& [key, value] : job.point->swept) text += " " + key + "=" + value;
    text += ": " + store::variant_name(job.cell.scheme->name,
                                       store::options_text(job.cell.settings.options));
    if (job.cell.settings.sample_rate > 0)
        text += fmt::format(" at {} Hz", job.cell.settings.sample_rate);
    return text;
}

}  // namespace jvari::bench::study
