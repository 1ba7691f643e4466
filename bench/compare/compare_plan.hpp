// Plan of a comparison: the cells with their settings, and the references to try in turn.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "bench/compare/catalogue.hpp"
#include "bench/study/job.hpp"
#include "schemes/scheme.hpp"

namespace jvari::bench::compare {

// Row rate for cells at these rates [Hz]; throws UsageError if there is no common rate.
double tap_rate_for(const CompareRequest&, const std::vector<double>& rates);

// Schemes named in the request, each once; else all that represent the scene. Throws Refusal.
std::vector<const Descriptor*> schemes_for(const CompareRequest&, const Catalogue&, const Scene&);

// Throws BadScene if the scene has no row at that tap rate, UsageError if the rows do not fit in
// memory.
void require_rows(const Scene&, const Settings&);

// Adds the cells of a comparison as jobs like `like`, and their points like `common`, with the
// requested references and reference modes.
//
// There is one point if all rates have rows in common: 44100 a second, else the lowest rate. Rates
// without common rows (44100 and 48000) get several points, each with its own rows and references.
// Nothing is resampled: a force is a mean over the interval between two rows, and its reference is
// the mean over the same interval. Schemes in continuous time are on the first point only.
//
// Throws UsageError for unknown names and for rates that --tap-rate does not divide, Refusal if no
// scheme represents the scene.
void add_jobs(study::Plan& into, const CompareRequest&, const Catalogue&,
              const study::Point& common, const study::Job& like);

// References of the first point only.
std::vector<study::ReferenceChoice> references_of(const CompareRequest&, const Catalogue&,
                                                  const Scene&);

// ---- Expands a request into the option sets and the numbers of modes to run.
//
// A request may leave options and modes open. The program then searches (CompareRequest::search),
// because the cheapest scheme may need matched compliance, or more modes than those below 20 kHz:
//   modes        1, 1.5, 2, 3 and 4 times the number below 20 kHz, at rates above twice the highest
//                frequency; and the advised number (advice.hpp), at half, the same and twice the
//                rate. `jvari trim` tries others.
//   compliance   own and matched, for a scheme with both, if something touches the string.
// There is no search for a scheme in continuous time, or against a reference with a cell's own
// modes.

struct Form {
    OptionValues options;
    // [Hz]; for a searched form, the rates at which the form can be made
    std::vector<double> rates;
};

class Untried {  // Searched forms that cannot be made, with reasons.
public:
    void add(const Descriptor&, const std::vector<double>& rates, bool at_all,
             const std::string& reason);
    std::vector<std::string> notes() const;  // a sentence for each reason

private:
    std::map<std::string, std::string> who_;  // by reason
};

// Combinations of the requested values for a scheme. `used`: marks the options that the scheme
// takes. Throws UsageError if an option is given both for all schemes and for this one.
std::vector<OptionValues> combinations_of(const std::vector<SchemeOption>&, const Descriptor&,
                                          std::vector<bool>& used);
// Throws UsageError if no scheme takes an option.
void must_be_used(const std::vector<SchemeOption>&, const std::vector<bool>& used);
bool sets(const OptionValues&, const Option&);
bool touched(const Scene&);  // true if something touches a string

std::vector<Form> forms_of(const CompareRequest&, const Descriptor&, const Scene&, const Settings&,
                           const std::vector<double>& rates, std::vector<bool>& used, Untried&);

// Largest number of modes in the search: 4 times `unasked`, limited by half the rate on each
// string, and at least `unasked`.
int most_modes_sought(const Scene&, int unasked, double rate);

struct Rung {
    int modes;                  // 0: the scheme's own
    std::vector<double> rates;  // [Hz]
    bool added;                 // true: added by the search, beside the default
};
// `settings`: with the default number of modes.
std::vector<Rung> rungs_of(const CompareRequest&, const Descriptor&, const Scene&, const Settings&,
                           const std::vector<double>& rates);

}  // namespace jvari::bench::compare
