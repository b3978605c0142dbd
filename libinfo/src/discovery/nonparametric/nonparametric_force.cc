#include "discovery/nonparametric/nonparametric_force.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "discovery/judgement/node_states.h"
#include "discovery/nonparametric/symbolic.h"
#include "discovery/search/translation.h"

namespace info::discover {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

using Follows = NonparametricForce::Follows;

constexpr double kSize = 0.3;  // prior sd of each term, in units of the latent force's scale
constexpr int kDegree = 5;     // of the polynomial in the position
constexpr int kPoints = 61;    // points of the plotted curve

// The terms of a force, as functions of (q, q̇) and as text.
struct Family {
  std::size_t axis;
  Follows follows;
  double lowest, highest;  // range of its argument
  std::vector<StateForce> terms;
};

// (q − middle)/half to the powers 0 … 5
Family elastic(const NodeStates& states, std::size_t axis) {
  double low = HUGE_VAL, high = -HUGE_VAL;
  for (const VectorXd& q : states.positions(axis)) {
    low = std::min(low, q.minCoeff());
    high = std::max(high, q.maxCoeff());
  }
  Family family{axis, Follows::position, low, high, {}};
  const double middle = 0.5 * (low + high), half = 0.5 * (high - low);
  if (!(half > 0)) return family;
  for (int power = 0; power <= kDegree; ++power)
    family.terms.push_back(
        {power == 0 ? "1" : fmt::format("((q{:+.17g})/{:.17g})^{}", -middle, half, power),
         [=](double q, double) { return std::pow((q - middle) / half, power); }});
  return family;
}

// viscous, quadratic and dry friction, each of size 1 at the typical speed
Family damping(const NodeStates& states, std::size_t axis, double smallSpeed) {
  const std::vector<VectorXd> speeds = states.speeds(axis);
  const double usual = rootMeanSquare(speeds);
  double highest = 0;
  for (const VectorXd& w : speeds) highest = std::max(highest, w.cwiseAbs().maxCoeff());
  Family family{axis, Follows::speed, -highest, highest, {}};
  if (!(usual > 0)) return family;
  family.terms = {{fmt::format("qdot/{:.17g}", usual), [=](double, double w) { return w / usual; }},
                  {fmt::format("qdot*abs(qdot)/{:.17g}", usual * usual),
                   [=](double, double w) { return w * std::abs(w) / (usual * usual); }},
                  {fmt::format("tanh(qdot/{})", smallSpeed),
                   [=](double, double w) { return std::tanh(w / smallSpeed); }}};
  return family;
}

// RMS of the scale of the latent force on an axis.
double scaleOf(const Likelihood& likelihood, const VectorXd& values, std::size_t axis) {
  const DiscoveryProblem& data = likelihood.data();
  std::vector<VectorXd> parts;
  for (const int trial : likelihood.trials())
    parts.emplace_back(
        onAxis(data.predict(trial, values, {}, {}, true).scale, axis, data.axes().size())
            .rowwise()
            .norm());
  return rootMeanSquare(parts);
}

// The largest first, since it is the unit of the others.
std::vector<FormulaTerm> formulaOf(Family& family, const VectorXd& coefficients, double sd) {
  Index first = 0;
  const double largest = coefficients.cwiseAbs().maxCoeff(&first);
  std::swap(family.terms.front(), family.terms[static_cast<std::size_t>(first)]);
  VectorXd sorted = coefficients;
  std::swap(sorted[0], sorted[first]);
  const double unit = std::copysign(std::max(largest, 0.01 * sd), sorted[0]);
  std::vector<FormulaTerm> formula;
  for (std::size_t k = 0; k < family.terms.size(); ++k) {
    const double coefficient = sorted[static_cast<Index>(k)];
    formula.push_back({family.terms[k].expression, k == 0 ? unit : coefficient / unit,
                       k == 0 ? sd : sd / std::abs(unit)});
  }
  return formula;
}

// c·(e_1 + r_2·e_2 + …) as a function of its argument, and its standard deviation from the
// derivatives in c and r_k.
void drawInto(NonparametricForce& drawn, const Family& family, const Fit& fit,
              const Candidate& candidate) {
  const std::size_t n = family.terms.size();
  std::vector<Index> own;
  VectorXd values(static_cast<Index>(n)), slopes(static_cast<Index>(n));
  for (std::size_t k = 0; k < n; ++k) {
    const int i = fit.hypothesis.indexOf(candidate.quantities[k]);
    own.push_back(i);
    values[static_cast<Index>(k)] = fit.values[static_cast<Index>(candidate.quantities[k])];
    slopes[static_cast<Index>(k)] =
        fit.hypothesis.free[static_cast<std::size_t>(i)].slope(fit.xi[i]);
  }
  const Eigen::MatrixXd covariance =
      slopes.asDiagonal() * Eigen::MatrixXd(fit.covariance(own, own)) * slopes.asDiagonal();
  drawn.force.resize(kPoints);
  drawn.sd.resize(kPoints);
  for (int i = 0; i < kPoints; ++i) {
    const double x = family.lowest + (family.highest - family.lowest) * i / (kPoints - 1);
    drawn.at.push_back(x);
    VectorXd terms(static_cast<Index>(n));  // each depends on q or q̇ alone
    for (std::size_t k = 0; k < n; ++k) terms[static_cast<Index>(k)] = family.terms[k].at(x, x);
    double sum = terms[0];
    VectorXd slope = values[0] * terms;  // derivatives in r_k
    for (Index k = 1; k < terms.size(); ++k) sum += values[k] * terms[k];
    slope[0] = sum;
    drawn.force[i] = values[0] * sum;
    drawn.sd[i] = std::sqrt(std::max(0.0, slope.dot(covariance * slope)));
  }
}

}  // namespace

