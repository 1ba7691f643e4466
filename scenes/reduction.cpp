#include "scenes/reduction.hpp"

#include <algorithm>
#include <cmath>

namespace jvari {

namespace {
// Names a value within a scene: the same place in every scene of the same shape.
template <class T>
using Place = std::function<T&(Scene&)>;

class List {
public:
    explicit List(double penetration) : penetration_(penetration) {}

    void value(Part part, const std::string& key, double now, double then,
               const Place<double>& place) {
        if (now != then)
            all.push_back(
                {part, key, then == 0 ? "0" : "1", [place, then](Scene& s) { place(s) = then; }});
    }
    template <class T>
    void part(Part p, const std::string& key, bool there, T String::*member, int string) {
        if (there) all.push_back({p, key, "", [=](Scene& s) { s.strings[string].*member = T{}; }});
    }

    void barrier(int s, int b, const Barrier& now) {
        const std::string key =
            "string." + std::to_string(s) + ".barrier." + std::to_string(b) + ".";
        std::visit([&](const auto& x) { contact(key, x, s, b); }, now);
    }

    void damping(int s, const Damping& now) {
        const std::string key = "string." + std::to_string(s) + ".damping.";
        const auto terms = [&]<class Law>(
                               const Law& law,
                               const std::vector<std::pair<const char*, double Law::*>>& members) {
            if (std::count_if(members.begin(), members.end(),
                              [&](const auto& m) { return law.*m.second != 0; }) < 2)
                return;
            for (const auto& [name, member] : members)
                value(Part::damping_term, key + name, law.*member, 0,
                      [s, m = member](Scene& x) -> double& {
                          return std::get<Law>(x.strings[s].damping).*m;
                      });
        };
        if (const auto* p = std::get_if<PolynomialDamping>(&now))
            terms(*p, {{"sigma0", &PolynomialDamping::sigma0},
                       {"sigma1", &PolynomialDamping::sigma1},
                       {"sigma3", &PolynomialDamping::sigma3}});
        if (const auto* q = std::get_if<QualityFactorDamping>(&now))
            terms(*q, {{"air_viscosity", &QualityFactorDamping::air_viscosity},
                       {"viscoelastic_angle", &QualityFactorDamping::viscoelastic_angle},
                       {"thermoelastic_loss", &QualityFactorDamping::thermoelastic_loss}});
    }

    std::vector<Reduction> all;

private:
    static double& stiffness_of(LumpedBarrier& b) { return b.stiffness.k; }
    static double& stiffness_of(ProfileBarrier& b) { return b.stiffness.K; }
    static const char* stiffness_key(const LumpedBarrier&) { return "stiffness"; }
    static const char* stiffness_key(const ProfileBarrier&) { return "stiffness_density"; }

    template <class B>
    void contact(const std::string& key, const B& now, int s, int b) {
        const auto of = [s, b](Scene& x) -> B& { return std::get<B>(x.strings[s].barriers[b]); };
        if (!is_rigid(now))
            for (const auto& [factor, text] :
                 {std::pair{0.1, "a tenth"}, std::pair{0.01, "a hundredth"}})
                all.push_back({Part::contact_stiffness, key + stiffness_key(now), text,
                               [of, f = factor](Scene& x) { stiffness_of(of(x)) *= f; }});
        if (now.exponent != 1)
            all.push_back(
                {Part::exponent, key + "exponent", "1", [of, eta = penetration_](Scene& x) {
                     // k eta^a = k' eta
                     stiffness_of(of(x)) *= std::pow(eta, of(x).exponent - 1);
                     of(x).exponent = 1;
                 }});
        value(Part::contact_loss, key + "contact_loss", now.contact_loss, 0,
              [of](Scene& x) -> double& { return of(x).contact_loss; });
        if constexpr (std::is_same_v<B, LumpedBarrier>)
            value(Part::footprint, key + "width", now.width, 0,
                  [of](Scene& x) -> double& { return of(x).width; });
    }

