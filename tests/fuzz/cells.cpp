// Whatever the tables of a folder hold, their cells are read or refused with UsageError; what is
// read survives being written.
//
// The input is facts.csv, errors.csv and cost.csv, with a line "%" before the second and the third.
// There is no file of a table that it does not come to.
#include "bench/study/cells.hpp"

#include <array>

#include "bench/store/records.hpp"
#include "bench/store/usage.hpp"
#include "fuzz.hpp"

using namespace jvari::test;
using namespace jvari::bench::study;

namespace {
using Tables = std::array<std::string, 3>;

Tables tables_in(const std::string& input) {
    Tables tables;
    std::size_t from = 0;
    for (std::string& table : tables) {
        const std::size_t end = std::min(input.find("\n%\n", from), input.size());
        table = input.substr(from, end - from);
        from = std::min(end + 3, input.size());
    }
    return tables;
}

class OwnFolder {
public:
    OwnFolder() : path_(OwnFile("cells").path()) {
        std::filesystem::create_directory(path_);
        std::ofstream(path_ / "manifest.json") << "{}";
    }
    ~OwnFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    jvari::bench::store::Folder holding(const Tables& tables) {
        constexpr const char* names[] = {"facts.csv", "errors.csv", "cost.csv"};
        for (std::size_t k = 0; k < tables.size(); ++k) {
            if (tables[k].empty()) std::filesystem::remove(path_ / names[k]);
            else std::ofstream(path_ / names[k], std::ios::binary) << tables[k];
        }
        return jvari::bench::store::Folder(path_);
    }

private:
    std::filesystem::path path_;
};

Tables tables_of(const Cells& cells) {
    using jvari::bench::store::csv;
    return {csv(table_of(cells, Contents::facts)), csv(errors_table(cells)),
            csv(table_of(cells, Contents::cost))};
}
}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static OwnFolder folder;
    Cells cells;
    try {
        cells = read_cells(folder.holding(tables_in(text_of(data, size))), false);
    } catch (const jvari::bench::store::UsageError&) { return 0; }
    if (cells.empty()) return 0;  // there is no facts.csv
    ++inputs_read;
    for (const TabledCell& c : cells) c.run(), c.problem(), c.figure(0);
    const Tables written = tables_of(cells);
    promise(tables_of(read_cells(folder.holding(written), true)) == written,
            "written and read back is the same cells",
            written[0] + "%\n" + written[1] + "%\n" + written[2]);
    return 0;
}
