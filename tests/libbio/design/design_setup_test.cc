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
  given.noise = 0.02;
  given.nuisance = {3};  // replaced
  const DesignQuestion q = designQuestion(
      elbow.catalogue, {{"TRI.radius", "hand.mass"}, {"*.radius"}, false, {{"hand.mass", 0.1}}},
      given);
  EXPECT_EQ(q.noise, 0.02);
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

TEST(DesignSetup, TheRangeIsThatOfTheCoordinateUnlessAnotherIsGiven) {
  const ShippedElbow elbow;
  const Coordinate& coordinate = elbow.arm.skeleton().coordinates().front();
  DesignLimits limits;
  limits.speed = 3;
  const DesignLimits own = withinRange(limits, coordinate, {});
  EXPECT_EQ(own.speed, 3);
  EXPECT_EQ(own.lower, coordinate.rangeMin);
  EXPECT_EQ(own.upper, coordinate.rangeMax);
  const DesignLimits given = withinRange(limits, coordinate, std::pair(0.5, 1.0));
  EXPECT_EQ(given.lower, 0.5);
  EXPECT_EQ(given.upper, 1);
}

TEST(DesignSetup, GroupsAreFlexorsExtensorsOrNames) {
  const ShippedElbow elbow;
  const auto groups =
      muscleGroups(elbow.arm, elbow.catalogue.nominal().start.q, {"extensors", "BRA+BRD", "PT"});
  ASSERT_EQ(groups.size(), 3u);
  EXPECT_EQ(groups[0].muscles, (std::vector<std::string>{"TRIlong", "TRIlat", "TRImed", "ANC"}));
  EXPECT_EQ(groups[1].muscles, (std::vector<std::string>{"BRA", "BRD"}));
  EXPECT_EQ(groups[2].name, "PT");
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
  const Coordinate& coordinate = elbow.arm.skeleton().coordinates().front();
  throwsSaying([&] { (void)withinRange({}, coordinate, std::pair(1.0, 1.0)); },
               "range: 1 to 1 rad, must rise");
}

}  // namespace
}  // namespace bio
