// Schemes that break one promise each and keep all others, and the honest one, which breaks none
// (check.sh). Those that need contacts or a thread are schemes of the tree under another name, with
// a fault in their scene or in the rows that they write.
#include <algorithm>
#include <numbers>
#include <string>

#include "schemes/registry.hpp"
#include "tests/contract_plugins/honest.hpp"

namespace {
using namespace jvari;

template <void (*fault)(const Honest&, const Block&, int)>
struct InItsRows final : Honest {
    using Honest::Honest;
    void spoil(const Block& out, int n) noexcept override { fault(*this, out, n); }
};

template <auto change>
struct OfAnotherString final : Honest {
    OfAnotherString(Scene scene, const Settings& settings)
        : Honest((change(scene.strings.front()), scene), settings) {}
};

void times(const Block& out, int n, double factor) {
    for (int k = 0; k < out.taps; ++k) out.tap[n + k * out.stride] *= factor;
}

// It declares features, and refuses each scene in a whole sentence.
struct RefusesEveryScene final : Honest {
    RefusesEveryScene(const Scene& scene, const Settings& settings) : Honest(scene, settings) {
        throw Refusal("scene " + scene.name + " is not to the taste of this scheme");
    }
};

// It declares bending stiffness, and steps the string as if it had none.
using IgnoresAFeature = OfAnotherString<[](String& s) { s.bending_stiffness = 0; }>;

// It plays a string under 1 % more tension, and keeps that string's ledger.
using PlaysAnotherString = OfAnotherString<[](String& s) { s.tension *= 1.01; }>;

// It starts from the mirror image of the scene's shape.
struct StartsFromAnotherShape final : Honest {
    StartsFromAnotherShape(const Scene& scene, const Settings& settings) : Honest(scene, settings) {
        for (std::size_t i = 1; i < shape_.size(); i += 2) shape_[i] = -shape_[i];
        Honest::reset();
    }
};

// It pulls at its nut before it has moved.
void starts_with_a_force(const Honest& h, const Block& out, int n) {
    for (int k = 0; h.row_ == 0 && k < out.taps; ++k)
        if (h.scene_.taps[k].quantity == Quantity::nut_force)
            out.tap[n + k * out.stride] += 3e-5 * h.scene_.strings.front().tension;
}

// It steps a second plane of motion that no scene here has.
struct CarriesDoubleState final : Honest {
    CarriesDoubleState(const Scene& scene, const Settings& settings)
        : Honest(scene, settings), other(scene, settings) {}
    void reset() noexcept override { Honest::reset(), other.reset(); }
    Status advance(const Block& out) noexcept override {
        return other.advance(out), Honest::advance(out);
    }
    int dofs() const override { return Honest::dofs() + other.dofs(); }
    Honest other;
};

// Its velocities outlive a reset.
struct KeepsStateAfterAReset final : Honest {
    using Honest::Honest;
    void reset() noexcept override { y_ = shape_, before_ = start_, row_ = 0; }
};

// From row 80 on its first tap is no number.
void gives_nan(const Honest& h, const Block& out, int n) {
    if (h.row_ >= 80 && out.taps > 0) out.tap[n] = std::nan("");
}

// Energy comes from nowhere in one row and goes there in the next, so that the sum is right.
void breaks_its_ledger_in_a_row(const Honest& h, const Block& out, int n) {
    if (out.energy && (h.row_ == 70 || h.row_ == 71))
        out.energy[n + out.stride] += (h.row_ == 70 ? 5e-11 : -5e-11) * h.start_;
}

// Each row is right to less than rounding is allowed, and all err to the same side.
void breaks_its_ledger_in_sum(const Honest& h, const Block& out, int n) {
    if (out.energy && h.row_ > 0) out.energy[n + out.stride] += 0.8e-11 * h.start_;
}

// A loss feeds energy in, although the ledger closes.
void dissipates_less_than_nothing(const Honest& h, const Block& out, int n) {
    if (!out.energy || h.row_ != 70) return;
    out.energy[n + out.stride] -= 1e-6 * h.start_ + out.energy[n + 2 * out.stride];
    out.energy[n + 2 * out.stride] = -1e-6 * h.start_;
}

// Its output depends on how many rows are asked for at once: a row asked for alone is another.
void depends_on_the_block_size(const Honest& h, const Block& out, int n) {
    if (h.row_ > 0 && out.rows == 1) times(out, n, 1 + 1e-12);
}

// Its output depends on whether its energy is asked for.
void depends_on_the_probe(const Honest& h, const Block& out, int n) {
    if (h.row_ > 0 && out.energy) times(out, n, 1 + 1e-12);
}

// It takes memory for each block.
struct AllocatesWhileStepping final : Honest {
    using Honest::Honest;
    Status advance(const Block& out) noexcept override {
        scratch = std::make_unique<double[]>(static_cast<std::size_t>(out.rows));
        return Honest::advance(out);
    }
    std::unique_ptr<double[]> scratch;
};

// It steps the true modes, and says of itself that they are a hundredth of a semitone flat.
struct MisstatesItsPartials final : Honest {
    using Honest::Honest;
    std::vector<FreeMode> free_modes() const override {
        std::vector<FreeMode> modes;
        for (int i = 0; i < modes_.count(); ++i)
            modes.push_back({std::sqrt(omega_squared_damped(modes_.omega0[i], modes_.sigma[i])) *
                                 std::exp2(-0.01 / 12),
                             modes_.sigma[i]});
        return modes;
    }
};

// From row 1 on its rows show the string half a step before their instants: an error of first
// order, which falls with the rate.
struct WritesHalfAStepLate final : Honest {
    WritesHalfAStepLate(const Scene& scene, const Settings& settings)
        : Honest(scene, settings), late(0.5 / settings.sample_rate) {}
    void spoil(const Block& out, int n) noexcept override {
        for (int k = 0; row_ > 0 && k < out.taps; ++k) {
            const bool velocity = scene_.taps[k].quantity == Quantity::velocity;
            double sum = 0;
            for (std::size_t i = 0; i < y_.size(); ++i) {
                // acceleration
                const double a =
                    -modes_.omega0[i] * modes_.omega0[i] * y_[i] - 2 * modes_.sigma[i] * v_[i];
                sum += weights_[k][i] *
                       (velocity ? v_[i] - late * a : y_[i] - late * v_[i] + 0.5 * late * late * a);
            }
            out.tap[n + k * out.stride] = sum;
        }
    }
    double late;  // [s]
};

// With fewer than 230 steps in a period, 30 kHz of a string of 131 Hz, it stores more from its
// second row on than was ever there.
struct GainsEnergyAtALowRate final : Honest {
    GainsEnergyAtALowRate(const Scene& scene, const Settings& settings)
        : Honest(scene, settings),
          low(settings.sample_rate < 230 * modes_.omega0.front() / (2 * std::numbers::pi)) {}
    void spoil(const Block& out, int n) noexcept override {
        if (low && out.energy && row_ > 0) out.energy[n] += 1e-3 * start_;
    }
    bool low;
};

// Its energies are twice what they are, and their balance closes.
void doubles_its_ledger(const Honest&, const Block& out, int n) {
    for (int k = 0; out.energy && k < 3; ++k) out.energy[n + k * out.stride] *= 2;
}

// ---- Schemes of the tree.

struct Fault {
    const char *name, *of;
    double (*factor)(Quantity);         // of the rows of a tap
    void (*change)(String&) = nullptr;  // of the scene
    const char* variant = nullptr;      // of modal_quadratised
    long from_row = 0;                  // of the factor
};

constexpr Fault faults[] = {
    {"pulls", "modal_quadratised", nullptr, nullptr, "raw"},
    {"turns_its_bridge_force_round", "modal_two_point",
     [](Quantity q) { return q == Quantity::bridge_force ? -1.0 : 1; }},
    {"triples_its_bridge_force", "modal_two_point",
     [](Quantity q) { return q == Quantity::bridge_force ? 3.0 : 1; }},
    {"triples_its_thread_force", "modal_two_point",
     [](Quantity q) { return q == Quantity::thread_force ? 3.0 : 1; }},
    {"turns_its_driving_force_round", "modal_two_point",
     [](Quantity q) { return q == Quantity::driving_force ? -1.0 : 1; }},
    {"halves_its_nut_force", "modal_two_point",
     [](Quantity q) { return q == Quantity::nut_force ? 0.5 : 1; }},
    {"ignores_the_width_of_a_barrier", "modal_two_point", nullptr,
     [](String& s) {
         for (Barrier& b : s.barriers)
             if (auto* lumped = std::get_if<LumpedBarrier>(&b)) lumped->width = 0;
     }},
    {"ignores_the_width_of_a_thread", "modal_two_point", nullptr,
     [](String& s) {
         if (s.thread) s.thread->width = 0;
     }},
    // as those of the library are: 4.39e8 N/m
    {"stiffens_a_stiff_barrier", "modal_two_point", nullptr,
     [](String& s) {
         for (Barrier& b : s.barriers)
             if (auto* lumped = std::get_if<LumpedBarrier>(&b); lumped && lumped->stiffness.k > 1e5)
                 lumped->stiffness.k *= 10;
     }},
    {"pulls_harder_after_a_tenth_of_a_second", "modal_two_point",
     [](Quantity q) { return q == Quantity::nut_force ? 1.1 : 1; }, nullptr, nullptr, 4410}};

class Spoiled : public Scheme {
public:
    Spoiled(const Fault& fault, Scene scene, const Settings& settings)
        : fault_(fault), scene_(std::move(scene)) {
        if (fault.change) fault.change(scene_.strings.front());
        Settings chosen = settings;
        if (fault.variant) chosen.options.emplace_back("variant", fault.variant);
        inner_ = make_scheme(of_the_tree(fault), scene_, chosen);
    }
    void reset() noexcept override { inner_->reset(), row_ = 0; }
    Status advance(const Block& out) noexcept override {
        const Status status = inner_->advance(out);
        for (int n = 0; n < out.rows; ++n, ++row_)
            for (int k = 0; fault_.factor && row_ >= fault_.from_row && k < out.taps; ++k)
                out.tap[n + k * out.stride] *= fault_.factor(scene_.taps[k].quantity);
        return status;
    }
    int dofs() const override { return inner_->dofs(); }
    std::vector<Fact> facts() const override { return inner_->facts(); }
    std::vector<FreeMode> free_modes() const override { return inner_->free_modes(); }

