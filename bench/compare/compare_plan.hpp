// What a comparison is going to run: which cells at which settings, which references to try in
// turn.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "bench/compare/catalogue.hpp"
#include "bench/study/job.hpp"
#include "schemes/scheme.hpp"

namespace jvari::bench::compare {

// The rows per second that cells at these rates are compared on; throws UsageError where there are
// none.
double tap_rate_for(const CompareRequest&, const std::vector<double>& rates);

// BadScene where the scene has no row at that tap rate, UsageError where its rows do not fit in
// memory.
void require_rows(const Scene&, const Settings&);

// Adds the cells of a comparison as jobs like `like`, and what they are compared on:
// points like `common`, with references and reference modes as asked.
//
// One point where all rates have rows in common: 44100 a second, else as many as the lowest rate.
// Rates that have none, as 44100 and 48000, are on several points, each with rows and references of
// its own. Nothing is resampled: a force is a mean over the interval between two rows, and its
// reference is the mean over the same interval. What steps in continuous time is on the first point
// alone.
//
// Throws UsageError for names that do not exist and rates that --tap-rate does not divide, Refusal
// where no scheme represents the scene.
void add_jobs(study::Plan& into, const CompareRequest&, const Catalogue&,
              const study::Point& common, const study::Job& like);

// The references of the first of these points, and nothing else of it.
std::vector<study::ReferenceChoice> references_of(const CompareRequest&, const Catalogue&,
                                                  const Scene&);

// ---- Expands a request into the option sets and the numbers of modes to run.
//
// A request names some of it. The rest is sought (CompareRequest::search), because the cheapest
// scheme may take more modes than those below 20 kHz, or matched compliance:
//   modes        1, 1.5, 2, 3 and 4 times those below 20 kHz, at rates above twice the frequency
//                of the highest; and those that were advised (advice.hpp), at half, the same and
//                twice the rate. Others `jvari trim` tries.
//   compliance   own and matched, of a scheme that has both, where something touches the string.
// Nothing is sought of a scheme in continuous time, or against a reference with a cell's own modes.

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
