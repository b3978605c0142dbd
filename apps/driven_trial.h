#pragma once

#include <string>

#include "bio/arm.h"
#include "bio/emg_mapping.h"
#include "bio/table_file.h"
#include "bio/trial.h"

namespace app {

/// What the driven trial of the i-th one given is called, from 0: "driven_1.sto".
std::string drivenName(std::size_t i);

/// The trial as a model without EMG parameters needs it: the excitations that drove the muscles,
/// with rows wherever they bend, and what was measured.
bio::Table drivenTable(const bio::Trial& trial, const bio::Arm& arm,
                       const bio::EmgMapping& mapping);

}  // namespace app
