#include "schemes/registry.hpp"

#include <dlfcn.h>

#include <algorithm>

#include "schemes/controls.hpp"

namespace jvari {

#define JVARI_SCHEME(name) extern const Descriptor name;
#define JVARI_CONTROL(name) JVARI_SCHEME(name)
#include "schemes/schemes.def"
#undef JVARI_SCHEME

std::span<const Descriptor> schemes() {
#define JVARI_SCHEME(name) name,
    static const Descriptor table[] = {
#include "schemes/schemes.def"
    };
#undef JVARI_SCHEME
#undef JVARI_CONTROL
    return table;
}

bool is_control(const Descriptor& d) {
#define JVARI_SCHEME(name) false,
#define JVARI_CONTROL(name) true,
    static constexpr bool controls[] = {
#include "schemes/schemes.def"
    };
#undef JVARI_SCHEME
#undef JVARI_CONTROL
    const auto place =
        std::find_if(schemes().begin(), schemes().end(), [&d](const Descriptor& one) { return &one == &d; }) - schemes().begin();
    return place < static_cast<std::ptrdiff_t>(std::size(controls)) && controls[place];
}

namespace {
std::vector<LoadedPlugin>& kept_plugins() {
    static std::vector<LoadedPlugin> all;
    return all;
}
}  // namespace

std::span<const LoadedPlugin> loaded_plugins() {
    return kept_plugins();
}

const Plugin& load_plugin(const std::string& path) {
    void* library = dlopen(path.find('/') == std::string::npos ? ("./" + path).c_str() : path.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (!library) throw std::runtime_error("cannot load plugin " + path + ": " + dlerror());
    const auto* plugin = static_cast<const Plugin*>(dlsym(library, "jvari_plugin"));
    if (!plugin) throw std::runtime_error("plugin " + path + " does not export jvari_plugin");
    if (plugin->abi != plugin_abi())
        throw std::runtime_error("plugin " + path + " has interface " + std::to_string(plugin->abi) + ", this program has " +
                                 std::to_string(plugin_abi()) + ": compile it with the headers and the compiler of this program");
    const auto must = [&path](bool good, const std::string& wrong) {
        if (!good) throw std::runtime_error("plugin " + path + " " + wrong);
    };
    must(plugin->count >= 0, "says that it has " + std::to_string(plugin->count) + " schemes");
    must(plugin->table || plugin->count == 0, "says that it has " + std::to_string(plugin->count) + " schemes and shows none");
    for (int i = 0; i < plugin->count; ++i) {
        const Descriptor& d = plugin->table[i];
        must(d.name && *d.name, "has no name for its scheme " + std::to_string(i));
        must(d.source, "has no source for its scheme " + std::string(d.name));
        must(d.make, "has nothing that makes its scheme " + std::string(d.name));
    }
    auto& all = kept_plugins();
    if (std::none_of(all.begin(), all.end(), [plugin](const LoadedPlugin& l) { return l.plugin == plugin; })) all.push_back({path, plugin});
    return *plugin;
}

}  // namespace jvari
