#include "bench/compare/advice.hpp"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <span>
#include <string_view>

#include "bench/compare/compare_plan.hpp"
#include "bench/compare/scene_notes.hpp"
#include "bench/store/records.hpp"
#include "bench/store/system/interruption.hpp"
#include "bench/store/usage.hpp"
#include "bench/study/errors.hpp"
#include "reference/agreement.hpp"
#include "scenes/excitation.hpp"
#include "scenes/modes.hpp"
#include "scenes/pitch.hpp"
#include "schemes/contact/compliance.hpp"
#include "schemes/making.hpp"
#include "schemes/run.hpp"

namespace jvari::bench::compare {

namespace {
constexpr double periods = 8;  // A period has about one contact, so problems are equally hard.
constexpr std::array rungs{1, 2, 4, 8, 16, 32};  // multiples of the tap rate
constexpr double of_rate = 0.49;                 // highest mode over the rate
constexpr double rise = 1.5;                     // ratio of modes, finer run over the first
constexpr double enough = 0.4;                   // share of own's modes that must allow matching
constexpr double fall = 3;      // largest fall of the estimate from one rung to the next
constexpr double margin = 2.5;  // an estimate within a tolerance includes this factor
// numbers of modes; at least twice those below 20 kHz
constexpr int fewest = 5, most_needed = 1400;
constexpr double patience = 20;  // limit for all runs [s of processor]

// Schemes with an error that two runs can estimate: first own and matched compliance, in order of
// preference; then matched only.
constexpr const char *with_a_record[] = {"modal_two_moment", "modal_two_point"},
                     *matched_alone[] = {"modal_spatial_newton", "modal_quadratised"};

constexpr double known_to = 0.1;  // estimated error of a waveform that counts as known

// Number of rows in the longest window, from the first row on, over which the estimate is at most
// known_to; NaN: all rows.
double agreement_until(const std::vector<double>& coarse, const std::vector<double>& fine) {
    constexpr double share = known_to / margin;
    const std::size_t rows = std::min(coarse.size(), fine.size());
    double apart = 0, all = 0;
    std::size_t until = 0;
    for (std::size_t n = 0; n < rows; ++n) {
        apart += (coarse[n] - fine[n]) * (coarse[n] - fine[n]);
        all += fine[n] * fine[n];
        if (apart <= share * share * all) until = n + 1;
    }
    return until < rows ? static_cast<double>(until) : nan;
}

bool is_among(std::span<const char* const> names, const Descriptor& d) {
    return std::ranges::find(names, std::string_view(d.name)) != names.end();
}

// Prober for a scene with only the judged tap and the judged duration.
class Prober {
public:
    Prober(Advice& advice, Scene scene, OptionValues options, const store::Listener& listener)
        : a_(advice),
          scene_(std::move(scene)),
          options_(std::move(options)),
          from_(free_from(scene_)),
          progress_(listener.begin("advice on " + scene_.name)) {
        for (const String& s : scene_.strings)
            for (const Barrier& b : s.barriers) rigid_ = rigid_ || is_rigid(b);
    }

    void probe(const Descriptor& scheme) {
        scheme_ = &scheme;
        double before = 0;  // difference on the rung below
        const double unlike = a_.target.unit == "%" ? 1 : HUGE_VAL;
        try {
            for (const int k : rungs) {
                const auto pair = pair_at(k * a_.settings.tap_rate);
                if (!pair) continue;
                const double d = difference(pair->coarse, pair->fine);
                take(*pair, d, before);
                if (a_.within) return halve(*pair, before);
                before = std::isfinite(d) ? d : unlike;
            }
        } catch (const store::PastItsLimit&) {
            a_.ended = fmt::format("a higher rate would take more than {:g} s", patience);
        }
        if (!a_.scheme && a_.ended.empty()) a_.ended = refused_;
    }

private:
    struct Pair {
        Settings coarse, fine;
    };

    // ---- Modes and compliance on a rung

    int most_modes(double rate) const {
        int most = jvari::most_modes;
        for (const String& s : scene_.strings) {
            most = std::min({most, modes_below(s, of_rate * rate),
                             std::max(most_needed, 2 * modes_below(s, 20e3))});
            if (const auto rows = modes_measured(s)) most = std::min(most, *rows);
        }
        return most;
    }

