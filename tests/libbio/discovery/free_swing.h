#pragma once

#include <cmath>
#include <random>
#include <string>
#include <type_traits>

#include "bio/opensim/osim_file.h"
#include "bio/tables/trial.h"
#include "support/scratch_folder.h"

/// A pendulum without muscles and its free swings.
namespace bio::discover {

inline constexpr double rodLength = 0.6, frictionPerMass = 0.03;

/// A point mass on a rod.
inline Model freePendulum(double mass) {
  const support::ScratchFolder folder;
  return readOsim(folder.file(
      "pendulum.osim",
      "<OpenSimDocument Version=\"30000\"><Model name=\"pendulum\"><gravity>0 -9.81 0</gravity>"
      "<BodySet><objects><Body name=\"ground\"><mass>0</mass></Body><Body name=\"arm\"><mass>" +
          std::to_string(mass) + "</mass><mass_center>0 " + std::to_string(-rodLength) +
          " 0</mass_center><inertia_xx>0</inertia_xx><inertia_yy>0</inertia_yy><inertia_zz>0"
          "</inertia_zz><inertia_xy>0</inertia_xy><inertia_xz>0</inertia_xz><inertia_yz>0"
          "</inertia_yz><Joint><PinJoint name=\"pivot\"><parent_body>ground</parent_body>"
          "<CoordinateSet><objects><Coordinate name=\"swing\"><default_value>0</default_value>"
          "<range>-3 3</range></Coordinate></objects></CoordinateSet></PinJoint></Joint></Body>"
          "</objects></BodySet><ForceSet><objects/></ForceSet></Model></OpenSimDocument>"));
}

/// The resistance of a viscous joint over the pendulum's mass [N m/kg], at a speed [rad/s].
inline double viscous(double speed) {
  return frictionPerMass * speed;
}

/// Its swing by RK4, with 0.2 degrees of noise; the same for any mass.
/// @param resistance over the mass [N m/kg], of the speed or of position and speed
template <class Resistance>
Trial freeSwing(double from, unsigned seed, const Resistance& resistance) {
  Trial trial;
  trial.file = "swing.csv";
  trial.times = Eigen::VectorXd::LinSpaced(151, 0, 3);
  trial.excitations.resize(151, 0);
  trial.measured.push_back({ofCoordinate("swing"), trial.times, Eigen::VectorXd(151)});
  std::mt19937 generator(seed);
  std::normal_distribution<double> noise(0, 0.2 * std::acos(-1) / 180);
  const auto bend = [&](double q, double speed) {
    double resists = 0;
    if constexpr (std::is_invocable_v<Resistance, double, double>)
      resists = resistance(q, speed);
    else
      resists = resistance(speed);
    return -9.81 / rodLength * std::sin(q) - resists / (rodLength * rodLength);
  };
  double q = from, w = 0;
  const double h = 0.001;
  for (Eigen::Index k = 0; k < 151; ++k) {
    trial.measured.front().values[k] = q + noise(generator);
    for (int i = 0; i < 20; ++i) {
      const double q1 = w, w1 = bend(q, w), q2 = w + h / 2 * w1, w2 = bend(q + h / 2 * q1, q2),
                   q3 = w + h / 2 * w2, w3 = bend(q + h / 2 * q2, q3), q4 = w + h * w3,
                   w4 = bend(q + h * q3, q4);
      q += h / 6 * (q1 + 2 * q2 + 2 * q3 + q4);
      w += h / 6 * (w1 + 2 * w2 + 2 * w3 + w4);
    }
  }
  return trial;
}

}  // namespace bio::discover
