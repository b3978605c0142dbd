#include "bio/discovery/effect_size.h"

#include <gtest/gtest.h>

#include <cmath>

#include "info/discovery/likelihood/hypothesis.h"
#include "support/cut_trial.h"
#include "support/shipped_elbow.h"

namespace bio::discover {
namespace {

using Eigen::Index;
using Eigen::VectorXd;
using fixtures::cut;
using fixtures::ShippedElbow;

struct Sized {
  Sized() : data(elbow.model, ShippedElbow::options(), "elbow_flexion", {cut(elbow.trial, 2)}) {}

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

  ShippedElbow elbow;
  MusculoskeletalProblem data;
};

TEST(EffectSize, OfALawIsTheLawsOwnMoment) {
  const Sized s;
  const VectorXd speed = s.data.motion(0, s.with("visc", 0.3)).qDot.row(0);
  const EffectSize damping = s.of("visc", 0.3);
  EXPECT_NEAR(damping.momentRms, 0.3 * Sized::rms(speed), 1e-6);
  EXPECT_NEAR(damping.momentPeak, 0.3 * speed.cwiseAbs().maxCoeff(), 1e-6);
  const EffectSize constant = s.of("const", 0.7);
  EXPECT_NEAR(constant.momentRms, 0.7, 1e-6);
  EXPECT_NEAR(constant.momentPeak, 0.7, 1e-6);
}

// Net moment of the muscles, and how far the motion goes without the effect.
TEST(EffectSize, ComesWithItsShareAndWhatItChangesInTheMotion) {
  const Sized s;
  const VectorXd values = s.with("const", 0.7);
  const Trajectory motion = s.data.motion(0, values);
  const MuscleReport report = reportMuscles(s.data.armAt(0, values), motion);
  const VectorXd net = report.tendonForce.cwiseProduct(report.momentArm).colwise().sum();
  const EffectSize size = s.of("const", 0.7);
  EXPECT_NEAR(size.share, 0.7 / Sized::rms(net), 0.01 * size.share);
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
  EXPECT_GT(size.momentPeak, 0.5 * 9.80665 * r * 0.7);
  EXPECT_LT(size.momentPeak, 0.5 * 9.80665 * r * 1.5);
  EXPECT_GT(size.momentRms, 0);
}

// Twice the excitation of the triceps is twice a part of its moment, not of the motion that
// follows.
TEST(EffectSize, OfAnErrorOfMusclesIsWhatTheirMomentsDifferBy) {
  const Sized s;
  const EffectSize small = s.of("Fmax_TRI", 1.01), large = s.of("Fmax_TRI", 1.02);
  EXPECT_GT(small.momentRms, 0);
  EXPECT_NEAR(large.momentRms / small.momentRms, 2, 0.1);
  EXPECT_GT(s.of("gain_TRI", 0.3).momentRms, 0);
  EXPECT_GT(s.of("delay", 0.03).momentRms, 0);
}

TEST(EffectSize, OfASensorIsWhatItShowsTooMuch) {
  const Sized s;
  const EffectSize bias = s.of("bias", 0.05);
  EXPECT_NEAR(bias.motionRms, 0.05, 1e-12);
  EXPECT_TRUE(std::isnan(bias.momentRms));
  EXPECT_TRUE(std::isnan(bias.share));
  const VectorXd q = s.data.motion(0, s.with("gain", 0.1)).q.row(0);
  EXPECT_NEAR(s.of("gain", 0.1).motionRms, 0.1 * Sized::rms(q), 1e-9);
  EXPECT_GT(s.of("clock", 0.05).motionRms, 0.001);
}

}  // namespace
}  // namespace bio::discover
