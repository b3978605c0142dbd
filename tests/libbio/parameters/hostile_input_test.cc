#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <ctime>

#include "support/shipped_elbow.h"

// Words and numbers that mean harm, of a model that was read: refused with one line, at once.
namespace bio {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// The one line that `work` refuses with.
template <class Refusal, class Work>
std::string refusedWith(Work work) {
  try {
    work();
  } catch (const Refusal& refusal) {
    EXPECT_THAT(refusal.what(), Not(HasSubstr("\n")));
    return refusal.what();
  }
  return "done without complaint";
}

TEST(HostileInput, APatternOfManyStarsIsMatchedAtOnce) {
  const fixtures::ShippedElbow elbow;
  const std::clock_t start = std::clock();
  std::string stars;
  for (int i = 0; i < 40; ++i) stars += "*i";
  EXPECT_THAT(refusedWith<std::invalid_argument>([&] { elbow.catalogue.select({stars}); }),
              HasSubstr("no parameter matches"));
  EXPECT_LT(std::clock() - start, 2 * CLOCKS_PER_SEC);
  const std::vector<std::size_t> radius = {elbow.catalogue.find("TRI.radius")};
  for (const std::string pattern : {"TRI*adius", "*RI.*us", "**TRI.radius*", "TRI.ra*a*ius"}) {
    const bool holds = pattern != "TRI.ra*a*ius";
    try {
      EXPECT_EQ(elbow.catalogue.select({pattern}), radius) << pattern;
      EXPECT_TRUE(holds) << pattern;
    } catch (const std::invalid_argument&) {
      EXPECT_FALSE(holds) << pattern;
    }
  }
}

TEST(HostileInput, AMuscleOfNoFiniteLengthIsNamed) {
  fixtures::ShippedElbow elbow;
  elbow.model.muscles[0].path.points[0].location.x() = 1e300;
  const MusculoskeletalSystem system(elbow.model, fixtures::ShippedElbow::options());
  const std::string refusal = refusedWith<NoStaticEquilibrium>(
      [&] { initialState(system, Eigen::VectorXd::Constant(1, 0.5), elbow.excitation, 0); });
  EXPECT_THAT(refusal, HasSubstr("muscle '" + elbow.model.muscles[0].name +
                                 "': muscle–tendon length at the start = inf m, must be finite"));
}

}  // namespace
}  // namespace bio
