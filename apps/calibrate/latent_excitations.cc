#include "calibrate/latent_excitations.h"

#include <fmt/format.h>

#include <cmath>

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

double PulledExcitation::rms() const {
  return std::sqrt(z.squaredNorm() / static_cast<double>(z.size()));
}

std::vector<PulledExcitation> pulledExcitations(const CalibrateFindings& f) {
  std::vector<PulledExcitation> all;
  if (f.calibration.parameters.empty()) return all;
  const Eigen::VectorXd theta = f.calibration.values();
  for (const bio::TrialSet::Latent& one : f.training.latent()) {
    const auto n = static_cast<Eigen::Index>(one.knots.size());
    bio::LatentExcitation latent{one.knots, theta.segment(static_cast<Eigen::Index>(one.first), n),
                                 one.declared.sd};
    const auto times = Eigen::VectorXd::Map(one.knots.data(), n);
    PulledExcitation pulled{f.training.trials()[one.trial].file,
                            one.declared,
                            one.knots,
                            one.atKnots,
                            {},
                            latent.values / latent.sd};
    pulled.fitted = bio::withLatent(times, one.atKnots.transpose(), latent).transpose();
    all.push_back(std::move(pulled));
  }
  return all;
}

std::string inWords(const PulledExcitation& one) {
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
  const std::vector<PulledExcitation> all = pulledExcitations(f);
  if (all.empty()) return;
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const PulledExcitation& one : all) {
    list.push_back({{"file", one.file},
                    {"muscle", one.declared.muscle},
                    {"prior_sd_log_odds", one.declared.sd},
                    {"knots_s", one.knots},
                    {"expected", knotValues(one.expected)},
                    {"estimate", knotValues(one.fitted)},
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
  const std::vector<PulledExcitation> all = pulledExcitations(f);
  if (all.empty()) return;
  report.details.emplace_back(Section{"Muscles without an electrode"});
  report.details.emplace_back(
      Paragraph{"Their excitation was estimated with the parameters, about what the trial gives "
                "(mean of the prior); held-out trials are predicted with that alone."});
  for (const PulledExcitation& one : all) {
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
