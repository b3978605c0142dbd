#include <gtest/gtest.h>

#include <chrono>
#include <cstdio>
#include <numbers>
#include <random>

#include "bio/discovery/musculoskeletal_problem.h"
#include "info/discovery/discover.h"
#include "support/shipped_elbow.h"

namespace bio::discover {
namespace {

using Eigen::Index;
using Eigen::VectorXd;
using fixtures::ShippedElbow;

constexpr double degree = std::numbers::pi / 180;

struct Hidden {
  std::string quantity;
  double value;
};

/// Trials as the arm with something hidden shows them: simulated by CVODE, with parameters off
/// within their tolerances, and noise.
std::vector<Trial> record(const std::vector<Hidden>& hidden, unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  std::vector<Trial> trials;
  std::vector<double> off;
  for (const char* name : {"curl_slow", "curl_fast", "cocontraction"}) {
    const ShippedElbow elbow("elbow8", name);
    const MusculoskeletalProblem data(elbow.model, ShippedElbow::options(), "elbow_flexion",
                                      {elbow.trial});
    VectorXd values = data.encompassing().nominal();
    const auto& nuisances = data.encompassing().nuisances();
    while (off.size() < nuisances.size()) off.push_back(normal(random));
    for (std::size_t i = 0; i < nuisances.size(); ++i) {
      const auto& quantity = data.quantities()[nuisances[i]];
      values[static_cast<Index>(nuisances[i])] *= std::exp(0.5 * quantity.sd * off[i]);
    }
    for (const Hidden& one : hidden) {
      values[static_cast<Index>(data.encompassing().find(one.quantity))] = one.value;
    }
    auto setting = data.encompassing().settingAt(values, {});
    const MeasuredMotion& old = elbow.trial.measured.front();
    setting.start.q[0] = old.values[0];
    const MusculoskeletalSystem arm(setting.model, ShippedElbow::options());
    SimulationOptions options;
    options.integrator = Integrator::cvode;
    options.duration = old.times[old.times.size() - 1] - elbow.trial.times[0];
    const Trajectory motion = simulateSetting(arm, setting, elbow.excitation, options);
    EXPECT_EQ(motion.outcome, Outcome::completed) << motion.why;
    Trial trial = elbow.trial;
    trial.file = name;
    MeasuredMotion& measured = trial.measured.front();
    measured.times = VectorXd::Map(motion.time.data(), static_cast<Index>(motion.time.size()));
    measured.values = motion.q.row(0).transpose();
    for (double& angle : measured.values) angle += 0.5 * degree * normal(random);
    trials.push_back(std::move(trial));
  }
  return trials;
}

TEST(Discover, NamesViscousDampingOfTheEightMuscleElbow) {
  const ShippedElbow elbow;
  const MusculoskeletalProblem data(elbow.model, ShippedElbow::options(), "elbow_flexion",
                                    record({{"visc.viscosity", 0.3}}, 1));
  info::discover::Options options;
  options.outputSd = 0.5 * degree;
  const auto begin = std::chrono::steady_clock::now();
  const info::discover::Verdict verdict = info::discover::run(data, options);
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  std::printf("%.1f s, %d fits: %s\n", seconds, verdict.fits, verdict.sentence.c_str());
  for (const auto& one : verdict.finalists) {
    std::printf("  %-14s %8.1f nats\n",
                one.effects.empty() ? "-" : data.candidates()[one.effects[0]].id.c_str(),
                one.logEvidence);
  }
  ASSERT_FALSE(verdict.effects.empty());
  const auto& found = verdict.effects.front();
  EXPECT_EQ(data.candidates()[found.candidate].id, "visc");
  EXPECT_EQ(verdict.effects.size(), 1u);
  EXPECT_NEAR(found.estimates.front().value, 0.3, 4 * found.estimates.front().sd);
}

}  // namespace
}  // namespace bio::discover
