#include "bio/discovery/effect_size.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "info/discovery/likelihood/hypothesis.h"
#include "libbio/simulation/arm_of_seven.h"
#include "second_ways/simbody_tree.h"
#include "support/cut_trial.h"
#include "support/shipped_elbow.h"

namespace bio::discover {
namespace {

using Eigen::Index;
using Eigen::VectorXd;
using fixtures::ArmOfSeven;
using fixtures::cut;
using fixtures::ShippedElbow;

struct Sized {
  explicit Sized(const Model& given = fixtures::elbowModel(),
                 std::vector<std::string> free = {"elbow_flexion"})
      : model(given),
        data(model, {{std::move(free), {}}, {}, {}}, "elbow_flexion",
             {cut(readTrial(ShippedElbow::root() + "/emg_data/curl_slow.sto", model), 2)}) {}

  std::size_t find(const std::string& id) const {
    for (std::size_t c = 0; c < data.candidates().size(); ++c)
      if (data.candidates()[c].id == id) return c;
    throw std::invalid_argument("no candidate " + id);
  }
  VectorXd with(const std::string& id, double amplitude) const {
    VectorXd values = info::discover::nominalValues(data);
    values[static_cast<Index>(data.candidates()[find(id)].quantities[0])] = amplitude;
    return values;
  }
  EffectSize of(const std::string& id, double amplitude) const {
    return effectSize(data, find(id), with(id, amplitude), 0);
  }
  static double rms(const VectorXd& values) {
    return std::sqrt(values.squaredNorm() / static_cast<double>(values.size()));
  }

