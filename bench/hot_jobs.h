#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "bio/discovery/musculoskeletal_problem.h"
#include "support/shipped_elbow.h"

namespace bio::bench {

/// What is measured: 4.5 s of curl_slow on the eight-muscle elbow, and what is asked of it.
class HotJobs {
 public:
  struct Job {
    const char* name;
    const char* what;
    void (HotJobs::*run)();
  };
  static const std::vector<Job>& all();

  HotJobs();
  void run(const Job& job) { (this->*job.run)(); }

  static SimulationOptions options(double step = 0.01, Integrator integrator = {}) {
    SimulationOptions o;
    o.integrator = integrator;
    o.step = step;
    o.duration = 4.5;
    return o;
  }
  Trajectory simulate(const SimulationOptions& options) const {
    return simulateSetting(elbow_.system, setting_, elbow_.excitation, options);
  }

  /// Newton iterations a step of the last simulation.
  double newtonIterations = 0;
  std::size_t numPredicted() const { return wanted_.size(); }
  std::size_t numNodes() const { return data_.nodes(0).size(); }
  std::size_t numParameters() const { return every_.size(); }

  /// @return how many of `count` simulations with parameters drawn reached their end, on `threads`
  int ensemble(int count, int threads) const;

 private:
  void simulation();
  void rungeKutta();
  void configurations();
  void sensitivitiesOf60();
  void sensitivitiesOfAll();
  void prediction();
  void compilation();
  void sensitivities(const std::vector<std::size_t>& wanted);

  fixtures::ShippedElbow elbow_;
  discover::MusculoskeletalProblem data_;
  ParameterCatalogue::Setting setting_;
  std::vector<std::size_t> every_, sixty_;
  std::vector<std::size_t> wanted_;  ///< quantities of data_
  Eigen::VectorXd values_, latent_;
};

}  // namespace bio::bench
