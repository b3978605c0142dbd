#pragma once

#include <Eigen/Dense>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bio/analysis/replay.h"
#include "bio/parameters/parameters.h"

namespace bio {

/// Result of one simulation of an ensemble; [rad] or [m] of the observed coordinate, NaN unless it
/// reached the end.
struct EnsembleRun {
  /// name(Outcome), or "impossible": no model or no initial state exists for these parameters.
  std::string outcome;
  double failedAt;           ///< [s]; NaN if it reached the end or never began
  double rmsError;           ///< against the measurement; NaN without one
  double rmsFromNominal;     ///< RMS difference from the nominal motion, over all rows
  double last;               ///< at the end of the trial
  double lowest, highest;    ///< at any row
  Eigen::VectorXd atCourse;  ///< at the times of the course
};

/// One trial, simulated with many values of some parameters. Immutable: may be used from several
/// threads; a run is a pure function of its parameters.
///
/// Runs go through simulateTogether. A model is compiled for every run. Paths that no selected
/// parameter changes are reused from the nominal model, since finding the surfaces that a path can
/// touch takes most of the time.
class SystemBatch {
 public:
  /// @param catalogue   made of `system`; must outlive the ensemble
  /// @param trial       excitations as recorded
  /// @param coordinate observed coordinate, must be free
  /// @param measured measured values of that coordinate, if any
  /// @param course      times within the trial [s], rising
  /// @throws std::invalid_argument what simulate() throws, if the coordinate is not free, or if the
  ///   model's own motion does not reach the end of the trial
  SystemBatch(const ParameterCatalogue& catalogue, const SystemOptions& system,
              ExcitationSignal trial, const std::string& coordinate,
              std::optional<MeasuredChannel> measured, std::vector<double> course,
              std::vector<std::size_t> selection, const SimulationOptions& options);

  const std::vector<double>& course() const { return course_; }
  /// The run with the model's own parameters.
  const EnsembleRun& nominal() const { return nominal_; }

  /// @param theta of the selection
  /// @throws std::invalid_argument for another number of values, or one that is not finite
  EnsembleRun run(const Eigen::VectorXd& theta) const;
  /// Several runs at once, faster in multiples of four (LaneJob); each result is bitwise
  /// that of a single run.
  std::vector<EnsembleRun> run(std::span<const Eigen::VectorXd> thetas) const;

 private:
  struct Draw;
  Draw prepare(const Eigen::VectorXd& theta) const;
  EnsembleRun describe(const Trajectory& motion) const;

  const ParameterCatalogue* catalogue_;
  SystemOptions systemOptions_;
  ExcitationSignal trial_;
  std::optional<MeasuredChannel> measured_;
  std::vector<double> course_;
  std::vector<std::size_t> selection_;
  SimulationOptions options_;
  MusculoskeletalSystem system_;     ///< nominal
  ExcitationSignal driven_;          ///< nominal
  bool drawsEmg_;                    ///< a parameter of the selection changes the excitations
  std::vector<std::string> shaped_;  ///< muscles whose paths depend on the selection
  int coordinate_;
  Eigen::RowVectorXd nominalMotion_;  ///< [rad] or [m], one column per row of time
  EnsembleRun nominal_;
};

}  // namespace bio
