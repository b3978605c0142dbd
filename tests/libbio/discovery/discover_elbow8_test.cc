#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <random>

#include "bio/analysis/driven_trial.h"
#include "bio/discovery/workflow.h"
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
    const MeasuredChannel& old = elbow.trial.measured.front();
    setting.start.q[0] = old.values[0];
    const MusculoskeletalSystem system(setting.model, ShippedElbow::options());
    SimulationOptions options;
    options.integrator = Integrator::cvode;
    options.duration = old.times[old.times.size() - 1] - elbow.trial.times[0];
    const Trajectory motion = simulateSetting(system, setting, elbow.excitation, options);
    EXPECT_EQ(motion.outcome, Outcome::completed) << motion.why;
    Trial trial = elbow.trial;
    trial.file = name;
    MeasuredChannel& measured = trial.measured.front();
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
  options.sds = 0.5 * degree;
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

// Two channels exchanged, and a torque that is in no catalogue above 108 degrees.
TEST(Discover, UsesWhatComesBeforeAPositionAtWhichTheModelFails) {
  const ShippedElbow elbow;
  Model person = elbow.model;
  person.expressionForces.push_back(
      {"law", "elbow_flexion", "-0.4*(1+tanh((q-1.885)/0.01))", true, {}});
  const MusculoskeletalSystem system(person, ShippedElbow::options());
  std::mt19937_64 random(8);
  std::normal_distribution<double> normal;
  std::vector<Trial> trials;
  for (const double effort : {1.0, 0.9, 1.1}) {
    Trial trial = elbow.trial;
    trial.file = "curl_slow with other efforts";
    trial.excitations *= effort;
    SimulationOptions options;
    options.integrator = Integrator::cvode;
    const TrialReplay replay =
        replayTrial(system, trial, options, beginningOf(trial, person, system, {}));
    ASSERT_EQ(replay.motion.outcome, Outcome::completed) << replay.motion.why;
    MeasuredChannel& measured = trial.measured.front();
    const auto n = static_cast<Index>(replay.motion.time.size());
    measured.times = VectorXd::Map(replay.motion.time.data(), n);
    measured.values = replay.motion.q.row(0).transpose();
    for (double& angle : measured.values) angle += 0.3 * degree * normal(random);
    const auto place = [&](const char* name) {
      return std::find(trial.muscles.begin(), trial.muscles.end(), name) - trial.muscles.begin();
    };
    trial.excitations.col(place("BRA")).swap(trial.excitations.col(place("TRIlong")));
    trials.push_back(std::move(trial));
  }
  DiscoveryRequest request{
      elbow.model, ShippedElbow::options(), "elbow_flexion", trials, 1, {}, {}, {}, {}};
  request.search.maxEffects = 1;
  request.search.latentTolerance = 0.02;  // the torque is no noise of the inputs
  // what could imitate such a torque, and what takes time
  request.problem.without = {"visc",      "coulomb", "stribeck",  "drag",      "powerdamp",
                             "stiffness", "cubic",   "limit",     "limit_exp", "payload",
                             "tilt",      "const",   "handforce", "spring",    "timed",
                             "fatigue",   "wraps",   "muscles",   "crosstalk", "electrodes",
                             "baselines", "mass",    "tau",       "tendon"};
  const DiscoveryResult result = discover(request);
  const auto& verdict = result.found.verdict;
  EXPECT_EQ(verdict.finding, info::discover::Finding::named) << verdict.sentence;
  ASSERT_TRUE(result.positionBreak) << verdict.sentence;
  ASSERT_TRUE(result.trialsAreCut) << verdict.sentence;
  EXPECT_TRUE(std::isfinite(result.inputs.correlation));  // of the whole trials
  EXPECT_NEAR(result.positionBreak->position / degree, 108, 5);
  ASSERT_EQ(verdict.effects.size(), 1u);
  EXPECT_EQ(result.data->candidates()[verdict.effects.front().candidate].id, "swap_TRIlong_BRA");
  EXPECT_TRUE(verdict.vetoed);
  EXPECT_NE(verdict.sentence.find("Above elbow_flexion = "), std::string::npos) << verdict.sentence;
  ASSERT_EQ(result.trials.size(), 3u);
  for (const RepairedTrial& one : result.trials) {
    ASSERT_TRUE(one.driven);
    EXPECT_NEAR(one.after, one.fitted, 0.01 * degree);
  }
}

}  // namespace
}  // namespace bio::discover
