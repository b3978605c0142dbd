#include "info/discovery/likelihood/whitening.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

namespace info::discover {

using Eigen::Index;
using Eigen::VectorXd;

bool Whitening::isPositive() const {
  return sds_.size() > 0 && (sds_.array() > 0).all() && sds_.allFinite();
}

double Whitening::sd(std::size_t output) const {
  if (sds_.size() == 1) return sds_[0];
  if (output >= static_cast<std::size_t>(sds_.size()))
    throw std::invalid_argument(
        fmt::format("output {} has no noise, there are {}", output, sds_.size()));
  return sds_[static_cast<Index>(output)];
}

VectorXd Whitening::bySample(const std::vector<int>& outputs, Index n) const {
  if (sds_.size() == 1) return VectorXd::Constant(n, sds_[0]);
  VectorXd sds(n);
  for (Index k = 0; k < n; ++k) sds[k] = sd(outputOf(outputs, k));
  return sds;
}

double Whitening::logDeterminant(const std::vector<int>& outputs, Index n) const {
  if (sds_.size() == 1) return static_cast<double>(n) * std::log(sds_[0]);
  return bySample(outputs, n).array().log().sum();
}

}  // namespace info::discover
