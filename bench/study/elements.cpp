#include "bench/study/elements.hpp"

#include <fmt/core.h>

#include <array>

#include "bench/sound/radiation.hpp"
#include "bench/store/usage.hpp"
#include "scenes/reduction.hpp"

namespace jvari::bench::study {

namespace {
constexpr std::array all = {Element::strings, Element::thread, Element::contact, Element::losses,   Element::stiffness,
                            Element::taps,    Element::body,   Element::probe,   Element::radiation};
constexpr std::array names = {"strings", "thread", "contact", "losses", "stiffness", "taps", "body", "probe", "radiation"};
static_assert(all.size() == names.size());
constexpr double any_rate = 44100;  // [Hz]; which taps radiate is the same at every rate

// The reductions that an element is made of.
bool is_of(Element e, const Reduction& r, const Scene& scene) {
    switch (e) {
        case Element::strings: return r.part == Part::string && r.key != "string.0";
        case Element::thread: return r.part == Part::thread;
        case Element::contact: return r.part == Part::barrier;
        case Element::losses: return r.part == Part::damping;
        case Element::stiffness: return r.part == Part::bending_stiffness;
        case Element::taps: return r.part == Part::tap && r.key != "tap." + scene.taps.front().name;
        case Element::body:
        case Element::probe:
        case Element::radiation: return false;
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
    return (is_added(e) ? "+" : "-") + std::string(name_of(e));
}

bool is_added(Element e) {
    return e == Element::probe || e == Element::radiation;
}

Scene without(Element e, Scene scene) {
    const auto refuse = [](const char* what, const char* verb) {
        throw store::UsageError(fmt::format("elements: it has no {} to {}", what, verb));
    };
    if ((e == Element::body || e == Element::radiation) && !scene.body) refuse("body", e == Element::body ? "go without" : "radiate");
    if (e == Element::radiation && sound::radiating_taps(scene, any_rate).empty())
        throw store::UsageError("elements: no tap is of what its body radiates: the driving force or the nut force of all strings");
    if (e == Element::body) scene.body.reset();
    if (e == Element::body || is_added(e)) return scene;
    std::vector<Reduction> own = reductions_of(scene);
    std::erase_if(own, [&](const Reduction& r) { return !is_of(e, r, scene); });
    if (own.empty()) refuse(e == Element::taps ? "second tap" : e == Element::strings ? "second string" : name_of(e), "go without");
    for (const Reduction& r : own) r.apply(scene);
    remove_idle_taps(scene);
    return scene;
}

}  // namespace jvari::bench::study
