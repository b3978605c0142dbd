#include "reduced/reduced_truth.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

#include "info/probability/random_stream.h"

namespace reduced {

using info::RandomStream;

namespace {

// One arm as it truly is. Nothing here comes from the model's code.
struct MusculoskeletalSystem {
  double strength[4] = {550, 850, 250, 1100}, best[4] = {0.13, 0.09, 0.17, 0.10};
  double straight[4] = {0.1656281294, 0.1126893492, 0.2255056898, 0.0710494310};  // ℓ at q = 0
  double weight = 1.5, rise = 0.03, width = 0.2;
  std::map<std::string, double> with;  // hidden effects
  double get(const std::string& effect) const {
    const auto found = with.find(effect);
    return found == with.end() ? 0 : found->second;
  }
};

struct State {
  double q = 0, w = 0, act[4] = {0, 0, 0, 0}, spent[4] = {0, 0, 0, 0}, z = 0;
};

State advance(const State& x, const State& slope, double h) {
  State y = x;
  y.q += h * slope.q;
  y.w += h * slope.w;
  y.z += h * slope.z;
  for (int i = 0; i < 4; ++i) {
    y.act[i] += h * slope.act[i];
    y.spent[i] += h * slope.spent[i];
  }
  return y;
}

// A signal at 100 Hz, straight between.
double signalAt(const std::vector<std::array<double, 4>>& u, std::size_t muscle, double t) {
  const double place = std::clamp(t / 0.01, 0.0, static_cast<double>(u.size() - 1));
  const auto k = std::min(static_cast<std::size_t>(place), u.size() - 2);
  const double share = place - static_cast<double>(k);
  return (1 - share) * u[k][muscle] + share * u[k + 1][muscle];
}

double angleOfArm(int muscle, double q, double extra) {
  static constexpr double even[4] = {0.018, 0.012, 0.025, -0.022};
  static constexpr double odd[4] = {0.022, 0.013, 0.04, -0.004};
  return even[muscle] + odd[muscle] * std::sin(q) + extra;
}
double shortening(int muscle, double q, double extra) {
  static constexpr double even[4] = {0.018, 0.012, 0.025, -0.022};
  static constexpr double odd[4] = {0.022, 0.013, 0.04, -0.004};
  return even[muscle] * q + odd[muscle] * (1 - std::cos(q)) + extra * (q - 1.2);
}

State slopeOf(const MusculoskeletalSystem& arm, const State& x, const double* excitation,
              double t) {
  State s;
  s.q = x.w;
  double torque = 0;
  const double fatigue = arm.get("fatigue");
  for (int i = 0; i < 4; ++i) {
    const double u = excitation[i], a = x.act[i];
    s.act[i] = (u - a) * (u / arm.rise + (1 - u) / (2 * arm.rise));
    s.spent[i] = a;
    const double wrap = i == 0 ? arm.get("wrapBIC") : i == 3 ? arm.get("wrapTRI") : 0;
    const double r = angleOfArm(i, x.q, wrap);
    const double length = (arm.straight[i] - shortening(i, x.q, wrap)) / arm.best[i];
    const double speed = -r * x.w / arm.best[i] / 10;
    const double byLength = std::exp(-(length - 1) * (length - 1) / arm.width);
    const double bySpeed =
        speed <= 0 ? (1 + speed) / (1 - 4 * speed) : (1 + 15 * speed) / (1 + 10 * speed);
    const double passive = 4 * std::pow(std::max(0.0, length - 1), 2);
    double force = arm.strength[i] * (a * byLength * bySpeed + passive);
    force *= 1 - fatigue * (1 - std::exp(-x.spent[i] / 0.4));
    torque += r * force;
  }
  const double extra = arm.get("payload");
  torque -= 9.81 * (arm.weight * 0.15 + extra * 0.34) * std::sin(x.q + arm.get("tilt"));
  const double grip = std::tanh(x.w / 0.05);
  torque -= arm.get("visc") * x.w + arm.get("coulomb") * grip;
  torque -= arm.get("stribeck") * (1 + std::exp(-std::pow(x.w / 0.4, 2))) * grip;
  torque -= arm.get("drag") * x.w * std::abs(x.w) + arm.get("stiffness") * (x.q - 1);
  if (const double A = arm.get("limit"); A != 0)
    torque -= A * (std::exp(8 * (x.q - 2.0)) - std::exp(-8 * (x.q - 0.5)));
  torque += arm.get("const") + arm.get("handforce") * 0.34 * std::cos(x.q);
  // what no catalogue has
  torque -= arm.get("cubic") * std::pow(x.q - 1.2, 3);
  if (const double b = arm.get("powerdamp"); b != 0)
    torque -= b * x.w / std::sqrt(std::sqrt(x.w * x.w + 1e-4));
  torque -= arm.get("qdamp") * x.q * x.q * x.w;
  torque += arm.get("tremor") * std::sin(2 * 3.14159265358979 * 4.7 * t);
  s.z = 12 * (x.w - std::abs(x.w) * x.z);  // Bouc–Wen
  torque -= arm.get("hysteresis") * x.z;
  s.w = torque / (arm.weight * 0.07 / 1.5 + extra * 0.34 * 0.34);
  return s;
}

// Excitations at the muscles: what was commanded, late, bent or mixed as the effects want.
void atTheMuscles(const MusculoskeletalSystem& arm,
                  const std::vector<std::array<double, 4>>& commanded,
                  const std::vector<std::array<double, 4>>& noise, double t, double* u) {
  const double late = t - arm.get("delay");
  for (std::size_t i = 0; i < 4; ++i) u[i] = signalAt(commanded, i, late);
  const double A = arm.get("shape");
  for (std::size_t i = 0; i < 4; ++i) {
    if (A != 0) u[i] = std::expm1(A * u[i]) / std::expm1(A);
    u[i] *= 1 + signalAt(noise, i, t);
  }
}

// Targets: holds and minimum-jerk reaches.
std::vector<double> targets(double seconds, RandomStream& random) {
  std::vector<double> path;
  double from = 0.5 + 1.4 * random.uniform(), to = from;
  double reach = 0, hold = 0.15 + 0.2 * random.uniform(), t = 0;
  for (double now = 0; now <= seconds + 0.011; now += 0.01, t += 0.01) {
    if (t > reach + hold) {
      from = to;
      to = 0.4 + 1.7 * random.uniform();
      reach = 0.35 + 0.5 * random.uniform();
      hold = 0.3 * random.uniform();
      t = 0;
    }
    const double s = reach > 0 ? std::min(1.0, t / reach) : 1;
    path.push_back(from + (to - from) * s * s * s * (10 - 15 * s + 6 * s * s));
  }
  return path;
}

Trial recordOne(const MusculoskeletalSystem& arm, const Recipe& recipe, RandomStream& random) {
  const auto ticks = static_cast<std::size_t>(std::lround(recipe.seconds / 0.01));
  const std::vector<double> target = targets(recipe.seconds, random);
  std::vector<std::array<double, 4>> noise(ticks + 1);
  const double keep = std::exp(-0.01 / 0.08), fresh = std::sqrt(1 - keep * keep);
  for (std::size_t k = 0; k <= ticks; ++k)
    for (std::size_t i = 0; i < 4; ++i)
      noise[k][i] = k == 0 ? recipe.emgNoise * random.normal()
                           : keep * noise[k - 1][i] + fresh * recipe.emgNoise * random.normal();
  const double together = 0.02 + 0.05 * random.uniform();  // co-contraction
  // the controller aims at a torque with its own idea of the arm, and corrects what it sees
  State x;
  x.q = target[0];
  std::vector<std::array<double, 4>> commanded(ticks + 1);
  std::vector<double> angle;
  double error = 0;
  const auto command = [&](std::size_t k) {
    const std::size_t next = std::min(k + 3, target.size() - 1);
    const double wish = (target[next] - target[next - 2]) / 0.02;
    error = std::clamp(error + 0.01 * (target[k] - x.q), -0.3, 0.3);
    const double torque =
        2.2 * std::sin(x.q) + 25 * (target[next] - x.q) + 4 * (wish - x.w) + 40 * error;
    std::array<double, 4> u{};
    const double flex = std::max(0.0, torque) / 55, extend = std::max(0.0, -torque) / 22;
    u[0] = together + flex;
    u[1] = together + 0.8 * flex;
    u[2] = together + 1.2 * flex;
    u[3] = 1.5 * together + extend;
    for (double& value : u) value = std::clamp(value, 0.01, 0.95);
    return u;
  };
  commanded[0] = command(0);
  for (std::size_t i = 0; i < 4; ++i) x.act[i] = commanded[0][i];
  {  // muscles have settled on what they got
    double u[4];
    for (std::size_t k = 1; k <= ticks; ++k) commanded[k] = commanded[0];
    atTheMuscles(arm, commanded, noise, 0, u);
    for (int i = 0; i < 4; ++i) x.act[i] = u[i];
  }
  const State start = x;
  std::vector<double> fine;  // angle every 0.5 ms
  for (std::size_t k = 0; k < ticks; ++k) {
    commanded[k + 1] = command(k);
    for (int sub = 0; sub < 20; ++sub) {
      const double t = 0.01 * static_cast<double>(k) + 0.0005 * sub, h = 0.0005;
      fine.push_back(x.q);
      double u0[4], u1[4], u2[4];
      atTheMuscles(arm, commanded, noise, t, u0);
      atTheMuscles(arm, commanded, noise, t + h / 2, u1);
      atTheMuscles(arm, commanded, noise, t + h, u2);
      const State k1 = slopeOf(arm, x, u0, t);
      const State k2 = slopeOf(arm, advance(x, k1, h / 2), u1, t + h / 2);
      const State k3 = slopeOf(arm, advance(x, k2, h / 2), u1, t + h / 2);
      const State k4 = slopeOf(arm, advance(x, k3, h), u2, t + h);
      x = advance(advance(advance(advance(x, k1, h / 6), k2, h / 3), k3, h / 3), k4, h / 6);
    }
    if (!std::isfinite(x.q)) throw std::domain_error("reduced truth: the arm went out of range");
  }
  fine.push_back(x.q);

  Trial trial;
  trial.excitations = commanded;
  for (auto& u : trial.excitations) {  // what electrodes see of each other
    const double biceps = u[0];
    u[0] += arm.get("bic<tri") * u[3];
    u[3] += arm.get("tri<bic") * biceps;
  }
  const double clock = arm.get("clock");
  const auto first = static_cast<std::size_t>(std::lround(trial.firstSample / 0.01));
  trial.angles.resize(static_cast<Eigen::Index>(ticks - first + 1));
  for (std::size_t k = first; k <= ticks; ++k) {
    const double place = (0.01 * static_cast<double>(k) - clock) / 0.0005;
    const auto at = std::min(static_cast<std::size_t>(place + 1e-9), fine.size() - 2);
    const double share = place - static_cast<double>(at);
    const double q = (1 - share) * fine[at] + share * fine[at + 1];
    trial.angles[static_cast<Eigen::Index>(k - first)] =
        (1 + arm.get("gain")) * q + arm.get("bias") + recipe.outputNoise * random.normal();
  }
  // what is believed of the start: within its tolerance
  trial.startAngle = start.q + (recipe.nuisances ? 0.05 * random.normal() : 0);
  trial.startSpeed = 0;
  return trial;
}

}  // namespace

double fullSize(const std::string& effect) {
  static const std::map<std::string, double> sizes = {
      {"visc", 0.25},      {"coulomb", 0.3},   {"stribeck", 0.25}, {"drag", 0.08},
      {"stiffness", 1},    {"limit", 0.8},     {"payload", 0.4},   {"tilt", 0.2},
      {"const", 0.6},      {"handforce", 2.5}, {"fatigue", 0.3},   {"delay", 0.03},
      {"shape", -1.2},     {"tri<bic", 0.15},  {"bic<tri", 0.15},  {"wrapBIC", 0.005},
      {"wrapTRI", 0.005},  {"bias", 0.1},      {"gain", 0.1},      {"clock", 0.03},
      {"cubic", 1.2},      {"powerdamp", 0.5}, {"qdamp", 0.2},     {"tremor", 0.4},
      {"hysteresis", 0.6}, {"flwidth", 0.35}};
  const auto found = sizes.find(effect);
  if (found == sizes.end()) throw std::invalid_argument("reduced truth: no effect " + effect);
  return found->second;
}

std::vector<Trial> record(const Recipe& recipe, std::uint64_t seed) {
  RandomStream draw(seed, 0), again(seed, 98);
  MusculoskeletalSystem arm;
  const double on = recipe.nuisances ? 1 : 0;
  // beyond 2.5 deviations it would be a parameter error, not a tolerance
  const auto within = [&] {
    double z = draw.normal();
    while (std::abs(z) > 2.5) z = again.normal();
    return on * z;
  };
  for (int i = 0; i < 4; ++i) {
    arm.strength[i] *= std::exp(0.15 * within());
    // a longer optimal length, the same path: the straight length stays
    arm.best[i] *= std::exp(0.04 * within());
  }
  arm.weight *= std::exp(0.05 * within());
  arm.rise *= std::exp(0.2 * within());
  for (const auto& [id, size] : recipe.effects) {
    static const std::string muscles[4] = {"BIC", "BRA", "BRD", "TRI"};
    bool parameter = false;
    for (int i = 0; i < 4; ++i) {
      if (id == "Fmax" + muscles[i]) arm.strength[i] *= size, parameter = true;
      if (id == "lopt" + muscles[i]) arm.best[i] *= size, parameter = true;
    }
    if (id == "mass") arm.weight *= size, parameter = true;
    if (id == "tau") arm.rise *= size, parameter = true;
    if (id == "flwidth") arm.width *= std::exp(size), parameter = true;
    if (!parameter) {
      fullSize(id);
      arm.with[id] += size;
    }
  }
  std::vector<Trial> trials;
  for (int t = 0; t < recipe.trials; ++t) {
    RandomStream random(seed, static_cast<std::uint64_t>(t) + 1);
    trials.push_back(recordOne(arm, recipe, random));
  }
  return trials;
}

}  // namespace reduced
