// A comparison without the command line: two schemes, each with its own and with matched
// compliance, on a scene of the installed library.
#include <bench/compare/record/compare_record.hpp>
#include <cstdio>

int main() {
    using namespace jvari::bench;
    compare::CompareRequest request;
    request.scene = "tanpura_c3_release";
    request.schemes = {"modal_two_point", "modal_quadratised"};
    request.rates = {44100};
    request.duration = 0.01;
    request.repeats = 1;
    const compare::Comparison c =
        compare::compare(request, compare::Catalogue(), store::Listener());
    const store::Table cells = compare::cells_of(c);
    bool good = cells.rows.size() == 4;
    for (std::size_t i = 0; i < cells.rows.size(); ++i) {
        std::printf("%s %s %s\n", cells.at(i, "scheme").c_str(), cells.at(i, "status").c_str(),
                    cells.at(i, "error_l2_10ms").c_str());
        good =
            good && cells.number(i, "error_l2_10ms") > 0 && cells.number(i, "error_l2_10ms") < 0.1;
    }
    return good ? 0 : 1;
}
