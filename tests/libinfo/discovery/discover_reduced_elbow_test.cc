// The whole way on the reduced elbow: data from independent code, parameters off within tolerance.
#include <gtest/gtest.h>

#include "info/discovery/discover.h"
#include "reduced/reduced_truth.h"

namespace {

using namespace info::discover;

Verdict found(const reduced::Elbow& elbow) {
  Options options;
  options.sds = 0.5 * 0.017453292519943295;
  options.latentTolerance = 0.02;
  options.heldOut = {2};
  return run(elbow, options);
}
reduced::Recipe recipe() {
  reduced::Recipe recipe;
  recipe.seconds = 3;
  return recipe;
}

TEST(DiscoverOnTheReducedElbow, NamesViscousDampingAndClosesTheGap) {
  reduced::Recipe damped = recipe();
  damped.effects = {{"visc", 0.25}};
  const reduced::Elbow elbow(reduced::record(damped, 41));
  const Verdict v = found(elbow);
  EXPECT_EQ(v.finding, Finding::named) << v.sentence;
  ASSERT_EQ(v.effects.size(), 1U);
  EXPECT_EQ(elbow.candidates()[v.effects[0].candidate].id, "visc");
  EXPECT_NEAR(v.effects[0].estimates[0].value, 0.25, 4 * v.effects[0].estimates[0].sd);
  EXPECT_GT(v.probability, 0.99);
  ASSERT_TRUE(v.heldOut && v.heldOut->closedFromCalibrated);
  EXPECT_GT(*v.heldOut->closedFromCalibrated, 0.9);
  EXPECT_FALSE(v.before.adequate() && v.latentSizeBefore < 0.02);
}

TEST(DiscoverOnTheReducedElbow, FindsNothingWhereOnlyParametersAreOffWithinTheirTolerance) {
  const Verdict v = found(reduced::Elbow(reduced::record(recipe(), 42)));
  EXPECT_EQ(v.finding, Finding::none) << v.sentence;
  EXPECT_TRUE(v.before.adequate());
  EXPECT_EQ(v.detectability.size(), 31U - 1U);
}

TEST(DiscoverOnTheReducedElbow, DoesNotNameAnEffectThatTheCatalogueLacks) {
  reduced::Recipe damped = recipe();
  damped.effects = {{"tremor", 0.4}};
  const Verdict v = found(reduced::Elbow(reduced::record(damped, 43)));
  EXPECT_EQ(v.finding, Finding::unknown) << v.sentence;
  ASSERT_TRUE(v.unknown);
  EXPECT_NEAR(v.unknown->peakFrequency, 4.7, 0.3);
}

}  // namespace
