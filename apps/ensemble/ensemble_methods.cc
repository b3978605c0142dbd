#include "ensemble/ensemble_methods.h"

#include <fmt/format.h>

#include <filesystem>

#include "bio/analysis/ensemble_statistics.h"
#include "output/text.h"

namespace app {
namespace {

std::string lawsOf(const bio::ParameterLaws& laws, const TypedLaws& typed) {
  std::string text =
      typed.distribution == "normal"
          ? std::string("normal distributions within their bounds")
          : std::string("uniform distributions over ±√3 standard deviations within their bounds");
  if (laws.together) {
    text += fmt::format(", correlated by a Gaussian copula with the covariance in {}",
                        std::filesystem::path(typed.covarianceFile).filename().string());
  } else if (laws.parameters.size() > 1) {
    text = "independent " + text;
  }
  if (typed.spread != 1)
    text += fmt::format(", with {} times their standard deviations", numberText(typed.spread));
  return text;
}

void sayPoints(const EnsembleFindings& f, const TypedLaws& typed, std::uint64_t seed,
               bool isDecomposed, Methods& methods) {
  const bio::ParameterLaws& laws = f.ensemble.laws();
  const std::size_t p = laws.parameters.size();
  const std::string parameters = p == 1 ? "one parameter" : fmt::format("{} parameters", p);
  if (isDecomposed) {
    methods.say(
        Methods::Part::inference,
        fmt::format("The trial was simulated {} times, at {} base points of a randomised Halton "
                    "sequence for {} by Saltelli's scheme (seed {}); the points are quantiles of "
                    "{}.",
                    f.ensemble.count(), f.basePoints, parameters, seed, lawsOf(laws, typed)));
  } else {
    methods.say(Methods::Part::inference,
                fmt::format("The trial was simulated {} times, each with {} drawn at random (seed "
                            "{}) from {}.",
                            f.ensemble.count(), parameters, seed, lawsOf(laws, typed)));
  }
  const std::size_t given = typed.priors.size() + typed.bounds.size();
  methods.say(Methods::Part::inference,
              given == 0 ? "Means, standard deviations and bounds are those of the default "
                           "priors, about the model's values."
                         : "Means, standard deviations and bounds are those of the default "
                           "priors, about the model's values, unless others were given.");
}

}  // namespace

void sayEnsemble(const EnsembleFindings& f, const TypedLaws& typed, std::uint64_t seed,
                 Methods& methods) {
  const bool isDecomposed = f.channels.front().sobol.has_value();
  sayPoints(f, typed, seed, isDecomposed, methods);
  const auto ok = f.outcomes.find("ok");
  const std::uint64_t lost = f.ensemble.count() - (ok == f.outcomes.end() ? 0 : ok->second);
  methods.say(
      Methods::Part::inference,
      fmt::format("Bands are the 5th, 50th and 95th percentiles at each of {} times{}.",
                  f.table.course().size(),
                  lost == 0 ? std::string()
                            : fmt::format("; {} that did not reach the end {} left out",
                                          counted(lost, "simulation"), lost == 1 ? "is" : "are")));
  if (isDecomposed) {
    methods.say(Methods::Part::inference,
                fmt::format("First-order Sobol indices are estimated as by {}, total indices by "
                            "Jansen's formula, each with a 95 % interval by resampling the base "
                            "points.",
                            citation(Publication::saltelli2010)),
                {Publication::saltelli2010});
  }
  methods.assume(
      "The distributions describe what is uncertain; everything that was not drawn has the model's "
      "value in all simulations.");
}

void sayDiscoveryInSets(const ModelDiscoveryRequest& each, std::size_t sets, Methods& methods) {
  methods.say(
      Methods::Part::inference,
      fmt::format("{} data sets were searched for missing effects, each by itself, with at most {} "
                  "in one hypothesis and {}; the report of each set has its methods.",
                  sets, counted(each.maxEffects, "effect"),
                  each.noise ? fmt::format("a noise of {} deg", numberText(*each.noise))
                             : std::string("the noise estimated from its data")));
}

}  // namespace app
