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

bool isKnot(const bio::CalibratedParameter& parameter) {
  return parameter.ofTrial && parameter.asked.name.find(".latent") != std::string::npos;
}

std::string inWords(const bio::PulledExcitation& one) {
  Eigen::Index at = 0;
  one.z.cwiseAbs().maxCoeff(&at);
  return fmt::format(
      "{} in {}: excitation {} instead of {} on average; pulled from what was expected by {} "
      "standard deviations (RMS), at most {} at {} s",
      one.declared.muscle, one.file, numberText(one.fitted.mean(), 3),
      numberText(one.expected.mean(), 3), numberText(one.rms(), 2), numberText(one.z[at], 3),
      numberText(one.knots[static_cast<std::size_t>(at)], 4));
}

void tellLatent(const CalibrateFindings& f, Summary& summary) {
  const std::vector<bio::PulledExcitation> all = bio::pulledExcitations(f.training, f.calibration);
  if (all.empty()) return;
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const bio::PulledExcitation& one : all) {
    nlohmann::ordered_json sds = nlohmann::ordered_json::array();
    for (const double sd : one.sd) sds.push_back(orNull(sd));
    list.push_back({{"file", one.file},
                    {"muscle", one.declared.muscle},
                    {"prior_sd_log_odds", one.declared.sd},
                    {"knots_s", one.knots},
                    {"expected", knotValues(one.expected)},
                    {"estimate", knotValues(one.fitted)},
                    {"sd_log_odds", sds},
                    {"prior_z", knotValues(one.z)},
                    {"rms_prior_z", one.rms()},
                    {"largest_prior_z", one.largest()}});
    if (one.largest() > 3) {
      summary.warn(inWords(one) + ": what was expected of it, or the model, is wrong");
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
  for (const bio::PulledExcitation& one : all) {
    report.details.emplace_back(Paragraph{inWords(one) + "."});
    Figure figure{.title = fmt::format("{} in {}", one.declared.muscle, one.file),
                  .xLabel = "Time [s]",
                  .yLabel = "Excitation [1]",
                  .series = {},
                  .caption = "At the knots of the latent excitation."};
    figure.series.push_back({.name = "expected",
                             .x = one.knots,
                             .y = knotValues(one.expected),
                             .style = SeriesStyle::dashed});
    figure.series.push_back({.name = "estimated", .x = one.knots, .y = knotValues(one.fitted)});
    report.details.emplace_back(std::move(figure));
  }
}

}  // namespace app
