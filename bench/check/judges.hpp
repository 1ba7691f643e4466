// One function for each promise, and what several of them need.
#pragma once

#include <memory>

#include "bench/check/promise.hpp"
#include "schemes/run.hpp"

namespace jvari::bench::check {

// Refusals and declarations: declared.cpp.
Verdict refusals_name_what_is_missing(const Case&);
Verdict runs_a_scene(const Case&);
Verdict heeds_every_feature(const Case&);

// On a scene: stepping.cpp, energy.cpp, start.cpp, state.cpp, contact.cpp.
Verdict allocates_nothing(const Case&);
Verdict gives_numbers(const Case&);
Verdict same_bits_whatever_the_block(const Case&);
Verdict same_bits_with_energy_probed(const Case&);
Verdict starts_anew_after_a_reset(const Case&);
Verdict keeps_its_ledger_in_every_row(const Case&);
Verdict keeps_its_ledger_in_sum(const Case&);
Verdict stores_no_negative_energy(const Case&);
Verdict starts_from_the_scenes_shape(const Case&);
Verdict starts_without_contact_forces(const Case&);
Verdict carries_no_more_state(const Case&);
Verdict never_pulls(const Case&);

// Numerical claims of a scheme as a whole: claims.cpp, against_references.cpp.
Verdict partials_are_its_own_relations(const Case&);
Verdict writes_rows_at_their_instants(const Case&);
Verdict converges_to_the_reference(const Case&);
Verdict stays_sound_over_a_map(const Case&);

bool represents(const Descriptor&, const Scene&);
Settings settings_for(const Descriptor&, const Scene&);
bool takes(const Descriptor&, const Scene&, const Settings&);  // false where it refuses
Run fresh(const Case&, const RunOptions&);                     // of a scheme made for it

}  // namespace jvari::bench::check
