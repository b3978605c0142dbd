// What is considered where nothing is said; that experiments follow is in dynamometer_plan_test.cc.
#include "bio/design/dynamometer_question.h"

#include <gtest/gtest.h>

#include "support/numbers.h"
#include "support/throws_saying.h"

namespace bio {
namespace {

using Kind = DynamometerExperiment::Kind;
using support::degree;

Coordinate turning() {
  Coordinate coordinate;
  coordinate.name = "knee_angle";
  coordinate.isRotation = true;
  coordinate.rangeMin = 0;
  coordinate.rangeMax = 100 * degree;
  return coordinate;
}

void isNear(const std::vector<double>& found, const std::vector<double>& wanted) {
  ASSERT_EQ(found.size(), wanted.size());
  for (std::size_t i = 0; i < found.size(); ++i) EXPECT_NEAR(found[i], wanted[i], 1e-12) << i;
}

DynamometerQuestion empty() {
  DynamometerQuestion question;
  question.kinds.clear();
  return question;
}

TEST(DynamometerQuestion, WhatIsLeftOutIsUsual) {
  const DynamometerQuestion q = withDefaults(empty(), turning());
  EXPECT_EQ(q.kinds.size(), 5u);
  isNear(q.positions,
         {10 * degree, (10 + 80.0 / 3) * degree, (10 + 160.0 / 3) * degree, 90 * degree});
  isNear(q.speeds, {30 * degree, 120 * degree});
  isNear(q.efforts, {0.3, 0.6, 1});
  isNear(q.releases, {10 * degree});
  isNear(q.loads, {0.5, 0.8});
  EXPECT_NEAR(q.releaseSpeed, 200 * degree, 1e-12);  // 10 samples of 0.1 s at 100 per second
}

TEST(DynamometerQuestion, SpeedsFollowTheTurnsTheSamplesAndTheLimit) {
  DynamometerQuestion q = empty();
  q.positions = {20 * degree, 25 * degree};  // 5° at 120 °/s would take 0.04 s
  q.rate = 40;
  isNear(withDefaults(q, turning()).speeds, {30 * degree});
  // 2·10°/speed has 8 samples of 25 ms
  EXPECT_NEAR(withDefaults(q, turning()).releaseSpeed, 100 * degree, 1e-12);
  q.fastest = 40 * degree;
  EXPECT_NEAR(withDefaults(q, turning()).releaseSpeed, 40 * degree, 1e-12);
  EXPECT_NEAR(withDefaults(q, turning(), 20 * degree).releaseSpeed, 20 * degree, 1e-12);
}

TEST(DynamometerQuestion, ListsAreSortedAndEachValueOnce) {
  DynamometerQuestion q = empty();
  q.kinds = {Kind::release, Kind::isometric};
  q.positions = {1, 0.5, 1};
  q.efforts = {0.9, 0.2, 0.2};
  q = withDefaults(q, turning());
  EXPECT_EQ(q.kinds, (std::vector<Kind>{Kind::isometric, Kind::release}));
  isNear(q.positions, {0.5, 1});
  isNear(q.efforts, {0.2, 0.9});
  EXPECT_TRUE(q.speeds.empty());  // nothing turns
}

TEST(DynamometerQuestion, AShiftIsInMillimetres) {
  Coordinate shift = turning();
  shift.isRotation = false;
  shift.rangeMax = 0.1;
  const DynamometerQuestion q = withDefaults(empty(), shift);
  isNear(q.speeds, {0.03, 0.12});
  isNear(q.releases, {0.01});
}

TEST(DynamometerQuestion, SaysWhatIsWrong) {
  const auto refused = [](auto change, const char* words,
                          const std::optional<double>& releaseSpeed = {}) {
    DynamometerQuestion question = empty();
    change(question);
    support::throwsSaying([&] { (void)withDefaults(question, turning(), releaseSpeed); }, words);
  };
  const auto nothing = [](auto&) {};
  refused([](auto& q) { q.positions = {2}; },
          "angles: 2 rad (114.6 deg) is outside the range of 'knee_angle', 0 to 1.745 rad");
  refused([](auto& q) { q.speeds = {NAN}; }, "speeds: nan rad/s (nan deg/s), must be > 0");
  refused([](auto& q) { q.speeds = {9}; }, "must be at most the largest speed, 8.7 rad/s");
  refused([](auto& q) { q.speeds = {0.01}; }, "these would take 140 s");
  refused([](auto& q) { q.efforts = {1.2}; }, "efforts: 120 % MVC, must be > 1,");
  refused([](auto& q) { q.loads = {1}; }, "loads: 100 %, must be > 0 and below 100");
  refused([](auto& q) { q.releases = {0}; }, "releases: 0 rad (0 deg), must be > 0");
  refused(nothing, "speed of releases: 0 rad/s (0 deg/s), must be > 0", 0.0);
  refused(nothing, "must be at least 8 samples (of 100 per second)", 300 * degree);
  refused(
      [](auto& q) {
        q.kinds = {Kind::isometric};
        q.loads = {0.5};
      },
      "loads: must have isotonic among the kinds");
  refused(
      [](auto& q) {
        q.kinds = {Kind::isotonic};
        q.speeds = {1};
      },
      "speeds: must have isokinetic or passive among the kinds");
  refused([](auto& q) { q.kinds = {Kind::passive}; }, "speed of releases: must have release", 1.0);
  support::throwsSaying([] { (void)dynamometerKindNamed("isotnic"); },
                        "kind of experiment 'isotnic'");
  for (const Kind kind :
       {Kind::isometric, Kind::isokinetic, Kind::passive, Kind::release, Kind::isotonic}) {
    EXPECT_EQ(dynamometerKindNamed(name(kind)), kind);
  }
}

}  // namespace
}  // namespace bio