    double penetration_;
};

void remove_string(Scene& s, int k) {
    s.strings.erase(s.strings.begin() + k);
    std::erase_if(s.taps, [k](const Tap& t) { return t.string == k; });
    for (Tap& t : s.taps)
        if (t.string && *t.string > k) --*t.string;
}
void remove_mass(Scene& s, int string, int m) {
    s.strings[string].masses.erase(s.strings[string].masses.begin() + m);
    std::erase_if(s.taps, [=](const Tap& t) { return t.string == string && t.mass == m; });
    for (Tap& t : s.taps)
        if (t.string == string && t.mass > m) --*t.mass;
}
}  // namespace

std::vector<Reduction> reductions_of(const Scene& scene, double penetration) {
    List list(penetration);
    const int strings = static_cast<int>(scene.strings.size());
    const auto key = [](int s) { return "string." + std::to_string(s); };
    for (int s = 0; s < strings; ++s) {
        const String& now = scene.strings[s];
        for (int b = 0; b < static_cast<int>(now.barriers.size()); ++b)
            list.barrier(s, b, now.barriers[b]);
        if (now.thread)
            list.value(Part::footprint, key(s) + ".thread.width", now.thread->width, 0,
                       [s](Scene& x) -> double& { return x.strings[s].thread->width; });
        list.damping(s, now.damping);
        list.value(Part::bending_stiffness, key(s) + ".bending_stiffness", now.bending_stiffness, 0,
                   [s](Scene& x) -> double& { return x.strings[s].bending_stiffness; });
    }
    for (int s = 0; s < strings; ++s) {
        const String& now = scene.strings[s];
        list.part(Part::damping, key(s) + ".damping",
                  !std::holds_alternative<NoDamping>(now.damping), &String::damping, s);
        list.part(Part::thread, key(s) + ".thread", now.thread.has_value(), &String::thread, s);
        list.part(Part::initial_shape, key(s) + ".start", now.start && now.pluck, &String::start,
                  s);
        list.part(Part::initial_shape, key(s) + ".velocity",
                  now.velocity && (now.start || now.pluck), &String::velocity, s);
        list.part(Part::pluck, key(s) + ".pluck", now.start && now.pluck, &String::pluck, s);
        list.part(Part::polarisation, key(s) + ".polarisation", now.polarisation.has_value(),
                  &String::polarisation, s);
    }
    if (scene.taps.size() > 1)
        for (int t = static_cast<int>(scene.taps.size()) - 1; t >= 0; --t)
            list.all.push_back(
                {Part::tap, "tap." + scene.taps[t].name, "", [name = scene.taps[t].name](Scene& x) {
                     std::erase_if(x.taps, [&name](const Tap& tap) { return tap.name == name; });
                 }});
    for (int s = strings - 1; s >= 0; --s)
        for (int b = static_cast<int>(scene.strings[s].barriers.size()) - 1; b >= 0; --b)
            list.all.push_back(
                {Part::barrier, key(s) + ".barrier." + std::to_string(b), "", [s, b](Scene& x) {
                     x.strings[s].barriers.erase(x.strings[s].barriers.begin() + b);
                 }});
    for (int s = strings - 1; s >= 0; --s)
        for (int m = static_cast<int>(scene.strings[s].masses.size()) - 1; m >= 0; --m)
            list.all.push_back({Part::mass, key(s) + ".mass." + std::to_string(m), "",
                                [s, m](Scene& x) { remove_mass(x, s, m); }});
    if (strings > 1)
        for (int s = strings - 1; s >= 0; --s)
            list.all.push_back({Part::string, key(s), "", [s](Scene& x) { remove_string(x, s); }});
    return std::move(list.all);
}

void remove_idle_taps(Scene& scene, const std::string& kept) {
    std::erase_if(scene.taps, [&](const Tap& t) {
        if (t.name == kept) return false;
        if (t.string) return lacks(scene.strings[*t.string], t.quantity, t.mass) != nullptr;
        return std::all_of(scene.strings.begin(), scene.strings.end(), [&t](const String& s) {
            return lacks(s, t.quantity, t.mass) != nullptr;
        });
    });
}

}  // namespace jvari
