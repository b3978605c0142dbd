#pragma once

#include "bio/design/dynamometer_question.h"
#include "design/design_options.h"
#include "design/design_report.h"
#include "design/separating_report.h"
#include "output/methods.h"

namespace app {

/// What is to be said of an experiment that was designed: what is measured, the criterion, the
/// inputs with their limits, the search.
/// @param typed  with the seed that was used
void sayDesign(const DesignFindings& findings, const DesignOptions& typed, Methods& methods);

/// What is to be said of one that was designed to discriminate between two effects.
void saySeparation(const SeparatingFindings& findings, const DesignOptions& typed,
                   Methods& methods);

/// What is to be said of experiments on a dynamometer that were ranked.
/// @param turns  whether the coordinate is a rotation
void sayDynamometer(const bio::DynamometerPlan& plan, const bio::DynamometerQuestion& question,
                    bool turns, Methods& methods);

}  // namespace app