    static const Descriptor& of_the_tree(const Fault& fault) {
        return *std::ranges::find_if(
            schemes(), [&fault](const Descriptor& d) { return std::string(d.name) == fault.of; });
    }

private:
    const Fault& fault_;
    Scene scene_;
    std::unique_ptr<Scheme> inner_;
    long row_ = 0;
};

Descriptor spoiled(const Fault& fault) {
    Descriptor d = Spoiled::of_the_tree(fault);
    d.name = fault.name;
    d.own = &fault;
    d.make = [](const Descriptor& own, const Scene& scene,
                const Settings& settings) -> std::unique_ptr<Scheme> {
        return std::make_unique<Spoiled>(*static_cast<const Fault*>(own.own), scene, settings);
    };
    return d;
}

template <class Made>
Descriptor named(const char* name) {
    return {name, "a test", honest_features, Balance::exact, Clock::stepped, planted<Made>};
}

const Descriptor table[] = {
    named<Honest>("honest"),
    named<RefusesEveryScene>("refuses_every_scene"),
    named<IgnoresAFeature>("ignores_a_feature"),
    named<PlaysAnotherString>("plays_another_string"),
    named<StartsFromAnotherShape>("starts_from_another_shape"),
    named<InItsRows<starts_with_a_force>>("starts_with_a_force"),
    named<CarriesDoubleState>("carries_double_state"),
    named<KeepsStateAfterAReset>("keeps_state_after_a_reset"),
    named<InItsRows<gives_nan>>("gives_nan"),
    named<InItsRows<breaks_its_ledger_in_a_row>>("breaks_its_ledger_in_a_row"),
    named<InItsRows<breaks_its_ledger_in_sum>>("breaks_its_ledger_in_sum"),
    named<InItsRows<dissipates_less_than_nothing>>("dissipates_less_than_nothing"),
    named<InItsRows<depends_on_the_block_size>>("depends_on_the_block_size"),
    named<InItsRows<depends_on_the_probe>>("depends_on_the_probe"),
    named<AllocatesWhileStepping>("allocates_while_stepping"),
    named<MisstatesItsPartials>("misstates_its_partials"),
    named<WritesHalfAStepLate>("writes_half_a_step_late"),
    named<GainsEnergyAtALowRate>("gains_energy_at_a_low_rate"),
    named<InItsRows<doubles_its_ledger>>("doubles_its_ledger"),
    spoiled(faults[0]),
    spoiled(faults[1]),
    spoiled(faults[2]),
    spoiled(faults[3]),
    spoiled(faults[4]),
    spoiled(faults[5]),
    spoiled(faults[6]),
    spoiled(faults[7]),
    spoiled(faults[8]),
    spoiled(faults[9])};
}  // namespace

JVARI_PLUGIN(table)