  Model model;
  MusculoskeletalProblem data;
};

// The course that a motion's rows lie on, a spline for each coordinate.
PrescribedMotion courseOf(const Trajectory& motion) {
  PrescribedMotion course;
  for (int k = 0; k < static_cast<int>(motion.q.rows()); ++k)
    course.add(k, motion.time, {motion.q.row(k).begin(), motion.q.row(k).end()});
  return course;
}

// Speed of the observed coordinate along that course.
VectorXd speedAlong(const Trajectory& motion) {
  const PrescribedMotion course = courseOf(motion);
  Eigen::MatrixXd q = motion.q, qDot = motion.qDot;
  for (Index k = 0; k < q.cols(); ++k) {
    VectorXd at = q.col(k), speed = at;
    course.place(motion.time[static_cast<std::size_t>(k)], at, speed);
    qDot.col(k) = speed;
  }
  // the integrator's own speeds differ by the square of the step: 2e-4 rad/s, of the shoulder 6e-3
  EXPECT_LT((qDot - motion.qDot).cwiseAbs().maxCoeff(), 0.01);
  return qDot.row(0);
}

TEST(EffectSize, OfALawIsTheLawsOwnMoment) {
  const Sized s;
  const VectorXd speed = speedAlong(s.data.motion(0, s.with("visc", 0.3)));
  const EffectSize damping = s.of("visc", 0.3);
  EXPECT_NEAR(damping.moment.rms, 0.3 * Sized::rms(speed), 1e-6);
  EXPECT_NEAR(damping.moment.peak, 0.3 * speed.cwiseAbs().maxCoeff(), 1e-6);
  const EffectSize constant = s.of("const", 0.7);
  EXPECT_NEAR(constant.moment.rms, 0.7, 1e-6);
  EXPECT_NEAR(constant.moment.peak, 0.7, 1e-6);
}

// Net moment of the muscles, and how far the motion goes without the effect.
TEST(EffectSize, ComesWithItsShareAndWhatItChangesInTheMotion) {
  const Sized s;
  const VectorXd values = s.with("const", 0.7);
  const Trajectory motion = s.data.motion(0, values);
  const MuscleReport report = reportMuscles(s.data.systemAt(0, values), motion);
  const VectorXd net = report.tendonForce.cwiseProduct(report.momentArm).colwise().sum();
  const EffectSize size = s.of("const", 0.7);
  EXPECT_NEAR(size.moment.share, 0.7 / Sized::rms(net), 0.01 * size.moment.share);
  const Trajectory without = s.data.motion(0, info::discover::nominalValues(s.data));
  EXPECT_NEAR(size.motionRms, Sized::rms((motion.q - without.q).row(0)), 1e-12);
  EXPECT_GT(size.motionRms, 0.02);
}

// A mass of 0.5 kg at a distance r from the elbow pulls with 0.5·g·r at the most while the arm is
// at rest, and here it hardly accelerates.
TEST(EffectSize, OfAMassIsItsWeightAndInertia) {
  const Sized s;
  const EffectSize size = s.of("payload", 0.5);
  const std::string hand = s.data.encompassing().movedBodies().back();
  const double r = s.data.encompassing().velocityOf(hand, 1.2).norm();
  EXPECT_GT(size.moment.peak, 0.5 * 9.80665 * r * 0.7);
  EXPECT_LT(size.moment.peak, 0.5 * 9.80665 * r * 1.5);
  EXPECT_GT(size.moment.rms, 0);
}

// Twice the excitation of the triceps is twice a part of its moment, not of the motion that
// follows.
TEST(EffectSize, OfAnErrorOfMusclesIsWhatTheirMomentsDifferBy) {
  const Sized s;
  const EffectSize small = s.of("Fmax_TRI", 1.01), large = s.of("Fmax_TRI", 1.02);
  EXPECT_GT(small.moment.rms, 0);
  EXPECT_NEAR(large.moment.rms / small.moment.rms, 2, 0.1);
  EXPECT_GT(s.of("gain_TRI", 0.3).moment.rms, 0);
  EXPECT_GT(s.of("delay", 0.03).moment.rms, 0);
}

// Before it starts it is 0, then constant.
TEST(EffectSize, OfATorqueThatStartsIsThatTorque) {
  const Sized s;
  VectorXd values = s.with("torque_from", 0.4);
  values[static_cast<Index>(s.data.candidates()[s.find("torque_from")].quantities[1])] = 1;
  const EffectSize size = effectSize(s.data, s.find("torque_from"), values, 0);
  EXPECT_NEAR(size.moment.peak, 0.4, 1e-6);
  EXPECT_NEAR(size.moment.rms, 0.4 * std::sqrt(0.5), 0.01);
}

// The shoulder is free, too, and held by a spring.
struct SizedWithShoulder : Sized {
  SizedWithShoulder() : Sized(ArmOfSeven::heldModel(), {"elbow_flexion", "shoulder_elv"}) {}
};

TEST(EffectSize, OfTheElbowsDampingIsNothingOnTheShoulder) {
  const SizedWithShoulder s;
  const VectorXd speed = speedAlong(s.data.motion(0, s.with("visc", 0.3)));
  const EffectSize size = s.of("visc", 0.3);
  ASSERT_EQ(size.moments.size(), 2U);
  EXPECT_EQ(size.moment.rms, size.moments[0].rms);
  EXPECT_NEAR(size.moments[0].rms, 0.3 * Sized::rms(speed), 1e-6);
  EXPECT_GT(size.moments[0].rms, 0.01);
  EXPECT_LT(size.moments[1].peak, 1e-9);
  EXPECT_EQ(size.moments[0].motionRms, size.motionRms);
  EXPECT_GT(size.moments[1].motionRms, 1e-4);  // it moves with the first
}

// m ∂p/∂q·(p̈ − g) with p from Simbody, on either coordinate.
TEST(EffectSize, OfAMassFollowsItsPathThroughSpace) {
  const SizedWithShoulder s;
  const EffectSize size = s.of("payload", 0.5);
  const Trajectory motion = s.data.motion(0, s.with("payload", 0.5));
  const std::string hand = s.data.encompassing().movedBodies().back();
  const SimbodyTree tree(s.model);
  const auto at = [&](const Eigen::Vector2d& q) {
    return tree.pointInGround({{"elbow_flexion", q[0]}, {"shoulder_elv", q[1]}}, hand,
                              findBody(s.model, hand).massCenter);
  };
  const PrescribedMotion course = courseOf(motion);
  const auto along = [&](double t) {
    Eigen::Vector2d q;
    course.place(t, q);
    return at(q);
  };
  constexpr double e = 1e-3;  // [s]
  Eigen::MatrixXd moment(2, motion.q.cols());
  for (Index k = 0; k < moment.cols(); ++k) {
    const double t = std::clamp(motion.time[static_cast<std::size_t>(k)], motion.time.front() + e,
                                motion.time.back() - e);
    const Eigen::Vector3d acceleration = (along(t + e) - 2 * along(t) + along(t - e)) / (e * e);
    for (int j = 0; j < 2; ++j) {
      const Eigen::Vector2d q = motion.q.col(k), d = 1e-6 * Eigen::Vector2d::Unit(j);
      moment(j, k) = 0.5 * (at(q + d) - at(q - d)).dot(acceleration - s.model.gravity) / 2e-6;
    }
  }
  ASSERT_EQ(size.moments.size(), 2U);
  for (Index j = 0; j < 2; ++j) {
    const EffectMoment& found = size.moments[static_cast<std::size_t>(j)];
    EXPECT_NEAR(found.rms, Sized::rms(moment.row(j)), 2e-3 * found.rms) << j;
    EXPECT_NEAR(found.peak, moment.row(j).cwiseAbs().maxCoeff(), 0.01 * found.peak) << j;
    EXPECT_GT(found.share, 0) << j;
  }
  EXPECT_GT(size.moments[1].rms, 1.5 * size.moments[0].rms);
}

// The triceps crosses both joints, the brachialis the elbow only.
TEST(EffectSize, OfAMuscleIsOnTheJointsThatItCrosses) {
  const SizedWithShoulder s;
  const EffectSize triceps = s.of("Fmax_TRI", 1.1), brachialis = s.of("Fmax_BRA", 1.1);
  ASSERT_EQ(triceps.moments.size(), 2U);
  ASSERT_EQ(brachialis.moments.size(), 2U);
  EXPECT_GT(triceps.moments[1].rms, 0.01 * triceps.moments[0].rms);
  EXPECT_GT(brachialis.moments[0].rms, 1e-3);
  EXPECT_LT(brachialis.moments[1].peak, 1e-9);
}

TEST(EffectSize, OfASensorIsWhatItShowsTooMuch) {
  const Sized s;
  const EffectSize bias = s.of("bias", 0.05);
  EXPECT_NEAR(bias.motionRms, 0.05, 1e-12);
  EXPECT_TRUE(std::isnan(bias.moment.rms));
  EXPECT_TRUE(std::isnan(bias.moment.share));
  EXPECT_TRUE(bias.moments.empty());
  const VectorXd q = s.data.motion(0, s.with("gain", 0.1)).q.row(0);
  EXPECT_NEAR(s.of("gain", 0.1).motionRms, 0.1 * Sized::rms(q), 1e-9);
  EXPECT_GT(s.of("clock", 0.05).motionRms, 0.001);
}

}  // namespace
}  // namespace bio::discover
