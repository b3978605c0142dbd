#include "hot_jobs.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <stdexcept>

#include "bio/analysis/ensemble.h"
#include "bio/simulation/integrator_names.h"
#include "info/parallel_for.h"
#include "info/probability/random_stream.h"

namespace bio::bench {

using Eigen::Index;

namespace {

template <class Value>
void keep(const Value& value) {
  asm volatile("" : : "r"(&value) : "memory");
}

}  // namespace

const std::vector<HotJobs::Job>& HotJobs::all() {
  static const std::vector<Job> jobs = {
      {"simulation", "4.5 s, variational, 0.01 s", &HotJobs::simulation},
      {"runge-kutta", "the same by Runge–Kutta at 4e-4 s", &HotJobs::rungeKutta},
      {"configurations", "1000 configurations", &HotJobs::configurations},
      {"sensitivities-60", "4.5 s with dq/dθ of 60 muscle parameters", &HotJobs::sensitivitiesOf60},
      {"sensitivities-all", "4.5 s with dq/dθ of every parameter", &HotJobs::sensitivitiesOfAll},
      {"prediction", "a prediction as discover asks for it", &HotJobs::prediction},
      {"compilation", "an arm compiled from its model", &HotJobs::compilation},
  };
  return jobs;
}

HotJobs::HotJobs()
    : data_(elbow_.model, fixtures::ShippedElbow::options(), "elbow_flexion", {elbow_.trial}),
      setting_(elbow_.catalogue.nominal()),
      every_(elbow_.catalogue.select({"all"})),
      sixty_(elbow_.catalogue.select({"*.max_isometric_force", "*.optimal_fiber_length",
                                      "*.tendon_slack_length", "*.pennation_angle", "*.damping",
                                      "*.time_scale", "*.activation1", "*.activation2"})) {
  sixty_.resize(60);
  // every nuisance, and the first quantities of candidates up to 60
  const auto& quantities = data_.quantities();
  values_.resize(static_cast<Index>(quantities.size()));
  for (std::size_t i = 0; i < quantities.size(); ++i) {
    values_[static_cast<Index>(i)] = quantities[i].nominal;
  }
  wanted_ = data_.nuisances();
  for (const auto& candidate : data_.candidates()) {
    if (wanted_.size() < 60) wanted_.push_back(candidate.quantities.front());
  }
  latent_.setZero(static_cast<Index>(numNodes()));
  for (Index k = 0; k < latent_.size(); ++k) latent_[k] = 0.05 * std::sin(0.3 * double(k));
}

void HotJobs::simulation() {
  const Trajectory motion = simulate(options());
  newtonIterations = double(motion.newtonIterations) / double(motion.steps);
  keep(motion.q);
}

void HotJobs::rungeKutta() {
  keep(simulate(options(4e-4, Integrator::rungeKutta4)).q);
}

void HotJobs::configurations() {
  SystemConfiguration<1> configuration(elbow_.system);
  Eigen::Matrix<double, 1, 1> q(0.9);
  for (int i = 0; i < 1000; ++i) {
    configuration.moveTo(q);
    keep(configuration);
    q[0] = 1.9 - q[0];
  }
}

void HotJobs::sensitivities(const std::vector<std::size_t>& wanted) {
  keep(simulateWithSensitivities(elbow_.system, elbow_.catalogue, setting_, wanted,
                                 elbow_.excitation, {options(), false})
           .q);
}
void HotJobs::sensitivitiesOf60() {
  sensitivities(sixty_);
}
void HotJobs::sensitivitiesOfAll() {
  sensitivities(every_);
}

void HotJobs::prediction() {
  const auto prediction = data_.predict(0, values_, latent_, wanted_, true);
  if (!prediction.outputs.allFinite()) throw std::runtime_error("the prediction failed");
  keep(prediction);
}

void HotJobs::compilation() {
  keep(MusculoskeletalSystem(elbow_.model, fixtures::ShippedElbow::options()));
}

int HotJobs::ensemble(int count, int threads) const {
  const auto drawn = elbow_.catalogue.select(
      {"*.max_isometric_force", "*.optimal_fiber_length", "*.tendon_slack_length"});
  const Eigen::VectorXd nominal = elbow_.catalogue.values(drawn);
  const SystemBatch ensemble(elbow_.catalogue, fixtures::ShippedElbow::options(), elbow_.excitation,
                             {{ofCoordinate("elbow_flexion"), {}}}, {}, drawn, options());
  constexpr int together = 16;
  std::atomic<int> completed = 0;
  info::parallelFor((count + together - 1) / together, threads, [&](int batch) {
    std::vector<Eigen::VectorXd> draws;
    for (int i = batch * together; i < std::min(count, (batch + 1) * together); ++i) {
      info::RandomStream random(1, static_cast<std::uint64_t>(i));
      Eigen::VectorXd& values = draws.emplace_back(nominal);
      for (double& value : values) value *= std::exp(0.01 * random.normal());
    }
    for (const EnsembleRun& run : ensemble.run(draws)) {
      if (run.outcome == name(Outcome::completed)) ++completed;
    }
  });
  return completed;
}

}  // namespace bio::bench
