// Lists the obstacle rules with which every string is paired, beside the discrete gradient: the
// columns in the table of pairings (driver/pairings.hpp). A new rule is a file like
// explicit_rule.hpp and a row here, with its file above.
#pragma once

#include "schemes/contact/explicit_rule.hpp"
#include "schemes/contact/gradient_rule.hpp"
#include "schemes/contact/moreau_jean_rule.hpp"
#include "schemes/contact/quadratised_rule.hpp"

// ROW(name, class, source)
#define JVARI_RULES(ROW)                                                           \
    ROW(quadratised, QuadratisedRule<Quadratisation::released>,                    \
        "Ducceschi et al. 2021, psi released in full where it would pull")         \
    ROW(moreau_jean, MoreauJeanRule,                                               \
        "Moreau 1988, Jean 1999: rigid contact with a coefficient of restitution") \
    ROW(penalty, ExplicitRule,                                                     \
        "the contact force known before the step (conditionally stable control)")
