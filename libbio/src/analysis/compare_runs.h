#pragma once

// The runs that a comparison is made of; not part of the public interface.

#include "bio/analysis/compare.h"

namespace bio::compare {

/// Whether the step is what the integrator steps by, so that it has an order and a largest one.
constexpr bool hasFixedStep(Integrator integrator) {
  return integrator != Integrator::cvode && integrator != Integrator::variationalAdaptive;
}

/// One system under one excitation, simulated as often as it takes.
class Runs {
 public:
  /// Keeps references; `reference` may be filled later by makeReference().
  Runs(const MusculoskeletalSystem& system, const ExcitationSignal& excitation,
       const SystemState& start, const CompareOptions& options, const ConvergedReference& reference)
      : system_(&system),
        excitation_(&excitation),
        start_(&start),
        options_(&options),
        reference_(&reference) {}

  ConvergedReference makeReference() const;
  void confirm(ConvergedReference& reference) const;
  CompareCell cell(Integrator integrator, double step) const;
  StepLimit limit(Integrator integrator) const;
  ObservedOrder order(Integrator integrator) const;

 private:
  SimulationOptions simulationOptions(Integrator integrator, double step) const;
  Trajectory run(Integrator integrator, double step) const;
  std::string fault(Integrator integrator, double step) const;

  const MusculoskeletalSystem* system_;
  const ExcitationSignal* excitation_;
  const SystemState* start_;
  const CompareOptions* options_;
  const ConvergedReference* reference_;
};

}  // namespace bio::compare
