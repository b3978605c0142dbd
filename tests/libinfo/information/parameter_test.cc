#include "info/information/parameter.h"

#include <gmock/gmock.h>

#include <cmath>

namespace {

using info::checkParameters;
using info::Parameter;
using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

TEST(Parameter, IsNamedWithItsUnit) {
  EXPECT_EQ(info::label({.name = "m1", .unit = "kg"}), "m1 [kg]");
  EXPECT_EQ(info::label({.name = "ratio"}), "ratio");
}

TEST(Parameter, MayBeFreeBoundedFixedOrKnownInAdvance) {
  EXPECT_NO_THROW(checkParameters({{.name = "a", .start = -3},
                                   {.name = "b", .start = 1, .lower = 0, .upper = 2},
                                   {.name = "c", .start = 2, .lower = 2, .upper = 2},
                                   {.name = "d", .prior = info::GaussianPrior{0, 1}}}));
}

TEST(Parameter, BoundsThatExcludeTheStartAreNamed) {
  EXPECT_THAT(
      [] { checkParameters({{.name = "m1", .unit = "kg", .start = 3, .lower = 0, .upper = 2}}); },
      ThrowsMessage<std::invalid_argument>(
          AllOf(HasSubstr("m1 [kg]"), HasSubstr("start 3"), HasSubstr("0 … 2"))));
}

TEST(Parameter, BreaksEachRuleOnce) {
  const double nan = std::nan("");
  const auto refused = [](Parameter parameter, const char* word) {
    EXPECT_THAT([&] { checkParameters({parameter}); },
                ThrowsMessage<std::invalid_argument>(HasSubstr(word)));
  };
  refused({.name = "", .start = 1}, "no name");
  refused({.name = "a", .start = nan}, "finite");
  refused({.name = "a", .start = 1, .lower = 2, .upper = 1}, "lower bound 2");
  refused({.name = "a", .start = 1, .lower = nan}, "lower bound");
  refused({.name = "a", .start = 1, .prior = info::GaussianPrior{0, 0}},
          "prior standard deviation");
  refused({.name = "a", .start = 1, .prior = info::GaussianPrior{0, nan}},
          "prior standard deviation");
  refused({.name = "a", .start = 1, .prior = info::GaussianPrior{nan, 1}}, "prior mean");
  EXPECT_THAT(
      [] {
        checkParameters({{.name = "a"}, {.name = "a"}});
      },
      ThrowsMessage<std::invalid_argument>(HasSubstr("twice")));
}

}  // namespace
