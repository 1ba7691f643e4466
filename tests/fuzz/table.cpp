// Whatever bytes come, a table of CSV or JSON is read or refused with std::exception; what is read
// survives being written as either. So do numbers, and bytes as base64 text.
#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "bench/store/encoding.hpp"
#include "bench/store/json.hpp"
#include "bench/store/records.hpp"
#include "fuzz.hpp"

using namespace jvari;
using namespace jvari::test;

namespace {
// A row of one empty field is an empty line, and that is no row.
bool written_as_nothing(const bench::store::Table& t) {
    if (t.columns.size() != 1) return false;
    for (const auto& row : t.rows)
        if (row[0].empty()) return true;
    return t.columns[0].empty();
}
}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string text = test::text_of(data, size);
    try {
        const bench::store::Table t = bench::store::read_csv(text);
        ++inputs_read;
        for (std::size_t i = 0; i < t.rows.size(); ++i)
            for (const std::string& name : t.columns) {
                const double x = t.number(i, name);
                promise(
                    std::isnan(x) || bench::store::number_of(jvari::bench::store::text_of(x)) == x,
                    "a number reads back as itself", t.text(i, name));
            }
        const auto json = table_json(t);
        promise(table_json(bench::store::table_in(json)) == json, "JSON reads back as itself",
                bench::store::compact(json));
        if (!t.columns.empty() && !written_as_nothing(t)) {
            const bench::store::Table again = bench::store::read_csv(bench::store::csv(t));
            promise(table_json(again) == table_json(t), "written and read back is the same table",
                    bench::store::csv(t));
        }
    } catch (const std::runtime_error&) {}
    try {
        bench::store::table_in(bench::store::parsed(text));
        ++inputs_read;
    } catch (const std::exception&) {}
    promise(bench::store::bytes_of_base64(bench::store::base64(text)) == text,
            "bytes survive base64", text);
    try {
        bench::store::bytes_of_base64(text);
    } catch (const std::runtime_error&) {}
    return 0;
}
