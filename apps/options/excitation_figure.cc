#include "options/excitation_figure.h"

#include <fmt/format.h>

#include <algorithm>

namespace app {

std::optional<Figure> excitationFigure(const bio::Trial& trial,
                                       const bio::MusculoskeletalSystem* system) {
  std::vector<std::string> names;
  if (system == nullptr) {
    names = trial.muscles;
  } else {
    for (const bio::SystemMuscle& muscle : system->muscles()) names.push_back(muscle.name);
  }
  Figure figure{.title = "Excitations",
                .xLabel = "Time [s]",
                .yLabel = "Excitation [1]",
                .caption = "From the trial, 0 to 1; straight lines between its rows."};
  const double baseline = bio::TrialOptions{}.baseline;
  for (const std::string& name : names) {
    const auto at = std::find(trial.muscles.begin(), trial.muscles.end(), name);
    if (at == trial.muscles.end()) continue;
    const Eigen::VectorXd values = trial.excitations.col(at - trial.muscles.begin());
    if ((values.array() == baseline).all()) continue;
    figure.series.push_back({.name = name, .x = asList(trial.times), .y = asList(values)});
  }
  if (figure.series.empty()) return {};
  return figure;
}

std::vector<Figure> excitationFigures(const bio::Trial& fitted, const bio::Trial* heldOut,
                                      const bio::MusculoskeletalSystem& system) {
  std::vector<Figure> figures;
  for (const bio::Trial* trial : {&fitted, heldOut}) {
    if (trial == nullptr) continue;
    auto figure = excitationFigure(*trial, &system);
    if (!figure) continue;
    figure->title =
        fmt::format("Excitations of {}{}", trial->file, trial == heldOut ? " (held out)" : "");
    figures.push_back(*std::move(figure));
  }
  return figures;
}

void addExcitations(std::vector<Figure> figures, Report& report) {
  if (figures.empty()) return;
  report.details.emplace_back(
      Section{"Excitations", "What drove the simulated muscles, in the first trial of each kind."});
  for (Figure& figure : figures) report.details.emplace_back(std::move(figure));
}

}  // namespace app
