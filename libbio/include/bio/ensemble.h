#pragma once

#include <Eigen/Dense>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bio/parameters.h"
#include "bio/replay.h"

namespace bio {

/// What one simulation of an ensemble came to; [rad] or [m] of the observed coordinate, NaN unless
/// it came to its end.
struct EnsembleRun {
  /// name(Outcome), or "impossible": no arm can be made of these parameters, or it has no start.
  std::string outcome;
  double failedAt;           ///< [s]; NaN if it came to its end, or never began
  double rmsError;           ///< from what was measured; NaN where nothing was
  double rmsFromNominal;     ///< from the motion with the model's own parameters, row by row
  double last;               ///< at the end of the trial
  double lowest, highest;    ///< at any row
  Eigen::VectorXd atCourse;  ///< at the times asked for
};

/// One trial, simulated with many values of some parameters. Immutable: may be used from several
/// threads; a run is a pure function of its parameters.
///
/// Runs go through simulateTogether. An arm is compiled for every run. Paths that no parameter of
/// the selection shapes are taken from the nominal arm, since finding out where a path can touch
/// what takes longer than all the rest.
class ArmEnsemble {
 public:
  /// @param catalogue   made of `arm`; must outlive the ensemble
  /// @param trial       excitations as recorded
  /// @param coordinate  what is observed, free
  /// @param measured    of that coordinate, if it was
  /// @param course      times within the trial [s], rising
  /// @throws std::invalid_argument what simulate() throws, if the coordinate is not free, or if the
  ///   model's own motion does not reach the end of the trial
  ArmEnsemble(const ParameterCatalogue& catalogue, const ArmOptions& arm, ExcitationSignal trial,
              const std::string& coordinate, std::optional<MeasuredMotion> measured,
              std::vector<double> course, std::vector<std::size_t> selection,
              const SimulationOptions& options);

  const std::vector<double>& course() const { return course_; }
  /// The run with the model's own parameters.
  const EnsembleRun& nominal() const { return nominal_; }

  /// @param theta of the selection
  /// @throws std::invalid_argument for another number of values, or one that is not finite
  EnsembleRun run(const Eigen::VectorXd& theta) const;
  /// The same for several at once, quicker if it is several times LaneJob's four; each is what it
  /// would be alone, to the last bit.
  std::vector<EnsembleRun> run(std::span<const Eigen::VectorXd> thetas) const;

 private:
  struct Draw;
  Draw prepare(const Eigen::VectorXd& theta) const;
  EnsembleRun describe(const Trajectory& motion) const;

  const ParameterCatalogue* catalogue_;
  ArmOptions armOptions_;
  ExcitationSignal trial_;
  std::optional<MeasuredMotion> measured_;
  std::vector<double> course_;
  std::vector<std::size_t> selection_;
  SimulationOptions options_;
  Arm arm_;                          ///< nominal
  ExcitationSignal driven_;          ///< nominal
  bool drawsEmg_;                    ///< a parameter of the selection changes the excitations
  std::vector<std::string> shaped_;  ///< muscles whose paths the selection shapes
  int coordinate_;
  Eigen::RowVectorXd nominalMotion_;  ///< [rad] or [m], one column per row of time
  EnsembleRun nominal_;
};

}  // namespace bio
