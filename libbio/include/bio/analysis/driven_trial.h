#pragma once

#include "bio/emg/emg_mapping.h"
#include "bio/simulation/musculoskeletal_system.h"
#include "bio/tables/table_file.h"
#include "bio/tables/trial.h"

namespace bio {

/// The trial for a model without EMG parameters: the excitations that drove the muscles, with rows
/// at all their corners, and the measurements.
Table drivenTable(const Trial& trial, const MusculoskeletalSystem& arm, const EmgMapping& mapping);

}  // namespace bio
