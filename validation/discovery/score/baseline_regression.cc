// Today's practice, to compare with: smooth the angle at 6 Hz, differentiate twice, take what the
// nominal model's inverse dynamics leave over, and regress it on one named torque after the other;
// the name with the best BIC wins.
//
//     baseline_regression MODEL.osim TRIAL.sto… --out DIR      writes DIR/verdict.json
//
// Exit status 2 for wrong use or files that cannot be read.

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "generator/arguments.h"
#include "generator/hidden_effects.h"

namespace {

using namespace hidden;
using Json = nlohmann::ordered_json;
using Samples = std::vector<double>;

struct Measured {
  Recording emg;
  Samples angle;  ///< [rad]
};

// A table as make_hidden_elbow writes it.
Measured readTrial(const std::string& file) {
  std::ifstream stream(file);
  std::string line;
  while (std::getline(stream, line) && !line.starts_with("endheader")) {
  }
  std::getline(stream, line);
  if (!stream) throw std::runtime_error(file + ": is no .sto table");
  Measured trial;
  while (std::getline(stream, line)) {
    std::istringstream cells(line);
    double time, angle;
    std::array<double, 8> emg{};
    cells >> time;
    for (double& u : emg) cells >> u;
    cells >> angle;
    if (!cells) throw std::runtime_error(file + ": a row without ten numbers: " + line);
    trial.emg.times.push_back(time);
    trial.emg.emg.push_back(emg);
    trial.angle.push_back(angle * degree);
  }
  if (trial.angle.size() < 50) throw std::runtime_error(file + ": holds too few rows");
  return trial;
}

// Butterworth's second-order low-pass forward and backward, ends mirrored.
Samples smoothed(const Samples& x, double rate, double cutoff) {
  const std::size_t n = x.size(), pad = 40;
  Samples y;
  for (std::size_t k = pad; k > 0; --k) y.push_back(2 * x[0] - x[k]);
  y.insert(y.end(), x.begin(), x.end());
  for (std::size_t k = 1; k <= pad; ++k) y.push_back(2 * x[n - 1] - x[n - 1 - k]);
  // the cut-off of one pass, so that both together are down by 3 dB at the one asked for
  const double w = std::tan(std::numbers::pi * cutoff / std::pow(std::sqrt(2.0) - 1, 0.25) / rate);
  const double norm = 1 + std::sqrt(2.0) * w + w * w;
  const double b = w * w / norm, a1 = 2 * (w * w - 1) / norm;
  const double a2 = (1 - std::sqrt(2.0) * w + w * w) / norm;
  for (int pass = 0; pass < 2; ++pass) {
    double x1 = y[0], x2 = y[0], y1 = y[0], y2 = y[0];
    for (double& value : y) {
      const double out = b * (value + 2 * x1 + x2) - a1 * y1 - a2 * y2;
      x2 = x1, x1 = value, y2 = y1, y1 = out;
      value = out;
    }
    std::reverse(y.begin(), y.end());
  }
  return {y.begin() + pad, y.begin() + static_cast<std::ptrdiff_t>(pad + n)};
}

Samples slopes(const Samples& x, double rate) {
  Samples d(x.size(), 0.0);
  for (std::size_t k = 1; k + 1 < x.size(); ++k) d[k] = (x[k + 1] - x[k - 1]) * rate / 2;
  return d;
}

// Torque of the nominal muscles along a given motion: activations and fibres by implicit Euler.
Samples muscleTorque(const TrueElbow& elbow, const Measured& trial, const Samples& q) {
  constexpr int parts = 5;
  Eigen::VectorXd y = elbow.start(trial.emg, q[0]);
  Samples torque(q.size(), 0.0);
  for (std::size_t k = 0; k < q.size(); ++k) {
    const double h = k == 0 ? 0 : (trial.emg.times[k] - trial.emg.times[k - 1]) / parts;
    for (int part = 1; k > 0 && part <= parts; ++part) {
      const double share = static_cast<double>(part) / parts;
      const double angle = q[k - 1] + share * (q[k] - q[k - 1]);
      const auto u = elbow.excitation(trial.emg, trial.emg.times[k - 1] + h * part);
      for (Eigen::Index i = 0; i < 8; ++i) {
        const HillMuscle& m = elbow.numbers().muscles[static_cast<std::size_t>(i)];
        double& a = y[2 + i];
        a += h * m.activationRate(u[i], a);
        const double length = elbow.arm(i, angle).length, before = y[10 + i];
        double low = before - 10 * m.fibreLength * h, high = before + 10 * m.fibreLength * h;
        low = std::max(low, 1.0001 * m.fibreLength * std::sin(m.pennation));
        for (int halving = 0; halving < 45; ++halving) {
          const double fibre = (low + high) / 2;
          (fibre - before < h * m.fibreVelocity(a, fibre, length) ? low : high) = fibre;
        }
        y[10 + i] = (low + high) / 2;
      }
    }
    for (Eigen::Index i = 0; i < 8; ++i) {
      const HillMuscle& m = elbow.numbers().muscles[static_cast<std::size_t>(i)];
      const auto arm = elbow.arm(i, q[k]);
      torque[k] -= m.tendonForce(y[10 + i], arm.length) * arm.slope;
    }
  }
  return torque;
}

struct Sums {
  double xx = 0, xr = 0;
};

int run(const Arguments& arguments) {
  const auto begun = std::chrono::steady_clock::now();
  const auto& words = arguments.words;
  if (words.size() < 2 || !arguments.has("out")) {
    throw std::invalid_argument("needs a model, trials and --out");
  }
  const ElbowNumbers nominal = readElbow(words[0]);
  const TrueElbow elbow(nominal, {}, {});
  std::vector<const EffectRow*> rows;
  for (const char* id : {"visc", "coulomb", "stribeck", "drag", "powerdamp", "stiffness", "limit",
                         "payload", "tilt", "const", "handforce"}) {
    rows.push_back(&hiddenEffect(id));
  }
  // torque of each effect per amplitude, from elbows that have a little of it
  constexpr double little = 1e-4;
  std::vector<TrueElbow> with;
  for (const EffectRow* row : rows) {
    Truth truth;
    truth.numbers = nominal;
    RandomNumbers unused(0, 0);
    row->apply(truth, little, unused);
    with.emplace_back(truth.numbers, truth.chain, truth.extras);
  }
  std::vector<Sums> sums(rows.size());
  double rr = 0;
  int n = 0;
  for (std::size_t f = 1; f < words.size(); ++f) {
    const Measured trial = readTrial(words[f]);
    const double rate = 1 / (trial.emg.times[1] - trial.emg.times[0]);
    const Samples q = smoothed(trial.angle, rate, 6);
    const Samples w = slopes(q, rate), acceleration = slopes(w, rate);
    const Samples muscles = muscleTorque(elbow, trial, q);
    for (std::size_t k = 10; k + 10 < q.size(); ++k) {
      const double residual =
          elbow.inertia() * acceleration[k] - elbow.gravityMoment(q[k]) - muscles[k];
      rr += residual * residual;
      ++n;
      for (std::size_t i = 0; i < rows.size(); ++i) {
        const double x =
            (with[i].extraTorque(trial.emg.times[k], q[k], w[k], 0) + with[i].gravityMoment(q[k]) -
             elbow.gravityMoment(q[k]) - (with[i].inertia() - elbow.inertia()) * acceleration[k]) /
            little;
        sums[i].xx += x * x;
        sums[i].xr += x * residual;
      }
    }
  }
  // BIC of one name against none, halved: about the logarithm of the Bayes factor
  std::vector<double> gain;
  for (const Sums& s : sums) {
    gain.push_back(-(n * std::log((rr - s.xr * s.xr / s.xx) / rr) + std::log(n)) / 2);
  }
  const auto best =
      static_cast<std::size_t>(std::max_element(gain.begin(), gain.end()) - gain.begin());
  double total = 1 / std::exp(std::max(0.0, gain[best]));
  Json inClass = Json::array();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    total += std::exp(gain[i] - std::max(0.0, gain[best]));
    if (gain[i] > gain[best] - 4.6) inClass.push_back(rows[i]->id);
  }
  Json verdict = {{"verdict", "none"}, {"effects", Json::array()}, {"class", Json::array()}};
  if (gain[best] > 5) {
    const Sums& s = sums[best];
    const double sd = std::sqrt((rr - s.xr * s.xr / s.xx) / n / s.xx);
    Json parameters = {
        {rows[best]->quantity, {{"value", s.xr / s.xx}, {"sd", sd}, {"unit", rows[best]->unit}}}};
    verdict["verdict"] = inClass.size() == 1 ? "named" : "ambiguous";
    verdict["effects"].push_back({{"id", rows[best]->id},
                                  {"name", rows[best]->name},
                                  {"kind", rows[best]->kind},
                                  {"parameters", parameters},
                                  {"log_bayes_factor", gain[best]},
                                  {"probability", 1 / total}});
    verdict["class"] = inClass;
  }
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begun;
  verdict["wall_s"] = taken.count();
  const std::filesystem::path folder = arguments.text("out");
  std::filesystem::create_directories(folder);
  std::ofstream stream(folder / "verdict.json");
  stream << verdict.dump(2) << '\n';
  stream.close();
  if (!stream) throw std::runtime_error((folder / "verdict.json").string() + ": cannot be written");
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(Arguments(argc, argv, {"out"}));
  } catch (const std::exception& e) {
    fmt::print(stderr, "baseline_regression: {}\n", e.what());
    return 2;
  }
}
