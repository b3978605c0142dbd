#include "bio/parameters/with_parameters.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "bio/parameters/parameters.h"
#include "bio/skeleton/articulated_tree.h"
#include "support/shipped_elbow.h"
#include "support/throws_saying.h"

namespace bio {
namespace {

using fixtures::ShippedElbow;
using support::throwsSaying;

ModelWithParameters elbowWith(const std::vector<NamedValue>& values) {
  const ShippedElbow elbow;
  return withParameters(elbow.model, ShippedElbow::options(), values);
}

TEST(WithParameters, SetsTheseNumbersAndNoOthers) {
  const ShippedElbow elbow;
  const ModelWithParameters set = withParameters(
      elbow.model, ShippedElbow::options(), {{"TRI.radius", 0.018}, {"BRA.pennation", 0.1, true}});
  const MusculoskeletalSystem system(set.model, ShippedElbow::options());
  const ParameterCatalogue catalogue(set.model, system, {system.skeleton().defaultValues(), {}});
  std::vector<std::string> changed;
  for (const ModelParameter& parameter : catalogue.parameters()) {
    if (parameter.name.starts_with("initial.")) continue;
    const auto& before = elbow.catalogue.parameters()[elbow.catalogue.find(parameter.name)];
    if (parameter.value != before.value) changed.push_back(parameter.name);
  }
  EXPECT_THAT(changed, testing::UnorderedElementsAre("TRI.radius", "BRA.pennation_angle"));
  ASSERT_EQ(set.numbers.size(), 2u);
  EXPECT_EQ(set.numbers[0].name, "TRI.radius");
  EXPECT_EQ(set.numbers[0].unit, "m");
  EXPECT_EQ(set.numbers[0].value, 0.018);
  EXPECT_EQ(set.numbers[0].before, 0.016);
  EXPECT_EQ(set.numbers[1].name, "BRA.pennation_angle");
  EXPECT_TRUE(set.ofTrial.empty());
  EXPECT_EQ(elbowWith({}).model, elbow.model);
}

TEST(WithParameters, LeavesNumbersOfATrialToItsReader) {
  const ModelWithParameters set =
      elbowWith({{"emg.BRA.gain", 1.5}, {"hand.mass", 1}, {"initial.elbow_flexion", 0.5, true}});
  ASSERT_EQ(set.ofTrial.size(), 2u);
  EXPECT_EQ(set.ofTrial[0].name, "emg.BRA.gain");
  EXPECT_EQ(set.ofTrial[1].value, 0.5);
  ASSERT_EQ(set.numbers.size(), 1u);
  throwsSaying([&] { requireOfModel(set); }, "'emg.BRA.gain' belongs to a trial");
  EXPECT_NO_THROW(requireOfModel(elbowWith({{"hand.mass", 1}})));
}

TEST(WithParameters, RefusesWhatIsNoNumberOfTheModel) {
  const auto refused = [](const std::vector<NamedValue>& values, const char* words) {
    throwsSaying([&] { elbowWith(values); }, words);
  };
  refused({{"TRI.raduis", 0.018}}, "nearest: TRI.radius");
  refused({{"hand.mass", 1}, {"hand.mass", 1}}, "'hand.mass' is given twice");
  refused({{"BRA.pennation", 0.1}, {"BRA.pennation_angle", 0.2}},
          "'BRA.pennation_angle' is given twice");
  refused({{"activation.time_scale", 0.1}, {"BRA.time_scale", 0.2}}, "set the same value");
  refused({{"hand.mass", 0.5, true}}, "hand.mass is no angle");
  refused({{"hand.mass", std::numeric_limits<double>::quiet_NaN()}}, "finite");
  refused({{"hand.mass", -0.1}}, "hand.mass = -0.1 kg, must be ≥ 0");
  const ShippedElbow passive("elbow8_passive");
  for (const char* name :
       {"elbow_flexion_ligaments.upper_stiffness", "elbow_flexion_ligaments.damping"})
    throwsSaying(
        [&] {
          withParameters(passive.model, ShippedElbow::options(), {{name, -1}});
        },
        "must be ≥ 0");
  EXPECT_NO_THROW((void)elbowWith({{"hand.mass_center.x", -0.01}, {"hand.inertia.xy", -1e-5}}));
  refused({{"TRI.radius", 1}}, "must be below");
  refused({{"TRI.radius", -0.01}}, "radius");
}

TEST(WithParameters, WithoutATrialHasTheNumbersOfTheWholeModel) {
  const ShippedElbow elbow;
  const SystemOptions options = optionsOfWholeModel(elbow.model, {});
  EXPECT_NO_THROW((void)withParameters(elbow.model, options, {{"BRA.optimal_fiber_length", 0.1}}));
  EXPECT_EQ(optionsOfWholeModel(elbow.model, {{"elbow_flexion", 0.5}})
                .skeleton.lockedValues.at("elbow_flexion"),
            0.5);
  // a model that locks all
  Model locked = elbow.model;
  for (Joint& joint : locked.joints)
    for (Coordinate& coordinate : joint.coordinates) coordinate.locked = true;
  EXPECT_EQ(optionsOfWholeModel(locked, {}).skeleton.freeCoordinates,
            independentCoordinates(locked));
}

}  // namespace
}  // namespace bio
