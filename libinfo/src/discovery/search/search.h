#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "discovery/search/effect_sets.h"
#include "info/discovery/discover.h"
#include "info/discovery/likelihood/joint_fit.h"

namespace info::discover {

/// A hypothesis with the optimal size of its latent force.
struct Entry {
  Effects effects;
  Fit fit;
  std::optional<Fit> simulation;  ///< the same without latent force, if it was fitted
  double score = 0;               ///< log Z − σ_d/s
  double jointScore = 0;          ///< the same before Likelihood::marginal
  bool works() const;             ///< false: the model could not be simulated in any fit
};

/// The results of a search from which another one starts.
struct SearchMemory {
  std::map<Effects, Entry> entries;
  Effects chosen;               ///< the chosen effects
  Eigen::VectorXd scaleValues;  ///< values at which the scale of the latent force was evaluated
  bool racedFromNominal = false;
  double noiseReduced = 1;  ///< RecordedNoise::reduced, with which it searched
};

/// η of the same latent force for another σ_d.
std::vector<Eigen::VectorXd> forceKept(std::vector<Eigen::VectorXd> eta, double from, double to);

/// Whether a candidate has one quantity and enough starts for a grid.
inline bool isGrid(const Candidate& candidate) {
  return candidate.quantities.size() == 1 && candidate.starts.size() >= 8;
}

/// Prediction of one linear step for a candidate.
struct Screened {
  std::size_t candidate = 0;
  double gain = 0;         ///< predicted gain [nats]
  double information = 0;  ///< S of its amplitude, in the amplitude's unit
};

/// Fits, screens and compares hypotheses; keeps the best fit of each.
class Search {
 public:
  using Report = std::function<void(const std::string& doing)>;
  Search(const DiscoveryProblem& data, std::vector<int> trials, const Options& options,
         const Whitening& sds, Report report);

  /// Calibrates the base model by homotopy in σ_d, from the nominal values; then from several
  /// starts without homotopy.
  void calibrate();
  /// Instead of calibrate(): adopts the results of another search. The base, the chosen effects and
  /// their closest competitors are fitted again from there; for the others the difference from the
  /// base is kept.
  void adopt(const SearchMemory& known);
  /// Adopts all results of a search of the same data at the same time step, unchanged.
  void take(const SearchMemory& known);
  const Likelihood& likelihood() const { return *likelihood_; }
  /// Values at which the scale of the latent force was evaluated.
  const Eigen::VectorXd& scaleValues() const { return scaleValues_; }
  const Entry& at(const Effects& effects) const { return entries_.at(effects); }
  const std::map<Effects, Entry>& entries() const { return entries_; }
  int fits() const { return fits_; }

  const DiscoveryProblem& data() const { return data_; }
  /// One-step gains of all candidates that are not in `effects`, at the fits with and without
  /// latent force.
  std::vector<Screened> screen(const Effects& effects, bool simulation) const;
  /// Gains of the candidates in short fits, for a base model too poor for linear steps.
  std::vector<Screened> probe(const Effects& effects);
  /// One-step gains at the fit of the nudged model, where a linear step is reliable however far the
  /// original model is from the data; empty if nudging is not available.
  std::vector<Screened> screenHeld(const Effects& effects);
  /// Union of the best of both modes, the best of each kind, and declared equivalents.
  std::vector<std::size_t> shortlist(const Effects& effects, int most);
  /// The fit without latent force, computed on demand; from the nominal values if the model cannot
  /// be simulated without that force at the values of its fit.
  const Fit& simulation(const Effects& effects);
  struct Tracked {
    Fit fit;
    const Likelihood* likelihood;  ///< of the nudged model
  };
  /// A fit with latent force of a nudged model, the nudging reduced from stage to stage while the
  /// latent force takes its place: the simulation stays near the data from the beginning, also past
  /// places where a path jumps, which no step of a fit would cross. Empty if nudging is not
  /// available.
  std::optional<Tracked> tracked(const Effects& effects, Eigen::VectorXd start);
  /// Fits `base` + a candidate, unless already fitted.
  void raceOne(const Effects& base, std::size_t candidate);
  /// Calls raceOne() for each candidate; then repeats them, and `base`, from the leader's nuisance
  /// parameters.
  void race(const Effects& base, const std::vector<std::size_t>& candidates);
  /// Repeats fits of single candidates from the nominal values and a large latent force: the `most`
  /// that are best after short fits from there. The parameters of a base model with a missing
  /// effect may be far from the true ones.
  void raceFromNominal(std::size_t most);
  /// Whether raceFromNominal() was called, in this search or in the one that it has adopted.
  bool hasRacedFromNominal() const { return racedFromNominal_; }
  /// A candidate that gains although its amplitude is insignificant has only found a better base:
  /// `base` is fitted from its nuisance parameters. True if `base` gained; hypotheses built on it
  /// that are now behind are discarded.
  bool refitBase(const Effects& base);
  /// Repeats the fit of a hypothesis if a larger one that contains it is better although its
  /// additional effects are insignificant (less than 2 standard deviations): the smaller one was in
  /// a wrong minimum, or was never fitted.
  void enforceNesting();
  /// Continues unconverged fits that are at most this many nats behind the best. True if one of
  /// them gained a nat.
  bool complete(double within);
  /// With a smaller latent force no estimate changes by a standard deviation, and
  /// Likelihood::marginal is omitted.
  bool exceedsNoise(const Fit& fit) const { return fit.noise.latent >= options_.latentScale / 4; }
  /// Repeats Likelihood::marginal for `effects` and for all hypotheses within this many nats.
  void refineEvidence(const Effects& effects, double within);
  /// Fits `effects` without one of them, starting from the fit of all.
  void drop(const Effects& effects, std::size_t effect);
  /// Smallest |amplitude − nominal|/standard deviation of its effects.
  double significance(const Entry& entry) const;

