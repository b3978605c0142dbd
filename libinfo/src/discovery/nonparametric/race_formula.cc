#include "discovery/nonparametric/race_formula.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "discovery/search/translation.h"

namespace info::discover {
namespace {

// Empty if a term is not a function of the state.
std::vector<FormulaTerm> termsOf(const Unknown& unknown) {
  std::vector<FormulaTerm> formula;
  double unit = 1;  // unit of the other coefficients: the amplitude
  for (const SymbolicTerm& term : unknown.terms) {
    if (term.expression.empty()) return {};
    // terms may nearly cancel, so that each may be many times larger than their sum
    const double sd = std::max(30 * term.sd, 3 * std::abs(term.coefficient));
    formula.push_back({term.expression, term.coefficient / unit, sd / std::abs(unit)});
    unit = unknown.terms.front().coefficient;
  }
  return formula;
}

std::string textOf(const Unknown& unknown, const std::vector<double>& values) {
  const auto& terms = unknown.terms;
  if (values.size() == 1) return SymbolicTerm::times(values[0], terms[0].name);
  std::string sum = terms[0].name;
  for (std::size_t k = 1; k < values.size(); ++k)
    sum += fmt::format(" {} {}", values[k] < 0 ? '-' : '+',
                       SymbolicTerm::times(std::abs(values[k]), terms[k].name));
  return SymbolicTerm::times(values[0], "(" + sum + ")");
}

}  // namespace

std::optional<RacedFormula> raceFormula(const Search& search, const Unknown& unknown,
                                        const Effects& kept, Options options) {
  RacedFormula formula;
  formula.axis = unknown.axis;
  formula.terms = termsOf(unknown);
  if (formula.terms.empty()) return {};
  const std::shared_ptr<const DiscoveryProblem> widened =
      search.data().withFormula(formula.axis, formula.terms, kept);
  if (!widened) return {};
  options.symbolic = false;
  options.judgeSamples = false;
  WarmStart draft;
  if (auto known = searchMemoryOf(search, kept, *widened))
    draft = std::make_shared<const SearchMemory>(std::move(*known));
  const Verdict raced = run(*widened, options, &draft);
  if (raced.reached != Stage::finished) return {};
  const auto isFormula = [&](std::size_t c) { return widened->candidates()[c].id == "formula"; };
  const auto alone = std::find_if(
      raced.finalists.begin(), raced.finalists.end(),
      [&](const Finalist& f) { return f.effects.size() == 1 && isFormula(f.effects[0]); });
  if (alone == raced.finalists.end()) return {};
  formula.logBayesFactor = alone->logEvidence;
  formula.significance = alone->significance;
  for (const Estimate& estimate : alone->estimates) {
    formula.values.push_back(estimate.value);
    formula.sds.push_back(estimate.sd);
  }
  formula.text = textOf(unknown, formula.values);
  formula.wins = raced.finding == Finding::named && !raced.vetoed && raced.effects.size() == 1 &&
                 isFormula(raced.effects[0].candidate);
  formula.after = raced.after;
  formula.excess = raced.excess;
  formula.heldOut = raced.heldOut;
  if (formula.wins) {
    formula.verdict = std::make_shared<const Verdict>(raced);
    formula.data = widened;
  }
  return formula;
}

}  // namespace info::discover
