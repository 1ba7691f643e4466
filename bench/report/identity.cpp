#include "bench/report/identity.hpp"

#include <algorithm>
#include <array>
#include <string_view>

#include "reference/references.hpp"
#include "schemes/controls.hpp"
#include "schemes/registry.hpp"

namespace jvari::bench::report {

namespace {
constexpr Family all_families[] = {{"two-point", "modal_two_point", "#0d44e1", "#3799e1"},
                                   {"quadratised", "modal_quadratised", "#480588", "#9a38f7"},
                                   {"splitting", "modal_strang", "#0b9ccb", "#bcf1f4"},
                                   {"spatial", "modal_spatial", "#0a722e", "#25ff90"},
                                   {"grid", "finite_difference", "#c07c00", "#e0a326"},
                                   {"sitar", "sitar_", "#610a2d", "#da0a42"},
                                   {"control", "", "#767676", "#8d959c"},
                                   {"other", "", "#81347f", "#994195"}};
constexpr int control_family = static_cast<int>(std::size(all_families)) - 2, other_family = control_family + 1;
constexpr const char* shapes[] = {"circle",        "diamond", "square",         "triangle-up",
                                  "triangle-down", "cross",   "triangle-right", "triangle-left"};

struct Known {
    std::string_view scheme;
    int family, place;  // of the family's schemes
    bool control;
};

int family_of(const Descriptor& d) {
    if (is_control(d)) return control_family;
    for (int f = 0; f < control_family; ++f)
        if (std::string_view(d.name).starts_with(all_families[f].prefix)) return f;
    return other_family;
}

const std::vector<Known>& known() {
    static const std::vector<Known> all = [] {
        std::vector<Known> found;
        std::array<int, std::size(all_families)> count{};
        for (const auto& list : {schemes(), references()})
            for (const Descriptor& d : list) {
                const int family = family_of(d);
                found.push_back({d.name, family, count[static_cast<std::size_t>(family)]++, is_control(d)});
            }
        return found;
    }();
    return all;
}

std::string_view scheme_in(std::string_view name) {
    return name.substr(0, name.find_first_of(" ,:"));
}

// Matched is dashed and as published dotted, whatever else was asked: that adds a dot.
std::vector<int> dash_of(std::string_view variant) {
    constexpr int dashes[][2] = {{10, 3}, {4, 2}, {1, 2}};
    constexpr std::pair<std::string_view, std::array<int, 2>> forms[] = {{" compliance=matched", {6, 3}}, {" compliance=own", {2, 3}}};
    if (variant.empty()) return {1, 0};
    for (const auto& [form, dash] : forms)
        if (variant == form) return {dash[0], dash[1]};
        else if (variant.find(form) != variant.npos) return {dash[0], dash[1], 1, dash[1]};
    unsigned hash = 0;
    for (const char c : variant) hash = 31 * hash + static_cast<unsigned char>(c);
    const std::size_t which = hash % std::size(dashes);
    return {dashes[which][0], dashes[which][1]};
}
}  // namespace

std::span<const Family> families() {
    return all_families;
}

std::vector<Identity> identities_of(const std::vector<std::string>& names) {
    std::vector<std::string> unknown;
    const auto found = [](std::string_view name) {
        return std::find_if(known().begin(), known().end(), [&](const Known& k) { return k.scheme == scheme_in(name); });
    };
    for (const std::string& name : names)
        if (found(name) == known().end()) unknown.push_back(name);
    std::sort(unknown.begin(), unknown.end());
    std::vector<Identity> identities;
    for (const std::string& name : names) {
        if (const auto k = found(name); k != known().end()) {
            identities.push_back({k->family, k->control, all_families[k->family].light, shapes[k->place % std::size(shapes)],
                                  dash_of(std::string_view(name).substr(k->scheme.size()))});
            continue;
        }
        const auto place = static_cast<std::size_t>(std::find(unknown.begin(), unknown.end(), name) - unknown.begin());
        // ink first, then the families' hues with other markers than theirs
        const std::size_t hue =
            place == 0 ? static_cast<std::size_t>(other_family) : (place - 1) % static_cast<std::size_t>(control_family);
        identities.push_back({other_family, false, all_families[hue].light, shapes[(place + 3) % std::size(shapes)], {1, 0}});
    }
    return identities;
}

std::vector<std::string> in_order(std::vector<std::string> names) {
    const auto key = [](const std::string& name) {
        const auto k = std::find_if(known().begin(), known().end(), [&](const Known& one) { return one.scheme == scheme_in(name); });
        // others stand before the controls
        const int family = k == known().end() ? other_family : k->family;
        return std::pair(family == control_family ? other_family + 1 : family, k == known().end() ? 0 : k->place);
    };
    std::stable_sort(names.begin(), names.end(), [&](const std::string& a, const std::string& b) { return key(a) < key(b); });
    return names;
}

}  // namespace jvari::bench::report
