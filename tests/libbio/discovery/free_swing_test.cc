// A pendulum without muscles that swings freely: what can be said of it does not depend on its
// mass.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "bio/discovery/musculoskeletal_problem.h"
#include "bio/discovery/workflow.h"
#include "info/discovery/discover.h"
#include "libbio/discovery/free_swing.h"

namespace bio::discover {
namespace {

using Eigen::VectorXd;
using testing::ElementsAre;

MusculoskeletalProblem swings(double mass, double step) {
  MusculoskeletalProblemOptions options;
  options.simulation.step = step;
  return {freePendulum(mass),
          SystemOptions{{{"swing"}, {}}, {}, {}},
          "swing",
          {freeSwing(1.2, 1, viscous), freeSwing(0.7, 2, viscous), freeSwing(0.9, 3, viscous)},
          options};
}

struct FoundInSwing {
  std::vector<std::string> names;
  double logBayesFactor = 0, value = 0, sd = 0;
  std::string sentence;
};

FoundInSwing foundInSwing(double mass) {
  const MusculoskeletalProblem data = swings(mass, 0.005);
  info::discover::Options search;
  search.heldOut = {2};
  const info::discover::Verdict verdict = info::discover::run(data, search);
  FoundInSwing result;
  result.sentence = verdict.sentence;
  for (const auto& effect : verdict.effects) {
    result.names.push_back(data.candidates()[effect.candidate].id);
    result.logBayesFactor = effect.logBayesFactor;
    result.value = effect.estimates.front().value;
    result.sd = effect.estimates.front().sd;
  }
  return result;
}

TEST(FreeSwing, IsDampedWhateverThePendulumWeighs) {
  const FoundInSwing light = foundInSwing(0.1), heavy = foundInSwing(20);
  ASSERT_THAT(light.names, ElementsAre("visc")) << light.sentence;
  ASSERT_THAT(heavy.names, ElementsAre("visc")) << heavy.sentence;
  EXPECT_NEAR(heavy.logBayesFactor, light.logBayesFactor, 0.1);
  EXPECT_NEAR(light.value, 0.1 * frictionPerMass, 3 * light.sd);
  EXPECT_NEAR(heavy.value, 200 * light.value, 0.1 * heavy.sd);
  EXPECT_LT(light.sd, 0.1 * light.value);
}

// Steps that are too long: what was found is told and written, with the reservation in it.
TEST(FreeSwing, WithLongStepsIsWrittenWithAReservation) {
  const Model model = freePendulum(0.1);
  MusculoskeletalProblemOptions options;
  const DiscoveryRequest request{
      model,
      SystemOptions{{{"swing"}, {}}, {}, {}},
      "swing",
      {freeSwing(1.2, 1, viscous), freeSwing(0.7, 2, viscous), freeSwing(0.9, 3, viscous)},
      1,
      0.02,
      options,
      {},
      {"a test", {"swing.csv"}}};
  const DiscoveryResult result = discover(request);
  const info::discover::Verdict& verdict = result.found.verdict;
  EXPECT_EQ(verdict.finding, info::discover::Finding::numerical) << verdict.sentence;
  ASSERT_FALSE(verdict.effects.empty());
  EXPECT_EQ(result.data->candidates()[verdict.effects.front().candidate].id, "visc");
  ASSERT_TRUE(result.repaired);
  EXPECT_TRUE(result.addsEffect);
  EXPECT_FALSE(result.effectOnly);
  EXPECT_THAT(result.repaired->added.model.credits,
              testing::HasSubstr("with the reservation: Halving the time step changes"));
  for (const RepairedTrial& trial : result.trials)
    EXPECT_NEAR(trial.after, trial.fitted, 1e-4) << trial.index;
}

// The energy is judged by the work that was done, of which there is none here.
TEST(FreeSwing, ReachesItsEndWithEveryIntegrator) {
  const MusculoskeletalSystem system(freePendulum(0.1), SystemOptions{{{"swing"}, {}}, {}, {}});
  SystemState start;
  start.q = VectorXd::Constant(1, 1.2);
  start.qDot = VectorXd::Zero(1);
  for (const Integrator integrator :
       {Integrator::variational, Integrator::rungeKutta4, Integrator::cvode}) {
    SimulationOptions options;
    options.integrator = integrator;
    options.step = 0.001;
    options.duration = 2;
    const Trajectory motion = simulate(system, {{0}, Eigen::MatrixXd::Zero(1, 0)}, start, options);
    EXPECT_EQ(motion.outcome, Outcome::completed) << motion.why;
    EXPECT_LT(energyError(system, motion), 1e-4 * 0.1 * 9.81 * rodLength);
  }
}

TEST(FreeSwing, HasNoParametersOfElectrodes) {
  const Model model = freePendulum(1);
  const MusculoskeletalSystem system(model, {{{"swing"}, {}}, {}, {}});
  const ParameterCatalogue all(model, system, {system.skeleton().defaultValues(), {}});
  for (const ModelParameter& parameter : all.parameters())
    EXPECT_FALSE(parameter.name.starts_with("emg.")) << parameter.name;
  EXPECT_NO_THROW(all.find("initial.swing"));
}

}  // namespace
}  // namespace bio::discover
