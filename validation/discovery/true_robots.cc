#include "true_robots.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace hidden {

void carry(const Rate& rate, double from, double to, std::vector<double>& x, double& step,
           double tolerance) {
  // Dormand and Prince (1980)
  static constexpr double c[7] = {0, 1.0 / 5, 3.0 / 10, 4.0 / 5, 8.0 / 9, 1, 1};
  static constexpr double a[7][6] = {
      {},
      {1.0 / 5},
      {3.0 / 40, 9.0 / 40},
      {44.0 / 45, -56.0 / 15, 32.0 / 9},
      {19372.0 / 6561, -25360.0 / 2187, 64448.0 / 6561, -212.0 / 729},
      {9017.0 / 3168, -355.0 / 33, 46732.0 / 5247, 49.0 / 176, -5103.0 / 18656},
      {35.0 / 384, 0, 500.0 / 1113, 125.0 / 192, -2187.0 / 6784, 11.0 / 84}};
  static constexpr double e[7] = {71.0 / 57600,      0,          -71.0 / 16695, 71.0 / 1920,
                                  -17253.0 / 339200, 22.0 / 525, -1.0 / 40};
  const std::size_t n = x.size();
  std::array<std::vector<double>, 7> k;
  for (auto& slope : k) slope.resize(n);
  std::vector<double> y(n);
  double t = from;
  while (t < to) {
    const bool last = t + step * (1 + 1e-9) >= to;
    const double h = last ? to - t : step;
    for (std::size_t stage = 0; stage < 7; ++stage) {
      y = x;
      for (std::size_t j = 0; j < stage; ++j)
        for (std::size_t i = 0; i < n; ++i) y[i] += h * a[stage][j] * k[j][i];
      rate(t + c[stage] * h, y, k[stage]);
    }
    double error = 0;
    for (std::size_t i = 0; i < n; ++i) {
      double one = 0;
      for (std::size_t j = 0; j < 7; ++j) one += h * e[j] * k[j][i];
      error = std::max(error, std::abs(one) / (tolerance * (1 + std::abs(x[i]))));
      if (!std::isfinite(one)) error = 1e10;
    }
    const double factor = std::clamp(0.9 * std::pow(std::max(error, 1e-10), -0.2), 0.2, 4.0);
    if (error <= 1) {
      t = last ? to : t + h;
      x = y;  // the last stage is the solution of order 5
      if (!last || factor < 1) step = h * factor;
    } else {
      step = h * factor;
      if (step < 1e-9) throw std::runtime_error("the motion does not stay finite");
    }
  }
}

namespace {

double at(const std::vector<double>& signal, const std::vector<double>& times, double t) {
  if (signal.empty()) return 0;
  const double place =
      std::clamp(t / (times[1] - times[0]), 0.0, static_cast<double>(signal.size() - 1));
  const auto k = std::min(static_cast<std::size_t>(place), signal.size() - 2);
  const double share = place - static_cast<double>(k);
  return signal[k] + share * (signal[k + 1] - signal[k]);
}

// What the cart does: its own acceleration, which may lag (x[0], and its speed x[1]), and the rest.
double cartOf(const Numbers& plant, const RobotRecord& record, double t,
              const std::vector<double>& x, std::vector<double>& xDot) {
  const double command = at(record.command, record.times, t), lag = plant.get("lag");
  xDot[0] = lag > 0 ? (command - x[0]) / lag : 0;
  const double cart = (lag > 0 ? x[0] : command) + at(record.unasked, record.times, t);
  xDot[1] = cart;
  return cart;
}

// Goes through the record from corner to corner of the command and from look to look; looks are
// late by the clock.
template <class See>
void watch(const Numbers& plant, const Rate& rate, std::vector<double>& x, RobotRecord& record,
           double tolerance, const See& see) {
  const double clock = plant.get("clock");
  double t = 0, step = 1e-3;
  std::size_t corner = 1;
  x[0] = record.command[0];
  for (std::size_t k = 0; k < record.times.size(); ++k) {
    const double look = std::max(0.0, record.times[k] - clock);
    while (t < look) {
      const double until = std::min(look, record.times[corner]);
      carry(rate, t, until, x, step, tolerance);
      t = until;
      if (t >= record.times[corner]) ++corner;
    }
    see(look, k);
  }
}

double dryShare(double w) {
  return std::tanh(w / 0.05);
}

using V2 = Eigen::Vector2d;
}  // namespace

