#pragma once

#include "bio/arm.h"
#include "bio/emg_mapping.h"
#include "bio/table_file.h"
#include "bio/trial.h"

namespace bio {

/// The trial as a model without EMG parameters needs it: the excitations that drove the muscles,
/// with rows wherever they bend, and what was measured.
Table drivenTable(const Trial& trial, const Arm& arm, const EmgMapping& mapping);

}  // namespace bio
