#pragma once

#include <map>
#include <string>
#include <vector>

#include "bio/observation/nudge.h"
#include "bio/observation/observed_motion.h"
#include "bio/sensitivity/cost_gradient.h"
#include "bio/tables/trial.h"
#include "info/estimation/least_squares.h"

namespace bio {

/// A trial as a function for estimators: from parameters to what was measured, at its times.
///
/// For every θ the model is changed, compiled and simulated; sensitivities are those of the
/// discrete motion, interpolated to the measured times in the same way as the motion. One
/// simulation gives all channels. Immutable: may be used from several threads.
class TrialPredictor {
 public:
  /// @param trial excitations; its measured values are not used
  /// @param coordinate observed coordinate, must be free
  /// @param times sample times within the trial [s], rising
  /// @param selection   indices of the catalogue's parameters: θ
  /// @throws std::invalid_argument if the coordinate is not free, a time is outside the
  ///   simulation, or the integrator has no sensitivities
  TrialPredictor(const ParameterCatalogue& catalogue, const SystemOptions& system,
                 ExcitationSignal trial, const std::string& coordinate, std::vector<double> times,
                 std::vector<std::size_t> selection, const SimulationOptions& options);

  /// A predictor of any observables, series after series.
  /// @param options  with the motion of prescribed coordinates
  /// @throws std::invalid_argument if a time is outside the simulation or does not rise, or the
  ///   integrator has no sensitivities
  TrialPredictor(const ParameterCatalogue& catalogue, const SystemOptions& system,
                 ExcitationSignal trial, std::vector<ObservedSeries> series,
                 std::vector<std::size_t> selection, const SimulationOptions& options);

  /// Number of samples of all series.
  Eigen::Index size() const { return size_; }
  const std::vector<std::size_t>& selection() const { return selection_; }
  const ParameterCatalogue& catalogue() const { return *catalogue_; }

  /// Adds a nudge that holds the model near a measured course; several may act together.
  void hold(Nudge nudge) { nudges_.push_back(std::move(nudge)); }

  /// The observables at their times, in their units; NaN after the end of a failed simulation, and
  /// everywhere if no model can be built with θ.
  Eigen::VectorXd outputs(const Eigen::VectorXd& theta) const;

  struct Linearised {
    Eigen::VectorXd outputs;  ///< at the times
    Eigen::MatrixXd gamma;    ///< Γ = dy/dθ: samples × parameters
  };
  Linearised withSensitivities(const Eigen::VectorXd& theta) const;
  /// In words, why outputs(θ) is not finite; empty if it is.
  std::string whyUndefined(const Eigen::VectorXd& theta) const;

  /// J = ½ Σ ((y_i − m_i)/σ_i)² over size() samples, and dJ/dθ by one sweep back, for a few
  /// simulations however many parameters there are; NaN if the motion ends too early.
  /// @throws what leastSquaresCost() and simulateWithGradient() throw
  CostGradient leastSquares(const Eigen::VectorXd& theta, const Eigen::VectorXd& measured,
                            const Eigen::VectorXd& sd) const;

  /// For info::LeastSquares; one output. This experiment must outlive it.
  info::Predictor predictor() const;

  /// The complete simulations. @throws what MusculoskeletalSystem, initialState and simulate throw
  Trajectory simulate(const Eigen::VectorXd& theta) const;
  SensitivityTrajectory simulateWithSensitivities(const Eigen::VectorXd& theta) const;

 private:
  /// The setting with the nudges, and its system.
  struct Held {
    ParameterCatalogue::Setting setting;
    SimulationOptions options;
    MusculoskeletalSystem system;
  };
  Held heldAt(ParameterCatalogue::Setting setting) const;
  SensitivityTrajectory sensitivitiesOf(const Held& held, bool muscles, bool reactions) const;

  const ParameterCatalogue* catalogue_;
  SystemOptions systemOptions_;
  ExcitationSignal trial_;
  std::vector<ObservedSeries> series_;
  Eigen::Index size_ = 0;
  std::vector<std::size_t> selection_;
  SimulationOptions options_;
  std::vector<Nudge> nudges_;
};

/// Several experiments with the same parameters; their samples are concatenated.
/// @throws std::invalid_argument for none, or different selections
info::Predictor joined(const std::vector<TrialPredictor>& experiments);

}  // namespace bio
