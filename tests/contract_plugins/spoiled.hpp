// A scheme of the tree under another name, with a fault in its scene or in the rows that it writes. Unlike the honest scheme it has
// contacts and a thread.
#pragma once

#include <algorithm>
#include <memory>
#include <string>

#include "schemes/plugin.hpp"
#include "schemes/registry.hpp"

namespace jvari {

inline const Descriptor& of_the_tree(const std::string& name) {
    return *std::ranges::find_if(schemes(), [&name](const Descriptor& d) { return d.name == name; });
}

class Spoiled : public Scheme {
public:
    Spoiled(const char* name, const Scene& scene, const Settings& settings)
        : scene_(scene), inner_(make_scheme(of_the_tree(name), scene, settings)) {}
    void reset() noexcept override { inner_->reset(); }
    Status advance(const Block& out) noexcept override {
        const Status status = inner_->advance(out);
        for (int k = 0; k < out.taps; ++k)
            for (int n = 0; n < out.rows; ++n) out.tap[n + k * out.stride] *= factor(scene_.taps[k].quantity);
        return status;
    }
    int dofs() const override { return inner_->dofs(); }
    std::vector<Fact> facts() const override { return inner_->facts(); }
    std::vector<FreeMode> free_modes() const override { return inner_->free_modes(); }

protected:
    virtual double factor(Quantity) const noexcept { return 1; }  // of a tap

private:
    Scene scene_;
    std::unique_ptr<Scheme> inner_;
};

inline Descriptor renamed(Descriptor d, const char* name, decltype(Descriptor::make) make) {
    d.name = name;
    d.make = make;
    return d;
}

}  // namespace jvari

// What `Made` makes of the scheme `of` as a plugin: Made(scene, settings).
#define JVARI_SPOILED(name, of, Made)                                                                                                \
    static const jvari::Descriptor table[] = {jvari::renamed(                                                                        \
        jvari::of_the_tree(of), #name,                                                                                               \
        [](const jvari::Descriptor&, const jvari::Scene& scene, const jvari::Settings& settings) -> std::unique_ptr<jvari::Scheme> { \
            return std::make_unique<Made>(scene, settings);                                                                          \
        })};                                                                                                                         \
    JVARI_PLUGIN(table)
