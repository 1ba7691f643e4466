#include "bench/report/report.hpp"

#include <utility>

#include "bench/report/page_sections.hpp"
#include "bench/report/vega.hpp"
#include "bench/store/fresh_file.hpp"

namespace jvari::bench::report {

namespace fs = std::filesystem;

std::vector<Menu> problem_menu(const std::vector<std::string>& problems) {
    if (problems.size() < 2) return {};
    Menu m{"scene", "problem_field", {}};
    for (const std::string& p : problems) m.choices.emplace_back(json_text(p), p);
    return {m};
}

std::string twin_file(const std::string& chart, const std::string& problem, const std::vector<std::string>& problems) {
    return chart + (problems.size() > 1 ? "-" + file_part(problem, problems) : "") + ".svg";
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
    page.sections = {path_section(results),       needs_section(results),       work_precision_section(results),
                     dispersion_section(results), convergence_section(results), cost_section(results),
                     map_section(results),        spectrogram_section(results), waveform_section(results)};

    std::vector<std::string> written, own;
    const Vega vega = find_vega();
    page.missing = vega.missing;
    if (vega.missing.empty()) page.scripts = vega_scripts(vega).value_or("");
    else listener.note(vega.missing);
    for (const Section& s : page.sections)
        for (const Chart& c : s.charts)
            for (const Twin& t : c.twins) {
                own.push_back(t.file);
                if (!vega.missing.empty()) continue;
                std::string why;
                const auto svg = svg_of(vega, t.spec, why);
                if (svg) store::write_fresh(folder / t.file, *svg);
                else listener.note(t.file + ": " + why);
                if (svg) written.push_back(t.file);
            }
    page.sections.push_back(picture_section(results, own));
    page.sections.push_back(cell_section(results));
    store::write_fresh(folder / "report.html", fitting_page_of(std::move(page)));
    written.emplace_back("report.html");
    return written;
}

}  // namespace jvari::bench::report