    Settings settings(double rate, int modes, const std::string& compliance, bool finer) const {
        Settings s{rate, a_.settings.tap_rate, modes, options_};
        if (!compliance.empty()) s.options.emplace_back(compliance_option.name, compliance);
        if (!finer || !needed_by(scene_).any(any_profile) ||
            !declares(*scheme_, profile_points_option.name))
            return s;
        const double points = 2 * number_option(s, profile_points_option);
        std::erase_if(s.options, [](auto& o) { return o.first == profile_points_option.name; });
        s.options.emplace_back(profile_points_option.name, fmt::format("{:g}", points));
        return s;
    }

    // Makes the scheme once, for the question whether it can be made and for its run.
    void make(const Settings& s) {
        const std::string key = settings_text(*scheme_, s);
        if (rows_.contains(key) || made_.contains(key)) return;
        made_.emplace(key, make_scheme(*scheme_, scene_, s));
    }

    // Largest possible number from `modes` down to that share; 0: none can be made.
    int taken(double rate, int modes, const std::string& compliance, bool finer, double share) {
        for (int n = modes; n >= 1 && n >= share * modes; n = n * 4 / 5) {
            try {
                make(settings(rate, n, compliance, finer));
                return n;
            } catch (const BadOption&) { throw; } catch (const Refusal& e) {
                refused_ = e.what();
            }
        }
        return 0;
    }

    // `share`: minimum share of the modes possible with own compliance
    std::optional<Pair> pair_with(double rate, const std::string& compliance, double share) {
        const int all = most_modes(2 * rate), most = taken(2 * rate, all, compliance, true, share);
        // a table of measured modes has no more
        const bool complete = std::ranges::all_of(
            scene_.strings, [=](const String& s) { return modes_measured(s) == most; });
        const auto risen_to = [=](int modes) {
            return complete ? modes : static_cast<int>(modes / rise);
        };
        const int own = std::min(most_modes(rate), risen_to(all)),
                  n = taken(rate, std::min(own, risen_to(most)), compliance, false, share);
        if (n == 0 || most == 0 || n < share * own) return std::nullopt;
        const int twice = taken(2 * rate, std::min(most, 2 * n), compliance, true, 1);
        return Pair{settings(rate, n, compliance, false),
                    settings(2 * rate, twice > 0 ? twice : most, compliance, true)};
    }

    std::optional<Pair> pair_at(double rate) {
        if (!touched(scene_)) return pair_with(rate, "", 1);
        if (sets(options_, compliance_option)) return pair_with(rate, "", 0);
        if (auto matched = pair_with(rate, "matched", rigid_ ? 0 : enough)) return matched;
        if (rigid_ || !is_among(with_a_record, *scheme_)) return std::nullopt;
        return pair_with(rate, "own", 1);
    }

    // ---- Runs and their differences

    // judged rows; empty if the run failed or is silent
    const std::vector<double>& rows_of(const Settings& s) {
        const std::string key = settings_text(*scheme_, s);
        if (const auto known = rows_.find(key); known != rows_.end()) return known->second;
        make(s);
        const auto scheme = made_.extract(key);
        std::vector<double>& kept = rows_[key];
        RunOptions options;
        // An exact balance needs no look at its energy, which takes as long as many rows do.
        options.timed = scheme_->balance == Balance::exact;
        options.progress = store::within(
            patience - a_.seconds,
            [this, &s](long done, long all) {
                progress_->show(0.5 * static_cast<double>(done) / static_cast<double>(all),
                                fmt::format("{:g} kHz", s.sample_rate / 1000));
            },
            0.05);
        const Run r = run(*scheme.mapped(), scene_, s, options);
        a_.seconds = store::processor_seconds() - start_;
        if (r.status.outcome != Outcome::ok) return kept;
        const auto rows = rows_from(r.trace.column(0), from_, r.trace.tap_rate);
        if (std::ranges::any_of(rows, [](double x) { return x != 0; }))
            kept.assign(rows.begin(), rows.end());
        return kept;
    }

    double difference(const Settings& coarse, const Settings& fine) {  // NaN: no answer
        const std::vector<double>&a = rows_of(coarse), &b = rows_of(fine);
        if (a.empty() || b.empty()) return nan;
        return study::error_of(a_.target.measure, a, b, a_.settings.tap_rate);
    }

    // Keeps the pair if it is the nearest so far.
    void take(const Pair& pair, double d, double before) {
        const double counted = std::max(d, before / fall);
        if (!std::isfinite(d) || !std::isfinite(counted)) return;
        const bool within = margin * counted <= a_.target.most;
        if (!within && counted >= a_.counted) return;
        a_.scheme = scheme_;
        a_.settings = pair.coarse, a_.finer = pair.fine;
        a_.difference = d, a_.counted = counted, a_.margin = margin;
        a_.within = within;
        if (study::is_waveform(a_.target.measure))
            a_.known_for =
                agreement_until(rows_of(pair.coarse), rows_of(pair.fine)) / a_.settings.tap_rate;
    }

