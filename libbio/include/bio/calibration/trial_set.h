#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "bio/analysis/replay.h"
#include "bio/observation/trial_predictor.h"
#include "bio/tables/trial.h"
#include "info/estimation/least_squares.h"

namespace bio {

struct TrialSetOptions {
  /// Names or patterns as ParameterCatalogue::select takes them: the same value in every trial.
  std::vector<std::string> parameters;
  bool ownStart = false;  ///< estimate the initial values and speeds of each trial as well
  /// Estimate the latent excitations that each trial declares (Trial::latent) as well; if not, they
  /// are what the trial says.
  bool latent = false;
  std::map<std::string, double> initial;  ///< start values [rad] or [m], as startCoordinates takes
  SimulationOptions simulation;           ///< start and duration are those of each trial
  int threads = 1;                        ///< trials simulated at once
};

/// Measured samples of one observable in one trial.
struct MeasuredSeries {
  std::size_t trial;  ///< index in the set
  Observable what;
  std::size_t channel;        ///< of TrialSet::channels()
  std::vector<double> times;  ///< [s]
  Eigen::VectorXd values;     ///< in the channel's unit
};

/// Measurements with the same unit and noise: all angles, or one other observable in all trials.
struct MeasuredGroup {
  std::string name;  ///< "angles", or the column's name
  std::string unit;
  bool areAngles = false;
};

/// The largest difference of two predictions of a trial, relative to the noise of its channel.
struct LargestDifference {
  std::size_t channel = 0;
  double difference = 0;  ///< [unit of the channel]
  double sd = 0;          ///< of the channel's noise
};

/// Several trials of one model as one experiment: θ = (parameters of the model, common to all;
/// then of each trial, if asked for, start and start speed of its free coordinates and the knots of
/// its latent excitations, all with priors), outputs = all that
/// was measured in all trials, concatenated, in its units. Each trial is simulated over all its
/// rows from the initial state of beginningOf().
class TrialSet {
 public:
  /// @throws std::invalid_argument, naming the file where there is one, for no trial, a knot of a
  ///   latent excitation as parameter (these are estimated anyway), a trial with
  ///   an external torque or without a measured channel, a channel that cannot be observed
  ///   (observed_motion.h), an unknown name, one given twice or two
  ///   that set the same value, an initial state as common parameter of several trials, another
  ///   integrator
  TrialSet(const Model& model, const SystemOptions& system, std::vector<Trial> trials,
           const TrialSetOptions& options);

  const MusculoskeletalSystem& system() const { return *system_; }
  /// With which it was made of the model.
  const SystemOptions& options() const { return options_; }
  const std::vector<Trial>& trials() const { return trials_; }
  /// Trial by trial.
  const std::vector<MeasuredSeries>& series() const { return series_; }
  const std::vector<MeasuredGroup>& channels() const { return channels_; }
  /// The catalogue of a trial; catalogues differ only in the initial state.
  const ParameterCatalogue& catalogue(std::size_t trial = 0) const { return *catalogues_[trial]; }
  /// Indices of the common parameters in the catalogue.
  const std::vector<std::size_t>& selection() const { return selection_; }

  /// Initial state of a trial at θ.
  StartPoint startAt(std::size_t trial, const Eigen::VectorXd& theta) const;
  /// Relation between the EMG of a trial and its excitations at θ.
  EmgMapping mappingAt(std::size_t trial, const Eigen::VectorXd& theta) const;

  /// A latent excitation of a trial and where its knots stand in parameters().
  struct Latent {
    std::size_t trial;
    LatentDeclaration declared;
    std::vector<double> knots;  ///< [s]
    Eigen::VectorXd atKnots;    ///< the trial's course: mean of the prior
    std::size_t first;          ///< of parameters(); the others follow
  };
  const std::vector<Latent>& latent() const { return latent_; }

  std::size_t numParameters() const { return parameters_.size(); }
  /// Number of common parameters; the others belong to single trials.
  std::size_t numCommon() const { return selection_.size(); }
  /// θ of the model and the trials, with the catalogue's bounds; those of trials have a prior.
  const std::vector<info::Parameter>& parameters() const { return parameters_; }
  /// What each of them sets; of several targets the first.
  const std::vector<ParameterTarget>& targets() const { return targets_; }
  /// Prior standard deviation of each, in its unit.
  const Eigen::VectorXd& priorSds() const { return priorSds_; }

