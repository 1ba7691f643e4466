#include "reference/in_series.hpp"

#include "schemes/modal/modal_compliance.hpp"

namespace jvari {

std::optional<InSeries> in_series(const Descriptor& descriptor, const Scene& scene, const Modes& modes, const Settings& settings) {
    if (choice_option(settings, compliance_option) != "matched") return {};
    const String& s = scene.strings.front();
    const auto refuse = [&](const char* what) { throw Refusal(std::string(descriptor.name) + ": compliance=matched " + what); };
    const LumpedBarrier* barrier = s.barriers.empty() ? nullptr : std::get_if<LumpedBarrier>(&s.barriers.front());
    if (s.barriers.size() > 1 || (!s.barriers.empty() && !barrier))
        refuse("takes one lumped barrier, and a thread; several contacts are not solved for");
    if (barrier && barrier->contact_loss != 0) refuse("leaves contact loss out");
    std::vector<double> own;
    for (double omega : modes.omega0) own.push_back(1 / (modes.mass * omega * omega));
    InSeries series;
    series.C = modal_compliance(descriptor, scene, modes_of(s, modes.count()), own);
    if (s.thread && !(series.C.cc > 0)) refuse("needs modes that are left out: nothing is missing at the thread");
    const ContactLaw law = barrier ? ContactLaw{barrier->stiffness.k, barrier->exponent} : ContactLaw{};
    const Thread thread = s.thread.value_or(Thread{});
    series.points =
        SeriesPoints(barrier ? &law : nullptr, barrier ? barrier->height : 0, thread.stiffness, thread.damping, thread.height, series.C);
    return series;
}

void add_series(const Block& out, int row, const InSeries& series, const SeriesPoints::Forces& F, double F_e) noexcept {
    for (int k = 0; k < out.taps; ++k) {
        const auto& on = series.C.taps[k];
        out.tap[k * out.stride + row] += on[0] * F.b + on[1] * F.c + on[2] * F_e;
    }
}

}  // namespace jvari
