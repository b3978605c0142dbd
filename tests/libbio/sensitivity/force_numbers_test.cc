#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bio/opensim/osim_file.h"
#include "bio/simulation/simulate_batch.h"
#include "bio/tables/trial_table.h"
#include "libbio/forces/arm_with_forces.h"
#include "support/scratch_folder.h"
#include "support/sensitivity_differences.h"

// Numbers of springs, bushings, elastic paths and actuators as parameters.
namespace bio {
namespace {

using fixtures::ArmOfSeven;
using fixtures::motorForce;
using fixtures::withAll;
using fixtures::withMotor;

const std::vector<std::string> numbers{"band.*",   "cord.*",  "sleeve.*", "ligament.*",
                                       "spring.*", "strap.*", "motor.*"};

TEST(ForceNumbers, AreCalledAsInOpenSim) {
  const ArmOfSeven c(0.1, ArmOfSeven::coordinates(), false, withMotor(withAll()));
  const ParameterCatalogue catalogue(c.model, c.system, {c.start.q, {}});
  const auto expectNumber = [&](const char* name, double value, const char* unit) {
    const ModelParameter& p = catalogue.parameters()[catalogue.find(name)];
    EXPECT_EQ(p.value, value) << name;
    EXPECT_EQ(p.unit, unit) << name;
    EXPECT_GT(p.sd, 0) << name;
    EXPECT_LE(p.lower, value) << name;
    EXPECT_GT(p.upper, value) << name;
    EXPECT_FALSE(p.meaning.empty()) << name;
  };
  expectNumber("band.stiffness", 40, "N/m");
  expectNumber("band.rest_length", 0.1, "m");
  expectNumber("cord.rest_length", 0, "m");
  expectNumber("sleeve.rotational_stiffness.y", 0.8, "N m/rad");
  expectNumber("sleeve.translational_stiffness.z", 250, "N/m");
  expectNumber("sleeve.rotational_damping.x", 0.02, "N m s/rad");
  expectNumber("sleeve.translational_damping.z", 1, "N s/m");
  expectNumber("ligament.resting_length", 0.1, "m");
  expectNumber("ligament.pcsa_force", 20, "N");
  expectNumber("spring.resting_length", 0.2, "m");
  expectNumber("spring.stiffness", 90, "N/m");
  expectNumber("spring.dissipation", 0.1, "s/m");
  expectNumber("strap.slack_length", 0.11, "m");
  expectNumber("strap.linear_stiffness", 30, "N");
  expectNumber("strap.transition_strain", 0.06, "");
  expectNumber("strap.damping_coefficient", 2, "N s");
  expectNumber("motor.optimal_force", 1.5, "N m");
  EXPECT_FALSE(catalogue.has("ligament.damping_coefficient"));
  EXPECT_FALSE(catalogue.has("ligament.transition_strain"));
}

TEST(ForceNumbers, OfWhatDoesNotActAreNotListed) {
  Model model = withMotor(withAll());
  model.pointSprings[1].enabled = false;
  const ArmOfSeven c(0.1, {"pro_sup"}, false, model);
  const ParameterCatalogue catalogue(c.model, c.system, {c.start.q, {}});
  EXPECT_TRUE(catalogue.has("band.stiffness"));                  // between ground and hand
  EXPECT_FALSE(catalogue.has("cord.stiffness"));                 // switched off
  EXPECT_FALSE(catalogue.has("sleeve.rotational_stiffness.x"));  // between bodies that rest
  EXPECT_FALSE(catalogue.has("strap.slack_length"));             // a path that nothing moves
  EXPECT_FALSE(catalogue.has("motor.optimal_force"));            // on a coordinate that is locked
}

// Of two of one name only the one that is switched on acts, in whatever order.
TEST(ForceNumbers, OfTwoOfOneNameAreThoseOfTheOneThatActs) {
  for (const bool offFirst : {true, false}) {
    Model model = withMotor(withAll());
    const auto twice = [&](auto& forces, auto change) {
      auto off = forces.front();
      off.enabled = false;
      change(off);
      forces.insert(offFirst ? forces.begin() : forces.end(), off);
      return offFirst ? 1u : 0u;
    };
    const std::size_t path = twice(model.elasticPaths, [](ElasticPath& p) { p.scale = 777; });
    const std::size_t motor =
        twice(model.actuators, [](CoordinateActuator& a) { a.optimalForce = 777; });
    const std::string name = model.elasticPaths[path].name;
    const ArmOfSeven c(0.1, ArmOfSeven::coordinates(), false, model);
    const ParameterCatalogue catalogue(c.model, c.system, {c.start.q, {}});
    for (const ModelParameter& one : catalogue.parameters()) {
      EXPECT_NE(one.value, 777) << one.name;
      EXPECT_EQ(std::count_if(catalogue.parameters().begin(), catalogue.parameters().end(),
                              [&](const ModelParameter& p) { return p.name == one.name; }),
                1)
          << one.name;
    }
    const auto targetOf = [&](const std::string& parameter) {
      return std::get<ForceNumberTarget>(
                 catalogue.parameters()[catalogue.find(parameter)].targets.front())
          .force;
    };
    EXPECT_EQ(targetOf("ligament.pcsa_force"), path);
    EXPECT_EQ(targetOf("motor.optimal_force"), motor);
    // the column of a trial controls it, too
    Table table;
    table.columns = {"time", model.muscles.front().name, "motor"};
    table.values.resize(2, 3);
    table.values << 0, 0.1, 2, 1, 0.1, 2;
    EXPECT_EQ(trialFrom(table, "made", model).applied.front().values[0], 3) << offFirst;
  }
}

TEST(ForceNumbers, SetTheModelWhichIsWrittenWithThem) {
  const ArmOfSeven c(0.1, ArmOfSeven::coordinates(), false, withMotor(withAll()));
  const ParameterCatalogue catalogue(c.model, c.system, {c.start.q, {}});
  const auto wanted = catalogue.select(numbers);
  ASSERT_EQ(wanted.size(), 26u);
  const Eigen::VectorXd values = 1.1 * catalogue.values(wanted).array() + 0.001;
  const auto setting = catalogue.at(wanted, values);
  const support::ScratchFolder folder;
  Model changed = setting.model;
  changed.externalLoads.clear();
  writeOsim(changed, folder / "changed.osim");
  const Model again = readOsim(folder / "changed.osim");
  const ParameterCatalogue read(again, MusculoskeletalSystem(again, c.options), {c.start.q, {}});
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    const ModelParameter& p = catalogue.parameters()[wanted[i]];
    EXPECT_NEAR(read.parameters()[read.find(p.name)].value, values[static_cast<Eigen::Index>(i)],
                1e-14)
        << p.name;
  }
  // and one at a time nothing else changes
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    const auto one = catalogue.at({wanted[i]}, values.segment(static_cast<Eigen::Index>(i), 1));
    const ParameterCatalogue now(one.model, MusculoskeletalSystem(one.model, c.options),
                                 {c.start.q, {}});
    for (const std::size_t j : wanted) {
      const bool isChanged = j == wanted[i];
      EXPECT_EQ(now.parameters()[j].value != catalogue.parameters()[j].value, isChanged);
    }
  }
}

