// Whatever the record of a cell holds under a checksum that is its own, it is read or not believed;
// what is read survives being written.
//
// The input is a record without the cell that it is of, which is put in front, and without its last
// brace.
#include <nlohmann/json.hpp>

#include "bench/store/encoding.hpp"
#include "bench/study/record.hpp"
#include "fuzz.hpp"
#include "schemes/registry.hpp"

using namespace jvari;
using namespace jvari::test;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static OwnFile file("cell.json");
    const std::string text = test::text_of(data, size), identity = R"({"scene":"a"})";
    static const bench::study::Cell planned{&schemes().front(), {}};
    const auto record = bench::study::read_record(
        file.holding(bench::store::sealed("{\"of\":" + identity + "," + text + "}")), identity,
        planned);
    if (!record) return 0;
    ++inputs_read;
    record->cell.status();
    const std::string written = bench::study::json_of(*record, identity);
    const auto again = bench::study::read_record(file.holding(written), identity, planned);
    promise(again && bench::study::json_of(*again, identity) == written,
            "written and read back is the same record", written);
    return 0;
}
