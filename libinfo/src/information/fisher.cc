#include "info/information/fisher.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "info/information/symmetric_eigen.h"

namespace info {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

MatrixXd stack(const std::vector<MatrixXd>& gamma_k) {
  if (gamma_k.empty()) return {};
  const Index h = gamma_k.front().rows();
  MatrixXd gamma(h * static_cast<Index>(gamma_k.size()), gamma_k.front().cols());
  for (std::size_t k = 0; k < gamma_k.size(); ++k) {
    if (gamma_k[k].rows() != h || gamma_k[k].cols() != gamma.cols())
      throw std::invalid_argument(
          fmt::format("Γ of sample {} is {} × {}, must be as in sample 0, {} × {}", k,
                      gamma_k[k].rows(), gamma_k[k].cols(), h, gamma.cols()));
    gamma.middleRows(static_cast<Index>(k) * h, h) = gamma_k[k];
  }
  return gamma;
}

MatrixXd fisherInformation(const MatrixXd& gamma, const OutputCovariance& covariance,
                           const ObservationMask& observed) {
  if (!gamma.allFinite())
    throw std::domain_error("Fisher information: every entry of Γ = dy/dθ must be finite");
  const MatrixXd white = covariance.whiten(gamma, observed);
  return white.transpose() * white;
}

MatrixXd fisherInformation(const std::vector<MatrixXd>& gamma_k, const OutputCovariance& covariance,
                           const ObservationMask& observed) {
  return fisherInformation(stack(gamma_k), covariance, observed);
}

MatrixXd cramerRaoBound(const MatrixXd& information, const std::vector<std::string>& names) {
  const Index p = information.rows();
  const auto name = [&](Index i) {
    return names.empty() ? fmt::format("θ{}", i) : names.at(static_cast<std::size_t>(i));
  };
  if (p == 0 || information.cols() != p)
    throw std::invalid_argument("Cramér–Rao bound: the information matrix must be square");
  if (!information.allFinite())
    throw std::domain_error("Cramér–Rao bound: every entry of the information must be finite");
  requireSymmetric(information, "Cramér–Rao bound", name);
  for (Index i = 0; i < p; ++i)
    if (!(information(i, i) > 0))
      throw std::domain_error(fmt::format(
          "zero information about parameter {}: no measured output depends on it (information "
          "{} must be > 0)",
          name(i), information(i, i)));
  // unit information for each parameter, so that the verdict does not depend on units
  const VectorXd scale = information.diagonal().cwiseSqrt().cwiseInverse();
  const auto eigen = symmetricEigen(scale.asDiagonal() * information * scale.asDiagonal());
  if (!(eigen.values[0] > 1e-13)) {
    std::string list;
    for (Index i = 0; i < p; ++i)
      if (std::abs(eigen.vectors(i, 0)) > 1e-3) list += (list.empty() ? "" : ", ") + name(i);
    throw std::domain_error(
        fmt::format("zero information about one combination of the parameters {}: they are not "
                    "separately identifiable",
                    list));
  }
  const MatrixXd half =
      scale.asDiagonal() * eigen.vectors * eigen.values.cwiseSqrt().cwiseInverse().asDiagonal();
  return half * half.transpose();
}

}  // namespace info
