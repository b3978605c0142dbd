#include "bio/path/path_table.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include "bio/opensim/osim_file.h"
#include "bio/simulation/musculoskeletal_system.h"
#include "bio/simulation/simulate.h"

namespace bio {
namespace path_table {
namespace {

using Value = PathTable::Value;

Value smooth(double q) {
  return {0.3 + 0.04 * std::sin(q), 0.04 * std::cos(q), -0.04 * std::sin(q), true};
}

// A curve that starts to bend at `kink`, as a path does that touches a cylinder there.
std::function<Value(double)> bending(double kink, double bend) {
  return [=](double q) {
    const double x = std::max(0.0, q - kink);
    return Value{0.3 + 0.01 * q + bend * x * x / 2, 0.01 + bend * x, x > 0 ? bend : 0, false};
  };
}

TEST(PathTable, AgreesWithASmoothPath) {
  const PathTable table(-0.2, 2.5, 120, smooth);
  EXPECT_EQ(table.standing(), 120u);
  for (int i = 0; i < 5000; ++i) {
    const double q = -0.2 + 2.7 * (i + 0.5) / 5000;
    Value found;
    ASSERT_TRUE(table.find(q, found)) << q;
    EXPECT_NEAR(found.length, smooth(q).length, 1e-15);
    EXPECT_NEAR(found.slope, smooth(q).slope, 1e-13);
    EXPECT_NEAR(found.curvature, smooth(q).curvature, 1e-10);
    EXPECT_TRUE(found.wrapped);
  }
}

// With two thirds as many pieces the curvature is 1.5⁴ times as far off.
TEST(PathTable, ConvergesWithTheFourthPowerOfTheWidth) {
  const auto worst = [](std::size_t pieces) {
    const PathTable table(0, 2, pieces, smooth);
    double error = 0;
    for (int i = 0; i < 2000; ++i) {
      Value found;
      if (!table.find(i * 1e-3, found)) continue;
      error = std::max(error, std::abs(found.curvature - smooth(i * 1e-3).curvature));
    }
    return error;
  };
  EXPECT_NEAR(worst(40) / worst(60), 5.06, 0.3);
}

TEST(PathTable, HasNoPieceOverAKink) {
  for (const double place : {0.001, 0.1, 0.25, 0.5, 0.75, 0.9, 0.999})
    for (const double bend : {1.0, -0.01, 1e-5}) {
      const PathTable table(0, 1, 10, bending(0.4 + 0.1 * place, bend));
      Value found;
      EXPECT_FALSE(table.find(0.45, found)) << place << " " << bend;
      EXPECT_EQ(table.standing(), 9u) << place << " " << bend;
    }
}

TEST(PathTable, HasNoPieceWhereThePathStartsToWrap) {
  const PathTable table(0, 1, 50, [](double q) {
    Value value = smooth(q);
    value.wrapped = q > 0.412;
    return value;
  });
  Value found;
  EXPECT_FALSE(table.find(0.405, found));
  EXPECT_EQ(table.standing(), 49u);
  ASSERT_TRUE(table.find(0.35, found));
  EXPECT_FALSE(found.wrapped);
  ASSERT_TRUE(table.find(0.55, found));
  EXPECT_TRUE(found.wrapped);
}

TEST(PathTable, HasNoPieceWhereThePathWrapsInBetweenOnly) {
  const PathTable table(0, 1, 50, [](double q) {
    Value value = smooth(q);
    value.wrapped = std::abs(q - 0.41) < 0.004;
    return value;
  });
  Value found;
  EXPECT_FALSE(table.find(0.41, found));
  EXPECT_EQ(table.standing(), 49u);
}

TEST(PathTable, HasNoPieceBeyondItsEnds) {
  const PathTable table(0, 1, 50, smooth);
  Value found;
  for (const double q : {-1e-12, 1.0, 1.1, -HUGE_VAL, HUGE_VAL, std::nan("")})
    EXPECT_FALSE(table.find(q, found)) << q;
  EXPECT_TRUE(table.find(0, found));
}

TEST(PathTable, RefusesWhatIsNoRange) {
  EXPECT_THROW(PathTable(1, 1, 10, smooth), std::invalid_argument);
  EXPECT_THROW(PathTable(0, HUGE_VAL, 10, smooth), std::invalid_argument);
  EXPECT_THROW(PathTable(0, 1, 0, smooth), std::invalid_argument);
}

// The eight muscles ----------------------------------------------------------------------------

constexpr double degree = std::numbers::pi / 180;

Model elbow8() {
  return readOsim(std::filesystem::path(FISHERHILL_SOURCE_DIR) / "models/elbow8.osim");
}

SystemOptions elbow(bool tables) {
  SystemOptions options;
  options.skeleton.freeCoordinates = {"elbow_flexion"};
  options.tabulatePaths = tables;
  return options;
}

TEST(PathTable, OfTheElbowIsTheElbow) {
  const Model model = elbow8();
  const MusculoskeletalSystem plain(model, elbow(false)), tabulated(model, elbow(true));
  SystemConfiguration<1> exact(plain), found(tabulated);
  int wrapped = 0;
  for (int i = 0; i <= 4000; ++i) {
    const Eigen::Matrix<double, 1, 1> q((-5 + 140 * i / 4000.0) * degree);
    exact.moveTo(q);
    found.moveTo(q);
    for (std::size_t m = 0; m < plain.numMuscles(); ++m) {
      EXPECT_NEAR(found.length(m).length, exact.length(m).length, 1e-13);
      EXPECT_NEAR(found.length(m).dL_dq[0], exact.length(m).dL_dq[0], 1e-11);
      EXPECT_NEAR(found.length(m).d2L_dq2(0, 0), exact.length(m).d2L_dq2(0, 0), 2e-9);
      EXPECT_EQ(found.length(m).wrapped, exact.length(m).wrapped);
      wrapped += exact.length(m).wrapped ? 1 : 0;
    }
  }
  EXPECT_GT(wrapped, 1000);
  for (const SystemMuscle& muscle : plain.muscles()) EXPECT_EQ(muscle.path.table(), nullptr);
  // within the range (109 pieces of 120 and parts of two) only what has a kink is asked of the path
  for (const SystemMuscle& muscle : tabulated.muscles())
    EXPECT_GE(muscle.path.table()->standing(), 98u) << muscle.name;
}

TEST(PathTable, SimulatesTheSameMotion) {
  const Model model = elbow8();
  const MusculoskeletalSystem plain(model, elbow(false)), tabulated(model, elbow(true));
  const auto names = static_cast<Eigen::Index>(plain.numMuscles());
  Eigen::MatrixXd u = Eigen::MatrixXd::Constant(4, names, 0.03);
  u.row(1).setConstant(0.15);
  u.row(2).setConstant(0.05);
  const ExcitationSignal excitation({0, 0.5, 1, 2}, u);
  SimulationOptions options;
  options.integrator = Integrator::variational;
  options.step = 0.005;
  options.duration = 2;
  const auto motion = [&](const MusculoskeletalSystem& system) {
    const Eigen::VectorXd q = Eigen::VectorXd::Constant(1, 60 * degree);
    return simulate(system, excitation, initialState(system, q, excitation, 0), options);
  };
  const Trajectory exact = motion(plain), found = motion(tabulated);
  ASSERT_EQ(exact.outcome, Outcome::completed);
  ASSERT_GT(exact.q.maxCoeff() - exact.q.minCoeff(), 20 * degree);
  EXPECT_LT((found.q - exact.q).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_EQ(found.steps, exact.steps);
}

// Arms made after another take its tables, and none for muscles of another shape.
TEST(PathTable, IsSharedByPathsOfTheSameShape) {
  const Model model = elbow8();
  const MusculoskeletalSystem first(model, elbow(true));
  Model wider = model;
  for (WrapObject& wrap : wider.wrapObjects)
    if (wrap.name == "TRI") wrap.radius += 0.003;
  const std::vector<std::string> triceps = {"TRIlong", "TRIlat", "TRImed"};
  const MusculoskeletalSystem second(wider, elbow(true), first, triceps), anew(wider, elbow(false));
  SystemConfiguration<1> exact(anew), found(second);
  const Eigen::Matrix<double, 1, 1> q(100 * degree);
  exact.moveTo(q);
  found.moveTo(q);
  for (std::size_t m = 0; m < first.numMuscles(); ++m) {
    const std::string& name = first.muscles()[m].name;
    const bool shaped = std::find(triceps.begin(), triceps.end(), name) != triceps.end();
    EXPECT_EQ(second.muscles()[m].path.table(), shaped ? nullptr : first.muscles()[m].path.table())
        << name;
    EXPECT_NEAR(found.length(m).dL_dq[0], exact.length(m).dL_dq[0], 1e-11) << name;
  }
}

TEST(PathTable, IsNotMadeForTwoCoordinates) {
  SystemOptions options = elbow(true);
  options.skeleton.freeCoordinates = {"elbow_flexion", "pro_sup"};
  const MusculoskeletalSystem system(elbow8(), options);
  ASSERT_GE(system.numMuscles(), 8u);
  for (const SystemMuscle& muscle : system.muscles()) EXPECT_EQ(muscle.path.table(), nullptr);
}

}  // namespace
}  // namespace path_table
}  // namespace bio
