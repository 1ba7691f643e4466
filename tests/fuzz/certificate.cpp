// Whatever a certificate holds under a checksum that is its own, it is read or refused; what is
// read survives being written, and says of every reference, over any time, what it is certain to.
//
// The input is a certificate without its checksum and its outer braces.
#include <nlohmann/json.hpp>

#include "bench/store/encoding.hpp"
#include "bench/study/certificate_library.hpp"
#include "fuzz.hpp"

using namespace jvari;
using namespace jvari::test;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static OwnFile file("certificate.json"), costs("certificate.cost.json");
    const std::string text = test::text_of(data, size);
    auto kept =
        bench::study::read_certificate(file.holding(bench::store::sealed("{" + text + "}")));
    if (!kept) return 0;
    ++inputs_read;
    costs.holding(bench::store::sealed("{" + text + "}"));
    bench::study::read_costs(file.path(), *kept);
    for (const auto& entry : kept->entries)
        for (const double until : {0.005, 0.05, 1.0, 1e300}) {
            const bench::study::Trust trust =
                bench::study::trust_of(*kept, entry.reference, entry.options, until);
            for (std::size_t tap = 0; tap < trust.figure.size(); ++tap)
                for (std::size_t window = 0; window < 3; ++window) trust.of_scene(tap, window);
            promise(trust.any() == trust.missing.empty(), "figures, or why there are none",
                    trust.missing);
        }
    std::string written;
    try {
        written = bench::study::json_of(*kept);
    } catch (const nlohmann::json::exception&) {
        // text that is no UTF-8: a certificate is of scenes that were read
        return 0;
    }
    const auto again = bench::study::read_certificate(file.holding(written));
    promise(again && bench::study::json_of(*again) == written,
            "written and read back is the same certificate", written);
    return 0;
}
