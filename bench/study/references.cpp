#include "bench/study/references.hpp"

#include <atomic>
#include <mutex>
#include <optional>

#include "bench/store/system/side_by_side.hpp"
#include "scenes/excitation.hpp"

namespace jvari::bench::study {

class References::Shared {
public:
    template <class Make>
    void make(double from, Make run) {
        if (made_) return;
        std::optional<store::Wait> wait(std::in_place);
        const std::lock_guard lock(mutex_);
        wait.reset();
        if (made_) return;
        try {
            truth_ = std::make_unique<Truth>(run());
            const Run& moved = truth_->reference.moved;
            if (moved.trace.rows > 0)
                floor_ = errors_of(moved.trace, truth_->reference.run.trace, {}, from);
        } catch (const std::exception& e) { refused_ = e.what(); }
        made_ = true;
    }
    void hold() { ++needed_by_; }
    void release() {
        if (--needed_by_ > 0) return;
        truth_.reset();
        made_ = false;
    }
    const Truth* truth() const { return truth_.get(); }
    const Errors& floor() const { return floor_; }
    const std::string& refused() const { return refused_; }

private:
    std::mutex mutex_;  // of what follows, until it is made
    std::unique_ptr<Truth> truth_;
    Errors floor_;
    std::string refused_;
    std::atomic<bool> made_ = false;
    std::atomic<int> needed_by_ = 0;
};

Against References::Of::against() const {
    if (!truth) return {};
    const Reference& r = truth->reference;
    return {r.choice.name(),
            r.choice.settings.modes,
            truth->description,
            *floor,
            r.trust,
            model ? model->trust : trust::Trust{}};
}

References::References(std::span<const Job> jobs) {
    for (const Job& job : jobs)
        if (job.judged) hold(*job.point);
}

References::~References() = default;

References::Shared& References::of(const std::string& key) {
    const std::lock_guard lock(mutex_);
    auto& shared = all_[key];
    if (!shared) shared = std::make_unique<Shared>();
    return *shared;
}

void References::each_of(const Point& p, void (Shared::*act)()) {
    (of(p.reference_key).*act)();
    if (!p.truth_key.empty()) (of(p.truth_key).*act)();
}

References::Of References::make(const Point& p, int jobs, const store::Listener& listener) {
    const Scene& scene = p.true_scene();
    const double from = free_from(scene);
    Shared& model = of(p.reference_key);
    if (p.in_model || !p.truth_modes)
        model.make(from, [&] {
            Truth t;
            t.reference = run_reference(p.references, scene, jobs, listener, p.time_limit, p.alone);
            return t;
        });
    Shared& truth = p.truth_key.empty() ? model : of(p.truth_key);
    if (p.truth_modes)
        truth.make(from, [&] {
            return run_truth(p.references, scene, *p.truth_modes, jobs, listener, p.time_limit);
        });
    return {truth.truth(), model.truth() ? &model.truth()->reference : nullptr, &truth.floor(),
            truth.refused()};
}

void References::hold(const Point& p) { each_of(p, &Shared::hold); }
void References::release(const Point& p) { each_of(p, &Shared::release); }

}  // namespace jvari::bench::study
