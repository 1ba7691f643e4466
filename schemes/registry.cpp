#include "schemes/registry.hpp"

#include <algorithm>
#include <stdexcept>
#include <string_view>

#include "scenes/wording.hpp"
#include "schemes/controls.hpp"
#include "schemes/open/open_plugin.hpp"

namespace jvari {

#define JVARI_BUILTIN(name) extern const Descriptor name;
#define JVARI_CONTROL(name) JVARI_BUILTIN(name)
#include "schemes/schemes.def"
#undef JVARI_BUILTIN

std::span<const Descriptor> schemes() {
#define JVARI_BUILTIN(name) name,
    static const Descriptor table[] = {
#include "schemes/schemes.def"
    };
#undef JVARI_BUILTIN
#undef JVARI_CONTROL
    return table;
}

bool is_control(const Descriptor& d) {
#define JVARI_BUILTIN(name) false,
#define JVARI_CONTROL(name) true,
    static constexpr bool controls[] = {
#include "schemes/schemes.def"
    };
#undef JVARI_BUILTIN
#undef JVARI_CONTROL
    const auto place = std::find_if(schemes().begin(), schemes().end(),
                                    [&d](const Descriptor& one) { return &one == &d; }) -
                       schemes().begin();
    return place < static_cast<std::ptrdiff_t>(std::size(controls)) && controls[place];
}

namespace {
std::vector<const Guest*>& all_guests() {
    // never destroyed: the guests live until the process ends
    static auto& all = *new std::vector<const Guest*>;
    return all;
}
}  // namespace

std::span<const Guest* const> guests() { return all_guests(); }

const Guest* find_guest(const std::string& path) {
    const auto found = std::find_if(all_guests().begin(), all_guests().end(),
                                    [&path](const Guest* g) { return g->path == path; });
    return found == all_guests().end() ? nullptr : *found;
}

namespace {
// A scheme's name appears in tables, commands and file names.
void check_name(const std::string& path, std::string_view name) {
    std::string wrong = unfit_as_file(name);
    if (name == "reference") wrong = "is what results call the reference";
    if (std::any_of(name.begin(), name.end(),
                    [](char c) { return static_cast<unsigned char>(c) >= 0x80; }))
        wrong = "has letters beyond ASCII";
    if (!wrong.empty())
        throw std::runtime_error(
            path + ": the scheme's name " + found_text(name) + " " + wrong +
            ". Names are of letters, digits and _, for files are called by them");
}
}  // namespace

const Guest& add_guest(Guest guest) {
    for (const Descriptor& d : guest.schemes) check_name(guest.path, d.name);
    // kept until the process ends
    const auto* added = new Guest(std::move(guest));
    const auto same = std::find_if(all_guests().begin(), all_guests().end(),
                                   [added](const Guest* g) { return g->path == added->path; });
    if (same == all_guests().end()) all_guests().push_back(added);
    else *same = added;
    return *added;
}

const Guest& load_plugin(const std::string& path) {
    const Guest* known = find_guest(path);
    return known ? *known : add_guest(open_plugin(path));
}

}  // namespace jvari
