// Expands a request into the option sets and the numbers of modes to run.
//
// A request names some of it. The rest is sought (CompareRequest::search), because the cheapest
// scheme may take more modes than those below 20 kHz, or matched compliance:
//   modes        1, 1.35, 2, 3 and 4 times those below 20 kHz, at rates above twice the frequency
//                of the highest. Below, `jvari trim` looks.
//   compliance   own and matched, of a scheme that has both, where something touches the string.
// Nothing is sought of a scheme in continuous time, or against a reference with a cell's own modes.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "bench/compare/catalogue.hpp"
#include "schemes/scheme.hpp"

namespace jvari::bench::compare {

struct Form {
    OptionValues options;
    std::vector<double> rates;  // [Hz]; a form that was sought has those at which it can be made
};

class Untried {  // what was sought and cannot be made, and why
public:
    void add(const Descriptor&, const std::vector<double>& rates, bool at_all,
             const std::string& reason);
    std::vector<std::string> notes() const;  // a sentence for each reason

private:
    std::map<std::string, std::string> who_;  // by reason
};

// Of a scheme each combination of the values asked for; `used`: which of them it takes. UsageError
// where one option is asked for all schemes and for this one.
std::vector<OptionValues> combinations_of(const std::vector<SchemeOption>&, const Descriptor&,
                                          std::vector<bool>& used);
// Throws UsageError where one is taken by no scheme.
void must_be_used(const std::vector<SchemeOption>&, const std::vector<bool>& used);
bool sets(const OptionValues&, const Option&);
bool touched(const Scene&);  // something touches a string

std::vector<Form> forms_of(const CompareRequest&, const Descriptor&, const Scene&, const Settings&,
                           const std::vector<double>& rates, std::vector<bool>& used, Untried&);

// The most modes that are sought: 4 times `unasked`, as far as half the rate allows on each string,
// but `unasked` at least.
int most_modes_sought(const Scene&, int unasked, double rate);

struct Rung {
    int modes;                  // 0: the scheme's own
    std::vector<double> rates;  // [Hz]
    bool added;                 // sought, beside those that it takes unasked
};
// `settings`: with the modes that it takes unasked.
std::vector<Rung> rungs_of(const CompareRequest&, const Descriptor&, const Scene&, const Settings&,
                           const std::vector<double>& rates);

}  // namespace jvari::bench::compare
