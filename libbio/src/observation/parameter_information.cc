#include "bio/observation/parameter_information.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "info/information/fisher.h"
#include "info/information/symmetric_eigen.h"

namespace bio {
namespace {

using Eigen::Index;

/// Information of the data on a parameter, in the prior's measure I·σ², that counts as none.
constexpr double nothing = 1e-12;

/// Forces, lengths, masses and scales are multiplied; positions, angles and times are added.
bool isAmount(const info::Parameter& p) {
  return p.start > 0 && p.lower >= 0;
}

/// The combination of two parameters that both effects agree on: the measured change is
/// seenA·δa + seenB·δb.
std::string combination(const info::Parameter& a, const info::Parameter& b, double seenA,
                        double seenB) {
  if (!isAmount(a) || !isAmount(b)) {
    const double ratio = seenB / seenA;
    return fmt::format("{} {} {:.3g}·{}", a.name, ratio < 0 ? "−" : "+", std::abs(ratio), b.name);
  }
  const double exponent = seenB * b.start / (seenA * a.start);
  const char* sign = exponent > 0 ? "·" : "/";
  if (std::abs(std::abs(exponent) - 1) < 0.05) {
    return fmt::format("{}{}{}", a.name, sign, b.name);
  }
  return fmt::format("{}{}{}^{:.2g}", a.name, sign, b.name, std::abs(exponent));
}

/// Pairs that look alike, those that matter most first.
void addPairs(const ParameterInformation& information, std::vector<std::string>& sentences) {
  constexpr std::size_t most = 12;
  auto pairs = alikePairs(information.fisher, 0.99);
  const auto weight = [&](const AlikePair& pair) {
    return std::min(information.normalisedSensitivity[pair.first],
                    information.normalisedSensitivity[pair.second]);
  };
  const double small = 1e-6 * information.normalisedSensitivity.maxCoeff();
  std::erase_if(pairs, [&](const AlikePair& pair) { return weight(pair) < small; });
  std::stable_sort(pairs.begin(), pairs.end(),
                   [&](const AlikePair& a, const AlikePair& b) { return weight(a) > weight(b); });
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (i == most) {
      sentences.push_back(fmt::format("{} more pairs of parameters are nearly indistinguishable",
                                      pairs.size() - most));
      break;
    }
    const info::Parameter& a = information.parameters[static_cast<std::size_t>(pairs[i].first)];
    const info::Parameter& b = information.parameters[static_cast<std::size_t>(pairs[i].second)];
    const double seenA = std::sqrt(information.fisher(pairs[i].first, pairs[i].first));
    const double seenB = std::copysign(
        std::sqrt(information.fisher(pairs[i].second, pairs[i].second)), -pairs[i].correlation);
    sentences.push_back(fmt::format(
        "{} and {} are nearly indistinguishable: only {} is determined (correlation {:.5f})",
        a.name, b.name, combination(a, b, seenA, seenB), pairs[i].correlation));
  }
}

void addStill(const ParameterInformation& information, std::vector<std::string>& sentences) {
  std::string names;
  int count = 0;
  for (Index i = 0; i < information.fisher.rows(); ++i) {
    const info::Parameter& p = information.parameters[static_cast<std::size_t>(i)];
    if (information.fisher(i, i) * p.prior->sd * p.prior->sd > nothing) continue;
    if (++count <= 8) names += (names.empty() ? "" : ", ") + p.name;
  }
  if (count > 8) names += fmt::format(" and {} more", count - 8);
  if (count > 0) {
    sentences.push_back(
        fmt::format("{} {} no effect on what is measured", names, count == 1 ? "has" : "have"));
  }
}

}  // namespace

