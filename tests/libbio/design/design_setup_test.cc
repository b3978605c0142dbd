#include "bio/design/design_setup.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/shipped_elbow.h"
#include "support/throws_saying.h"

namespace bio {
namespace {

using fixtures::ShippedElbow;
using support::throwsSaying;

TEST(DesignSetup, NuisanceParametersHaveTheirDefaultPriorsAndNoneTwice) {
  const ShippedElbow elbow;
  DesignQuestion given;
  given.period = 0.02;
  given.nuisance = {3};  // replaced
  const DesignQuestion q = designQuestion(
      elbow.catalogue, {{"TRI.radius", "hand.mass"}, {"*.radius"}, false, {{"hand.mass", 0.1}}},
      given);
  EXPECT_EQ(q.period, 0.02);
  EXPECT_EQ(q.parameters, elbow.catalogue.select({"TRI.radius", "hand.mass"}));
  const std::vector<std::size_t> radii = elbow.catalogue.select({"*.radius"});
  ASSERT_EQ(q.nuisance.size(), radii.size() - 1);
  const std::size_t asked = q.parameters[0];
  EXPECT_EQ(std::count(q.nuisance.begin(), q.nuisance.end(), asked), 0);
  EXPECT_TRUE(std::isinf(q.priorSd[0]));
  EXPECT_EQ(q.priorSd[1], 0.1);
  EXPECT_EQ(q.priorSd[2], elbow.catalogue.parameters()[q.nuisance[0]].sd);
  const DesignQuestion all = designQuestion(elbow.catalogue, {{"TRI.radius"}, {}, true, {}}, {});
  EXPECT_EQ(all.priorSd[0], elbow.catalogue.parameters()[asked].sd);
  EXPECT_TRUE(all.nuisance.empty());
}

TEST(DesignSetup, LimitsAreOfAllFreeCoordinatesOrByName) {
  const ShippedElbow elbow;
  const MusculoskeletalSystem two(elbow.model, {{{"elbow_flexion", "shoulder_elv"}, {}}, {}, {}});
  const Coordinate& coordinate = elbow.system.skeleton().coordinates().front();
  DesignLimits limits;
  limits.robustness = 3;
  const DesignLimits own = withCoordinates(limits, elbow.system, {});
  EXPECT_EQ(own.robustness, 3);
  ASSERT_EQ(own.coordinates.size(), 1u);
  EXPECT_EQ(own.coordinates[0].lower, coordinate.rangeMin);
  EXPECT_EQ(own.coordinates[0].upper, coordinate.rangeMax);
  EXPECT_EQ(own.coordinates[0].torque, 10);
  GivenLimits given{{{"", {0.5, 1.0}}}, {{"", 4}}, {{"", 2}}};
  const DesignLimits one = withCoordinates(limits, elbow.system, given);
  EXPECT_EQ(one.coordinates[0].lower, 0.5);
  EXPECT_EQ(one.coordinates[0].upper, 1);
  EXPECT_EQ(one.coordinates[0].torque, 4);
  EXPECT_EQ(one.coordinates[0].speed, 2);
  throwsSaying([&] { (void)withCoordinates(limits, two, given); },
               "range: must name its coordinate, of which 2 are free");
  given = {{{"shoulder_elv", {0.5, 1.0}}}, {{"elbow_flexion", 4}}, {{"", 2}, {"elbow_flexion", 3}}};
  for (const CoordinateLimits& each : withCoordinates(limits, two, given).coordinates) {
    const bool isElbow = each.coordinate == "elbow_flexion";
    EXPECT_EQ(each.torque, isElbow ? 4 : 0);
    EXPECT_EQ(each.speed, isElbow ? 3 : 2);
    EXPECT_EQ(each.lower, isElbow ? coordinate.rangeMin : 0.5);
  }
  EXPECT_EQ(freeCoordinates(two, 0.1, 0.2).size(), 2u);
  EXPECT_EQ(freeCoordinates(two, 0.1, 0.2)[0].sd, 0.1);
}

TEST(DesignSetup, GroupsAreFlexorsExtensorsOrNames) {
  const ShippedElbow elbow;
  const auto groups =
      muscleGroups(elbow.system, elbow.catalogue.nominal().start.q, {"extensors", "BRA+BRD", "PT"});
  ASSERT_EQ(groups.size(), 3u);
  EXPECT_EQ(groups[0].muscles, (std::vector<std::string>{"TRIlong", "TRIlat", "TRImed", "ANC"}));
  EXPECT_EQ(groups[1].muscles, (std::vector<std::string>{"BRA", "BRD"}));
  EXPECT_EQ(groups[2].name, "PT");
  // of each coordinate, without what does not cross it
  const MusculoskeletalSystem two(elbow.model, {{{"elbow_flexion", "shoulder_elv"}, {}}, {}, {}});
  const auto own = muscleGroups(two, two.skeleton().defaultValues(),
                                {"elbow_flexion.extensors", "shoulder_elv.extensors"});
  EXPECT_EQ(own[0].muscles, groups[0].muscles);
  EXPECT_EQ(std::count(own[1].muscles.begin(), own[1].muscles.end(), "TRIlat"), 0);
}

TEST(DesignSetup, SaysWhatIsWrong) {
  const ShippedElbow elbow;
  const auto asked = [&](const DesignNames& names) {
    return [&elbow, names] { (void)designQuestion(elbow.catalogue, names, {}); };
  };
  throwsSaying(asked({{"TRI.radios"}, {}, false, {}}), "TRI.radios");
  throwsSaying(asked({{"TRI.radius"}, {}, false, {{"hand.mass", 0.1}}}),
               "prior: hand.mass is neither a parameter of interest nor");
  throwsSaying(asked({{"TRI.radius"}, {}, false, {{"TRI.radius", NAN}}}),
               "prior: TRI.radius = nan, must be > 0");
  throwsSaying([] { (void)optimalityNamed("T"); }, "criterion 'T', must be E, A or D");
  EXPECT_EQ(optimalityNamed("A"), info::Optimality::a);
  EXPECT_EQ(optimalityNamed("D"), info::Optimality::d);
  throwsSaying(
      [&] {
        (void)withCoordinates({}, elbow.system, {{{"", {1.0, 1.0}}}});
      },
      "range: 1 to 1 rad, must rise");
  throwsSaying(
      [&] {
        (void)withCoordinates({}, elbow.system, {{}, {{"shoulder_elv", 1}}});
      },
      "torque of 'shoulder_elv': must be a coordinate that is free to move");
}

}  // namespace
}  // namespace bio
