#include "bio/analysis/trial_ensemble.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

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
  const ChannelRun run = drawn.ensemble.run(std::span(&theta, 1)).front().channels.at(0);
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

/// ElbowRoles of the coordinates of elbow8 in the shipped trial, and what is observed of them.
struct ElbowRoles {
  const char* name;
  std::vector<std::string> coordinates, prescribed, observed;
};
struct ObservedElbow {
  explicit ObservedElbow(const ElbowRoles& roles)
      : options{{roles.coordinates, {}}, {}, {}, false, roles.prescribed},
        trial(readTrial(ShippedElbow::root() + "/emg_data/curl_slow.sto", model,
                        {.prescribed = roles.prescribed})),
        system(model, options) {}
  TrialReplay replay(const Model& drawn) const {
    const MusculoskeletalSystem own(drawn, options);
    return replayTrial(own, trial, {}, beginningOf(trial, drawn, own, {}));
  }
  TrialEnsemble ensemble(const TrialEnsembleOptions& asked) const {
    return {model, system, options, trial, beginningOf(trial, model, system, {}).point, asked};
  }
  Model model = DrawnElbow::elbow().model;
  SystemOptions options;
  Trial trial;
  MusculoskeletalSystem system;
};

/// NaN: it was not measured.
double rmsErrorIn(const TrialReplay& replay, const Observable& what) {
  for (const auto& [name, error] : replay.errors)
    if (what == ofCoordinate(name)) return error.rms;
  for (const ChannelError& channel : replay.channelErrors)
    if (what == channel.what) return channel.error.rms;
  return std::nan("");
}

// The second way compiles each drawn model anew and replays the trial alone.
TEST(TrialEnsemble, ChannelsAreThoseOfSingleReplaysOfTheDrawnModels) {
  for (const ElbowRoles& roles : {ElbowRoles{"two free joints",
                                             {"shoulder_elv", "elbow_flexion"},
                                             {},
                                             {"shoulder_elv", "elbow_flexion",
                                              "elbow_flexion.speed", "BIClong.tendon_force"}},
                                  ElbowRoles{"a dynamometer moves the elbow",
                                             {"elbow_flexion"},
                                             {"elbow_flexion"},
                                             {"elbow_flexion.moment", "BRA.fiber_length"}},
                                  ElbowRoles{"a free shoulder, a prescribed elbow",
                                             {"shoulder_elv", "elbow_flexion"},
                                             {"elbow_flexion"},
                                             {"shoulder_elv", "elbow_flexion.moment"}}}) {
    SCOPED_TRACE(roles.name);
    ObservedElbow elbow(roles);
    const Observable last = observableNamed(roles.observed.back(), elbow.model);
    elbow.trial.measured.push_back(
        {last, elbow.trial.times.segment(20, 60), Eigen::VectorXd::LinSpaced(60, 1, 9)});
    TrialEnsembleOptions options = drawing(
        {"hand.mass", "TRI.radius", "BRA.tendon_slack_length", "BIClong.max_isometric_force"});
    options.observe = roles.observed;
    const TrialEnsemble ensemble = elbow.ensemble(options);
    const TrialReplay nominal = elbow.replay(elbow.model);
    const Eigen::VectorXd times =
        Eigen::VectorXd::Map(nominal.motion.time.data(), std::ssize(nominal.motion.time));
    std::vector<Eigen::VectorXd> thetas;
    for (std::uint64_t i = 0; i < ensemble.count(); ++i) thetas.push_back(ensemble.draw(i, 3));
    const std::vector<EnsembleRun> runs = ensemble.run(thetas);
    int finished = 0, measured = 0;
    for (std::size_t i = 0; i < runs.size(); ++i) {
      if (runs[i].outcome != "ok") continue;
      ++finished;
      const Model model =
          ParameterCatalogue(elbow.model, elbow.system,
                             beginningOf(elbow.trial, elbow.model, elbow.system, {}).point)
              .at(ensemble.laws().selection, thetas[i])
              .model;
      const MusculoskeletalSystem system(model, elbow.options);
      const TrialReplay replay = elbow.replay(model);
      ASSERT_EQ(runs[i].channels.size(), roles.observed.size());
      for (std::size_t c = 0; c < roles.observed.size(); ++c) {
        SCOPED_TRACE(roles.observed[c]);
        const ChannelRun& run = runs[i].channels[c];
        const Observable& what = ensemble.channels()[c].what;
        const auto all = [&](const MusculoskeletalSystem& of, const Trajectory& motion) {
          return ObservedMotion(of, {{what, times}}).values(motion);
        };
        const Eigen::VectorXd course = all(system, replay.motion);
        const Eigen::VectorXd change = course - all(elbow.system, nominal.motion);
        const double least = 1e-12 * (1 + course.cwiseAbs().maxCoeff());
        EXPECT_NEAR(run.last, course[course.size() - 1], least);
        EXPECT_NEAR(run.lowest, course.minCoeff(), least);
        EXPECT_NEAR(run.highest, course.maxCoeff(), least);
        EXPECT_NEAR(run.atCourse[0], course[0], least);
        EXPECT_NEAR(run.atCourse[1], course[course.size() / 2], least);
        EXPECT_NEAR(run.atCourse[2], run.last, least);
        EXPECT_NEAR(run.rmsFromNominal, std::sqrt(change.array().square().mean()), least);
        const double error = rmsErrorIn(replay, what);
        EXPECT_EQ(std::isnan(run.rmsError), std::isnan(error));
        if (std::isnan(error)) continue;
        ++measured;
        EXPECT_NEAR(run.rmsError, error, least);
      }
    }
    EXPECT_GE(finished, 3);
    EXPECT_GE(measured, finished);
  }
}

TEST(TrialEnsemble, ObservesAllFreeCoordinatesUnlessToldOtherwise) {
  const ObservedElbow elbow(
      {"", {"shoulder_elv", "elbow_flexion", "pro_sup"}, {"elbow_flexion"}, {}});
  const TrialEnsemble ensemble = elbow.ensemble(drawing({"hand.mass"}));
  ASSERT_EQ(ensemble.channels().size(), 2u);
  EXPECT_EQ(ensemble.channels()[0].what, ofCoordinate("shoulder_elv"));
  EXPECT_EQ(ensemble.channels()[1].what, ofCoordinate("pro_sup"));
  EXPECT_FALSE(ensemble.channels()[0].measured);
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
  options.observe = {"elbow_flexion", "elbow_flexion.speed"};
  refused(options, "has no measured elbow_flexion.speed");
  options.observe = {"elbow_flexion", "elbow_flexion"};
  refused(options, "observe: 'elbow_flexion' is given twice");
  options.observe = {"elbow_flexion.angle"};
  refused(options, "observe: 'elbow_flexion.angle' is nothing that can be measured of this model");
  options.observe = {"elbow_flexion.moment"};
  options.output = "final";
  refused(options, "its coordinate must be prescribed or locked");
  options.observe = {};
  options.laws.names = {"all"};
  refused(options, "parameters, at most 32; choose them with parameters");
  options.laws.names = {};
  options.laws.covariance = {{"hand.mass"}, Eigen::MatrixXd::Constant(1, 1, 1e-4)};
  refused(options, "covariance cannot be combined with sobol");
  const ObservedElbow held({"", {"elbow_flexion"}, {"elbow_flexion"}, {}});
  throwsSaying([&] { (void)held.ensemble(drawing({"hand.mass"})); },
               "no coordinate is free to be observed: observe must name what is");
}

}  // namespace
}  // namespace bio
