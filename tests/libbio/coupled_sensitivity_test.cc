#include "bio/coupled_sensitivity.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "support/shipped_elbow.h"

namespace bio {
namespace {

using testing::ShippedElbow;

SimulationOptions tight(double duration) {
  SimulationOptions options;
  options.duration = duration;
  options.newtonTolerance = 1e-12;
  return options;
}

/// How far sensitivities are from differences of whole simulations.
struct Disagreement {
  double worst = 0;  ///< relative to the quantity's largest sensitivity over time
  std::string of;
  int parameters = 0;
  int compared = 0;   ///< quantities for which differences settled to 1e-5
  int negligible = 0;  ///< quantities that the parameter hardly moves
  int undecided = 0;  ///< those whose change drowns in rounding, or that a kink disturbs
  std::vector<std::string> undecidedMotion;  ///< parameters for which the motion is among them
};

/// All that a simulation gives, one below the other.
Eigen::VectorXd everything(const Arm& arm, const Trajectory& motion) {
  const MuscleReport report = reportMuscles(arm, motion);
  Eigen::VectorXd all(motion.q.size() + motion.qDot.size() + motion.fibreLength.size() +
                      motion.activation.size() + report.tendonForce.size());
  const Eigen::MatrixXd q = motion.q.transpose(), qDot = motion.qDot.transpose(),
                        l = motion.fibreLength.transpose(), a = motion.activation.transpose(),
                        F = report.tendonForce.transpose();
  all << q.reshaped(), qDot.reshaped(), l.reshaped(), a.reshaped(), F.reshaped();
  return all;
}

/// The sensitivities of all that in one parameter.
Eigen::VectorXd everything(const SensitivityTrajectory& s, Eigen::Index column) {
  std::vector<double> all;
  for (const auto* group : {&s.q, &s.qDot, &s.fibreLength, &s.activation, &s.tendonForce}) {
    for (const SensitivityMatrix& m : *group) {
      for (Eigen::Index k = 0; k < m.rows(); ++k) all.push_back(m(k, column));
    }
  }
  return Eigen::Map<Eigen::VectorXd>(all.data(), static_cast<Eigen::Index>(all.size()));
}

/// Differences of fourth order, one-sided where the parameter sits on the border of its domain.
template <class F>
Eigen::VectorXd difference(const F& f, const ModelParameter& parameter, double h) {
  const double x = parameter.value;
  if (x - 2 * h < parameter.lower) {
    return (-25 * f(x) + 48 * f(x + h) - 36 * f(x + 2 * h) + 16 * f(x + 3 * h) - 3 * f(x + 4 * h)) /
           (12 * h);
  }
  if (x + 2 * h > parameter.upper) {
    return (25 * f(x) - 48 * f(x - h) + 36 * f(x - 2 * h) - 16 * f(x - 3 * h) + 3 * f(x - 4 * h)) /
           (12 * h);
  }
  return (8 * (f(x + h) - f(x - h)) - (f(x + 2 * h) - f(x - 2 * h))) / (12 * h);
}

/// Compares with differences at three steps; for each quantity the finer one of the two neighbours
/// that agree best with each other counts, whatever the sensitivities say.
Disagreement compare(const ShippedElbow& elbow, const std::vector<std::size_t>& wanted,
                     double duration, bool print = false) {
  const SimulationOptions options = tight(duration);
  const ParameterCatalogue& catalogue = elbow.catalogue;
  const SensitivityTrajectory s = simulateWithSensitivities(
      elbow.arm, catalogue, catalogue.nominal(), wanted, elbow.excitation, {options, true});
  Disagreement result;
  const Eigen::Index K = s.motion.q.cols();
  const Eigen::VectorXd values = everything(elbow.arm, s.motion);
  for (std::size_t j = 0; j < wanted.size(); ++j) {
    const ModelParameter& parameter = catalogue.parameters()[wanted[j]];
    const auto simulated = [&](double value) {
      const auto setting = catalogue.at({wanted[j]}, Eigen::VectorXd::Constant(1, value));
      const Arm arm(setting.model, ShippedElbow::options());
      return everything(arm, simulateSetting(arm, setting, elbow.excitation, options));
    };
    const Eigen::VectorXd exact = everything(s, static_cast<Eigen::Index>(j));
    // the largest step moves the arm by about 1e-4 rad
    const double effect = exact.head(K).cwiseAbs().maxCoeff();
    const double largest = std::min(0.05 * parameter.deviation, 1e-4 / (effect + 1e-30));
    std::array<Eigen::VectorXd, 5> differences;
    for (std::size_t k = 0; k < 5; ++k) {
      differences[k] = difference(simulated, parameter, largest * std::pow(0.2, k));
    }
    ++result.parameters;
    for (Eigen::Index block = 0; block < exact.size(); block += K) {
      const Eigen::VectorXd own = exact.segment(block, K);
      const double size = values.segment(block, K).cwiseAbs().maxCoeff();
      // what a deviation of the parameter changes by less than 1e-7 of its size does not count
      const double negligible = 1e-7 * size / parameter.deviation;
      const double scale = own.cwiseAbs().maxCoeff();
      double settled = std::numeric_limits<double>::infinity();
      std::size_t best = 1;
      for (std::size_t k = 1; k < 5; ++k) {
        const double change =
            (differences[k] - differences[k - 1]).segment(block, K).cwiseAbs().maxCoeff();
        if (change < settled) {
          settled = change;
          best = k;
        }
      }
      Eigen::Index row = 0;
      const double off = (own - differences[best].segment(block, K)).cwiseAbs().maxCoeff(&row);
      if (scale < negligible) {
        ++result.negligible;
        EXPECT_LT(off, negligible) << parameter.name << " quantity " << block / K;
        continue;
      }
      if (!(settled <= 1e-5 * scale)) {
        ++result.undecided;
        if (block < 2 * K && scale > 0) result.undecidedMotion.push_back(parameter.name);
        if (print && block < 2 * K) {
          fmt::print("undecided {} quantity {} scale {:.3g} h {:.3g} settled {:.3g} off", parameter.name,
                     block / K, scale, largest, settled / scale);
          for (const auto& d : differences)
            fmt::print(" {:.3g}", (own - d.segment(block, K)).cwiseAbs().maxCoeff() / scale);
          fmt::print("\n");
        }
        EXPECT_LT(off, 10 * settled) << parameter.name << " quantity " << block / K;
        continue;
      }
      ++result.compared;
      if (print && off > 1e-5 * scale) {
        fmt::print("{:40s} {:10.3g}  quantity {} row {}: {} against {}\n", parameter.name,
                   off / scale, block / K, row, own[row], differences[best][block + row]);
      }
      if (off > result.worst * scale) {
        result.worst = off / scale;
        result.of = fmt::format("{}, quantity {}", parameter.name, block / K);
      }
    }
  }
  return result;
}

double duration() {
  return std::getenv("DUR") ? atof(std::getenv("DUR")) : 0.5;
}

TEST(CoupledSensitivity, MatchesDifferencesOfWholeSimulations) {
  const ShippedElbow elbow(std::getenv("MODEL") ? std::getenv("MODEL") : "elbow8", std::getenv("TRIAL") ? std::getenv("TRIAL") : "curl_slow");
  const auto all = elbow.catalogue.select({"all"});
  const Disagreement d = compare(elbow, all, duration(), true);
  fmt::print("{} parameters, {} quantities, {} negligible, {} undecided, worst {:.3g} for {}\n",
             d.parameters, d.compared, d.negligible, d.undecided, d.worst, d.of);
  for (const std::string& name : d.undecidedMotion) fmt::print("undecided: {}\n", name);
  EXPECT_LT(d.worst, 1e-5) << d.of;
}

}  // namespace
}  // namespace bio