std::optional<NonparametricForce> raceNonparametric(const Search& search, const Effects& chosen,
                                                    const Fit& smoothing, const Options& options,
                                                    const Whitening& sds,
                                                    const Search::Report& report, int& fits) {
  const NodeStates states = statesAtNodes(search.likelihood(), smoothing);
  std::vector<Family> families;
  for (std::size_t axis = 0; axis < states.numAxes; ++axis) {
    families.push_back(elastic(states, axis));
    families.push_back(damping(states, axis, search.data().axes()[axis].smallSpeed));
  }
  std::optional<NonparametricForce> best;
  for (Family& family : families) {
    if (family.terms.empty()) continue;
    const double sd = kSize * scaleOf(search.likelihood(), smoothing.values, family.axis);
    const VectorXd coefficients =
        linearCoefficients(search.likelihood(), smoothing, states, family.axis, family.terms, sd);
    const auto widened =
        search.data().withFormula(family.axis, formulaOf(family, coefficients, sd), chosen);
    if (!widened) return {};
    const auto memory = searchMemoryOf(search, chosen, *widened);
    const auto formula = placeOf(*widened, "formula");
    if (!memory || !formula) return {};
    Search race(*widened, search.likelihood().trials(), options, sds, report);
    race.take(*memory);
    const auto net = [&](const Effects& effects) {
      return race.at(effects).score - options.evidence * static_cast<double>(effects.size());
    };
    std::vector<Effects> besides = {{}};
    if (chosen.size() > 1)
      for (const std::size_t e : memory->chosen)
        if (race.entries().count(without(memory->chosen, e)) > 0)
          besides.push_back(without(memory->chosen, e));
    for (const Effects& rest : besides) {
      race.raceOne(rest, *formula);
      const Effects all = with(rest, *formula);
      if (!race.at(all).works()) continue;
      const double ahead = net(all) - net(memory->chosen);
      if (best && best->ahead >= ahead) continue;
      best.emplace();
      best->axis = family.axis;
      best->follows = family.follows;
      best->logBayesFactor = race.at(all).score - race.at({}).score;
      best->ahead = ahead;
      best->wins = ahead > options.remainder;
      drawInto(*best, family, race.at(all).fit, widened->candidates()[*formula]);
      for (const std::size_t e : rest)
        best->besides.push_back(*placeOf(search.data(), widened->candidates()[e].id));
    }
    fits += race.fits();
  }
  return best;
}

}  // namespace info::discover
