#pragma once

#include "bio/arm.h"
#include "bio/emg_mapping.h"
#include "bio/table_file.h"
#include "bio/trial.h"

namespace bio {

/// The trial for a model without EMG parameters: the excitations that drove the muscles, with rows
/// at all their corners, and the measurements.
Table drivenTable(const Trial& trial, const Arm& arm, const EmgMapping& mapping);

}  // namespace bio
