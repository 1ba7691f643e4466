// A comparison without the command line: two schemes, each with its own and with matched
// compliance, on a scene of the installed library.
#include <bench/compare/record/findings.hpp>
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
    const study::Cells cells = compare::cells_of(c);
    bool good = cells.size() == 4;
    for (const study::TabledCell& cell : cells) {
        const double error = cell.figure(study::measure("error_l2_10ms")).value;
        std::printf("%s %s %g\n", cell.variant().c_str(), cell.status.c_str(), error);
        good = good && error > 0 && error < 0.1;
    }
    return good ? 0 : 1;
}
