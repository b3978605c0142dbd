#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <vector>

#include "discovery/search/effect_sets.h"
#include "info/discovery/discover.h"
#include "info/discovery/likelihood/joint_fit.h"

namespace info::discover {

/// Thrown inside when the caller's progress function says stop.
struct Stopped {};

/// A hypothesis with the size of latent force that suits it best.
struct Entry {
  Effects effects;
  Fit fit;
  std::optional<Fit> simulation;  ///< the same without latent force, where it was fitted
  double score = 0;               ///< log Z − σ_d/s
  double jointScore = 0;          ///< the same before Likelihood::marginal
  bool works() const;             ///< false: no fit could be simulated
};

/// What a search leaves to another one.
struct SearchMemory {
  std::map<Effects, Entry> entries;
  Effects chosen;               ///< what it chose of them
  Eigen::VectorXd scaleValues;  ///< where the scale of the latent force was taken
  bool racedFromNominal = false;
};

/// η of another σ_d with the same latent force.
std::vector<Eigen::VectorXd> forceKept(std::vector<Eigen::VectorXd> eta, double from, double to);

/// A candidate of one quantity with so many starts that they are a grid.
inline bool isGrid(const Candidate& candidate) {
  return candidate.quantities.size() == 1 && candidate.starts.size() >= 8;
}

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
  Search(const DiscoveryProblem& data, std::vector<int> trials, const Options& options,
         double outputSd, Report report);

  /// Base model by homotopy in σ_d, from the nominal values; then from several starts without.
  void calibrate();
  /// Instead of calibrate(): what another search knows. The base, what was chosen and what comes
  /// near it are fitted again from there; the others keep their distance from the base.
  void adopt(const SearchMemory& known);
  /// The same of the same data at the same time step: all is as it was there.
  void take(const SearchMemory& known);
  const Likelihood& likelihood() const { return *likelihood_; }
  /// Where the scale of the latent force was taken.
  const Eigen::VectorXd& scaleValues() const { return scaleValues_; }
  const Entry& at(const Effects& effects) const { return entries_.at(effects); }
  const std::map<Effects, Entry>& entries() const { return entries_; }
  int fits() const { return fits_; }

  const DiscoveryProblem& data() const { return data_; }
  /// One-step gains of all candidates that are not yet in `effects`, at the fits with and without
  /// latent force.
  std::vector<Screened> screen(const Effects& effects, bool simulation) const;
  /// The same from short fits, for a base so poor that one linear step is no guide.
  std::vector<Screened> probe(const Effects& effects);
  /// The same at the fit of a model that is held near the data, where one linear step is a good
  /// guide however far the model by itself is off; empty where holding is not offered.
  std::vector<Screened> screenHeld(const Effects& effects);
  /// Union of the best of both modes, the best of each kind, and declared equivalents.
  std::vector<std::size_t> shortlist(const Effects& effects, int most);
  /// The fit without latent force, made where it is not there yet; from the nominal values where
  /// the model cannot be simulated without that force at those of its fit.
  const Fit& simulation(const Effects& effects);
  /// Fits `base` + a candidate, if that has not been done.
  void raceOne(const Effects& base, std::size_t candidate);
  /// The same of each candidate; then again from the leader's nuisances, and `base` too.
  void race(const Effects& base, const std::vector<std::size_t>& candidates);
  /// Fits single candidates once more, from the nominal values and a large latent force: the `most`
  /// that short fits from there like best. A base that lacks something may have gone far away from
  /// what is true with it.
  void raceFromNominal(std::size_t most);
  /// Here, or in the search that this one has adopted.
  bool hasRacedFromNominal() const { return racedFromNominal_; }
  /// A candidate that gains though it is absent has only found a better base: fits that from its
  /// nuisances. True if `base` gained; what has been raced on it and is now behind is forgotten.
  bool refitBase(const Effects& base);
  /// Fits a hypothesis again where another that contains it is better though what it has more is
  /// absent there (less than 2 deviations): the smaller one was in a wrong minimum, or was never
  /// raced.
  void enforceNesting();
  /// Fits what is no further than so many nats behind the best and was not done goes on. True if
  /// one of them gained a nat.
  bool complete(double within);
  /// A smaller latent force moves no estimate by a deviation: Likelihood::marginal is left out.
  bool exceedsNoise(const Fit& fit) const { return fit.noise.latent >= options_.latentScale / 4; }
  /// Takes Likelihood::marginal of `effects` and of all within so many nats once more.
  void refineEvidence(const Effects& effects, double within);
  /// Fits `effects` without one of them, from where the fit of all of them is.
  void drop(const Effects& effects, std::size_t effect);
  /// Least |amplitude − nominal|/deviation over its effects.
  double significance(const Entry& entry) const;

