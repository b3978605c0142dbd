// The robots of models/robots move as the equations of `fisherhill robot` say.

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "bio/analysis/replay.h"
#include "bio/opensim/osim_file.h"
#include "robots/cart_double_pendulum.h"
#include "robots/suspended_mass.h"
#include "support/scratch_folder.h"

namespace bio {
namespace {

constexpr double amplitude = 0.06, duration = 2;
const double turning = 2 * std::acos(-1) / 1.2;

/// What the cart does: amplitude·(1 − cos(turning·t)).
std::string cartMotion(const support::ScratchFolder& scratch) {
  std::ostringstream text;
  text.precision(15);
  text << "time,cart_x\n";
  for (int k = 0; k <= 500; ++k) {
    const double t = duration * k / 500;
    text << t << ',' << amplitude * (1 - std::cos(turning * t)) << '\n';
  }
  return scratch.file("cart.csv", text.str());
}

/// A robot's state after that motion, from rest, by RK4.
template <class Robot, class Parameters>
auto stateOf(const Robot& robot, const Parameters& theta) {
  using State = info::Vector<double, Robot::stateSize>;
  const int steps = 4000;
  const double h = duration / steps;
  State x = State::Zero();
  const auto slope = [&](double t, const State& at) {
    info::Vector<double, 1> u;
    u << amplitude * turning * turning * std::cos(turning * t);
    return robot.template f<double>(at, u, theta);
  };
  for (int k = 0; k < steps; ++k) {
    const double t = h * k;
    const State a = slope(t, x), b = slope(t + h / 2, x + h / 2 * a),
                c = slope(t + h / 2, x + h / 2 * b), d = slope(t + h, x + h * c);
    x += h / 6 * (a + 2 * b + 2 * c + d);
  }
  return x;
}

/// Where that motion takes a model, by CVODE: the coordinates, then their speeds.
Eigen::VectorXd replayed(const std::string& file) {
  const support::ScratchFolder scratch;
  const Model model = readOsim(std::string(FISHERHILL_SOURCE_DIR) + "/models/robots/" + file);
  SystemOptions roles;
  for (const Joint& joint : model.joints)
    for (const Coordinate& coordinate : joint.coordinates)
      roles.skeleton.freeCoordinates.push_back(coordinate.name);
  roles.prescribed = {"cart_x"};
  const MusculoskeletalSystem system(model, roles);
  const Trial trial = readTrial(cartMotion(scratch), model, {.prescribed = roles.prescribed});
  SimulationOptions cvode;
  cvode.integrator = Integrator::cvode;
  const Trajectory motion =
      replayTrial(system, trial, cvode, beginningOf(trial, model, system, {})).motion;
  Eigen::VectorXd end(2 * motion.q.rows());
  end << motion.q.rightCols(1), motion.qDot.rightCols(1);
  return end;
}

TEST(RobotModels, TheCartWithTheDoublePendulumMovesAsItsEquationsSay) {
  const info::CartDoublePendulum<info::DoublePendulumUnknowns::bothMasses> robot{.damping = 5e-4};
  const auto x = stateOf(robot, info::Vector<double, 2>(0.085, 0.0847));
  const Eigen::VectorXd end = replayed("cart_double_pendulum.osim");
  ASSERT_EQ(end.size(), 6);
  EXPECT_GT(std::abs(x[1]), 0.1);  // it moves
  for (const int k : {1, 2}) {
    EXPECT_NEAR(end[k], x[k], 2e-5);
    EXPECT_NEAR(end[3 + k], x[3 + k], 2e-4);
  }
}

TEST(RobotModels, TheSuspendedMassMovesAsItsEquationsSay) {
  const auto x = stateOf(info::SuspendedMass{}, info::Vector<double, 2>(0.12, 0.5));
  const Eigen::VectorXd end = replayed("suspended_mass.osim");
  ASSERT_EQ(end.size(), 4);
  EXPECT_GT(std::abs(x[1]), 0.02);
  EXPECT_NEAR(end[1], -x[1], 2e-5);  // the robot's angle has the other sign
  EXPECT_NEAR(end[3], -x[3], 2e-4);
}

}  // namespace
}  // namespace bio
