#include "schemes/driver/pairings.hpp"

#include <iterator>
#include <list>

#include "schemes/contact/compliance.hpp"

namespace jvari {

namespace {
struct RuleColumn {
    const char *name, *source;
    bool conserves, own_only;
    std::span<const Option> options;
    std::span<const Approximation> approximates;
    Features leaves_out;
};
#define JVARI_ROW(name, Rule, source) \
    {#name,                           \
     source,                          \
     Rule::conserves,                 \
     OwnOnly<Rule>,                   \
     options_of<Rule>(),              \
     approximations_of<Rule>(),       \
     left_out_by<Rule>()},
const RuleColumn columns[] = {JVARI_RULES(JVARI_ROW)};
#undef JVARI_ROW

const std::vector<const StringRow*>& rows() {
#define JVARI_STRING(name) &name,
    static const std::vector<const StringRow*> all = {
#include "schemes/driver/strings.def"
    };
#undef JVARI_STRING
    return all;
}

const StringRow::Known* known_cell(const StringRow& row, const RuleColumn& column) {
    for (const StringRow::Known& k : row.known)
        if (k.rule && std::string(k.rule) == column.name) return &k;
    return nullptr;
}
std::string new_name(const StringRow& row, const RuleColumn& column) {
    return std::string(row.scheme->name) + "_" + column.name;
}
template <class T>
std::span<const T> both(std::span<const T> one, std::span<const T> other) {  // kept for good
    static std::list<std::vector<T>> kept;
    if (other.empty()) return one;
    kept.emplace_back(one.begin(), one.end());
    kept.back().insert(kept.back().end(), other.begin(), other.end());
    return kept.back();
}
// without compliance=matched, kept for good
std::span<const Option> own_only(std::span<const Option> options) {
    static std::list<std::vector<Option>> kept;
    kept.emplace_back(options.begin(), options.end());
    std::erase_if(kept.back(),
                  [](const Option& o) { return std::string(o.name) == compliance_option.name; });
    return kept.back();
}
}  // namespace

std::vector<Pairing> pairings() {
    std::vector<Pairing> all;
    for (const StringRow* row : rows()) {
        all.push_back({row->scheme->name, "gradient", row->scheme->name, ""});
        for (const RuleColumn& column : columns) {
            const StringRow::Known* known = known_cell(*row, column);
            all.push_back({row->scheme->name, column.name,
                           known ? known->scheme->name : new_name(*row, column),
                           known ? known->options : ""});
        }
    }
    return all;
}

const std::vector<Descriptor>& schemes_of_pairings() {
    static std::list<std::string> names;
    static const std::vector<Descriptor> all = [] {
        std::vector<Descriptor> paired;
        for (const StringRow* row : rows())
            for (std::size_t c = 0; c < std::size(columns); ++c) {
                if (known_cell(*row, columns[c])) continue;
                Descriptor d = *row->scheme;
                d.name = names.emplace_back(new_name(*row, columns[c])).c_str();
                d.source = columns[c].source;
                d.represents = d.represents - Feature::moving_body - Feature::clipped_loss -
                               columns[c].leaves_out;
                d.options =
                    both(columns[c].own_only ? own_only(d.options) : d.options, columns[c].options);
                d.approximates = both(d.approximates, columns[c].approximates);
                d.balance = columns[c].conserves ? Balance::exact : Balance::none;
                d.make = row->makers[c];
                d.stand_in_rank = 0;
                paired.push_back(d);
            }
        return paired;
    }();
    return all;
}

}  // namespace jvari
