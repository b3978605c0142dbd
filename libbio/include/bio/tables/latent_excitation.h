#pragma once

#include <Eigen/Dense>
#include <string>
#include <vector>

namespace bio {

/// The unknown part of the excitation of a muscle without an electrode: a correction of its
/// log-odds, straight between knots. With x̂ the trial's course, cut to 0.001 … 0.999,
///     x = 1/(1 + e^{−(ln x̂/(1 − x̂) + c(t))}),   c(t) = Σ_k c_k H_k(t)
/// H_k the hat function of knot k. Smooth in every c_k, never outside 0 … 1; c = 0 leaves the
/// course, which is the mean of the prior c_k ~ N(0, sd²). c = ±1 turns 0.05 into 0.13 or 0.019.
struct LatentExcitation {
  std::vector<double> knots;  ///< [s] rising, at least two; c is constant outside
  Eigen::VectorXd values;     ///< c_k [1], one per knot
  double sd = 1;              ///< of the prior of every c_k [1] > 0
};

/// The wish for one: which muscle, how free it is, how fast it may change.
struct LatentDeclaration {
  std::string muscle;
  double sd = 1;          ///< of the prior of the log-odds at a knot [1] > 0
  double spacing = 0.25;  ///< largest distance of knots [s] > 0
  friend bool operator==(const LatentDeclaration&, const LatentDeclaration&) = default;
};

/// With equally spaced knots from the first to the last time, and c = 0.
/// @throws std::invalid_argument for a sd or a spacing that is not > 0, or more than 10 000 knots
LatentExcitation latentExcitation(const LatentDeclaration& declared, double first, double last);

/// H_k(t)
double hatAt(const std::vector<double>& knots, std::size_t k, double t);

/// x at times, of the trial's course there. @throws std::invalid_argument for knots that do not
/// rise, or values that are not finite or not one per knot
Eigen::RowVectorXd withLatent(const Eigen::VectorXd& times, const Eigen::RowVectorXd& course,
                              const LatentExcitation& latent);
/// ∂x/∂c_k = x (1 − x) H_k(t), of x itself.
Eigen::RowVectorXd latentSlope(const Eigen::VectorXd& times, const Eigen::RowVectorXd& x,
                               const LatentExcitation& latent, std::size_t k);

/// A line of a trial's header, `latent_excitation`: "MUSCLE SD KNOTS_S", several between
/// semicolons.
std::string latentHeader(const std::vector<LatentDeclaration>& declared);
/// @throws std::invalid_argument for another text, a muscle given twice, or a number that is not >
/// 0
std::vector<LatentDeclaration> latentInHeader(const std::string& text);

}  // namespace bio
