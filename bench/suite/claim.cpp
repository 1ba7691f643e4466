#include "bench/suite/claim.hpp"

namespace jvari::bench::suite {

namespace {
using store::key;
using store::needed;

struct Expected {
    double value, tolerance;
};

Where rows_that(Where where, const store::Entry& e) {  // with what `e` says in place of what was said before
    for (const auto& [column, value] : e.members()) {
        std::erase_if(where, [&name = column](const auto& w) { return w.first == name; });
        where.emplace_back(column, value.option_text());
    }
    return where;
}

store::Kind<const Take*> take() {
    std::vector<std::pair<std::string, const Take*>> words;
    for (const Take& t : takes()) words.emplace_back(t.name, &t);
    return store::one_of("take", std::move(words));
}

std::vector<store::Key<Pick>> pick_keys() {
    return {key("table", &Pick::table, store::name_of_file(), "a table of the folder: errors, cost, trace, centroid, ...", ""),
            key("column", &Pick::column, store::text(), "what is measured", ""),
            key("along", &Pick::along, store::text(), "the column that orders the rows", "none"),
            key("from", &Pick::from, store::number(), "of `along`", "its first"),
            key("to", &Pick::to, store::number(), "of `along`", "its last"),
            key("take", &Pick::take, take(), "the one number of these rows", "value"),
            {{"where", "a table: column = value", "all rows", "the rows that carry these values; \"\" where the field is empty"},
             [](Pick& q, const store::Entry& e) { q.where = rows_that(q.where, e); }}};
}

// A quantity that differs from the claim's first one in what it says.
store::Key<Claim> other(const char* name, std::optional<Pick> Claim::*member, const char* meaning) {
    return {{name, "a table", "none", meaning}, [member](Claim& c, const store::Entry& e) {
                Pick& pick = (c.*member).emplace(c.measured.value_or(Pick()));
                read_keys(e, pick_keys(), pick);
                if (const auto where = e.at("where")) pick.own = rows_that({}, *where);
            }};
}

store::Key<Claim> each_of_these() {
    return {{"each", "tables: column = value", "none", "holds if it holds of the rows that carry these values too, set by set"},
            [](Claim& c, const store::Entry& e) {
                c.each.clear();
                for (const store::Entry& one : e.items()) c.each.push_back(rows_that({}, one));
            }};
}

store::Key<Claim> expected() {
    return {{"expected", "[number, tolerance]", "none", "at_least and at_most in one: the number, and how far it may be off"},
            [](Claim& c, const store::Entry& e) {
                const auto both = e.items();
                if (both.size() != 2 || !both[0].number() || !(both[1].number() > 0.0)) e.refuse("[number, tolerance > 0]");
                c.least = *both[0].number() - *both[1].number();
                c.most = *both[0].number() + *both[1].number();
            }};
}

// The keys in the order in which they are read: other quantities begin as the first one.
std::vector<store::Key<Claim>> claim_keys() {
    std::vector<store::Key<Claim>> keys{needed("says", &Claim::says, store::text(), "the statement, quoted or in short"),
                                        key("place", &Claim::place, store::text(), "where it stands: a figure, a section", "none")};
    for (const store::Key<Pick>& k : pick_keys())
        keys.push_back(
            {k.words, [read = k.read](Claim& c, const store::Entry& e) { read(c.measured ? *c.measured : c.measured.emplace(), e); }});
    keys.insert(keys.end(),
                {other("against", &Claim::against, "other rows, that these are taken less, row by row along `along`"),
                 other("minus", &Claim::minus, "another number, that this is taken less"),
                 other("over", &Claim::over, "another number, that this is divided by"), each_of_these(), expected(),
                 key("at_least", &Claim::least, store::number(), "of the number, if the claim holds", "no limit"),
                 key("at_most", &Claim::most, store::number(), "of the number, if the claim holds", "no limit"),
                 key("uncertainty", &Claim::uncertainty, store::not_negative(), "of the number, beside what the tables say of theirs"),
                 key("unit", &Claim::unit, store::text(), "of the number", "none"),
                 key("open", &Claim::open, store::text(), "why it cannot be told, whatever is measured", "none"),
                 key("note", &Claim::note, store::text(), "a remark beside the verdict", "none")});
    return keys;
}

void hold_together(Claim& c, const store::Entry& e) {
    if (!c.measured) {
        if (c.open.empty()) e.fail("it measures nothing: expected a table and a column, or `open`, why it cannot be told");
        return;
    }
    for (const char* name : {"table", "column"})
        if (!e.at(name)) e.fail(std::string("the key ") + name + " is missing");
    if (std::isinf(c.least) && std::isinf(c.most) && c.open.empty()) e.fail("no limit: expected at_least, at_most or expected");
    if (!(c.least <= c.most)) e.fail("at_least is above at_most");
}
}  // namespace

store::Kind<std::vector<Claim>> claims() {
    return store::tables("claim", store::table(claim_keys(), hold_together));
}

}  // namespace jvari::bench::suite
