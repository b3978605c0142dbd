#pragma once

#include <Eigen/Dense>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

namespace info {

/// Weights of the criteria of an information matrix I with eigenvalues λ, each ≥ 0:
///     φ(I) = e/λ_min + a·tr I⁻¹ − d·ln det I + condition·λ_max/λ_min
struct InformationWeights {
  double e = 0;          ///< [unit of I]
  double a = 0;          ///< [1]
  double d = 0;          ///< [1]
  double condition = 0;  ///< [1]
};

/// A cost of information and its gradient in I.
struct InformationCost {
  double value;
  Eigen::MatrixXd dvalue_dI;  ///< symmetric; dφ = ⟨dvalue_dI, dI⟩
};

/// Thrown if a motion has no information about some combination of the parameters, so that no
/// direction of descent exists. The message says what to do.
struct NoInformation : std::domain_error {
  using std::domain_error::domain_error;
};

/// φ(I) and its gradient.
/// @param repeatedTolerance eigenvalues within this fraction of λ_max count as equal (optimality.h)
/// @throws std::domain_error if a weight is negative or not finite
/// @throws NoInformation if λ_min ≤ 1e-14 λ_max and a weight is > 0
InformationCost informationCost(const InformationWeights& weights,
                                const Eigen::MatrixXd& information, double repeatedTolerance);

/// Limits on every input, enforced by a barrier whose cost is small until an input approaches a
/// limit.
///
/// With s = 1 − ((u − mid)/half)², each input and time adds weight·b(s), b(s) = −ln s for s > δ and
/// its quadratic continuation ½[((s − 2δ)/δ)² − 1] − ln δ below, C² everywhere, so that the cost of
/// a trajectory outside the limits is defined as well. δ = 0.1: the cost at a limit is 3.80·weight.
/// Hauser and Saccon 2006.
struct InputLimits {
  Eigen::VectorXd lower;  ///< [unit of u]; empty: no limits
  Eigen::VectorXd upper;
  double weight = 0.01;  ///< > 0
};

/// Value and slope of the barrier for one input.
struct Barrier {
  double value, slope;
};
Barrier inputBarrier(double u, double lower, double upper, double weight);
/// The sum over all inputs, and its slope.
double limitCost(const InputLimits& limits, const Eigen::VectorXd& u);
Eigen::VectorXd limitSlope(const InputLimits& limits, const Eigen::VectorXd& u);

/// State of a search after an iteration. costs.back() and eigenvalues belong to the current motion.
struct SearchProgress {
  int iteration;
  double cost;
  double slope;                 ///< DJ·ζ of the last direction, < 0
  double step;                  ///< γ taken
  Eigen::VectorXd eigenvalues;  ///< of I
};

/// Options of the search ξ ← P(ξ + γζ), with ζ from the affine LQ problem and γ by Armijo's rule.
struct SearchOptions {
  int maxIterations = 100;
  double slopeTolerance = 0.1;  ///< stops at |DJ·ζ| ≤ this [unit of J] …
  double relativeSlope = 0;     ///< … or at |DJ·ζ| ≤ this·J
  double armijoSlope =
      0.4;  ///< a step is accepted if J decreases by this fraction of γ·|DJ·ζ|, in (0, 1)
  double armijoShrink = 0.5;  ///< factor by which γ is reduced until then, in (0, 1)
  int maxShrinks = 60;
  /// The first trial step is limited to |γ v_i| ≤ this [unit of u], since the direction can be
  /// extremely long if λ_min is tiny. 0: no limit.
  double largestMove = 0;
  /// Eigenvalues closer than this fraction of λ_max count as equal; see informationCost.
  double repeatedTolerance = 1e-9;
  /// The tolerance in a last attempt when the search stalls, since λ_min has a kink at repeated
  /// eigenvalues.
  double stuckTolerance = 0.05;
  /// Called after every iteration; returning false stops.
  std::function<bool(const SearchProgress&)> progress = {};
};

enum class SearchEnd {
  slopeSmall,      ///< the predicted decrease is below the tolerance: a minimum
  noProgress,      ///< no step along the direction lowers J
  iterationLimit,  ///< J was still decreasing
  stopped          ///< stopped by the progress callback
};

/// The reason as one line of text.
std::string describe(SearchEnd why);

/// The course of a search.
struct SearchResult {
  SearchEnd why = SearchEnd::iterationLimit;
  bool converged = false;  ///< why is slopeSmall
  int iterations = 0;
  std::vector<double> costs;   ///< J at the start and after each iteration
  std::vector<double> slopes;  ///< DJ·ζ at each iteration, including the last
  std::vector<double> steps;   ///< γ of each iteration
  int trials = 0;              ///< number of projected motions in all line searches
  Eigen::MatrixXd informationStart, information;
};

/// The interface of a problem to the search, for discrete and continuous time.
class SearchProblem {
 public:
  struct Direction {
    double slope;        ///< DJ·ζ
    double largestMove;  ///< max |v_i|
  };
  virtual ~SearchProblem() = default;
  virtual double cost() const = 0;
  virtual const Eigen::MatrixXd& information() const = 0;
  /// Finds ζ at the current motion.
  virtual Direction findDirection(double repeatedTolerance) = 0;
  /// J(P(ξ + γζ)); infinite if the motion does not exist.
  virtual double trial(double step) = 0;
  /// Makes the last trial the current motion.
  virtual void accept() = 0;
};

/// @throws std::invalid_argument if an option is out of range
SearchResult search(SearchProblem& problem, const SearchOptions& options);

}  // namespace info
