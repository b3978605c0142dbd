#include "calibrate/latent_excitations.h"

#include <fmt/format.h>

#include "output/json_text.h"
#include "output/text.h"

namespace app {
namespace {

std::vector<double> knotValues(const Eigen::VectorXd& values) {
  return {values.begin(), values.end()};
}

}  // namespace

std::string inWords(const bio::PulledExcitation& excitation) {
  Eigen::Index at = 0;
  excitation.z.cwiseAbs().maxCoeff(&at);
  return fmt::format(
      "{} in {}: excitation {} instead of {} on average; pulled from what was expected by {} "
      "standard deviations (RMS), at most {} at {} s",
      excitation.declared.muscle, excitation.file, numberText(excitation.fitted.mean(), 3),
      numberText(excitation.expected.mean(), 3), numberText(excitation.rms(), 2),
      numberText(excitation.z[at], 3),
      numberText(excitation.knots[static_cast<std::size_t>(at)], 4));
}

void tellLatent(const CalibrateFindings& f, Summary& summary) {
  const std::vector<bio::PulledExcitation> all = bio::pulledExcitations(f.training, f.calibration);
  if (all.empty()) return;
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const bio::PulledExcitation& excitation : all) {
    nlohmann::ordered_json sds = nlohmann::ordered_json::array();
    for (const double sd : excitation.sd) sds.push_back(orNull(sd));
    list.push_back({{"file", excitation.file},
                    {"muscle", excitation.declared.muscle},
                    {"prior_sd_log_odds", excitation.declared.sd},
                    {"knots_s", excitation.knots},
                    {"expected", knotValues(excitation.expected)},
                    {"estimate", knotValues(excitation.fitted)},
                    {"sd_log_odds", sds},
                    {"prior_z", knotValues(excitation.z)},
                    {"rms_prior_z", excitation.rms()},
                    {"largest_prior_z", excitation.largest()}});
    if (excitation.largest() > 3) {
      summary.warn(inWords(excitation) + ": what was expected of it, or the model, is wrong");
    }
  }
  summary.set("latent_excitations", list);
}

void addLatent(const CalibrateFindings& f, Report& report) {
  const std::vector<bio::PulledExcitation> all = bio::pulledExcitations(f.training, f.calibration);
  if (all.empty()) return;
  report.details.emplace_back(Section{"Muscles without an electrode"});
  report.details.emplace_back(
      Paragraph{"Their excitation was estimated with the parameters, about what the trial gives "
                "(mean of the prior); held-out trials are predicted with that alone."});
  for (const bio::PulledExcitation& excitation : all) {
    report.details.emplace_back(Paragraph{inWords(excitation) + "."});
    Figure figure{.title = fmt::format("{} in {}", excitation.declared.muscle, excitation.file),
                  .xLabel = "Time [s]",
                  .yLabel = "Excitation [1]",
                  .series = {},
                  .caption = "At the knots of the latent excitation."};
    figure.series.push_back({.name = "expected",
                             .x = excitation.knots,
                             .y = knotValues(excitation.expected),
                             .style = SeriesStyle::dashed});
    figure.series.push_back(
        {.name = "estimated", .x = excitation.knots, .y = knotValues(excitation.fitted)});
    report.details.emplace_back(std::move(figure));
  }
}

}  // namespace app
