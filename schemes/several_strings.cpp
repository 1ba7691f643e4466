#include "schemes/several_strings.hpp"

#include <algorithm>

#include "schemes/impacts.hpp"

namespace jvari {

namespace {
constexpr int rows_at_a_time = 64;  // rows for one string before the next string's turn

struct OneOfSeveral {
    std::unique_ptr<Scheme> scheme;
    std::vector<HeardTap> taps;
};

void put(double* to, const double* from, int rows, bool first) noexcept {
    if (first) std::copy_n(from, rows, to);
    else
        for (int n = 0; n < rows; ++n) to[n] += from[n];
}

class SeveralStrings final : public Scheme {
public:
    SeveralStrings(std::vector<OneOfSeveral> strings, double steps_per_row)
        : strings_(std::move(strings)), steps_per_row_(steps_per_row) {
        std::size_t taps = 0;
        for (const OneOfSeveral& s : strings_) taps += s.taps.size();
        tap_.resize(rows_at_a_time * taps);
        energy_.resize(3 * rows_at_a_time * strings_.size());
        of_each_.resize(strings_.size());
    }

    void reset() noexcept override {
        for (auto& s : strings_) s.scheme->reset();
        done_ = 0;
    }
    Status advance(const Block& out) noexcept override {
        for (int from = 0; from < out.rows; from += rows_at_a_time) {
            Block part = out;
            part.rows = std::min(rows_at_a_time, out.rows - from);
            part.tap = out.tap + from;
            part.energy = out.energy ? out.energy + from : nullptr;
            const Status status = advance_part(part);
            if (status.outcome != Outcome::ok || out.stopped()) return status;
        }
        return {};
    }
    int dofs() const override {
        int sum = 0;
        for (const auto& s : strings_) sum += s.scheme->dofs();
        return sum;
    }
    std::vector<Fact> facts() const override {
        std::vector<Fact> all;
        for (std::size_t k = 0; k < strings_.size(); ++k)
            for (Fact& f : facts_of_string(static_cast<int>(k), strings_[k].scheme->facts()))
                all.push_back(std::move(f));
        return all;
    }
    std::vector<FreeMode> free_modes() const override {
        return strings_.front().scheme->free_modes();
    }

private:
    void advance_each(const Block& out, int rows) noexcept {
        double *tap = tap_.data(), *energy = energy_.data();
        for (std::size_t k = 0; k < strings_.size(); ++k) {
            auto& [own, status] = of_each_[k];
            own = out;
            own.rows = rows;
            own.taps = static_cast<int>(strings_[k].taps.size());
            own.stride = rows_at_a_time;
            own.tap = tap;
            own.energy = out.energy ? energy : nullptr;
            own.impacts = out.impacts ? out.impacts + k : nullptr;
            status = strings_[k].scheme->advance(own);
            tap += own.taps * own.stride;
            energy += 3 * own.stride;
        }
    }

    Status advance_part(const Block& out) noexcept {  // advances rows_at_a_time rows at most
        advance_each(out, out.rows);
        if (out.stopped()) return {};
        Status failed;
        int rows = out.rows;  // ends at the row with the first failure
        for (const auto& [own, status] : of_each_) {
            if (status.outcome == Outcome::ok ||
                (failed.outcome != Outcome::ok && status.step >= failed.step))
                continue;
            failed = status;
            rows = std::clamp(
                static_cast<int>(static_cast<long>(failed.step / steps_per_row_) + 1 - done_), 0,
                rows);
        }
        for (std::size_t k = 0; k < strings_.size(); ++k) {
            const Block& own = of_each_[k].first;
            for (std::size_t t = 0; t < strings_[k].taps.size(); ++t)
                put(out.tap + strings_[k].taps[t].column * out.stride, own.tap + t * own.stride,
                    rows, strings_[k].taps[t].first);
            for (int c = 0; own.energy && c < 3; ++c)
                put(out.energy + c * out.stride, own.energy + c * own.stride, rows, k == 0);
        }
        done_ += rows;
        if (rows < out.rows) step_anew(out);
        return failed;
    }

    // Repeats the run up to the end of the valid rows. A string's motion after another string's
    // failure thus enters none of its facts.
    void step_anew(Block out) noexcept {
        out.impacts = nullptr;
        for (auto& s : strings_) s.scheme->reset();
        for (long row = 0; row < done_; row += rows_at_a_time) {
            advance_each(out, static_cast<int>(std::min<long>(rows_at_a_time, done_ - row)));
            if (out.stopped()) return;
        }
    }

    std::vector<OneOfSeveral> strings_;
    double steps_per_row_;
    long done_ = 0;  // rows since the start
    std::vector<double> tap_, energy_;
    // for each string: the block last written, and its status
    std::vector<std::pair<Block, Status>> of_each_;
};

std::string of_string(int k) { return "string." + std::to_string(k); }

// Key in a single-string scene: "string.0.tension", "string.damping.file"
std::string renamed(const std::string& key, int k) {
    for (const std::string own : {"string.0.", "string."})
        if (key.starts_with(own)) return of_string(k) + "." + key.substr(own.size());
    return key;
}

}  // namespace

std::vector<HeardTap> heard_taps(const Scene& scene, int string, std::vector<bool>& heard_already) {
    std::vector<HeardTap> all;
    for (int t = 0; t < static_cast<int>(scene.taps.size()); ++t) {
        if (!hears(scene.taps[t], scene, string)) continue;
        all.push_back({t, !heard_already[t]});
        heard_already[t] = true;
    }
    return all;
}

std::vector<Fact> facts_of_string(int k, std::vector<Fact> facts) {
    for (Fact& f : facts) f.name.insert(0, of_string(k) + ".");
    return facts;
}

std::string named_after_string(int k, const char* refusal) { return of_string(k) + ": " + refusal; }

BadScene named_after_string(int k, const BadScene& e) {
    return {renamed(e.key, k), e.found, e.expected};
}

std::unique_ptr<Scheme> several_strings(const Descriptor& descriptor, const Scene& scene,
                                        const Settings& settings) {
    std::vector<OneOfSeveral> strings;
    std::vector<bool> heard_already(scene.taps.size(), false);
    for (int k = 0; k < static_cast<int>(scene.strings.size()); ++k) {
        auto scheme = made_of_string(
            scene, k, [&](const Scene& one) { return make_scheme(descriptor, one, settings); });
        strings.push_back({std::move(scheme), heard_taps(scene, k, heard_already)});
    }
    const bool continuous = descriptor.clock == Clock::continuous;
    return std::make_unique<SeveralStrings>(
        std::move(strings), continuous ? 1 : settings.sample_rate / settings.tap_rate);
}

}  // namespace jvari
