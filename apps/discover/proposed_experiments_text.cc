#include "discover/proposed_experiments_text.h"

#include <fmt/format.h>

#include <cctype>

#include "info/discovery/judgement/separation.h"
#include "output/text.h"

namespace app {

std::string predictedExperimentSentence(
    const std::vector<bio::discover::PredictedExperiment>& predictedExperiments,
    const info::discover::DiscoveryProblem& data, const info::discover::Verdict& verdict,
    double enough) {
  if (predictedExperiments.empty() || predictedExperiments.front().least() < enough) return {};
  const bio::discover::PredictedExperiment& best = predictedExperiments.front();
  std::string rivals;
  for (std::size_t i = 0; i < best.nats.size(); ++i)
    rivals += fmt::format(
        "{}{} ({} nats)", i == 0 ? "" : ", ", rivalName(data, verdict, i + 1),
        best.nats[i] < 10 ? numberText(best.nats[i], 2) : fmt::format("{:.0f}", best.nats[i]));
  std::string what = best.sentence;
  what.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(what.front())));
  return fmt::format(
      "{}. Simulated with each of the effects in question, it is expected to distinguish {} from "
      "{}; {} nats are enough.",
      what, rivalName(data, verdict, 0), rivals, enough);
}

}  // namespace app
