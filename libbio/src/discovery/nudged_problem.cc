#include "bio/discovery/musculoskeletal_problem.h"
#include "bio/observation/nudge.h"

namespace bio::discover {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// A MusculoskeletalProblem whose coordinates are held near what was measured. Must not
/// outlive it.
class MusculoskeletalProblem::Nudged final : public info::discover::DiscoveryProblem {
 public:
  Nudged(const MusculoskeletalProblem& of, double frequency) : of_(of) {
    for (const OfTrial& trial : of.trials_) {
      std::vector<Nudge>& nudges = nudges_.emplace_back();
      for (const Series& series : trial.series) {
        const Observable& what = of.encompassing_.sensors()[series.sensor];
        if (!what.isCoordinate()) continue;
        nudges.push_back(nudgeTo(of.encompassing_.system(),
                                 of.encompassing_.system().skeleton().indexOf(what.of),
                                 series.times, trial.measured(series.samples), frequency));
      }
    }
  }
  const std::vector<Quantity>& quantities() const override { return of_.quantities(); }
  const std::vector<std::size_t>& nuisances() const override { return of_.nuisances(); }
  const std::vector<Candidate>& candidates() const override { return of_.candidates(); }
  int numTrials() const override { return of_.numTrials(); }
  std::string trialName(int trial) const override { return of_.trialName(trial); }
  const std::vector<double>& times(int trial) const override { return of_.times(trial); }
  const std::vector<int>& outputOfSample(int trial) const override {
    return of_.outputOfSample(trial);
  }
  const VectorXd& measured(int trial) const override { return of_.measured(trial); }
  const std::vector<info::discover::Axis>& axes() const override { return of_.axes(); }
  const std::vector<info::discover::Node>& nodes(int trial) const override {
    return of_.nodes(trial);
  }
  double latentLag() const override { return of_.latentLag(); }
  Prediction predict(int trial, const VectorXd& values, const VectorXd& latent,
                     const std::vector<std::size_t>& wanted, bool latentToo) const override {
    return of_.predictWith(&of(trial), trial, values, latent, wanted, latentToo);
  }
  std::unique_ptr<Simulation> simulated(int trial, const VectorXd& values, const VectorXd& latent,
                                        const std::vector<std::size_t>& wanted,
                                        bool latentToo) const override {
    return of_.simulatedWith(&of(trial), trial, values, latent, wanted, latentToo);
  }
  VectorXd outputs(int trial, const VectorXd& values, const VectorXd& latent) const override {
    return of_.outputsOf(of_.of(trial), values, latent, 1, &of(trial));
  }
  MatrixXd inputs(int trial) const override { return of_.inputs(trial); }
  std::vector<std::string> inputNames() const override { return of_.inputNames(); }

 private:
  const std::vector<Nudge>& of(int trial) const {
    return nudges_.at(static_cast<std::size_t>(trial));
  }

  const MusculoskeletalProblem& of_;
  std::vector<std::vector<Nudge>> nudges_;
};

std::unique_ptr<info::discover::DiscoveryProblem> MusculoskeletalProblem::nudged(
    double frequency) const {
  bool isMeasured = false;
  for (const OfTrial& trial : trials_) {
    for (const Series& series : trial.series) {
      if (!encompassing_.sensors()[series.sensor].isCoordinate()) continue;
      isMeasured = true;
      if (series.times.size() < 4) return nullptr;
    }
  }
  if (!isMeasured) return nullptr;
  return std::make_unique<Nudged>(*this, frequency);
}

}  // namespace bio::discover