std::vector<AlikePair> alikePairs(const Eigen::MatrixXd& fisher, double limit) {
  std::vector<AlikePair> pairs;
  const double largest = fisher.diagonal().size() ? fisher.diagonal().maxCoeff() : 0;
  for (Index i = 0; i < fisher.rows(); ++i) {
    for (Index j = i + 1; j < fisher.cols(); ++j) {
      const double scale = std::sqrt(fisher(i, i) * fisher(j, j));
      if (!(scale > 1e-30 * largest)) continue;
      // estimates of two parameters with information I have the correlation of −I
      const double correlation = -fisher(i, j) / scale;
      if (std::abs(correlation) >= limit) pairs.push_back({i, j, correlation});
    }
  }
  std::sort(pairs.begin(), pairs.end(), [](const AlikePair& a, const AlikePair& b) {
    return std::abs(a.correlation) > std::abs(b.correlation);
  });
  return pairs;
}

ParameterInformation informationAbout(const ParameterCatalogue& catalogue,
                                      const std::vector<std::size_t>& selection,
                                      const std::vector<Eigen::MatrixXd>& gammas, double noise) {
  if (!(noise > 0 && std::isfinite(noise))) {
    throw std::invalid_argument(fmt::format("noise = {}, must be > 0 and finite", noise));
  }
  const auto p = static_cast<Index>(selection.size());
  if (p == 0 || gammas.empty())
    throw std::invalid_argument("must have at least one parameter and one trial");
  ParameterInformation information;
  information.parameters = catalogue.asEstimated(selection, true);
  information.fisher.setZero(p, p);
  Eigen::VectorXd squares = Eigen::VectorXd::Zero(p);
  Index samples = 0;
  const info::OutputCovariance covariance(Eigen::MatrixXd::Constant(1, 1, noise * noise));
  for (const Eigen::MatrixXd& gamma : gammas) {
    if (gamma.cols() != p) {
      throw std::invalid_argument(
          fmt::format("sensitivities to {} parameters, must be {}", gamma.cols(), p));
    }
    information.fisher += info::fisherInformation(gamma, covariance);
    squares += gamma.colwise().squaredNorm().transpose();
    samples += gamma.rows();
  }
  Eigen::VectorXd sd(p);
  for (Index i = 0; i < p; ++i) {
    sd[i] = information.parameters[static_cast<std::size_t>(i)].prior->sd;
  }
  information.normalisedSensitivity =
      (squares / static_cast<double>(samples)).cwiseSqrt().cwiseProduct(sd);
  information.boundAlone = information.fisher.diagonal().cwiseSqrt().cwiseInverse();

  // in units of the priors' deviations: S(I + Λ)S = SIS + 1, well conditioned from below
  const Eigen::MatrixXd scaled = sd.asDiagonal() * information.fisher * sd.asDiagonal();
  const Eigen::LLT<Eigen::MatrixXd> factor(scaled + Eigen::MatrixXd::Identity(p, p));
  const Eigen::MatrixXd covarianceScaled = factor.solve(Eigen::MatrixXd::Identity(p, p));
  const Eigen::VectorXd ratio = covarianceScaled.diagonal().cwiseSqrt();
  information.boundJoint = ratio.cwiseProduct(sd);
  information.correlation =
      ratio.cwiseInverse().asDiagonal() * covarianceScaled * ratio.cwiseInverse().asDiagonal();
  for (Index i = 0; i < p; ++i) information.identifiable.push_back(ratio[i] <= 0.5);
  // combinations about which the data at least halve what was uncertain: 1/(1 + λ) ≤ 1/4
  const Eigen::VectorXd eigenvalues = info::symmetricEigenvalues(scaled);
  information.determinedCombinations = (eigenvalues.array() >= 3).count();
  if (information.determinedCombinations < p) {
    information.sentences.push_back(
        fmt::format("the data at least halve the uncertainty of {} combinations of the {} "
                    "parameters; the other combinations rest mainly on their priors",
                    information.determinedCombinations, p));
  }
  addPairs(information, information.sentences);
  addStill(information, information.sentences);
  return information;
}

}  // namespace bio
