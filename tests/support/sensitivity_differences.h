#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>

#include "bio/sensitivity/coupled_sensitivity.h"
#include "info/parallel_for.h"

namespace bio::fixtures {

/// How far sensitivities are from differences of whole simulations, of the models changed, compiled
/// and simulated anew.
struct DiscoveryProblem {
  double worst = 0;  ///< relative to the quantity's largest sensitivity over time
  std::string of;
  double worstMotion = 0;  ///< the same among q and q̇ alone
  int parameters = 0;
  int compared = 0;    ///< quantities for which differences settled to 3e-6
  int negligible = 0;  ///< quantities that a deviation moves by less than 1e-6 of their size
  int undecided = 0;   ///< those whose differences do not settle: rounding, or a kink at hand
  std::vector<std::string> undecidedMotion;  ///< parameters for which the motion is among them
};

/// All that a simulation gives, one below the other.
inline Eigen::VectorXd everything(const MusculoskeletalSystem& system, const Trajectory& motion) {
  const MuscleReport report = reportMuscles(system, motion);
  Eigen::VectorXd all(motion.q.size() + motion.qDot.size() + motion.fibreLength.size() +
                      motion.activation.size() + report.tendonForce.size() +
                      motion.reaction.size());
  const Eigen::MatrixXd q = motion.q.transpose(), qDot = motion.qDot.transpose(),
                        l = motion.fibreLength.transpose(), a = motion.activation.transpose(),
                        F = report.tendonForce.transpose(), R = motion.reaction.transpose();
  all << q.reshaped(), qDot.reshaped(), l.reshaped(), a.reshaped(), F.reshaped(), R.reshaped();
  return all;
}

/// The sensitivities of all that in one parameter.
inline Eigen::VectorXd everything(const SensitivityTrajectory& s, Eigen::Index column) {
  std::vector<double> all;
  for (const auto* group :
       {&s.q, &s.qDot, &s.fibreLength, &s.activation, &s.tendonForce, &s.reaction}) {
    for (const SensitivityMatrix& m : *group) {
      if (m.size() == 0) {  // the reaction at a free coordinate
        all.resize(all.size() + static_cast<std::size_t>(s.motion.q.cols()), 0.0);
        continue;
      }
      for (Eigen::Index k = 0; k < m.rows(); ++k) all.push_back(m(k, column));
    }
  }
  return Eigen::Map<Eigen::VectorXd>(all.data(), static_cast<Eigen::Index>(all.size()));
}

/// Differences of fourth order, one-sided where the parameter sits on the border of its domain.
template <class F>
Eigen::VectorXd fourthOrderDifference(const F& f, const ModelParameter& parameter, double h) {
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

/// Compares with differences at five steps; for each quantity the finer one of the two neighbours
/// that agree best with each other counts, whatever the sensitivities say.
inline DiscoveryProblem compareWithDifferences(const MusculoskeletalSystem& system,
                                               const SystemOptions& systemOptions,
                                               const ExcitationSignal& excitation,
                                               const ParameterCatalogue& catalogue,
                                               const std::vector<std::size_t>& wanted,
                                               SimulationOptions options) {
  options.newtonTolerance = 1e-12;
  const SensitivityTrajectory s = simulateWithSensitivities(
      system, catalogue, catalogue.nominal(), wanted, excitation, {options, true, true});
  const Eigen::Index K = s.motion.q.cols();
  const Eigen::Index motionRows = 2 * s.motion.q.size();
  const Eigen::VectorXd values = everything(system, s.motion);
  constexpr std::size_t steps = 5;
  std::vector<std::array<Eigen::VectorXd, steps>> differences(wanted.size());
  info::parallelFor(static_cast<int>(wanted.size()), 0, [&](int index) {
    const auto j = static_cast<std::size_t>(index);
    const ModelParameter& parameter = catalogue.parameters()[wanted[j]];
    const auto simulated = [&](double value) {
      const auto setting = catalogue.at({wanted[j]}, Eigen::VectorXd::Constant(1, value));
      const MusculoskeletalSystem changed(setting.model, systemOptions);
      return everything(changed, simulateSetting(changed, setting, excitation, options));
    };
    // the largest step moves the arm by about 1e-4 rad
    const double effect = everything(s, index).head(s.motion.q.size()).cwiseAbs().maxCoeff();
    const double largest = std::min(0.3 * parameter.sd, 1e-4 / (effect + 1e-30));
    for (std::size_t k = 0; k < steps; ++k) {
      differences[j][k] = fourthOrderDifference(simulated, parameter,
                                                largest * std::pow(0.1, static_cast<double>(k)));
    }
  });
  DiscoveryProblem result;
  for (std::size_t j = 0; j < wanted.size(); ++j) {
    const ModelParameter& parameter = catalogue.parameters()[wanted[j]];
    const Eigen::VectorXd exact = everything(s, static_cast<Eigen::Index>(j));
    ++result.parameters;
    for (Eigen::Index block = 0; block < exact.size(); block += K) {
      const auto ofBlock = [&](const Eigen::VectorXd& all) { return all.segment(block, K); };
      const double scale = ofBlock(exact).cwiseAbs().maxCoeff();
      double settled = std::numeric_limits<double>::infinity();
      std::size_t best = 1;
      for (std::size_t k = 1; k < steps; ++k) {
        const double change =
            (ofBlock(differences[j][k]) - ofBlock(differences[j][k - 1])).cwiseAbs().maxCoeff();
        if (change < settled) {
          settled = change;
          best = k;
        }
      }
      const double off = (ofBlock(exact) - ofBlock(differences[j][best])).cwiseAbs().maxCoeff();
      const double negligible = 1e-6 * ofBlock(values).cwiseAbs().maxCoeff() / parameter.sd;
      if (scale <= negligible) {
        ++result.negligible;
        EXPECT_LE(off, std::max(negligible, 10 * settled))
            << parameter.name << " quantity " << block / K;
      } else if (!(settled <= 3e-6 * scale)) {
        ++result.undecided;
        if (block < motionRows) result.undecidedMotion.push_back(parameter.name);
        EXPECT_LT(off, 10 * settled) << parameter.name << " quantity " << block / K;
      } else {
        ++result.compared;
        if (block < motionRows) result.worstMotion = std::max(result.worstMotion, off / scale);
        if (off > result.worst * scale) {
          result.worst = off / scale;
          result.of = fmt::format("{}, quantity {}", parameter.name, block / K);
        }
      }
    }
  }
  return result;
}

/// For the log of a test.
inline void tell(const DiscoveryProblem& d) {
  fmt::print(
      "  {} parameters: {} quantities agree, worst {:.2g} ({}), of q and q̇ {:.2g}; {} negligible, "
      "{} undecided\n",
      d.parameters, d.compared, d.worst, d.of, d.worstMotion, d.negligible, d.undecided);
}

}  // namespace bio::fixtures
