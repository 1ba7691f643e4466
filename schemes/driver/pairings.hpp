// The table of pairings: a row for each string, a column for each obstacle rule, a scheme in each
// cell. The schemes of the first column, by the discrete gradient, and some others have names that
// the field knows, and are in schemes.def. All others are made here, named STRING_RULE, and are
// found by their name alone: no comparison runs them unasked.
#pragma once

#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include "schemes/contact/rules.hpp"
#include "schemes/scheme.hpp"

namespace jvari {

using MakeScheme = std::unique_ptr<Scheme> (*)(const Descriptor&, const Scene&, const Settings&);

#define JVARI_ROW(name, Rule, source) 1,
constexpr int rules_counted[] = {JVARI_RULES(JVARI_ROW)}, rule_count = std::size(rules_counted);
#undef JVARI_ROW

struct StringRow {
    const Descriptor* scheme;  // by the discrete gradient
    // by each other rule: {JVARI_RULES(JVARI_MAKER)} for a template made<Rule>
    MakeScheme makers[rule_count];
    struct Known {
        const char* rule;
        const Descriptor* scheme;
        const char* options = "";
    };
    Known known[rule_count] = {};  // cells that already have a name
};
#define JVARI_MAKER(name, Rule, source) make<Rule>,
#define JVARI_STRING(name) extern const StringRow name;
#include "schemes/driver/strings.def"
#undef JVARI_STRING

struct Pairing {
    // options: the scheme's options that select this pairing
    std::string string, rule, scheme, options;
};
// all cells, row by row, the discrete gradient first
std::vector<Pairing> pairings();
const std::vector<Descriptor>& schemes_of_pairings();  // the pairings made here

}  // namespace jvari
