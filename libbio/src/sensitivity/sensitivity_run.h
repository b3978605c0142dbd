#pragma once

// A motion first, its sensitivities later; not public.

#include <optional>

#include "bio/sensitivity/coupled_sensitivity.h"
#include "simulation/step_tape.h"

namespace bio::stepping {

/// simulateWithSensitivities() in two parts.
class SensitivityRun {
 public:
  /// Simulates the motion. The arguments must outlive this object.
  /// @throws what simulateWithSensitivities() throws
  SensitivityRun(const MusculoskeletalSystem& system, const ParameterCatalogue::Setting& setting,
                 const ExcitationSignal& trial, const SensitivityOptions& options);

  SensitivityRun(const SensitivityRun&) = delete;
  SensitivityRun& operator=(const SensitivityRun&) = delete;

  const Trajectory& motion() const { return motion_; }
  /// With the motion, which is moved there: to be called once at most.
  SensitivityTrajectory sensitivities(const std::vector<ParameterDirection>& wanted);

 private:
  const SensitivityOptions& options() const { return own_ ? *own_ : given_; }

  const MusculoskeletalSystem& system_;
  const ParameterCatalogue::Setting& setting_;
  const ExcitationSignal& trial_;
  const SensitivityOptions& given_;
  std::optional<SensitivityOptions> own_;  ///< with forces that the system turns into its own
  ExcitationSignal driven_;
  SystemState start_;
  StepTape tape_;
  Trajectory motion_;
};

}  // namespace bio::stepping