 private:
  double significance(const Entry& entry, std::size_t effect) const;
  double bestScore() const;  ///< of all hypotheses
  double scoreOf(const Fit& fit) const;
  /// Evaluates the scale of the latent force along the simulation with these values.
  void scaleAt(const Eigen::VectorXd& values);
  void mustWork() const;  ///< @throws std::domain_error if the base could not be fitted
  /// @param near a fit whose latent force keeps the simulation near the data at the start; or null
  /// @param hopeless a slow first fit below this score is not continued
  void improve(const Effects& effects, const Eigen::VectorXd& start, double size,
               const Fit* near = nullptr, double hopeless = -HUGE_VAL);
  Eigen::VectorXd drawn(std::uint64_t start) const;
  /// A fit without latent force by nudging that is gradually reduced.
  struct NudgedFit {
    Eigen::VectorXd values;  ///< where it ends
    double evidence = 0;     ///< of its last stage
  };
  /// Fits with the nudging of stages first to end − 1, from nudged.values on. False if the model
  /// cannot be simulated so.
  bool fitNudged(const Effects& effects, std::size_t first, std::size_t end, NudgedFit& nudged);
  /// Where all stages end. Empty if the model cannot be simulated so, or if
  /// DiscoveryProblem::nudged is not available.
  std::optional<Eigen::VectorXd> nudgedFrom(const Effects& effects, const Eigen::VectorXd& start);
  /// Fits candidates beside `base` from the results of nudged fits that start at the nominal
  /// values, for those close to the best.
  void raceNudged(const Effects& base, const std::vector<std::size_t>& candidates);
  /// Fits without latent force from where nudged fits end; improve() from there if that is news.
  void continueNudged(const Effects& effects, const Eigen::VectorXd& start);
  /// One-step gains of all candidates that are not in `effects` at a fit of a likelihood.
  std::vector<Screened> screenAt(const Likelihood& likelihood, const Fit& fit,
                                 const Effects& effects) const;
  /// The start of a candidate beside `base` that is best after a short fit.
  Eigen::VectorXd bestStart(const Effects& base, std::size_t candidate, const Fit& near,
                            double latent);
  /// Values with an effect's own quantities at one of its starts, or at nominal; quantities that
  /// are free in any case are kept.
  Eigen::VectorXd started(std::size_t candidate, std::size_t start, Eigen::VectorXd values) const;
  Eigen::VectorXd absent(std::size_t candidate, Eigen::VectorXd values) const;
  /// Indices in Candidate::quantities of its quantities that are not nuisance parameters.
  std::vector<std::size_t> ownQuantities(std::size_t candidate) const;

  const DiscoveryProblem& data_;
  std::vector<int> trials_;
  const Options& options_;
  Whitening output_;
  Report report_;
  std::optional<Likelihood> likelihood_;
  std::vector<std::unique_ptr<DiscoveryProblem>> nudged_;  ///< the strongest first
  std::vector<Likelihood> nudgedLikelihoods_;
  std::set<Effects> raced_;  ///< by raceNudged
  struct GridStart {
    Eigen::VectorXd values;   ///< of the fit with fixed amplitude
    double gain = -HUGE_VAL;  ///< log Bayes factor [nats] against the base, both nudged
  };
  GridStart searchGrid(std::size_t candidate, const Fit& base) const;
  /// The best fit beside the base model with a latent force and the amplitude held on its grid;
  /// empty if none is better than without the candidate.
  std::optional<Fit> searchForcedGrid(std::size_t candidate);
  std::map<std::size_t, GridStart> gridStarts_;  ///< best start of each candidate with a grid
  Eigen::VectorXd scaleValues_;
  std::map<Effects, Entry> entries_;
  struct ScreenedFit {
    Fit fit;
    std::vector<Screened> result;
  };
  /// The last results of screen(), of which several decisions ask for the same.
  mutable std::map<std::pair<Effects, bool>, ScreenedFit> screened_;
  int fits_ = 0;
  bool racedFromNominal_ = false;
};

}  // namespace info::discover
