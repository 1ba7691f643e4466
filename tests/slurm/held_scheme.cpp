// A plugin for the test on a cluster: modal_two_point under another name, that a node can be told
// to stop in the middle of a run.
//
// Where the folder $JVARI_HOLD has a file of the node's name, the first run there that is half done
// renames it to NODE.PID and stops itself (SIGSTOP): whoever waits for that file has a task that is
// at work and will not end before it is ended. Elsewhere nothing is changed.
#include <signal.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <string>

#include "schemes/plugin.hpp"
#include "schemes/registry.hpp"

namespace {
using namespace jvari;

const Descriptor& whole() {
    for (const Descriptor& d : schemes())
        if (d.name == std::string("modal_two_point")) return d;
    std::abort();
}

void stop_where_asked() {
    const char *folder = std::getenv("JVARI_HOLD"), *node = std::getenv("SLURMD_NODENAME");
    if (!folder || !node) return;
    const std::string file = std::string(folder) + "/" + node;
    if (std::rename(file.c_str(), (file + "." + std::to_string(getpid())).c_str()) == 0)
        raise(SIGSTOP);
}

class Held final : public Scheme {
public:
    Held(const Scene& scene, const Settings& s)
        : scheme_(make_scheme(whole(), scene, s)), half_(scene.duration * s.tap_rate / 2) {}
    void reset() noexcept override {
        scheme_->reset();
        row_ = 0;
    }
    Status advance(const Block& out) noexcept override {
        if (row_ > half_) stop_where_asked();
        row_ += out.rows;
        return scheme_->advance(out);
    }
    int dofs() const override { return scheme_->dofs(); }
    std::vector<Fact> facts() const override { return scheme_->facts(); }
    std::vector<FreeMode> free_modes() const override { return scheme_->free_modes(); }

private:
    std::unique_ptr<Scheme> scheme_;
    double half_;  // rows
    double row_ = 0;
};

Descriptor held_descriptor() {
    Descriptor d = whole();
    d.name = "held_two_point";
    d.make = [](const Descriptor&, const Scene& scene,
                const Settings& s) -> std::unique_ptr<Scheme> {
        return std::make_unique<Held>(scene, s);
    };
    return d;
}
const Descriptor table[] = {held_descriptor()};
}  // namespace

JVARI_PLUGIN(table)
