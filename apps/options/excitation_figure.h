#pragma once

#include <optional>
#include <vector>

#include "bio/simulation/musculoskeletal_system.h"
#include "bio/tables/trial.h"
#include "report/report.h"

namespace app {

/// Excitations of the muscles, in the rows of a trial. A muscle without a column is left out: its
/// excitation is the baseline throughout. Empty if none is left.
/// @param system  whose muscles are drawn; null: all of the trial
std::optional<Figure> excitationFigure(const bio::Trial& trial,
                                       const bio::MusculoskeletalSystem* system = nullptr);

/// Such figures of a trial that was fitted and, unless null, one that was held out, titled by their
/// files.
std::vector<Figure> excitationFigures(const bio::Trial& fitted, const bio::Trial* heldOut,
                                      const bio::MusculoskeletalSystem& system);

/// A section of these figures, if there are any.
void addExcitations(std::vector<Figure> figures, Report& report);

}  // namespace app
