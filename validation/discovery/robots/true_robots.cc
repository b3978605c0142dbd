#include "robots/true_robots.h"

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

V2 pulledDown(double tilt) {
  return 9.81 * V2(-std::sin(tilt), -std::cos(tilt));
}

// A link: its mass centre and the next joint lie on the line through its own joint.
struct Link {
  double m, s, inertia, next;
};
}  // namespace

void observeDoublePendulum(const Numbers& plant, RobotRecord& record, double tolerance) {
  std::vector<Link> links = {
      {plant.at("m_1"), plant.at("com_1"), plant.at("I_1"), plant.at("pivots")},
      {plant.at("m_2"), plant.at("com_2"), plant.at("I_2"), 0.2796}};
  if (plant.get("link_3") > 0)
    links.push_back({plant.get("link_3"), plant.at("link_3_length"), 0, 0});
  const auto n = static_cast<Eigen::Index>(links.size());
  const V2 gravity = pulledDown(plant.get("tilt"));
  const auto moment = [&](Eigen::Index joint, double angle, double w) {
    if (joint == 2) return -0.5 * links[2].m * links[2].s * links[2].s * w;
    const std::string name = std::to_string(joint + 1);
    const double ratio = w / 0.5;
    return -(plant.at("damping") + plant.get("visc_" + name)) * w -
           plant.get("coulomb_" + name) * dryShare(w) -
           plant.get("stribeck_" + name) * (1 + std::exp(-ratio * ratio)) * dryShare(w) -
           plant.get("locked_" + name) * (angle + 2e-3 * w) - plant.get("cable_" + name) * angle -
           plant.get("cogging_" + name) * std::sin(6 * angle);
  };
  const bool welded = plant.get("welded_2") > 0;
  // unknown: the angular accelerations, the joints' reactions, and the weld's moment
  const Rate rate = [&](double t, const std::vector<double>& x, std::vector<double>& xDot) {
    const V2 cart(cartOf(plant, record, t, x, xDot), 0);
    const auto angles = Eigen::VectorXd::Map(x.data() + 2, n);
    const auto w = Eigen::VectorXd::Map(x.data() + 2 + n, n);
    Eigen::MatrixXd M = Eigen::MatrixXd::Zero(3 * n + 1, 3 * n + 1);
    Eigen::VectorXd r = Eigen::VectorXd::Zero(3 * n + 1);
    // of the joint: its speed, and its acceleration without what the angular ones make
    V2 speed(x[1], 0), bent = cart;
    Eigen::MatrixXd carried = Eigen::MatrixXd::Zero(2, n);
    const auto reaction = [&](Eigen::Index i) { return n + 2 * i; };
    for (Eigen::Index i = 0; i < n; ++i) {
      const Link& link = links[static_cast<std::size_t>(i)];
      const V2 along(std::sin(angles[i]), -std::cos(angles[i]));
      const V2 across(std::cos(angles[i]), std::sin(angles[i]));
      const V2 v = speed + link.s * w[i] * across;
      const double air = i < 2 ? plant.get("drag") * v.norm() : 0;
      // m a = R_i − R_{i+1} + m g + drag
      M.block(2 * i, 0, 2, n) = link.m * carried;
      M.block<2, 1>(2 * i, i) += link.m * link.s * across;
      M.block<2, 2>(2 * i, reaction(i)) = -Eigen::Matrix2d::Identity();
      if (i + 1 < n) M.block<2, 2>(2 * i, reaction(i + 1)) = Eigen::Matrix2d::Identity();
      r.segment<2>(2 * i) = link.m * (gravity - bent + link.s * w[i] * w[i] * along) - air * v;
      // moments about the mass centre: from R_i above it and −R_{i+1} below it
      const Eigen::Index row = 2 * n + i;
      const V2 up = -link.s * along, down = (link.next - link.s) * along;
      M(row, i) = link.inertia;
      M(row, reaction(i)) = up.y(), M(row, reaction(i) + 1) = -up.x();
      if (i + 1 < n) M(row, reaction(i + 1)) = -down.y(), M(row, reaction(i + 1) + 1) = down.x();
      const double own = i == 0 ? moment(0, angles[0], w[0])
                                : moment(i, angles[i] - angles[i - 1], w[i] - w[i - 1]);
      r[row] += own;
      if (i > 0) r[row - 1] -= own;
      // on to the next joint
      carried.col(i) = link.next * across;
      speed += link.next * w[i] * across;
      bent -= link.next * w[i] * w[i] * along;
    }
    // the weld holds the second joint, or there is none
    M(3 * n, 3 * n) = welded ? 0 : 1;
    if (welded) {
      M(3 * n, 0) = 1, M(3 * n, 1) = -1;
      M(2 * n, 3 * n) = 1, M(2 * n + 1, 3 * n) = -1;
    }
    const Eigen::VectorXd y = M.partialPivLu().solve(r);
    for (Eigen::Index i = 0; i < n; ++i) {
      xDot[static_cast<std::size_t>(2 + i)] = w[i];
      xDot[static_cast<std::size_t>(2 + n + i)] = y[i];
    }
  };
  record.seen.assign(2, std::vector<double>(record.times.size()));
  record.largestAngle = 0;
  std::vector<double> x(2 + 2 * links.size(), 0);
  // it hangs where gravity pulls
  for (std::size_t i = 0; i < links.size(); ++i) x[2 + i] = -plant.get("tilt");
  watch(plant, rate, x, record, tolerance, [&](double, std::size_t k) {
    for (std::size_t i = 0; i < 2; ++i) {
      const std::string name = std::to_string(i + 1);
      record.largestAngle = std::max(record.largestAngle, std::abs(x[2 + i]));
      record.seen[i][k] = (1 + plant.get("gain_" + name)) * x[2 + i] + plant.get("bias_" + name);
    }
  });
}

void observeSuspendedMass(const Numbers& plant, RobotRecord& record, double tolerance) {
  const double m = plant.at("mass"), length = plant.at("length"), C = plant.get("elastic");
  constexpr double g = 9.81, stringDamping = 0.2;
  const double tilt = plant.get("tilt");
  const V2 gravity = pulledDown(-tilt);  // its angles turn the other way round
  double force = 0;
  // place and speed relative to the cart, in a frame that falls with its acceleration
  const auto pulled = [&](double t, const std::vector<double>& x, std::vector<double>& xDot) {
    const double cart = cartOf(plant, record, t, x, xDot);
    const V2 place(x[2], x[3]), speed(x[4], x[5]);
    const V2 through = speed + V2(x[1], 0);
    const double r = place.norm(), growing = plant.get("creep") * length;
    const V2 along = place / r, across(along.y(), -along.x());
    const double turning = across.dot(speed) / r;
    const double pivot = -plant.get("visc") * turning - plant.get("coulomb") * dryShare(turning);
    const V2 pull = m * (gravity - V2(cart, 0)) - plant.get("drag") * through.norm() * through +
                    pivot / r * across;
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
  const V2 hanging = length * gravity.normalized(), growth = plant.get("creep") * hanging;
  std::vector<double> x = {0, 0, hanging.x(), hanging.y(), growth.x(), growth.y()}, xDot(6);
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