 private:
  double significance(const Entry& entry, std::size_t effect) const;
  double bestScore() const;  ///< of all hypotheses
  double scoreOf(const Fit& fit) const;
  void mustWork() const;  ///< @throws std::domain_error if the base could not be fitted
  /// @param near  a fit whose latent force keeps the simulation near the data at the start; or null
  /// @param hopeless  a first fit that is slow and below this score is not followed any further
  void improve(const Effects& effects, const Eigen::VectorXd& start, double size,
               const Fit* near = nullptr, double hopeless = -HUGE_VAL);
  Eigen::VectorXd drawn(std::uint64_t start) const;
  /// A fit without latent force that is held near the data at first, and less and less.
  struct Led {
    Eigen::VectorXd values;  ///< where it ends
    double evidence = 0;     ///< half way
  };
  /// Nothing where the model cannot be simulated so, or DiscoveryProblem::nudged is not offered.
  std::optional<Led> ledFrom(const Effects& effects, Eigen::VectorXd start);
  /// Fits from where those end that are led from the nominal values, of candidates beside `base`
  /// that come near the best of them.
  void raceLed(const Effects& base, const std::vector<std::size_t>& candidates);
  /// One-step gains of all candidates that are not yet in `effects` at a fit of a likelihood.
  std::vector<Screened> screenAt(const Likelihood& likelihood, const Fit& fit,
                                 const Effects& effects) const;
  /// The start of a candidate beside `base` that a short fit likes best.
  Eigen::VectorXd bestStart(const Effects& base, std::size_t candidate, const Fit& near,
                            double latent);
  /// Values with an effect's own quantities at one of its starts, or at nominal; those that are
  /// free anyway stay.
  Eigen::VectorXd started(std::size_t candidate, std::size_t start, Eigen::VectorXd values) const;
  Eigen::VectorXd absent(std::size_t candidate, Eigen::VectorXd values) const;
  /// Its quantities that are no nuisances, as places in Candidate::quantities.
  std::vector<std::size_t> ownQuantities(std::size_t candidate) const;

  const DiscoveryProblem& data_;
  std::vector<int> trials_;
  const Options& options_;
  double output_;
  Report report_;
  std::optional<Likelihood> likelihood_;
  std::vector<std::unique_ptr<DiscoveryProblem>> nudged_;  ///< the strongest first
  std::vector<Likelihood> nudgedLikelihoods_;
  std::set<Effects> raced_;  ///< by raceLed
  struct GridStart {
    Eigen::VectorXd values;   ///< of the fit, the amplitude held
    double gain = -HUGE_VAL;  ///< nats beside the base, held
  };
  GridStart searchGrid(std::size_t candidate, const Fit& base) const;
  std::map<std::size_t, GridStart> gridStarts_;  ///< the best of candidates with a grid of starts
  Eigen::VectorXd scaleValues_;
  std::map<Effects, Entry> entries_;
  int fits_ = 0;
  bool racedFromNominal_ = false;
};

}  // namespace info::discover
