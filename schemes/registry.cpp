#include "schemes/registry.hpp"

#include <dlfcn.h>

#include <algorithm>

#include "schemes/controls.hpp"
#include "schemes/plugin.hpp"

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
std::vector<const Guest*>& all_guests() {
    static std::vector<const Guest*> all;
    return all;
}
}  // namespace

std::span<const Guest* const> guests() {
    return all_guests();
}

const Guest* find_guest(const std::string& path) {
    const auto found = std::ranges::find_if(all_guests(), [&path](const Guest* g) { return g->path == path; });
    return found == all_guests().end() ? nullptr : *found;
}

const Guest& add_guest(Guest guest) {
    const auto* added = new Guest(std::move(guest));  // NOLINT(cppcoreguidelines-owning-memory): for the life of the process
    const auto same = std::ranges::find_if(all_guests(), [added](const Guest* g) { return g->path == added->path; });
    if (same == all_guests().end()) all_guests().push_back(added);
    else *same = added;
    return *added;
}

namespace {
Guest open_plugin(const std::string& path) {
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
    return {path, {plugin->schemes().begin(), plugin->schemes().end()}, "", plugin->compiler, plugin->flags, plugin->optimised};
}
}  // namespace

const Guest& load_plugin(const std::string& path) {
    const Guest* known = find_guest(path);
    return known ? *known : add_guest(open_plugin(path));
}

}  // namespace jvari
