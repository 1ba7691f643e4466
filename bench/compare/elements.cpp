#include "bench/compare/elements.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "bench/store/usage.hpp"

namespace jvari::bench::compare {

namespace {
constexpr std::array all = {Element::thread, Element::contact, Element::stiffness, Element::taps, Element::probe};
constexpr std::array names = {"thread", "contact", "stiffness", "taps", "probe"};
static_assert(all.size() == names.size());

// Taps of forces that nothing makes any more.
void remove_idle_taps(Scene& scene) {
    const bool thread = std::ranges::any_of(scene.strings, [](const String& s) { return s.thread.has_value(); });
    const bool contact = std::ranges::any_of(scene.strings, [](const String& s) { return !s.barriers.empty(); });
    std::erase_if(scene.taps, [thread, contact](const Tap& t) {
        return (t.quantity == Quantity::thread_force && !thread) || (t.quantity == Quantity::bridge_force && !contact) ||
               (t.quantity == Quantity::driving_force && !thread && !contact);
    });
}

// Whether `take`, which empties a part and says whether something was in it, found something on any string.
template <class Take>
bool taken_from_any(Scene& scene, Take take) {
    bool any = false;
    for (String& s : scene.strings) any = take(s) || any;
    return any;
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
    bool had = true;
    switch (e) {
        case Element::thread:
            had = taken_from_any(scene, [](String& s) { return std::exchange(s.thread, std::nullopt).has_value(); });
            break;
        case Element::contact: had = taken_from_any(scene, [](String& s) { return !std::exchange(s.barriers, {}).empty(); }); break;
        case Element::stiffness: had = taken_from_any(scene, [](String& s) { return std::exchange(s.bending_stiffness, 0.0) != 0; }); break;
        case Element::taps:
            had = scene.taps.size() > 1;
            if (had) scene.taps.resize(1);
            break;
        case Element::probe: break;
    }
    if (!had)
        throw store::UsageError(std::string("elements: it has no ") + (e == Element::taps ? "second tap" : name_of(e)) + " to go without");
    remove_idle_taps(scene);
    return scene;
}

}  // namespace jvari::bench::compare
