#include "schemes/registry.hpp"

#include <dlfcn.h>

namespace jvari {

extern const Descriptor modal_two_point, modal_two_point_trapezoidal, modal_spatial_newton;
extern const Descriptor modal_quadratised, modal_quadratised_two_point_constrained, modal_quadratised_two_point_raw,
    modal_quadratised_three_point, modal_quadratised_three_point_constrained, modal_quadratised_three_point_raw;
extern const Descriptor modal_explicit_penalty, modal_impulse_invariant;
extern const Descriptor sitar_waveguide, sitar_fdm;
extern const Descriptor finite_difference_explicit, finite_difference_theta, finite_difference_hamiltonian;

std::span<const Descriptor> schemes() {
    static const Descriptor table[] = {
        modal_two_point,
        modal_two_point_trapezoidal,
        modal_spatial_newton,
        modal_quadratised,
        modal_quadratised_two_point_constrained,
        modal_quadratised_two_point_raw,
        modal_quadratised_three_point,
        modal_quadratised_three_point_constrained,
        modal_quadratised_three_point_raw,
        modal_explicit_penalty,
        modal_impulse_invariant,
        sitar_waveguide,
        sitar_fdm,
        finite_difference_explicit,
        finite_difference_theta,
        finite_difference_hamiltonian,
    };
    return table;
}

std::span<const Descriptor> load_plugin(const std::string& path) {
    void* library = dlopen(path.find('/') == std::string::npos ? ("./" + path).c_str() : path.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (!library) throw std::runtime_error("cannot load plugin " + path + ": " + dlerror());
    const auto* plugin = static_cast<const Plugin*>(dlsym(library, "jvari_plugin"));
    if (!plugin) throw std::runtime_error("plugin " + path + " does not export jvari_plugin");
    if (plugin->abi != plugin_abi)
        throw std::runtime_error("plugin " + path + " has interface version " + std::to_string(plugin->abi) + ", this program has " +
                                 std::to_string(plugin_abi));
    const auto must = [&path](bool good, const std::string& wrong) {
        if (!good) throw std::runtime_error("plugin " + path + " " + wrong);
    };
    must(plugin->count >= 0, "says that it has " + std::to_string(plugin->count) + " schemes");
    must(plugin->schemes || plugin->count == 0, "says that it has " + std::to_string(plugin->count) + " schemes and shows none");
    for (int i = 0; i < plugin->count; ++i) {
        const Descriptor& d = plugin->schemes[i];
        must(d.name && *d.name, "has no name for its scheme " + std::to_string(i));
        must(d.source, "has no source for its scheme " + std::string(d.name));
        must(d.make, "has nothing that makes its scheme " + std::string(d.name));
    }
    return {plugin->schemes, static_cast<std::size_t>(plugin->count)};
}

}  // namespace jvari
