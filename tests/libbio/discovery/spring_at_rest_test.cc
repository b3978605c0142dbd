// A free pendulum with a spring, or with a sensor that reads too large: data that tell neither.

#include <gtest/gtest.h>

#include <cmath>

#include "bio/discovery/musculoskeletal_problem.h"
#include "info/discovery/discover.h"
#include "libbio/discovery/free_swing.h"

namespace bio::discover {
namespace {

constexpr double springPerMass = 0.3;  // [N m/rad/kg], 5 % of the weight's

/// Log evidence of an effect of a pendulum whose coordinate has a range of ± this [rad].
double evidenceOf(const std::string& effect, double range) {
  Model model = freePendulum(1);
  for (Joint& joint : model.joints)
    for (Coordinate& coordinate : joint.coordinates) {
      coordinate.rangeMin = -range;
      coordinate.rangeMax = range;
    }
  MusculoskeletalProblemOptions options;
  options.simulation.step = 0.005;
  const auto spring = [](double q, double) { return springPerMass * q; };
  const MusculoskeletalProblem data(
      model, SystemOptions{{{"swing"}, {}}, {}, {}}, "swing",
      {freeSwing(0.96, 1, spring), freeSwing(-0.88, 2, spring), freeSwing(-1.23, 3, spring)},
      options);
  const auto nominal = info::discover::nominalValues(data);
  const info::discover::Likelihood likelihood(data, {0, 1, 2}, nominal);
  for (std::size_t c = 0; c < data.candidates().size(); ++c) {
    const info::discover::Candidate& candidate = data.candidates()[c];
    if (candidate.id != effect) continue;
    Eigen::VectorXd start = nominal;
    for (std::size_t i = 0; i < candidate.quantities.size(); ++i)
      start[Eigen::Index(candidate.quantities[i])] = candidate.starts.front()[Eigen::Index(i)];
    const double noise = 0.2 * std::acos(-1) / 180;
    return likelihood
        .fit(makeHypothesis(data, {c}, {0, 1, 2}), {noise, 0, 0.08}, start, {}, {60, 1e-9})
        .logEvidence;
  }
  throw std::invalid_argument(effect);
}

// Its rest position is where springs rest: what range a reader assumed costs it nothing.
TEST(SpringAtRest, IsAsProbableWhateverTheRangeOfTheCoordinate) {
  EXPECT_NEAR(evidenceOf("stiffness", 60), evidenceOf("stiffness", 3), 0.2);
  EXPECT_NEAR(evidenceOf("cubic", 60), evidenceOf("cubic", 3), 0.2);
}

TEST(SpringAtRest, IsNoLessProbableThanASensorGainThatDoesAsWell) {
  EXPECT_GT(evidenceOf("stiffness", 60), evidenceOf("gain", 60));
}

}  // namespace
}  // namespace bio::discover
