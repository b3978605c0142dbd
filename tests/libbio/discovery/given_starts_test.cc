#include <gtest/gtest.h>

#include "info/discovery/likelihood/hypothesis.h"
#include "libbio/discovery/effect_cases.h"

namespace bio::discover {
namespace {

using namespace effect_cases;

// A start that is given is that of the limb, which a sensor that is off shows elsewhere.
TEST(GivenStarts, AreThoseOfTheLimbWhateverTheSensorShows) {
  const Case c(0.3);
  MusculoskeletalProblemOptions options = Case::exact();
  options.initial = {{"elbow_flexion", 0.4}};
  const auto make = [&] {
    return MusculoskeletalProblem(c.elbow.model, ShippedElbow::options(), "elbow_flexion",
                                  {cut(c.elbow.trial, 0.3)}, options);
  };
  const MusculoskeletalProblem data = make();
  const std::size_t angle = data.encompassing().quantities().size();
  EXPECT_EQ(data.quantities()[angle].name, "trial1.initial.elbow_flexion");
  EXPECT_EQ(data.quantities()[angle].nominal, 0.4);
  EXPECT_EQ(data.quantities()[angle].sd, c.data.quantities()[angle].sd);
  VectorXd values = info::discover::nominalValues(data);
  EXPECT_NEAR(data.outputs(0, values, {})[0], 0.4, 1e-12);
  const std::size_t bias = c.find("bias").quantities[0], gain = c.find("gain").quantities[0];
  values[static_cast<Index>(bias)] = 0.07;
  values[static_cast<Index>(gain)] = -0.1;
  EXPECT_NEAR(data.outputs(0, values, {})[0], 0.9 * 0.4 + 0.07, 1e-12);
  EXPECT_NEAR(data.startsAt(0, values).at(0).value, 0.4, 1e-12);
  const std::vector<std::size_t> wanted = {angle, angle + 1, bias, gain};
  const auto at = data.predict(0, values, {}, wanted, false);
  for (std::size_t j = 0; j < wanted.size(); ++j) {
    const auto f = [&](double step) {
      VectorXd moved = values;
      moved[static_cast<Index>(wanted[j])] += step;
      return data.outputs(0, moved, {});
    };
    EXPECT_LT(problem(at.gamma.col(static_cast<Index>(j)), f, 0.1), 2e-4) << wanted[j];
  }
  options.initial = {{"shoulder_elv", 0.4}};
  EXPECT_THROW(make(), std::invalid_argument);
}

}  // namespace
}  // namespace bio::discover
