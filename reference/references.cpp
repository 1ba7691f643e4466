#include "reference/references.hpp"

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

const Descriptor* best_reference(const Scene& scene) {
    for (const Descriptor& r : references())
        if ((needed_by(scene) - r.represents).empty()) return &r;
    return nullptr;
}

}  // namespace jvari
