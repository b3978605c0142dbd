#include "bio/parameter_information.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "info/fisher.h"

namespace bio {
namespace {

using Eigen::Index;

/// "a·b^0.7", the combination of two parameters that both effects agree on: with information I the
/// change √I_11 δ₁ ∓ √I_22 δ₂ is what is seen.
std::string combination(const info::Parameter& a, const info::Parameter& b, double seenA,
                        double seenB) {
  if (a.start == 0 || b.start == 0) {
    const double ratio = seenB / seenA;
    return fmt::format("{} {} {:.3g}·{}", a.name, ratio < 0 ? "−" : "+", std::abs(ratio), b.name);
  }
  const double exponent = seenB * b.start / (seenA * a.start);
  if (std::abs(std::abs(exponent) - 1) < 0.02) {
    return fmt::format("{}{}{}", a.name, exponent > 0 ? "·" : "/", b.name);
  }
  return fmt::format("{}{}{}^{:.2g}", a.name, exponent > 0 ? "·" : "/", b.name,
                     std::abs(exponent));
}

std::vector<std::string> inWords(const ParameterInformation& known) {
  std::vector<std::string> sentences;
  constexpr std::size_t most = 12;
  const auto pairs = alikePairs(known.fisher, 0.99);
  for (const AlikePair& pair : pairs) {
    if (sentences.size() == most) {
      sentences.push_back(fmt::format("and {} more pairs of parameters look alike",
                                      pairs.size() - most));
      break;
    }
    const info::Parameter& a = known.parameters[static_cast<std::size_t>(pair.first)];
    const info::Parameter& b = known.parameters[static_cast<std::size_t>(pair.second)];
    const double seenA = std::sqrt(known.fisher(pair.first, pair.first));
    const double seenB = std::copysign(
        std::sqrt(known.fisher(pair.second, pair.second)), -pair.correlation);
    sentences.push_back(fmt::format("only {} is determined, not {} and {} apart: correlation {:.4f}",
                                    combination(a, b, seenA, seenB), a.name, b.name,
                                    pair.correlation));
  }
  std::string still;
  int count = 0;
  for (Index i = 0; i < known.fisher.rows(); ++i) {
    if (known.fisher(i, i) > 0) continue;
    if (++count <= 8) still += (still.empty() ? "" : ", ") + known.parameters[static_cast<std::size_t>(i)].name;
  }
  if (count == 1) sentences.push_back(still + " moves nothing that is measured");
  if (count > 8) still += fmt::format(" and {} more", count - 8);
  if (count > 1) sentences.push_back(still + " move nothing that is measured");
  return sentences;
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
  if (p == 0 || gammas.empty()) throw std::invalid_argument("no parameter, or no trial");
  ParameterInformation known;
  known.parameters = catalogue.asEstimated(selection, true);
  known.fisher.setZero(p, p);
  Eigen::VectorXd squares = Eigen::VectorXd::Zero(p);
  Index samples = 0;
  const info::OutputCovariance covariance(Eigen::MatrixXd::Constant(1, 1, noise * noise));
  for (const Eigen::MatrixXd& gamma : gammas) {
    if (gamma.cols() != p) {
      throw std::invalid_argument(
          fmt::format("sensitivities to {} parameters, must be {}", gamma.cols(), p));
    }
    known.fisher += info::fisherInformation(gamma, covariance);
    squares += gamma.colwise().squaredNorm().transpose();
    samples += gamma.rows();
  }
  Eigen::VectorXd deviation(p);
  for (Index i = 0; i < p; ++i) {
    deviation[i] = known.parameters[static_cast<std::size_t>(i)].prior->deviation;
  }
  known.normalisedSensitivity =
      (squares / static_cast<double>(samples)).cwiseSqrt().cwiseProduct(deviation);
  known.boundAlone = known.fisher.diagonal().cwiseSqrt().cwiseInverse();

  // in units of the priors' deviations: S(I + Λ)S = SIS + 1, well conditioned from below
  const Eigen::MatrixXd scaled = deviation.asDiagonal() * known.fisher * deviation.asDiagonal();
  const Eigen::LLT<Eigen::MatrixXd> factor(scaled + Eigen::MatrixXd::Identity(p, p));
  const Eigen::MatrixXd covarianceScaled = factor.solve(Eigen::MatrixXd::Identity(p, p));
  const Eigen::VectorXd ratio = covarianceScaled.diagonal().cwiseSqrt();
  known.boundJoint = ratio.cwiseProduct(deviation);
  known.correlation =
      ratio.cwiseInverse().asDiagonal() * covarianceScaled * ratio.cwiseInverse().asDiagonal();
  for (Index i = 0; i < p; ++i) known.identifiable.push_back(ratio[i] <= 0.5);
  known.sentences = inWords(known);
  return known;
}

}  // namespace bio