  /// 1 × samples
  Eigen::MatrixXd measured() const;
  /// J(θ) = ½ Σ ((y_i(θ) − m_i)/σ_i)² over all samples, and dJ/dθ by one sweep back per trial.
  struct Cost {
    double value = 0;                  ///< NaN if a motion ends too early
    Eigen::VectorXd gradient;          ///< dJ/dθ, as parameters()
    std::vector<CostGradient> trials;  ///< of each trial alone
  };
  /// @param sd  σ > 0 of each channel, in its unit
  /// @throws std::invalid_argument as leastSquaresCost() does, and for another number of σ than
  /// channels()
  Cost leastSquares(const Eigen::VectorXd& theta, const std::vector<double>& sd) const;

  /// 1 × samples; NaN after the end of a failed simulation. The set must outlive it.
  info::Predictor predictor() const { return predictor(experiments_); }
  /// The experiments with every measured coordinate held near its measured course (nudge.h). A
  /// series with fewer than four samples is not held.
  std::vector<TrialPredictor> nudged(double frequency) const;
  /// The predictor of these experiments; set and experiments must outlive it.
  info::Predictor predictor(const std::vector<TrialPredictor>& experiments) const;
  /// Why the trial's simulation does not reach its end; empty if it does.
  std::string failure(std::size_t trial, const Eigen::VectorXd& theta) const;
  /// Mean square difference [rad²] of predictions from the measured angles: of all trials, and of
  /// one; NaN without angles.
  double meanSquare(const Eigen::MatrixXd& predicted) const;
  double meanSquare(const Eigen::MatrixXd& predicted, std::size_t trial) const;
  /// Mean square difference of the measurements of a channel, in the square of its unit.
  double meanSquareOf(const Eigen::MatrixXd& predicted, std::size_t channel) const;
  /// By trial. @param sds  of the noise of each channel > 0
  std::vector<LargestDifference> largestDifferences(const Eigen::MatrixXd& a,
                                                    const Eigen::MatrixXd& b,
                                                    const std::vector<double>& sds) const;

 private:
  void collectSeries(const Model& model);
  std::size_t channelOf(const Observable& what, const Model& model);
  void collectParameters(const TrialSetOptions& options);
  void collectOwn(const TrialSetOptions& options);
  void addLatent(std::size_t trial, std::size_t first);
  std::vector<std::size_t> selectionOf(std::size_t trial) const;
  Eigen::VectorXd thetaOf(std::size_t trial, const Eigen::VectorXd& theta) const;

  std::vector<Trial> trials_;
  int threads_;
  SystemOptions options_;
  std::unique_ptr<const MusculoskeletalSystem> system_;
  std::vector<std::unique_ptr<const ParameterCatalogue>> catalogues_;  ///< one per trial
  std::vector<std::size_t> selection_;
  /// Indices of each trial's initial state and latent excitations that are estimated, and
  /// where they begin in parameters_.
  std::vector<std::vector<std::size_t>> own_;
  std::vector<Eigen::Index> ownBegin_;
  std::vector<Latent> latent_;
  std::vector<info::Parameter> parameters_;
  std::vector<ParameterTarget> targets_;
  Eigen::VectorXd priorSds_;
  std::vector<MeasuredSeries> series_;
  std::vector<MeasuredGroup> channels_;
  std::vector<Eigen::Index> begin_ = {0};  ///< where the samples of each trial begin, and their end
  std::vector<TrialPredictor> experiments_;  ///< one per trial
};

/// Whether a name, or a pattern, asks for knots of latent excitations: emg.MUSCLE.latentK, also
/// with the number of a trial in front.
bool namesKnot(const std::string& parameter);

/// Indices of the parameters that the names select, each once.
/// @throws std::invalid_argument as ParameterCatalogue::select does, and for a name given twice
std::vector<std::size_t> selectDistinct(const ParameterCatalogue& catalogue,
                                        const std::vector<std::string>& names);

}  // namespace bio
