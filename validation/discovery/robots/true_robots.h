#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

namespace hidden {

/// x' = rate(t, x, x').
using Rate = std::function<void(double, const std::vector<double>&, std::vector<double>&)>;

/// Carries x from one time to another by Dormand and Prince's pair of orders 5 and 4, its steps
/// such that the estimated error of each stays below `tolerance`·(1 + |x_i|).
/// @param step  proposed first step [s] > 0, then the next one
/// @throws std::runtime_error if that needs steps below 1e-9 s
void carry(const Rate& rate, double from, double to, std::vector<double>& x, double& step,
           double tolerance = 1e-10);

/// Numbers of a plant by name, SI. What is not there is 0.
struct Numbers : std::map<std::string, double> {
  using std::map<std::string, double>::map;
  double get(const std::string& name) const {
    const auto at = find(name);
    return at == end() ? 0 : at->second;
  }
};

/// What is done to a robot's cart, and what its sensors show without noise.
struct RobotRecord {
  std::vector<double> times;    ///< [s], equally spaced from 0
  std::vector<double> command;  ///< acceleration of the cart [m/s²], linear between times
  std::vector<double> unasked;  ///< acceleration that nobody commanded, likewise; empty: none
  std::vector<std::vector<double>> seen;  ///< per sensor: [rad] or [N]
  double largestAngle = 0;                ///< of any link, or of the string [rad]
  double leastForce = 0;                  ///< of the string [N]
};

/// A robot as it is: its own dynamics, no code or derivation shared with the libraries.
///
/// double-pendulum: bodies in the plane, two or three, with their joints' reactions, Newton's and
/// Euler's equations of all solved together; a welded joint is one more unknown moment. Numbers
/// m_1, m_2, com_1, com_2, I_1, I_2, pivots, damping and those of effects, see hidden_robots.cc.
///
/// suspended-mass: a point mass in Cartesian coordinates, held by the reaction of a string or by
/// a spring and damper. Numbers mass, length.
///
/// At rest, hanging, until time 0.
/// @throws std::runtime_error where the motion does not stay finite
void observeDoublePendulum(const Numbers& plant, RobotRecord& record, double tolerance = 1e-10);
void observeSuspendedMass(const Numbers& plant, RobotRecord& record, double tolerance = 1e-10);

}  // namespace hidden
