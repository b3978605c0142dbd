#include "explore/live_model.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "bio/analysis/replay.h"
#include "bio/emg/emg_mapping.h"
#include "bio/opensim/osim_file.h"

namespace {

using namespace bio;
using testing::HasSubstr;

const std::string modelFile = FISHERHILL_SOURCE_DIR "/models/elbow8.osim";
const std::string trialFile = FISHERHILL_SOURCE_DIR "/emg_data/curl_slow.sto";

app::LiveChoice elbow() {
  app::LiveChoice choice;
  choice.system.skeleton.freeCoordinates = {"elbow_flexion"};
  return choice;
}

TEST(LiveModel, SimulatesWhatReplayDoesWithAnySetting) {
  app::LiveModel live(modelFile, elbow());
  live.addTrial(trialFile, "");
  // numbers of muscles, of a wrap object, a path point, a body, electrodes and the start
  const std::vector<std::string> names = {"BRA.max_isometric_force",
                                          "TRI.radius",
                                          "BIClong.point3.y",
                                          "hand.mass",
                                          "emg.delay",
                                          "emg.BRD.gain",
                                          "initial.elbow_flexion.speed"};
  live.select(names);
  const ParameterCatalogue& catalogue = live.catalogue(0);
  const Model given = readOsim(modelFile);
  const Trial trial = readTrial(trialFile, given);
  std::mt19937 random(3);
  for (int draw = 0; draw < 6; ++draw) {
    const std::vector<std::size_t> selection = catalogue.select(names);
    Eigen::VectorXd values = catalogue.values(selection);
    for (Eigen::Index i = 0; i < values.size(); ++i) {
      const double sd = catalogue.parameters()[selection[static_cast<std::size_t>(i)]].sd;
      values[i] += draw == 0 ? 0 : 0.5 * sd * std::normal_distribution()(random);
    }
    live.run(0, values, Integrator::variational, 0.01);
    // a model compiled afresh
    const auto setting = catalogue.at(selection, values);
    const MusculoskeletalSystem system(setting.model, elbow().system);
    TrialBeginning beginning;
    beginning.point = setting.start;
    SimulationOptions options;
    const TrialReplay replay = replayTrial(system, trial, options, beginning, setting.mapping);
    ASSERT_EQ(live.motion().time, replay.motion.time);
    EXPECT_EQ(live.motion().q, replay.motion.q) << draw;
    EXPECT_EQ(live.motion().fibreLength, replay.motion.fibreLength) << draw;
    // and its error against the measurement
    const Eigen::VectorXd left = live.measured()[0] - trial.measured[0].values;
    EXPECT_NEAR(std::sqrt(left.squaredNorm() / static_cast<double>(left.size())),
                replay.errors[0].second.rms, 1e-12);
  }
}

TEST(LiveModel, DrawsThePostureOfTheMoment) {
  app::LiveModel live(modelFile, elbow());
  live.addTrial(trialFile, "");
  live.select({});
  live.run(0, Eigen::VectorXd(0), Integrator::variational, 0.01);
  const Trajectory& motion = live.motion();
  const app::LiveModel::Drawing drawing = live.drawingAt(motion.time[120]);
  ASSERT_EQ(drawing.bodies.size(), live.bodies().size());
  ASSERT_EQ(drawing.paths.size(), live.paths().size());
  // the polyline is as long as the muscle and its tendon, but for chords of its arcs
  Trajectory moment;
  moment.time = {motion.time[120]};
  moment.q = motion.q.col(120);
  moment.qDot = motion.qDot.col(120);
  moment.activation = motion.activation.col(120);
  moment.fibreLength = motion.fibreLength.col(120);
  const MuscleReport report = reportMuscles(live.system(), moment);
  for (std::size_t i = 0; i < live.system().numMuscles(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    double length = 0;
    const std::vector<Eigen::Vector3d>& points = drawing.paths[i].points;
    for (std::size_t p = 1; p < points.size(); ++p) length += (points[p] - points[p - 1]).norm();
    EXPECT_NEAR(length, report.muscleTendonLength(k, 0), 1e-4) << live.paths()[i];
    EXPECT_EQ(drawing.paths[i].activation, motion.activation(k, 120));
    EXPECT_NEAR(drawing.paths[i].force, report.tendonForce(k, 0), 1e-9);
  }
}

TEST(LiveModel, KeepsTheLastMotionAfterAnError) {
  app::LiveModel live(modelFile, elbow());
  live.addTrial(trialFile, "");
  EXPECT_THROW(live.select({"TRI.diameter"}), std::invalid_argument);
  live.select({"TRI.radius"});
  live.run(0, Eigen::VectorXd::Constant(1, 0.016), Integrator::variational, 0.01);
  const Eigen::MatrixXd before = live.motion().q;
  EXPECT_THROW(live.run(0, Eigen::VectorXd::Constant(1, 0.5), Integrator::variational, 0.01),
               std::invalid_argument);
  EXPECT_EQ(live.motion().q, before);
  EXPECT_THROW(live.run(0, Eigen::VectorXd(0), Integrator::variational, 0.01),
               std::invalid_argument);
}

}  // namespace
