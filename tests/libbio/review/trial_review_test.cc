#include "bio/review/trial_review.h"

#include <gmock/gmock.h>

#include <cmath>
#include <functional>

#include "support/throws_saying.h"

namespace bio {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

Model hinge() {
  Model model;
  Joint joint;
  joint.coordinates.push_back({.name = "elbow_flexion", .rangeMin = 0, .rangeMax = 2.3});
  model.joints.push_back(joint);
  return model;
}

Trial usual() {
  Trial trial;
  trial.times = Eigen::VectorXd::LinSpaced(101, 0, 1);
  trial.muscles = {"BRA"};
  trial.excitations = Eigen::VectorXd::LinSpaced(101, 0.1, 0.9);
  trial.measured.push_back(
      {ofCoordinate("elbow_flexion"), trial.times, Eigen::VectorXd::LinSpaced(101, 0.5, 1)});
  return trial;
}

std::vector<std::string> linesOf(const Trial& trial) {
  std::vector<std::string> lines;
  for (const Remark& r : reviewTrial(trial, hinge())) lines.push_back(r.subject + ": " + r.message);
  return lines;
}

TEST(TrialReview, FindsNothingUnusualInAUsualTrial) {
  EXPECT_THAT(linesOf(usual()), IsEmpty());
}

TEST(TrialReview, NamesEachUnusualQuantityOnce) {
  struct Case {
    std::function<void(Trial&)> spoil;
    std::string remark;
  };
  const Case cases[] = {
      {[](Trial& t) { t.times(50) += 0.002; },
       "time: intervals = 0.008 to 0.012 s, usually equal (the median is 0.01 s)"},
      {[](Trial& t) { t.times *= 20; },
       "time: rows are up to 0.2 s apart: the excitation between them is taken as a straight line; "
       "record it, or resample the recording, at 20 Hz or more"},
      {[](Trial& t) {
         t.times *= 20;
         t.excitations.setConstant(0.3);
       },
       "time: rows are 0.2 s apart, usually below 0.1 s"},
      {[](Trial& t) { t.times *= 100; },
       "time: rows are 1 s apart, usually below 0.1 s: milliseconds?"},
      {[](Trial& t) { t.excitations.setZero(); }, "excitation of 'BRA': is 0 throughout"},
      {[](Trial& t) { t.excitations.setOnes(); }, "excitation of 'BRA': is 1 throughout"},
      {[](Trial& t) { t.excitations(3, 0) = 0.9; },
       "excitation of 'BRA': jumps by 0.784 between rows, usually below 0.5"},
      {[](Trial& t) { t.measured[0].values *= 57; },
       "measured 'elbow_flexion': values = 28.5 to 57 rad, must be within ±2π or the model's "
       "range: "
       "degrees stand in a column 'elbow_flexion_deg', or under inDegrees=yes"},
      {[](Trial& t) { t.measured[0].values.array() -= 0.7; },
       "measured 'elbow_flexion': values = -0.2 to 0.3 rad, outside the model's range 0 to 2.3"},
      {[](Trial& t) { t.measured[0].values(50) = 1.5; },
       "measured 'elbow_flexion': jumps by 0.755 rad between measurements, usually below 0.5 rad"},
      {[](Trial& t) { t.measured[0].times.array() += 0.25; },
       "measured 'elbow_flexion': begins 0.25 s after the excitations"},
      {[](Trial& t) {
         for (Eigen::Index k = 0; k < 101; ++k) {
           const Eigen::Index before = k / 4 * 4;
           const auto recorded = [](Eigen::Index i) {
             return 1 + 0.1 * std::sin(0.1 * static_cast<double>(i));
           };
           const double part = static_cast<double>(k - before) / 4;
           t.measured[0].values(k) = (1 - part) * recorded(before) + part * recorded(before + 4);
         }
       },
       "measured 'elbow_flexion': 1 value in 4 was recorded, the others lie on straight lines "
       "between: noise is estimated too small from them, and intervals become too narrow; give the "
       "recorded values only, with empty cells (or NaN) between"},
  };
  for (const Case& c : cases) {
    Trial trial = usual();
    c.spoil(trial);
    EXPECT_THAT(linesOf(trial), ElementsAre(c.remark));
  }
}

TEST(TrialReview, WhatACommandMustTellOrRefuseWeighsMore) {
  Trial degrees = usual();
  degrees.measured[0].values *= 57;
  EXPECT_EQ(reviewTrial(degrees, hinge()).front().weight, Weight::error);
  Model crank = hinge();  // one whose range is that wide is only asked about
  crank.joints[0].coordinates[0].rangeMax = 100;
  EXPECT_EQ(reviewTrial(degrees, crank).front().weight, Weight::warning);
  Trial milliseconds = usual();
  milliseconds.times *= 100;
  EXPECT_EQ(reviewTrial(milliseconds, hinge()).front().weight, Weight::warning);
  milliseconds.times /= 5;
  EXPECT_EQ(reviewTrial(milliseconds, hinge()).front().weight, Weight::warning);
  milliseconds.excitations.setConstant(0.3);
  EXPECT_EQ(reviewTrial(milliseconds, hinge()).front().weight, Weight::unusual);
}

// A gap matters where an excitation changes across it, and only beyond a tenth of a second.
TEST(TrialReview, AsksForRowsThatShowTheExcitation) {
  const auto told = [](const Trial& trial) {
    for (const std::string& line : linesOf(trial)) {
      if (line.find("straight line") != std::string::npos) return line;
    }
    return std::string();
  };
  Trial trial = usual();
  trial.times *= 10;
  EXPECT_EQ(told(trial), "");  // 0.1 s
  trial.times.tail(40).array() += 0.3;
  EXPECT_THAT(told(trial), testing::HasSubstr("up to 0.4 s apart"));
  trial.excitations.row(61) = trial.excitations.row(60);
  EXPECT_EQ(told(trial), "");  // row 61 is the first of the last 40
}

TEST(UsableSeries, NeedsEnoughValuesThatChange) {
  MeasuredChannel motion = usual().measured[0];
  EXPECT_EQ(whyNotUsable(motion), "");
  motion.values.head(100).setConstant(0.5);
  motion.values.tail(1).setConstant(0.6);
  EXPECT_THAT(whyNotUsable(motion), testing::HasSubstr("only two different values in 101 samples"));
  motion.values.setConstant(1.2);
  EXPECT_THAT(whyNotUsable(motion), testing::HasSubstr("the same value in all 101 samples"));
  motion.values = Eigen::VectorXd::LinSpaced(19, 0, 1);
  EXPECT_EQ(whyNotUsable(motion), "'elbow_flexion' has 19 measured values, must have at least 20");
  EXPECT_EQ(whyNotUsable(motion, 19), "");
  EXPECT_NO_THROW(requireUsable("a.sto", motion, 19));
  support::throwsSaying(
      [&] { requireUsable("a.sto", motion); },
      "a.sto: measured 'elbow_flexion' has 19 measured values, must have at least 20");
}

}  // namespace
}  // namespace bio
