#pragma once

#include <functional>
#include <map>
#include <optional>
#include <vector>

#include "info/discover/discover.h"
#include "info/discover/joint_fit.h"

namespace info::discover {

/// Thrown inside when the caller's progress function says stop.
struct Stopped {};

/// A hypothesis with the size of latent force that suits it best.
struct Entry {
  std::vector<std::size_t> effects;  ///< sorted
  Fit fit;
  std::optional<Fit> simulation;  ///< the same without latent force, where it was fitted
  double score = 0;               ///< log Z − σ_d/s
  bool works() const;             ///< false: no fit could be simulated
};

/// What one linear step says of a candidate.
struct Screened {
  std::size_t candidate = 0;
  double gain = 0;         ///< nats that it would gain
  double information = 0;  ///< S of its amplitude, in the amplitude's unit
};

/// Fits, screens and races hypotheses; remembers the best fit of each.
class Search {
 public:
  using Report = std::function<void(const std::string& doing)>;
  Search(const Disagreement& data, std::vector<int> trials, const Options& options,
         double outputDeviation, Report report);

  /// Base model by homotopy in σ_d, from the nominal values.
  void calibrate();
  const Likelihood& likelihood() const { return *likelihood_; }
  /// Where the scale of the latent force was taken.
  const Eigen::VectorXd& likelihoodValues() const { return scaleValues_; }
  const Entry& at(const std::vector<std::size_t>& effects) const { return entries_.at(effects); }
  const std::map<std::vector<std::size_t>, Entry>& entries() const { return entries_; }
  int fits() const { return fits_; }

  /// One-step gains of all candidates that are not yet in `effects`, at the fits with and without
  /// latent force.
  std::vector<Screened> screen(const std::vector<std::size_t>& effects, bool simulation) const;
  /// Union of the best of both modes, the best of each kind, and declared equivalents.
  std::vector<std::size_t> shortlist(const std::vector<std::size_t>& effects, int most);
  /// The fit without latent force, made where it is not there yet.
  const Fit& simulation(const std::vector<std::size_t>& effects);
  /// Fits `with` + each candidate; then again from the leader's nuisances, and `with` too.
  void race(const std::vector<std::size_t>& with, const std::vector<std::size_t>& candidates);
  /// Least |amplitude − nominal|/deviation over its effects.
  double significance(const Entry& entry) const;

  /// Fits `effects` without one of them, from where the fit of all of them is.
  void drop(const std::vector<std::size_t>& effects, std::size_t effect);

 private:
  void mustWork() const;  ///< @throws std::domain_error if the base could not be fitted
  void improve(const std::vector<std::size_t>& effects, const Eigen::VectorXd& start, double size);
  Eigen::VectorXd started(std::size_t candidate, std::size_t start, Eigen::VectorXd values) const;

  const Disagreement& data_;
  std::vector<int> trials_;
  const Options& options_;
  double output_;
  Report report_;
  std::optional<Likelihood> likelihood_;
  Eigen::VectorXd scaleValues_;
  std::map<std::vector<std::size_t>, Entry> entries_;
  int fits_ = 0;
};

}  // namespace info::discover