    void halve(Pair pair, double before) {
        while (pair.coarse.modes >= 2 * fewest) {
            pair.coarse.modes /= 2;
            try {
                const double d = difference(pair.coarse, pair.fine);
                if (!(margin * std::max(d, before / fall) <= a_.target.most)) return;
                take(pair, d, before);
            } catch (const Refusal&) { return; }
        }
    }

    Advice& a_;
    const Scene scene_;
    const OptionValues options_;
    const double from_;  // [s]
    bool rigid_ = false;
    const Descriptor* scheme_ = nullptr;
    const double start_ = store::processor_seconds();
    std::map<std::string, std::unique_ptr<Scheme>> made_;  // by settings, before their run
    std::map<std::string, std::vector<double>> rows_;      // by settings
    std::string refused_;
    std::unique_ptr<store::Progress> progress_;
};

const Descriptor& scheme_for(const Scene& scene, const AdviceRequest& r,
                             const Catalogue& catalogue) {
    if (!r.scheme.empty()) {
        const Descriptor& d = catalogue.find(r.scheme);
        if (!is_among(with_a_record, d) && !is_among(matched_alone, d))
            throw Refusal(fmt::format(
                "{}: two runs do not tell its error, for they share what the scheme makes of the "
                "scene. Expected {}; or name --rate and --modes in place of --within",
                d.name, fmt::join(with_a_record, ", ")));
        return d;
    }
    for (const char* name : with_a_record)
        if (const Descriptor& d = catalogue.find(name); represents(d, scene)) return d;
    std::vector<std::string> others;
    for (const auto* list : {&catalogue.schemes, &catalogue.references})
        for (const Descriptor* d : *list)
            if (represents(*d, scene)) others.emplace_back(d->name);
    throw Refusal(
        fmt::format("scene {} needs {}: no scheme whose error two runs tell represents "
                    "it. Name a scheme by --scheme: {}",
                    scene.name, names_of(needed_by(scene)), fmt::join(others, ", ")));
}

Advice advice_of(const Scene& whole, const AdviceRequest& r, const Catalogue& catalogue,
                 const store::Listener& listener) {
    Advice a;
    a.target = target_of(r.measure.empty() ? "l2_whole" : r.measure, r.within);
    // no population has tested what two runs tell of what is heard
    const bool waveform =
        study::is_waveform(a.target.measure) && !study::measures()[a.target.measure].heard;
    if (!waveform && a.target.name != "third_octave_db")
        throw store::UsageError(
            fmt::format("--of {}: found no record of what two runs tell of it, expected a waveform "
                        "(l2_10ms, l2_50ms, l2_whole) or third_octave_db",
                        r.measure));
    const Descriptor& scheme = scheme_for(whole, r, catalogue);
    Scene scene = whole;
    const int tap = tap_named(scene, r.tap);
    scene.taps = {scene.taps[r.tap.empty() ? study::headline_of(scene).nut : tap]};
    a.tap = scene.taps.front().name;
    const double from = free_from(scene), left = scene.duration - from,
                 window = r.measure.empty() ? periods / lowest_pitch(scene)
                                            : study::measures()[a.target.measure].window;
    a.periods = r.measure.empty() && window <= left;
    a.window = std::min(window, left);
    if (window > left)
        a.target.measure = a.target.name == "third_octave_db" ? a.target.measure
                                                              : study::measure("error_l2_whole");
    scene.duration = from + a.window;
    if (!(left > 0))
        throw Refusal(
            fmt::format("scene {} ends before its pluck does: nothing can be judged", whole.name));
    const double tap_rate = r.tap_rate.value_or(44100);
    const Settings s = settings_of_run(scheme, tap_rate, tap_rate, 0, r.options);
    if (is_among(matched_alone, scheme) &&
        std::ranges::find(s.options, std::pair<std::string, std::string>("compliance", "own")) !=
            s.options.end())
        throw Refusal(
            fmt::format("{}: two runs do not tell its error with compliance=own, which "
                        "hardly falls while rate and modes rise together",
                        scheme.name));
    a.settings.tap_rate = tap_rate;
    require_rows(scene, s);
    Prober(a, std::move(scene), s.options, listener).probe(scheme);
    return a;
}
}  // namespace

bool asks_for_advice(const AdviceRequest& r, bool names_rate, int modes) {
    if (r.within.empty() && !(r.measure.empty() && r.tap.empty()))
        throw store::UsageError("--of and --tap go with --within ERROR");
    if (r.within.empty() && !r.scheme.empty()) return false;
    if (names_rate || modes != 0)
        throw store::UsageError(
            r.within.empty() ? "--rate and --modes go with --scheme NAME"
                             : "--within chooses rate and modes: expected no --rate, no --modes");
    return true;
}

std::vector<Advice> advise(const Scene& scene, const AdviceRequest& request,
                           const Catalogue& catalogue, const store::Listener& listener) {
    AdviceRequest r = request;
    if (r.within.empty()) r.within = "1%";
    std::vector<Advice> all{advice_of(scene, r, catalogue, listener)};
    if (all.back().within || !request.within.empty()) return all;
    r.within = "3dB", r.measure = "third_octave_db";
    all.push_back(advice_of(scene, r, catalogue, listener));
    all.back().known_for = all.front().known_for;
    return all;
}

bool is_to_run(const Advice& a, const std::string& within) {
    return a.scheme && (a.within || within.empty());
}

namespace {
std::string horizon_text(const Advice& a) {
    if (std::isnan(a.known_for)) return "";
    return fmt::format(
        "the waveform of {} is known to {:g} % for the first {} only, over which two runs differ "
        "by "
        "{:g} %; ",
        a.tap, 100 * known_to, time_text(a.known_for), 100 * known_to / margin);
}

std::string answer_text(const Advice& a) {
    const Target& t = a.target;
    std::string window =
        (a.periods ? fmt::format("{:g} periods, ", periods) : "") + time_text(a.window);
    if (study::is_waveform(t.measure)) window = "waveform of " + a.tap + ", " + window;
    else window = t.title + " of " + a.tap + ", " + window;
    if (!a.scheme)
        return fmt::format("nothing is known to be within {} ({}): {}", t.text(t.most), window,
                           a.ended.empty() ? "no run at twice the rate has more modes" : a.ended);
    const double bound = a.margin * a.counted;
    const std::string settings = settings_text(*a.scheme, a.settings);
    if (!a.within)
        return fmt::format(
            "nothing is known to be within {} ({}){}; nearest: {}, within {} by an estimate: try "
            "--within {:.2g}{}{}",
            t.text(t.most), window, a.ended.empty() ? "" : ", and " + a.ended, settings,
            t.text(bound), 1.05 * (t.unit == "%" ? 100 * bound : bound), t.unit,
            t.unit == "%" ? "" : " --of " + t.name);
    std::string finer = fmt::format("twice the rate and {} modes", a.finer.modes);
    if (const auto& more = a.finer.options; more.size() > a.settings.options.size())
        finer += fmt::format(" and {} points", more.back().second);
    return fmt::format(
        "{}: estimated error {} ({}); {} move it by {}{}, and {:g} times that is within {}",
        settings, t.text(a.counted), window, finer, t.text(a.difference),
        a.counted > a.difference ? ", counted as a third of what the rate below moved by" : "",
        a.margin, t.text(t.most));
}
}  // namespace

std::string text_of(const Advice& a) {
    return a.within && study::is_waveform(a.target.measure) ? answer_text(a)
                                                            : horizon_text(a) + answer_text(a);
}

std::string short_text(const Advice& a) {
    const Target& t = a.target;
    if (!a.scheme) return "nothing for " + t.text(t.most);
    return fmt::format("{} for {} of {}, estimated {}", settings_text(*a.scheme, a.settings),
                       t.text(t.most), study::is_waveform(t.measure) ? "the waveform" : t.title,
                       t.text(a.counted));
}

nlohmann::ordered_json json_of(const Advice& a) {
    nlohmann::ordered_json j{{"within", a.within},         {"tolerance", a.target.most},
                             {"measure", a.target.name},   {"tap", a.tap},
                             {"window_s", a.window},       {"estimate", a.counted},
                             {"difference", a.difference}, {"margin", a.margin},
                             {"processor_s", a.seconds},   {"text", text_of(a)}};
    if (!a.scheme) return j;
    j["scheme"] = a.scheme->name;
    j["options"] = store::options_text(a.settings.options);
    j["rate"] = a.settings.sample_rate;
    j["modes"] = a.settings.modes;
    return j;
}

}  // namespace jvari::bench::compare
