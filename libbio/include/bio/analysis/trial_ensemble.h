#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "bio/analysis/ensemble.h"
#include "bio/analysis/parameter_laws.h"
#include "bio/tables/trial.h"

namespace bio {

struct TrialEnsembleOptions {
  LawRequest laws;               ///< its optionPrefix is that of all messages
  int draws = 1000;              ///< of parameters, 1 to 10⁷; with sobol: base points ≥ 2
  bool sobol = false;            ///< draws are the points of Saltelli's scheme, for Sobol's indices
  std::string output = "final";  ///< whose variance sobol decomposes (ensembleOutputs())
  /// Observed channels by the names that they have as columns of a trial; empty: all free
  /// coordinates.
  std::vector<std::string> observe = {};
  int bandPoints = 46;  ///< times of the percentile band, 2 to 1000
  /// Integrator and step; times, external force and prescribed motion are those of the trial.
  SimulationOptions simulation = {};
};

/// A trial, simulated with many random draws of the parameters: what `fisherhill ensemble`
/// computes.
///
/// Run i is a function of seed and i alone, on any thread or machine: its parameters are the
/// quantiles of a point of the unit cube, which comes from the random stream (seed, i), or with
/// `sobol` is point i of Saltelli's scheme (info::sobolPoint). Immutable.
class TrialEnsemble {
 public:
  /// @param system  made of `model` with `options`
  /// @param start of the model's own motion, as beginningOf() has it
  /// @throws std::invalid_argument for options out of range, a channel given twice, no channel, an
  ///   output that needs a measurement that the trial has not, more than 32 parameters with sobol,
  ///   a covariance with it, and what observableNamed, parameterLaws and SystemBatch throw
  TrialEnsemble(const Model& model, const MusculoskeletalSystem& system,
                const SystemOptions& options, const Trial& trial, const StartPoint& start,
                const TrialEnsembleOptions& asked);
  TrialEnsemble(const TrialEnsemble&) = delete;  // the batch points into the catalogue
  TrialEnsemble& operator=(const TrialEnsemble&) = delete;

  const Model& model() const { return catalogue_.model(); }
  const ParameterLaws& laws() const { return laws_; }
  const std::vector<EnsembleChannel>& channels() const { return batch_->channels(); }
  /// Times of the percentile band [s].
  const std::vector<double>& course() const { return batch_->course(); }
  /// The run with the model's own parameters.
  const EnsembleRun& nominal() const { return batch_->nominal(); }
  /// One sentence if that run leaves the valid range of its model (leftRange()), else empty.
  const std::string& nominalRemark() const { return remark_; }
  /// How many runs there are: draws, or draws·(p + 2) with sobol.
  std::uint64_t count() const;

  /// The parameters of run `number`.
  Eigen::VectorXd draw(std::uint64_t number, std::uint64_t seed) const;
  /// Runs with these parameters; faster with many at once (SystemBatch::run).
  std::vector<EnsembleRun> run(std::span<const Eigen::VectorXd> thetas) const {
    return batch_->run(thetas);
  }

 private:
  void check(const Trial& trial, const std::vector<EnsembleChannel>& channels,
             const TrialEnsembleOptions& asked) const;

  ParameterCatalogue catalogue_;
  ParameterLaws laws_;
  bool sobol_;
  int draws_;
  std::unique_ptr<const SystemBatch> batch_;
  std::string remark_;
};

}  // namespace bio
