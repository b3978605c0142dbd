#include "bio/discovery/musculoskeletal_problem.h"
#include "bio/observation/nudge.h"
#include "info/discovery/likelihood/forwarding_problem.h"

namespace bio::discover {

using Eigen::VectorXd;

/// A MusculoskeletalProblem whose coordinates are held near what was measured. Must not
/// outlive it.
class MusculoskeletalProblem::Nudged final : public info::discover::ForwardingProblem {
 public:
  Nudged(const MusculoskeletalProblem& problem, double frequency)
      : ForwardingProblem(problem), problem_(problem) {
    for (const OfTrial& trial : problem.trials_) {
      std::vector<Nudge>& nudges = nudges_.emplace_back();
      for (const Series& series : trial.series) {
        const Observable& what = problem.encompassing_.sensors()[series.sensor];
        if (!what.isCoordinate()) continue;
        nudges.push_back(nudgeTo(problem.encompassing_.system(),
                                 problem.encompassing_.system().skeleton().indexOf(what.object),
                                 series.times, trial.measured(series.samples), frequency));
      }
    }
  }
  Prediction predict(int trial, const VectorXd& values, const VectorXd& latent,
                     const std::vector<std::size_t>& wanted, bool latentToo) const override {
    return problem_.predictWith(&of(trial), trial, values, latent, wanted, latentToo);
  }
  std::unique_ptr<Simulation> simulated(int trial, const VectorXd& values, const VectorXd& latent,
                                        const std::vector<std::size_t>& wanted,
                                        bool latentToo) const override {
    return problem_.simulatedWith(&of(trial), trial, values, latent, wanted, latentToo);
  }
  VectorXd outputs(int trial, const VectorXd& values, const VectorXd& latent) const override {
    return problem_.outputsOf(problem_.of(trial), values, latent, 1, &of(trial));
  }
  // not available while the coordinates are held
  VectorXd refinedOutputs(int, const VectorXd&) const override { return {}; }
  std::unique_ptr<DiscoveryProblem> nudged(double) const override { return nullptr; }
  std::unique_ptr<DiscoveryProblem> withFormula(std::size_t,
                                                const std::vector<info::discover::FormulaTerm>&,
                                                const std::vector<std::size_t>&) const override {
    return nullptr;
  }

 private:
  const std::vector<Nudge>& of(int trial) const {
    return nudges_.at(static_cast<std::size_t>(trial));
  }

  const MusculoskeletalProblem& problem_;
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
