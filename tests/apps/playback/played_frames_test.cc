#include "playback/played_frames.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "support/shipped_elbow.h"
#include "two_links.h"

namespace {

using namespace bio;
using app::FrameMaker;
using app::PlayedFrame;
using Eigen::Vector3d;
using testing::ElementsAre;

TEST(PlayedFrames, PlaceTheLinksOfAPendulumWhereTrigonometryDoes) {
  const Model model = fixtures::twoLinks();
  const MusculoskeletalSystem system(model, fixtures::twoLinksFree());
  const Trajectory motion = fixtures::twoLinksSwing(5);
  const FrameMaker maker(model, system, {});
  ASSERT_THAT(maker.bodies(), ElementsAre("ground", "upper", "lower"));
  const std::vector<PlayedFrame> frames = maker.frames(motion, {0, 3});
  ASSERT_EQ(frames.size(), 2u);
  for (const PlayedFrame& frame : frames) {
    const Eigen::Index row = &frame == &frames[0] ? 0 : 3;
    EXPECT_EQ(frame.time, motion.time[static_cast<std::size_t>(row)]);
    const double q1 = motion.q(0, row), q2 = motion.q(1, row);
    EXPECT_LT(frame.bodies[1].p.norm(), 1e-14);
    const Vector3d lower = fixtures::upperLength * Vector3d(std::sin(q1), -std::cos(q1), 0);
    EXPECT_LT((frame.bodies[2].p - lower).norm(), 1e-14);
    const Vector3d down = -Vector3d(-std::sin(q1 + q2), std::cos(q1 + q2), 0);
    EXPECT_LT((frame.bodies[2].R * -Vector3d::UnitY() - down).norm(), 1e-14);
  }
}

// Lengths come from other code than the points of a path.
TEST(PlayedFrames, DrawMusclesAsLongAsTheyAreAndAsActive) {
  const fixtures::ShippedElbow elbow;
  const SystemState start =
      initialState(elbow.system, Eigen::VectorXd::Constant(1, 0.6), elbow.excitation, 0);
  const Trajectory motion =
      simulate(elbow.system, elbow.excitation, start, fixtures::forSeconds(1));
  const FrameMaker maker(elbow.model, elbow.system, {});
  const std::vector<std::size_t> rows = app::evenRows(motion.time, 7);
  const std::vector<PlayedFrame> frames = maker.frames(motion, rows);
  const MuscleReport report = reportMuscles(elbow.system, motion);
  ASSERT_EQ(frames.size(), 7u);
  ASSERT_EQ(frames[0].lines.size(), maker.paths().size());
  for (std::size_t f = 0; f < frames.size(); ++f) {
    const auto row = static_cast<Eigen::Index>(rows[f]);
    for (std::size_t i = 0; i < elbow.system.numMuscles(); ++i) {
      const app::PlayedLine& line = frames[f].lines[i];
      double length = 0;
      for (std::size_t p = 1; p < line.points.size(); ++p)
        length += (line.points[p] - line.points[p - 1]).norm();
      const auto k = static_cast<Eigen::Index>(i);
      // chords that dip at most 0.1 mm below arcs: measured at most 0.023 mm
      EXPECT_NEAR(length, report.muscleTendonLength(k, row), 1e-4) << maker.paths()[i];
      EXPECT_EQ(line.activation, motion.activation(k, row));
      EXPECT_GT(line.radius, 0.0024);
    }
  }
}

TEST(PlayedFrames, AreAtEqualDistancesAndHaveBothEnds) {
  EXPECT_THAT(app::evenRows({0, 1, 2, 3, 4}, 3), ElementsAre(0, 2, 4));
  EXPECT_THAT(app::evenRows({0, 0.1, 0.2, 0.9, 1}, 3), ElementsAre(0, 2, 4));
  EXPECT_THAT(app::evenRows({0, 1}, 100), ElementsAre(0, 1));
  EXPECT_THAT(app::evenRows({3}, 2), ElementsAre(0));
  EXPECT_THAT(app::evenRows({0, 1, 2}, 1), ElementsAre(0));
  EXPECT_TRUE(app::evenRows({}, 4).empty());
}

TEST(PlayedFrames, KeepTheCornersOfALine) {
  const std::vector<Vector3d> bent{{0, 0, 0}, {1, 1e-5, 0}, {2, 0, 0},
                                   {2, 1, 0}, {2, 2, 1e-5}, {2, 3, 0}};
  const std::vector<Vector3d> thinned = app::thinnedLine(bent, 1e-4);
  EXPECT_THAT(thinned, ElementsAre(bent[0], bent[2], bent[5]));
  EXPECT_EQ(app::thinnedLine(bent, 1e-6), bent);
}

}  // namespace
