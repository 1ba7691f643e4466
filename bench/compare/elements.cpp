#include "bench/compare/elements.hpp"

#include <algorithm>
#include <array>

#include "bench/store/usage.hpp"
#include "scenes/reduction.hpp"

namespace jvari::bench::compare {

namespace {
constexpr std::array all = {Element::thread, Element::contact, Element::stiffness, Element::taps, Element::probe};
constexpr std::array names = {"thread", "contact", "stiffness", "taps", "probe"};
static_assert(all.size() == names.size());

// The reductions that an element is made of.
bool is_of(Element e, const Reduction& r, const Scene& scene) {
    switch (e) {
        case Element::thread: return r.part == Part::thread;
        case Element::contact: return r.part == Part::barrier;
        case Element::stiffness: return r.part == Part::bending_stiffness;
        case Element::taps: return r.part == Part::tap && r.key != "tap." + scene.taps.front().name;
        case Element::probe: return false;
    }
    return false;
}
}  // namespace

std::span<const Element> elements() {
    return all;
}

const char* name_of(Element e) {
    return names[static_cast<std::size_t>(e)];
}

std::string change_of(Element e) {
    return (e == Element::probe ? "+" : "-") + std::string(name_of(e));
}

Scene without(Element e, Scene scene) {
    if (e == Element::probe) return scene;
    std::vector<Reduction> own = reductions_of(scene);
    std::erase_if(own, [&](const Reduction& r) { return !is_of(e, r, scene); });
    if (own.empty())
        throw store::UsageError(std::string("elements: it has no ") + (e == Element::taps ? "second tap" : name_of(e)) + " to go without");
    for (const Reduction& r : own) r.apply(scene);
    remove_idle_taps(scene);
    return scene;
}

}  // namespace jvari::bench::compare
