#pragma once

#include <Eigen/Dense>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bio/analysis/replay.h"
#include "bio/observation/observed_motion.h"
#include "bio/parameters/parameters.h"

namespace bio {

/// A channel that an ensemble observes.
struct EnsembleChannel {
  Observable what;
  std::optional<MeasuredChannel> measured;  ///< in the trial, if it was
};

/// A channel of one simulation, in unitOf(); NaN unless the simulation reached the end.
struct ChannelRun {
  double rmsError;           ///< against the measurement; NaN without one
  double rmsFromNominal;     ///< RMS difference from the nominal motion, over all rows
  double last;               ///< at the end of the trial
  double lowest, highest;    ///< at any row
  Eigen::VectorXd atCourse;  ///< at the times of the course
};

/// Result of one simulation of an ensemble.
struct EnsembleRun {
  /// name(Outcome), or "impossible": no model or no initial state exists for these parameters.
  std::string outcome;
  double failedAt;                   ///< [s]; NaN if it reached the end or never began
  std::vector<ChannelRun> channels;  ///< in the order of SystemBatch::channels()
};

/// One trial, simulated with many values of some parameters. Immutable: may be used from several
/// threads; a run is a pure function of its parameters.
///
/// Runs go through simulateTogether, so those of one free hinge and no other coordinate share SIMD
/// registers, all others are simulated one by one. A model is compiled for every run. Paths that no
/// selected parameter changes are reused from the nominal model, since finding the surfaces that a
/// path can touch takes most of the time.
class SystemBatch {
 public:
  /// @param catalogue   made of `system`; must outlive the ensemble
  /// @param trial       excitations as recorded
  /// @param channels    observed; measured values at times within the trial
  /// @param course      times within the trial [s], rising
  /// @throws std::invalid_argument what simulate() and ObservedMotion throw, or if the model's own
  ///   motion does not reach the end of the trial
  SystemBatch(const ParameterCatalogue& catalogue, const SystemOptions& system,
              ExcitationSignal trial, std::vector<EnsembleChannel> channels,
              std::vector<double> course, std::vector<std::size_t> selection,
              const SimulationOptions& options);

  const std::vector<EnsembleChannel>& channels() const { return channels_; }
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
  EnsembleRun notFinished(const std::string& outcome, double failedAt) const;
  EnsembleRun describe(const MusculoskeletalSystem& system, const Trajectory& motion) const;

  const ParameterCatalogue* catalogue_;
  SystemOptions systemOptions_;
  ExcitationSignal trial_;
  std::vector<EnsembleChannel> channels_;
  std::vector<double> course_;
  std::vector<std::size_t> selection_;
  SimulationOptions options_;
  MusculoskeletalSystem system_;     ///< nominal
  ExcitationSignal driven_;          ///< nominal
  bool drawsEmg_;                    ///< a parameter of the selection changes the excitations
  std::vector<std::string> shaped_;  ///< muscles whose paths depend on the selection
  std::vector<ObservedSeries>
      series_;                     ///< of each channel: at all rows, at the course, as measured
  Eigen::VectorXd nominalValues_;  ///< of the series
  EnsembleRun nominal_;
};

}  // namespace bio
