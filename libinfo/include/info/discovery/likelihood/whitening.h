#pragma once

#include <Eigen/Dense>
#include <utility>
#include <vector>

namespace info::discover {

/// The noise of the outputs, v ~ N(0, σ_o²) of output o: what concerns samples (residuals,
/// derivatives, disturbances) is divided by the standard deviation of the sample's output, so that
/// outputs of different units can be added.
///
/// `outputs` is the index of each sample's output (DiscoveryProblem::outputOfSample); empty: one
/// output.
class Whitening {
 public:
  /// All outputs have the standard deviation `sd`. Not explicit: a number is the commonest noise.
  Whitening(double sd = 0) : sds_(Eigen::VectorXd::Constant(1, sd)) {}
  /// @param sds one for each output, in its unit
  explicit Whitening(Eigen::VectorXd sds) : sds_(std::move(sds)) {}

  /// Whether every σ is positive and finite; otherwise nothing can be divided.
  bool isPositive() const;
  /// of the output with this index
  double sd(std::size_t output) const;
  /// A whitening of these outputs with `factor` times the noise.
  Whitening scaled(double factor) const { return Whitening(Eigen::VectorXd(factor * sds_)); }

  /// σ of each of n samples
  Eigen::VectorXd bySample(const std::vector<int>& outputs, Eigen::Index n) const;
  /// Divides each row (a sample) by its σ. Allocates nothing.
  template <class Rows>
  void whiten(const std::vector<int>& outputs, Rows& rows) const {
    if (sds_.size() == 1) {
      rows /= sds_[0];
      return;
    }
    for (Eigen::Index k = 0; k < rows.rows(); ++k) rows.row(k) /= sd(outputOf(outputs, k));
  }
  /// Σ log σ over n samples: what whitening takes from the logarithm of their density
  double logDeterminant(const std::vector<int>& outputs, Eigen::Index n) const;

  friend bool operator==(const Whitening& a, const Whitening& b) {
    return a.sds_.size() == b.sds_.size() && a.sds_ == b.sds_;
  }

 private:
  static std::size_t outputOf(const std::vector<int>& outputs, Eigen::Index sample) {
    return outputs.empty() ? 0
                           : static_cast<std::size_t>(outputs.at(static_cast<std::size_t>(sample)));
  }

  Eigen::VectorXd sds_;  // one, or one for each output
};

}  // namespace info::discover