void observeDoublePendulum(const Numbers& plant, RobotRecord& record, double tolerance) {
  const double m[2] = {plant.at("m_1"), plant.at("m_2")};
  const double s[2] = {plant.at("com_1"), plant.at("com_2")};
  const double inertia[2] = {plant.at("I_1"), plant.at("I_2")}, pivots = plant.at("pivots");
  const V2 gravity = 9.81 * V2(-std::sin(plant.get("tilt")), -std::cos(plant.get("tilt")));
  const auto moment = [&](int joint, double angle, double w) {
    const std::string n = std::to_string(joint + 1);
    const double ratio = w / 0.5;
    return -(plant.at("damping") + plant.get("visc_" + n)) * w -
           plant.get("coulomb_" + n) * dryShare(w) -
           plant.get("stribeck_" + n) * (1 + std::exp(-ratio * ratio)) * dryShare(w) -
           plant.get("cable_" + n) * angle - plant.get("cogging_" + n) * std::sin(6 * angle);
  };
  // unknown: both angular accelerations, then both joints' reactions
  const Rate rate = [&](double t, const std::vector<double>& x, std::vector<double>& xDot) {
    const V2 cart(cartOf(plant, record, t, x, xDot), 0);
    const double angle[2] = {x[2], x[3]}, w[2] = {x[4], x[5]};
    V2 along[2], across[2];
    for (int i = 0; i < 2; ++i) {
      along[i] = V2(std::sin(angle[i]), -std::cos(angle[i]));
      across[i] = V2(std::cos(angle[i]), std::sin(angle[i]));
    }
    const double joint[2] = {moment(0, angle[0], w[0]),
                             moment(1, angle[1] - angle[0], w[1] - w[0])};
    const V2 speed[2] = {V2(x[1], 0) + s[0] * w[0] * across[0],
                         V2(x[1], 0) + pivots * w[0] * across[0] + s[1] * w[1] * across[1]};
    Eigen::Matrix<double, 6, 6> M = Eigen::Matrix<double, 6, 6>::Zero();
    Eigen::Matrix<double, 6, 1> r;
    const V2 bend = w[0] * w[0] * along[0];
    const V2 drag[2] = {-plant.get("drag") * speed[0].norm() * speed[0],
                        -plant.get("drag") * speed[1].norm() * speed[1]};
    // link 1: m a = R1 − R2 + m g + drag
    M.block<2, 1>(0, 0) = m[0] * s[0] * across[0];
    M.block<2, 2>(0, 2) = -Eigen::Matrix2d::Identity();
    M.block<2, 2>(0, 4) = Eigen::Matrix2d::Identity();
    r.segment<2>(0) = m[0] * (gravity - cart + s[0] * bend) + drag[0];
    // link 2: m a = R2 + m g + drag
    M.block<2, 1>(2, 0) = m[1] * pivots * across[0];
    M.block<2, 1>(2, 1) = m[1] * s[1] * across[1];
    M.block<2, 2>(2, 4) = -Eigen::Matrix2d::Identity();
    r.segment<2>(2) =
        m[1] * (gravity - cart + pivots * bend + s[1] * w[1] * w[1] * along[1]) + drag[1];
    // moments about the mass centres
    const V2 up1 = -s[0] * along[0], down1 = (pivots - s[0]) * along[0], up2 = -s[1] * along[1];
    M(4, 0) = inertia[0];
    M(4, 2) = up1.y(), M(4, 3) = -up1.x();
    M(4, 4) = -down1.y(), M(4, 5) = down1.x();
    r[4] = joint[0] - joint[1];
    M(5, 1) = inertia[1];
    M(5, 4) = up2.y(), M(5, 5) = -up2.x();
    r[5] = joint[1];
    const Eigen::Matrix<double, 6, 1> y = M.partialPivLu().solve(r);
    xDot[2] = w[0], xDot[3] = w[1], xDot[4] = y[0], xDot[5] = y[1];
  };
  record.seen.assign(2, std::vector<double>(record.times.size()));
  record.largestAngle = 0;
  std::vector<double> x(6, 0);
  // it hangs where gravity pulls
  x[2] = x[3] = -plant.get("tilt");
  watch(plant, rate, x, record, tolerance, [&](double, std::size_t k) {
    for (std::size_t i = 0; i < 2; ++i) {
      const std::string n = std::to_string(i + 1);
      record.largestAngle = std::max(record.largestAngle, std::abs(x[2 + i]));
      record.seen[i][k] = (1 + plant.get("gain_" + n)) * x[2 + i] + plant.get("bias_" + n);
    }
  });
}

void observeSuspendedMass(const Numbers& plant, RobotRecord& record, double tolerance) {
  const double m = plant.at("mass"), length = plant.at("length"), C = plant.get("elastic");
  constexpr double g = 9.81, stringDamping = 0.2;
  double force = 0;
  // place and speed relative to the cart, in a frame that falls with its acceleration
  const auto pulled = [&](double t, const std::vector<double>& x, std::vector<double>& xDot) {
    const double cart = cartOf(plant, record, t, x, xDot);
    const V2 place(x[2], x[3]), speed(x[4], x[5]);
    const V2 through = speed + V2(x[1], 0);
    const V2 pull = m * V2(-cart, -g) - plant.get("drag") * through.norm() * through;
    const double r = place.norm(), growing = plant.get("creep") * length;
    const V2 along = place / r;
    if (C > 0) {
      const double free = length - C * m * g + growing * t;
      force = (r - free) / C + stringDamping * (along.dot(speed) - growing);
    } else {
      // r r̈ + ṙ² = |ṗ|² + p·p̈ with r̈ = 0
      force = along.dot(pull) + m * (speed.squaredNorm() - growing * growing) / r;
    }
    const V2 acceleration = (pull - force * along) / m;
    xDot[2] = speed.x(), xDot[3] = speed.y();
    xDot[4] = acceleration.x(), xDot[5] = acceleration.y();
  };
  const Rate rate = pulled;
  record.seen.assign(1, std::vector<double>(record.times.size()));
  record.largestAngle = 0;
  record.leastForce = HUGE_VAL;
  std::vector<double> x = {0, 0, 0, -length, 0, -plant.get("creep") * length}, xDot(6);
  watch(plant, rate, x, record, tolerance, [&](double t, std::size_t k) {
    pulled(t, x, xDot);
    record.leastForce = std::min(record.leastForce, force);
    record.largestAngle = std::max(record.largestAngle, std::abs(std::atan2(x[2], -x[3])));
    double seen = force;
    const double limit = plant.get("saturation_at");
    if (limit > 0 && force > limit) seen -= plant.get("saturation") * (force - limit);
    record.seen[0][k] =
        (1 + plant.get("gain")) * seen + plant.get("bias") + plant.get("drift") * record.times[k];
  });
}

}  // namespace hidden
