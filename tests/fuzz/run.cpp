// Whatever a kept run holds under a checksum that is its own, it is read whole or not believed;
// what is read survives being written. So is a WAV file read or refused with UsageError.
#include <algorithm>
#include <cstring>

#include "bench/store/encoding.hpp"
#include "bench/store/trace_file.hpp"
#include "bench/store/usage.hpp"
#include "bench/study/reference.hpp"
#include "fuzz.hpp"

using namespace jvari;
using namespace jvari::test;

namespace {
bool same_bits(std::span<const double> a, std::span<const double> b) {  // NaN too
    return a.size() == b.size() &&
           (a.empty() || std::memcmp(a.data(), b.data(), a.size_bytes()) == 0);
}
}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static OwnFile file("kept.run"), sound("sound.wav");
    const std::string text = test::text_of(data, size), key = "key";
    try {
        bench::store::read_wav(sound.holding(text), 1.0);
    } catch (const bench::store::UsageError&) {}
    const auto run = bench::study::read_run(file.holding(bench::store::hash_of(text) + text), key);
    if (!run) return 0;
    ++inputs_read;
    bench::study::write_run(file.path(), key, *run);
    const auto again = bench::study::read_run(file.path(), key);
    promise(again.has_value(), "what is written is read back");
    promise(again->trace.names == run->trace.names && again->trace.rows == run->trace.rows,
            "with its columns");
    for (int k = 0; k < run->trace.taps(); ++k)
        promise(same_bits(again->trace.column(k), run->trace.column(k)), "bit for bit");
    return 0;
}
