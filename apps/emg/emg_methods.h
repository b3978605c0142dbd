#pragma once

#include "bio/emg/emg.h"
#include "bio/emg/emg_recordings.h"
#include "output/methods.h"

namespace app {

/// What is to be said of EMG that became excitations: the stages with their filters, the
/// normalisation, which electrode drives which muscle, and what was measured beside it.
/// @param config  of which `result` was made
void sayEmg(const bio::JoinedRecordings& joined, const bio::EmgConfig& config,
            const bio::EmgResult& result, Methods& methods);

}  // namespace app
