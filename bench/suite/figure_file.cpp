#include "bench/suite/figure_file.hpp"

#include <algorithm>

#include "bench/suite/facet.hpp"

namespace jvari::bench::suite {

namespace {
using store::key;
using store::needed;

store::Kind<FigureAxis> axis() {
    static const auto titled = [](FigureAxis& a, const store::Entry& e) {
        if (!e.at("title")) a.title = a.column;
    };
    const auto table =
        store::table(std::vector{needed("column", &FigureAxis::column, store::text(), "of the table"),
                                 key("to", &FigureAxis::to, store::text(), "the column of a band's upper edge"),
                                 key("title", &FigureAxis::title, store::text(), "beside the axis", "the column's name"),
                                 key("factor", &FigureAxis::factor, store::number(), "from the column's unit to the title's"),
                                 key("log", &FigureAxis::log, store::yes_or_no(), "a logarithmic scale"),
                                 key("domain", &FigureAxis::domain, store::from_to(store::number()), "what is shown", "all")},
                     +titled);
    return {"a column's name, or a table",
            [read = table.read](const store::Entry& e) {
                if (!e.is_text()) return read(e);
                FigureAxis a;
                a.column = a.title = e.text();
                return a;
            },
            table.below};
}

std::vector<std::string> tables_to_draw() {
    std::vector<std::string> all{"cells"};
    for (const Facet& f : facets())
        if (f.rows && !f.write) all.emplace_back(f.name);
    return all;
}

std::string field_text(const store::Entry& e) {  // as it stands in a csv file
    return e.is_text() ? e.text() : number_text(store::number().read(e));
}

using Where = std::pair<std::string, std::vector<std::string>>;
using Label = std::pair<std::string, std::string>;

std::vector<store::Key<Figure>> figure_keys() {
    const auto where = store::by_name<Where>("a table: column = values", [](const std::string& column, const store::Entry& e) {
        Where w{column, {}};
        for (const store::Entry& one : e.items()) w.second.push_back(field_text(one));
        return w;
    });
    const auto labels = store::by_name<Label>("a table: name = text", [](const std::string& name, const store::Entry& e) {
        return Label{name, e.text()};
    });
    const auto kinds = store::one_of<FigureKind>("kind", {{"lines", FigureKind::lines},
                                                          {"points", FigureKind::points},
                                                          {"band", FigureKind::band},
                                                          {"spectrogram", FigureKind::spectrogram}});
    return {
        needed("name", &Figure::name, store::name_of_file(), "the file is `figure-NAME.svg`"),
        needed("title", &Figure::title, store::text(), "above it"),
        key("paper", &Figure::paper, store::text(), "the paper's figure, under the title"),
        key("statement", &Figure::statement, store::text(), "what the paper says of it, under the title"),
        needed("kind", &Figure::kind, kinds, "points are lines with marks; a band lies between `y.column` and `y.to`"),
        key("table", &Figure::table, store::word("table", tables_to_draw()),
            "what is drawn; a spectrogram is drawn of the cells that measure one"),
        key("x", &Figure::x, axis(), "of a spectrogram none"),
        key("y", &Figure::y, axis(), "of a spectrogram none"),
        key("colour", &Figure::colour, store::several(store::text()),
            "columns whose fields, joined by a comma, name a line. Of a spectrogram they go across", "one line"),
        key("panels", &Figure::panels, store::several(store::text()), "columns that name a panel. Of a spectrogram they go down",
            "one panel"),
        key("across", &Figure::across, store::whole(1, 20), "panels in a row"),
        key("free", &Figure::free, store::yes_or_no(), "each panel has its own scales"),
        key("width", &Figure::width, store::whole(1, 4000), "of a panel [px]"),
        key("height", &Figure::height, store::whole(1, 4000), "of a panel [px]"),
        key("beside", &Figure::beside, store::text(), "the name of another figure, which stands at its right in the same picture", "alone"),
        key("where", &Figure::where, where, "rows with one of these values", "all"),
        key("labels", &Figure::labels, labels, "what is written in place of a name")};
}

void fit_the_kind(Figure& f, const store::Entry& e) {
    const char* drawn_from[] = {"table", "x", "y"};
    for (const char* name : drawn_from)
        if (f.kind != FigureKind::spectrogram) e.need(name);
        else if (const auto x = e.at(name)) x->refuse("nothing: a spectrogram is drawn from the cells that measure it");
    if (f.kind != FigureKind::spectrogram && (f.kind == FigureKind::band) == f.y.to.empty())
        e.need("y").refuse(f.kind == FigureKind::band ? "{ column = LOW, to = HIGH }" : "no column `to`: only a band has one");
}
}  // namespace

store::Kind<std::vector<Figure>> figures() {
    auto all = store::tables("figure", store::table(figure_keys(), fit_the_kind));
    all.read = [read = all.read](const store::Entry& e) {
        std::vector<Figure> figures = read(e);
        std::size_t k = 0;
        for (const store::Entry& one : e.items()) {
            const std::string& beside = figures[k++].beside;
            const auto right = std::ranges::find(figures, beside, &Figure::name);
            if (beside.empty()) continue;
            if (right == figures.end() || !right->beside.empty() || right->kind == FigureKind::spectrogram)
                one.need("beside").refuse("the name of a figure of this file, no spectrogram, with nothing beside it");
        }
        return figures;
    };
    return all;
}

}  // namespace jvari::bench::suite