TEST(ForceNumbers, SensitivitiesMatchDifferences) {
  for (const auto& free : {std::vector<std::string>{"elbow_flexion"}, ArmOfSeven::coordinates()}) {
    const ArmOfSeven c(0.2, free, false, withMotor(withAll()));
    const ParameterCatalogue catalogue(
        c.model, c.system, {c.start.q, Eigen::VectorXd::Constant(c.start.q.size(), 0.3)});
    SimulationOptions options;
    options.duration = 0.08;
    options.externalForce = motorForce(c.system.skeleton().numCoordinates());
    const fixtures::DiscoveryProblem d = fixtures::compareWithDifferences(
        c.system, c.options, c.excitation, catalogue, catalogue.select(numbers), options);
    fixtures::tell(d);
    EXPECT_GT(d.compared, 26 * 10);
    EXPECT_LT(d.worst, 1e-5) << d.of;
  }
}

TEST(ForceNumbers, TheReactionAtASwungShoulderFollowsThemToo) {
  const ArmOfSeven c(0.2, {"elbow_flexion", "shoulder_elv"}, false, withMotor(withAll()));
  SystemOptions swung = c.options;
  swung.prescribed = {"shoulder_elv"};
  const MusculoskeletalSystem system(c.model, swung);
  SimulationOptions options;
  options.duration = 0.08;
  options.externalForce = motorForce(2);
  options.prescribed.add(1, Function{1, SineFunction{0.2, 5, 0.3, 0.8}});
  StartPoint start{c.start.q, Eigen::VectorXd::Zero(2)};
  options.prescribed.place(0, start.q, start.qDot);
  const ParameterCatalogue catalogue(c.model, system, start);
  const fixtures::DiscoveryProblem d = fixtures::compareWithDifferences(
      system, swung, c.excitation, catalogue, catalogue.select(numbers), options);
  fixtures::tell(d);
  EXPECT_GT(d.compared, 26 * 5);
  EXPECT_LT(d.worst, 1e-5) << d.of;
}

// A batch of hinges whose motors are of different strength, and one simulated alone.
TEST(ForceNumbers, ABatchKnowsTheStrengthOfEachMotor) {
  const ArmOfSeven weak(0.2, {"elbow_flexion"}, false, withMotor(ArmOfSeven::heldModel()));
  Model model = weak.model;
  model.actuators[0].optimalForce = 3;
  const ArmOfSeven strong(0.2, {"elbow_flexion"}, false, model);
  SimulationOptions options;
  options.duration = 0.15;
  options.externalForce = motorForce(1);
  const std::vector<LaneJob> jobs{{&weak.system, &weak.excitation, &weak.start},
                                  {&strong.system, &weak.excitation, &weak.start}};
  const std::vector<Trajectory> both = simulateTogether(jobs, options);
  SimulationOptions doubled = options;
  Eigen::MatrixXd values(8, 1);
  for (Eigen::Index k = 0; k < 8; ++k) {
    values(k, 0) = 3 * options.externalForce.controls()[0].values[k];
  }
  doubled.externalForce = {options.externalForce.times(), values};
  const Trajectory expected = simulate(weak.system, weak.excitation, weak.start, doubled);
  EXPECT_GT((both[0].q - both[1].q).cwiseAbs().maxCoeff(), 1e-3);
  EXPECT_LT((both[1].q - expected.q).cwiseAbs().maxCoeff(), 1e-12);
}

}  // namespace
}  // namespace bio
