// What makes steps cheap: first guesses, fibres whose own equation is solved before the system's,
// and paths that several threads find.
#include <gtest/gtest.h>

#include "bio/path/posture_samples.h"
#include "bio/simulation/simulate.h"
#include "libbio/simulation/arm_of_seven.h"
#include "simulation/first_guess.h"
#include "support/shipped_elbow.h"

namespace bio {
namespace {

using fixtures::ShippedElbow;

struct Effort {
  double perStep;  ///< Newton iterations of the system
  long halved;
};
Effort effortOf(const std::string& model, double step) {
  const ShippedElbow elbow(model, "curl_fast");
  SimulationOptions options = fixtures::forSeconds(4);
  options.step = step;
  const SystemState start = initialState(
      elbow.system, startCoordinates(elbow.trial, elbow.system, {}), elbow.excitation, 0);
  const Trajectory motion = simulate(elbow.system, elbow.excitation, start, options);
  EXPECT_EQ(motion.outcome, Outcome::completed) << motion.why;
  return {static_cast<double>(motion.newtonIterations) / static_cast<double>(motion.steps),
          motion.halvedSteps};
}

// With one iteration for all fibres and the motion at once it is 3.7 and 6.0.
TEST(SettledFibres, TakeFewIterationsOfTheSystem) {
  for (const char* model : {"elbow8", "elbow8_Millard2012"}) {
    const Effort effort = effortOf(model, 0.02);
    EXPECT_LT(effort.perStep, 2.8) << model;
    EXPECT_EQ(effort.halved, 0) << model;
  }
}

// A smooth motion needs none of it: two iterations a step, the second for the last digits.
TEST(SettledFibres, CostASmoothMotionNothing) {
  EXPECT_LT(effortOf("elbow8", 0.0025).perStep, 2.05);
}

// Over parts of any length; with less than three parts behind it a parabola and a straight line.
TEST(FirstGuess, IsTheCubicThroughTheLastEnds) {
  const auto x = [](double t) { return 0.3 - 2 * t + 5 * t * t + 7 * t * t * t; };
  const std::vector<double> parts = {0.02, 0.01, 0.005, 0.03, 0.02, 0.04};
  stepping::PartLengths lengths{parts[0], parts[0]};
  stepping::LastEnds<double> ends(-2);
  double t = 0;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    const double h = parts[k];
    const double guess = ends.guess(lengths.weights(h), x(t));
    const double error = std::abs(guess - x(t + h));
    if (k == 0) {
      EXPECT_NEAR(guess, x(t) - 2 * h, 1e-15);
    } else if (k < 3) {
      EXPECT_GT(error, 1e-6) << k;
    } else {
      EXPECT_LT(error, 1e-14) << k;
    }
    ends.add(h, lengths, x(t), x(t + h));
    lengths.add(h);
    t += h;
  }
}

TEST(PathsByThreads, AreThoseOfOneThread) {
  const Model model = fixtures::ArmOfSeven::heldModel();
  SystemOptions options{{fixtures::ArmOfSeven::coordinates(), {}}, {}, {}};
  const MusculoskeletalSystem one(model, options);
  options.threads = 3;
  const MusculoskeletalSystem several(model, options);
  ASSERT_EQ(one.numMuscles(), several.numMuscles());
  EXPECT_EQ(one.warnings(), several.warnings());
  EXPECT_EQ(one.notes(), several.notes());
  const std::vector<double> middle(7, 0.3);
  const Posture posture = postureOf(one.skeleton(), middle);
  for (std::size_t i = 0; i < one.numMuscles(); ++i) {
    const SystemMuscle &a = one.muscles()[i], &b = several.muscles()[i];
    EXPECT_EQ(a.name, b.name);
    EXPECT_EQ(a.path.pathPoints(posture, 0.1), b.path.pathPoints(posture, 0.1)) << a.name;
  }
}

// The first of two wrong muscles is named, whichever thread is faster.
TEST(PathsByThreads, TheFirstErrorIsTheOneThatIsTold) {
  Model model = fixtures::ArmOfSeven::heldModel();
  ASSERT_GE(model.muscles.size(), 4u);
  for (const std::size_t wrong : {1u, 3u}) model.muscles[wrong].path.points.resize(1);
  SystemOptions options{{fixtures::ArmOfSeven::coordinates(), {}}, {}, {}};
  std::string first;
  for (options.threads = 1; options.threads <= 3; ++options.threads) {
    try {
      const MusculoskeletalSystem system(model, options);
      FAIL() << "a path of one point";
    } catch (const std::exception& error) {
      if (first.empty()) first = error.what();
      EXPECT_EQ(error.what(), first);
      EXPECT_NE(first.find(model.muscles[1].name), std::string::npos) << first;
    }
  }
}

}  // namespace
}  // namespace bio
