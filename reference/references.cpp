#include "reference/references.hpp"

#include <algorithm>

#include "schemes/contact/compliance.hpp"
#include "schemes/making.hpp"

namespace jvari {

std::span<const Descriptor> references() {
    static const Descriptor table[] = {
        exact_linear,
        characteristic_lattice,
        exact_contact,
#if !defined(JVARI_WITHOUT_SUNDIALS)  // the page's module
        sundials,
#endif
    };
    return table;
}

std::vector<const Descriptor*> references_of(const Scene& scene) {
    std::vector<const Descriptor*> able;
    for (const Descriptor& r : references())
        if (represents(r, scene)) able.push_back(&r);
    return able;
}

const Descriptor* best_reference(const Scene& scene) {
    const auto able = references_of(scene);
    return able.empty() ? nullptr : able.front();
}

std::optional<OptionValues> matched(const Descriptor& reference, const Scene& scene,
                                    OptionValues options) {
    constexpr Features never = Feature::profile_barrier | Feature::moving_body |
                               // rigid: matched unasked
                               Feature::tension_modulation | Feature::rigid_barrier;
    const Features needed = needed_by(scene);
    const auto is_compliance = [](const auto& o) { return o.first == compliance_option.name; };
    if (!declares(reference, compliance_option.name) ||
        std::any_of(options.begin(), options.end(), is_compliance) || needed.any(never))
        return {};
    constexpr Features touching = Feature::lumped_barrier | Feature::thread | any_mass;
    if (!needed.any(touching)) return {};
    options.emplace_back(compliance_option.name, "matched");
    return options;
}

bool is_matched(const OptionValues& options) {
    return std::find(options.begin(), options.end(),
                     std::pair<std::string, std::string>(compliance_option.name, "matched")) !=
           options.end();
}

}  // namespace jvari
