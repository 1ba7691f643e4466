#include "bench/judge/judge.hpp"

#include <fmt/core.h>
#include <algorithm>
#include <cmath>
#include <limits>

#include "bench/store/fresh_file.hpp"
#include "bench/store/records.hpp"
#include "bench/store/trace_file.hpp"
#include "bench/store/usage.hpp"
#include "scenes/wording.hpp"

namespace jvari::bench::judge {

namespace {
constexpr double near_row = 0.1;  // fraction of a row: other programs print six digits

double number_in(const store::Field& value, const std::string& where) {  // NaN and inf are numbers
    const std::string field = value.text();
    const auto from = field.find_first_not_of(" \t\r"), to = field.find_last_not_of(" \t\r");
    if (from == std::string::npos)
        throw store::UsageError(where + ": found nothing, expected a number");
    const auto x = number_of(std::string_view(field).substr(from, to + 1 - from));
    if (!x)
        throw store::UsageError(
            fmt::format("{}: found {}, expected a number", where, found_text(field)));
    return *x;
}

store::Table table_in(const std::filesystem::path& path, const std::string& text) {
    try {
        return store::read_csv(text);
    } catch (const std::runtime_error& e) {
        throw store::UsageError(
            fmt::format("{}: {}. Is the file cut off?", path.string(), e.what()));
    }
}

int column_of(const store::Table& t, const std::filesystem::path& path, const std::string& name,
              const char* what) {
    const int k = t.column(name);
    if (k >= 0) return k;
    const bool semicolons =
        t.columns.size() == 1 && t.columns[0].find_first_of(";\t") != std::string::npos;
    throw store::UsageError(fmt::format(
        "{}: {} {} is missing; the file has the columns {}{}", path.string(), what, name,
        list_of(t.columns),
        semicolons ? ". Expected commas between columns, and points in numbers, as 0.5" : ""));
}

void check_times(const store::Table& t, const std::filesystem::path& path, double tap_rate) {
    const auto time = static_cast<std::size_t>(column_of(t, path, "time_s", "the column"));
    for (std::size_t n = 0; n < t.rows.size(); ++n) {
        const std::string where = fmt::format("{}: line {}", path.string(), n + 2);
        const double found = number_in(t.rows[n][time], where),
                     due = static_cast<double>(n) / tap_rate;
        if (!(std::abs(found - due) * tap_rate <= near_row))
            throw store::UsageError(
                fmt::format("{}: row {} is at {:.9g} s, expected {:.9g} s: rows are at n/{:.12g} "
                            "s, from the start on",
                            where, n, found, due, tap_rate));
    }
}

Trace empty_trace(const Scene& scene, double tap_rate, std::size_t rows) {
    Trace trace;
    trace.tap_rate = tap_rate;
    trace.rows = trace.stride = static_cast<long>(rows);
    for (const Tap& tap : scene.taps) trace.names.push_back(tap.name);
    trace.tap.resize(rows * scene.taps.size());
    return trace;
}

void copy_column(const store::Table& t, const std::filesystem::path& path, int column, double* to) {
    for (std::size_t n = 0; n < t.rows.size(); ++n)
        to[n] = number_in(t.rows[n][static_cast<std::size_t>(column)],
                          fmt::format("{}: line {}", path.string(), n + 2));
}

Trace from_csv(const std::filesystem::path& path, const Scene& scene, double tap_rate, long rows) {
    const std::string text = store::read_whole(path);
    const store::Table t = table_in(path, text);
    if (!text.ends_with('\n'))
        throw store::UsageError(
            fmt::format("{}: line {} does not end with a line break, so its last number may be cut "
                        "off; end the file with one where it is whole",
                        path.string(), t.rows.size() + 1));
    Trace trace = empty_trace(scene, tap_rate, t.rows.size());
    std::vector<int> columns;
    for (const std::string& name : trace.names) columns.push_back(column_of(t, path, name, "tap"));
    check_times(t, path, tap_rate);
    check_rows(trace, path.string(), rows);
    for (std::size_t k = 0; k < columns.size(); ++k)
        copy_column(t, path, columns[k], trace.tap.data() + k * t.rows.size());
    const bool energy = std::ranges::all_of(store::energy_names,
                                            [&t](const char* name) { return t.column(name) >= 0; });
    if (energy) trace.energy.resize(3 * t.rows.size());
    for (std::size_t k = 0; energy && k < 3; ++k)
        copy_column(t, path, t.column(store::energy_names[k]),
                    trace.energy.data() + k * t.rows.size());
    if (const auto odd =
            std::ranges::find_if_not(trace.energy, [](double x) { return std::isfinite(x); });
        odd != trace.energy.end() && no_number_in(trace).empty()) {
        const std::size_t at = static_cast<std::size_t>(odd - trace.energy.begin());
        throw store::UsageError(fmt::format(
            "{}: column {} holds no number in row {}; leave the three energy columns out where "
            "there is none",
            path.string(), store::energy_names[at / t.rows.size()], at % t.rows.size()));
    } else if (odd != trace.energy.end()) {
        trace.energy.clear();  // trace of a failed scheme
    }
    return trace;
}

Trace from_wav(const std::filesystem::path& path, const Scene& scene, double tap_rate, long rows) {
    if (scene.taps.size() != 1)
        throw store::UsageError(
            fmt::format("{}: a sound is of one tap, the scene has {}: say which by --tap NAME",
                        path.string(), scene.taps.size()));
    const store::Signal signal = store::read_signal(path);
    if (signal.rate != tap_rate)
        throw store::UsageError(
            fmt::format("{}: has {} samples a second, expected {}, as many as rows", path.string(),
                        signal.rate, tap_rate));
    Trace trace = empty_trace(scene, tap_rate, signal.samples.size());
    trace.tap = signal.samples;
    check_rows(trace, path.string(), rows);
    return trace;
}
}  // namespace

void check_rows(const Trace& trace, const std::string& what, long rows) {
    if (trace.rows > rows)
        throw store::UsageError(fmt::format(
            "{}: has {} rows, the scene has {}: {:.9g} s at {:.12g} rows a second, and the start",
            what, trace.rows, rows, static_cast<double>(rows - 1) / trace.tap_rate,
            trace.tap_rate));
    if (trace.rows == 0) throw store::UsageError(what + ": has no row");
}

void must_be_whole(const Trace& trace, const std::string& what, long rows) {
    check_rows(trace, what, rows);
    if (trace.rows < rows)
        throw store::UsageError(fmt::format(
            "{}: has {} rows, the scene has {}: it stops early. To judge what is there, add "
            "--duration {:.12g}",
            what, trace.rows, rows, static_cast<double>(trace.rows - 1) / trace.tap_rate));
}

std::string no_number_in(const Trace& trace) {
    for (long row = 0; row < trace.rows; ++row)
        for (int k = 0; k < trace.taps(); ++k)
            if (!std::isfinite(trace.column(k)[static_cast<std::size_t>(row)]))
                return fmt::format("tap {} holds no number in row {}, at {:.6g} s",
                                   trace.names[static_cast<std::size_t>(k)], row,
                                   static_cast<double>(row) / trace.tap_rate);
    return "";
}

namespace {
// Checks the size before reading: at most 64 characters a number, and a few additional columns.
void check_size(const std::filesystem::path& path, std::size_t taps, double tap_rate, long rows) {
    constexpr double number = 64, header = 1e6;
    std::error_code error;  // the reader reports the error
    const double size = static_cast<double>(std::filesystem::file_size(path, error));
    const double most = header + number * static_cast<double>(taps + 8) * static_cast<double>(rows);
    if (!error && size > most)
        throw store::UsageError(
            fmt::format("{}: has {:.0f} MB, and {} rows of {} taps, {:.9g} s at {:.12g} rows a "
                        "second, take {:.0f} MB at most",
                        path.string(), 1e-6 * size, rows, taps,
                        static_cast<double>(rows - 1) / tap_rate, tap_rate, 1e-6 * most));
}
}  // namespace

Trace read_trace(const std::filesystem::path& path, const Scene& scene, double tap_rate,
                 long rows) {
    check_size(path, scene.taps.size(), tap_rate, rows);
    const std::string extension = path.extension().string();
    if (extension == ".wav") return from_wav(path, scene, tap_rate, rows);
    if (extension == ".csv") return from_csv(path, scene, tap_rate, rows);
    throw store::UsageError(fmt::format("{}: found the extension \"{}\", expected .csv or .wav",
                                        path.string(), extension));
}

namespace {
class Played final : public Scheme {
public:
    explicit Played(std::shared_ptr<const Trace> trace) : trace_(std::move(trace)) {}
    void reset() noexcept override { row_ = 0; }
    Status advance(const Block& out) noexcept override {
        for (int n = 0; n < out.rows; ++n, ++row_) {
            const bool there = row_ < trace_->rows;
            for (int k = 0; k < out.taps; ++k)
                out.tap[n + k * out.stride] = there ? trace_->tap[row_ + k * trace_->stride]
                                                    : std::numeric_limits<double>::quiet_NaN();
            if (!out.energy) continue;
            const bool balanced = there && !trace_->energy.empty();
            for (int k = 0; k < 3; ++k)
                out.energy[n + k * out.stride] =
                    balanced ? trace_->energy[row_ + k * trace_->stride] : 0;
        }
        return {};
    }
    int dofs() const override { return 0; }

private:
    std::shared_ptr<const Trace> trace_;
    long row_ = 0;
};
}  // namespace

std::unique_ptr<Scheme> played(std::shared_ptr<const Trace> trace) {
    return std::make_unique<Played>(std::move(trace));
}

}  // namespace jvari::bench::judge
