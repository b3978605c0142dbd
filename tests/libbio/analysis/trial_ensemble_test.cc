#include "bio/analysis/trial_ensemble.h"

#include <gtest/gtest.h>

#include "bio/analysis/replay.h"
#include "info/probability/random_stream.h"
#include "support/shipped_elbow.h"
#include "support/throws_saying.h"

namespace bio {
namespace {

using fixtures::ShippedElbow;
using support::throwsSaying;

struct DrawnElbow {
  explicit DrawnElbow(const TrialEnsembleOptions& options, Trial trial = elbow().trial)
      : ensemble(elbow().model, elbow().system, ShippedElbow::options(), trial,
                 beginningOf(trial, elbow().model, elbow().system, {}).point, options) {}
  static const ShippedElbow& elbow() {
    static const ShippedElbow one;
    return one;
  }
  TrialEnsemble ensemble;
};

TrialEnsembleOptions drawing(const std::vector<std::string>& names) {
  TrialEnsembleOptions options;
  options.laws.names = names;
  options.draws = 4;
  options.bandPoints = 3;
  return options;
}

TEST(TrialEnsemble, ADrawIsTheQuantilesOfItsRandomStream) {
  const DrawnElbow drawn(drawing({"hand.mass", "TRI.radius"}));
  EXPECT_EQ(drawn.ensemble.count(), 4u);
  info::RandomStream random(7, 3);
  const Eigen::VectorXd theta = drawn.ensemble.draw(3, 7);
  for (Eigen::Index i = 0; i < 2; ++i) {
    EXPECT_EQ(theta[i], drawn.ensemble.laws().parameters[static_cast<std::size_t>(i)].law.quantile(
                            random.uniform()));
  }
  EXPECT_NE(drawn.ensemble.draw(3, 8), theta);
}

TEST(TrialEnsemble, RunsAreReplaysOfTheModelWithTheDrawnParameters) {
  const DrawnElbow drawn(drawing({"hand.mass"}));
  const ShippedElbow& elbow = DrawnElbow::elbow();
  const Eigen::VectorXd theta = drawn.ensemble.draw(1, 5);
  const EnsembleRun run = drawn.ensemble.run(std::span(&theta, 1)).front();
  Model model = elbow.catalogue.at({elbow.catalogue.find("hand.mass")}, theta).model;
  const MusculoskeletalSystem system(model, ShippedElbow::options());
  SimulationOptions options;
  const TrialReplay replay =
      replayTrial(system, elbow.trial, options, beginningOf(elbow.trial, model, system, {}));
  EXPECT_NEAR(run.last, replay.motion.q(0, replay.motion.q.cols() - 1), 1e-9);
  EXPECT_NEAR(run.rmsError, replay.errors.front().second.rms, 1e-9);
  EXPECT_EQ(drawn.ensemble.course().back(), elbow.trial.times[0] + elbow.trial.duration());
  EXPECT_NEAR(run.atCourse[2], run.last, 1e-9);
}

TEST(TrialEnsemble, SobolDrawsChangeOneParameterAtATime) {
  TrialEnsembleOptions options = drawing({"hand.mass", "TRI.radius"});
  options.sobol = true;
  const DrawnElbow drawn(options);
  EXPECT_EQ(drawn.ensemble.count(), 16u);
  const Eigen::VectorXd a = drawn.ensemble.draw(4, 1), b = drawn.ensemble.draw(5, 1),
                        ab = drawn.ensemble.draw(7, 1);
  EXPECT_EQ(ab[0], a[0]);
  EXPECT_EQ(ab[1], b[1]);
}

TEST(TrialEnsemble, RefusesInOneLine) {
  const auto refused = [](const TrialEnsembleOptions& options, const char* words,
                          const Trial& trial = DrawnElbow::elbow().trial) {
    throwsSaying([&] { DrawnElbow drawn(options, trial); }, words);
  };
  TrialEnsembleOptions options = drawing({"hand.mass"});
  options.draws = 0;
  refused(options, "draws = 0, must be 1 to 10000000");
  options.draws = 1;
  options.sobol = true;
  refused(options, "sobol: draws must be at least 2");
  options.draws = 2;
  options.bandPoints = 1;
  refused(options, "band_points = 1, must be 2 to 1000");
  options.bandPoints = 2;
  options.output = "speed";
  refused(options, "output 'speed', must be rms_error");
  options.output = "rms_error";
  Trial bare = DrawnElbow::elbow().trial;
  bare.measured.clear();
  refused(options, "has no measured elbow_flexion", bare);
  options.laws.names = {"all"};
  refused(options, "parameters, at most 32; choose them with parameters");
  options.laws.names = {};
  options.laws.covariance = {{"hand.mass"}, Eigen::MatrixXd::Constant(1, 1, 1e-4)};
  refused(options, "covariance cannot be combined with sobol");
}

}  // namespace
}  // namespace bio
