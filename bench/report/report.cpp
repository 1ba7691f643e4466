#include "bench/report/report.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "bench/compare/bound.hpp"
#include "bench/report/sections/page_sections.hpp"
#include "bench/report/vega.hpp"
#include "bench/store/fresh_file.hpp"

namespace jvari::bench::report {

namespace fs = std::filesystem;

std::vector<Menu> problem_menu(const std::vector<std::string>& problems) {
    if (problems.empty()) return {};
    Menu m{"scene", "problem_field", {}};
    for (const std::string& p : problems) m.choices.emplace_back(json_text(p), p);
    return {m};
}

std::vector<Menu> error_menus(const std::vector<Axis>& axes) {
    Menu measures{"error", "measure_field", {}}, taps{"tap", "tap_field", {}};
    const auto add = [](Menu& m, const std::string& value, const std::string& text) {
        const std::pair choice{json_text(value), text};
        if (std::find(m.choices.begin(), m.choices.end(), choice) == m.choices.end()) m.choices.push_back(choice);
    };
    for (const Axis& a : axes) {
        add(measures, a.measure, a.tap.empty() ? a.title : a.title.substr(0, a.title.rfind(", tap ")));
        add(taps, a.tap, a.tap.empty() ? "headline" : a.tap);
    }
    return {measures, taps};
}

std::vector<std::pair<std::string, std::vector<std::string>>> offers_of(const WorkPrecision& w, const std::vector<std::string>& problems) {
    std::vector<std::pair<std::string, std::vector<std::string>>> offers;
    for (const std::string& problem : problems) {
        const store::Table own = rows_where(w.cells, "problem", problem);
        std::vector<std::string> columns;
        const std::string headline = compare::headline_error(own, store::all_rows(own));
        for (const Axis& a : w.errors)
            for (std::size_t i = 0; i < own.rows.size(); ++i)
                if (std::isfinite(own.number(i, a.column))) {
                    columns.insert(a.column == headline ? columns.begin() : columns.end(), a.column);
                    break;
                }
        offers.emplace_back(problem, columns);
    }
    return offers;
}

std::string twin_file(const std::string& chart, const std::string& problem, const std::vector<std::string>& problems) {
    return chart + (problems.size() > 1 ? "-" + file_part(problem, problems) : "") + ".svg";
}

std::string with_unit(const std::string& key) {
    constexpr std::pair<const char*, const char*> units[] = {{"rate", "Hz"},
                                                             {"stiffness", "N/m^exponent"},
                                                             {"stiffness_density", "N/m^(exponent+1)"},
                                                             {"tension", "N"},
                                                             {"amplitude", "m"},
                                                             {"coefficient", "1/m"},
                                                             {"linear_density", "kg/m"},
                                                             {"bending_stiffness", "N m^2"},
                                                             {"length", "m"},
                                                             {"position", "m"},
                                                             {"height", "m"},
                                                             {"width", "m"},
                                                             {"damping", "kg/s"},
                                                             {"duration", "s"},
                                                             {"contact_loss", "s/m"},
                                                             {"sigma0", "1/s"}};
    const std::string last = key.substr(key.rfind('.') + 1);
    std::string text = key.starts_with("string.0.") ? key.substr(9) : key;
    std::replace(text.begin(), text.end(), '.', ' ');
    for (const auto& [name, unit] : units)
        if (last == name) text += std::string(" [") + unit + "]";
    return text;
}

std::string rate_text(double hz) {
    return std::isnan(hz) ? "" : fmt::format("{:.5g} kHz", hz / 1000);
}

store::Table rows_where(const store::Table& t, const std::string& column, const std::string& text) {
    store::Table rows{t.columns, {}};
    for (std::size_t i = 0; i < t.rows.size(); ++i)
        if (t.at(i, column) == text) rows.rows.push_back(t.rows[i]);
    return rows;
}

store::Table without_names(const store::Table& t) {
    return t.only({t.columns.begin() + 2, t.columns.end()});
}

std::vector<std::string> write_report(const fs::path& folder, const store::Listener& listener) {
    const Results results = read_results(folder);
    store::must_be_writable(folder / "report.html");
    Page page;
    page.title = results.name;
    page.about = results.source + (results.source.empty() ? "" : " \u2014 ") + results.about;
    page.manifest = results.manifest;
    page.command = results.command;
    page.verdicts = verdicts_of(results);
    page.finding = results.maps.rows.empty() ? finding_of_trim(results) : finding_of_maps(results);
    page.sections = {path_section(results),       needs_section(results),       work_precision_section(results), sweep_section(results),
                     dispersion_section(results), convergence_section(results), cost_section(results),           overview_section(results),
                     map_section(results),        spectrogram_section(results), waveform_section(results)};

    std::vector<std::string> written, own;
    const Vega vega = find_vega();
    page.missing = vega.missing;
    if (vega.missing.empty()) page.scripts = vega_scripts(vega).value_or("");
    else listener.note(vega.missing);
    std::vector<std::string> specs;
    for (const Section& s : page.sections)
        for (const Chart& c : s.charts)
            for (const Twin& t : c.twins) {
                own.push_back(t.file);
                specs.push_back(t.spec);
            }
    if (vega.missing.empty()) {
        std::string why;
        const auto svgs = svgs_of(vega, specs, why);
        for (std::size_t k = 0; k < svgs.size(); ++k) {
            if (!svgs[k]) continue;
            store::write_fresh(folder / own[k], *svgs[k]);
            written.push_back(own[k]);
        }
        if (!why.empty()) listener.note(why);
    }
    page.sections.push_back(picture_section(results, own));
    page.sections.push_back(cell_section(results));
    store::write_fresh(folder / "report.html", fitting_page_of(std::move(page)));
    written.emplace_back("report.html");
    return written;
}

}  // namespace jvari::bench::report
