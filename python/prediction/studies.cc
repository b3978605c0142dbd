#include "prediction/studies.h"

#include <fmt/format.h>

#include <stdexcept>

#include "bio/analysis/replay.h"
#include "bio/tables/different_trials.h"

namespace python {

Studies begun(const bio::Model& model, const std::vector<bio::Trial>& trials,
              const Choosing& chosen) {
  Studies studies{
      systemChoice(model, trials, chosen.coordinate, chosen.lock, chosen.integrator, chosen.step)};
  if (trials.empty()) throw std::invalid_argument("trials: empty, must have at least one");
  for (const bio::Trial& trial : trials) mustBeOfTheModelAsItIs(trial);
  bio::requireDifferentTrials(trials, {});
  return studies;
}

void prepare(Studies& studies, const bio::Model& model, const std::vector<bio::Trial>& trials,
             const Choosing& chosen, const std::atomic<bool>& goOn) {
  const SystemChoice& choice = studies.choice;
  studies.system = std::make_unique<bio::MusculoskeletalSystem>(model, choice.systemOptions());
  for (const bio::Trial& trial : trials) {
    bio::SimulationOptions simulation = during(trial, choice.simulation());
    simulation.progress = [&](double) { return goOn.load(); };
    studies.trials.push_back(bio::studiedTrial(
        trial, model, *studies.system,
        bio::beginningOf(trial, model, *studies.system, chosen.initial).point, simulation));
  }
  studies.question.system = choice.systemOptions();
  if (!choice.coordinates.empty()) studies.question.coordinate = choice.coordinates.front();
}

void mustHaveFreeCoordinate(const Studies& studies, const char* otherwise) {
  if (!studies.choice.coordinates.empty()) return;
  throw std::invalid_argument(
      fmt::format("no coordinate is free to be observed: all are prescribed{}", otherwise));
}

}  // namespace python
