#include <fmt/format.h>

#include <cmath>

#include "bio/model/units.h"
#include "calibrate/calibrate_report.h"
#include "calibrate/held_out_prediction.h"
#include "calibrate/latent_excitations.h"
#include "output/json_text.h"
#include "output/text.h"

namespace app {

double rmse(const bio::TrialSet& set, const Eigen::MatrixXd& predicted) {
  return std::sqrt(set.meanSquare(predicted)) * bio::degreesPerRadian;
}

double rmseAfter(const CalibrateFindings& f, bool heldOut) {
  return f.calibrated->rms(heldOut) * bio::degreesPerRadian;
}

namespace {

using Json = nlohmann::ordered_json;

Json estimateJson(const CalibrateFindings& f, const bio::CalibratedParameter& parameter) {
  Json json = {{"value", parameter.value},
               {"sd", orNull(parameter.sd)},
               {"unit", parameter.asked.unit},
               {"identifiable", parameter.identifiable},
               {"model", parameter.model},
               {"interval", Json::array({orNull(parameter.lower), orNull(parameter.upper)})},
               {"sd_data_alone", orNull(parameter.determinacy.bound)},
               {"at_bound", parameter.atBound}};
  if (parameter.asked.prior) {
    json["prior"] = {{"mean", parameter.asked.prior->mean}, {"sd", parameter.asked.prior->sd}};
  }
  if (parameter.byLikelihood) json["interval_is"] = "profile likelihood";
  if (!parameter.why.empty()) json["why"] = parameter.why;
  if (parameter.profile && parameter.identifiable) {
    json["profile_interval"] =
        Json::array({orNull(parameter.profile->lower), orNull(parameter.profile->upper)});
  }
  if (f.options.bootstrap > 0) {
    json["bootstrap_sd"] = orNull(parameter.bootstrapSd);
    json["bootstrap_interval"] =
        Json::array({orNull(parameter.bootstrapLower), orNull(parameter.bootstrapUpper)});
  }
  return json;
}

/// RMS errors and noise of each measured channel, in its unit.
Json channelsJson(const CalibrateFindings& f) {
  const bio::Calibration& c = f.calibration;
  Json channels = Json::object();
  for (std::size_t i = 0; i < f.training.channels().size(); ++i) {
    const bio::MeasuredGroup& channel = f.training.channels()[i];
    const double unit = channel.areAngles ? bio::degreesPerRadian : 1;
    const auto rms = [&](const bio::TrialSet& set, const Eigen::MatrixXd& predicted) {
      for (std::size_t k = 0; k < set.channels().size(); ++k) {
        if (set.channels()[k].name != channel.name) continue;
        return orNull(std::sqrt(set.meanSquareOf(predicted, k)) * unit);
      }
      return Json(nullptr);
    };
    Json& json = channels[channel.name];
    json = {{"unit", channel.areAngles ? "deg" : channel.unit},
            {"rmse_train_before", rms(f.training, c.before)},
            {"rmse_train", rms(f.training, c.after)},
            {"noise", c.channelNoise[i].sd * unit},
            {"samples_per_independent_value", c.channelNoise[i].correlationTime}};
    if (!f.heldOut) continue;
    json["rmse_held_out_before"] = rms(*f.heldOut, c.heldOutBefore);
    json["rmse_held_out"] = rms(*f.heldOut, c.heldOutAfter);
  }
  return channels;
}

/// Correlation of the estimates, without knots of latent excitations.
Json correlationJson(const bio::Calibration& c) {
  std::vector<Eigen::Index> kept;
  for (std::size_t i = 0; i < c.parameters.size(); ++i) {
    if (!bio::isKnot(c.parameters[i].target)) kept.push_back(static_cast<Eigen::Index>(i));
  }
  Json rows = Json::array();
  for (const Eigen::Index i : kept) {
    Json row = Json::array();
    for (const Eigen::Index k : kept) row.push_back(c.correlation(i, k));
    rows.push_back(std::move(row));
  }
  return rows;
}

/// Other minima that fit nearly as well: a warning each, and their values.
Json otherMinima(const bio::Calibration& c, Summary& summary) {
  Json list = Json::array();
  for (const bio::OtherMinimum& minimum : c.otherMinima) {
    Json values = Json::object();
    std::string words;
    for (std::size_t i = 0; i < c.parameters.size(); ++i) {
      const bio::CalibratedParameter& parameter = c.parameters[i];
      if (parameter.ofTrial) continue;
      const double value = minimum.values[static_cast<Eigen::Index>(i)];
      values[parameter.asked.name] = value;
      const double sd = minimum.sd[static_cast<Eigen::Index>(i)];
      if (std::abs(value - parameter.value) < 3 * (sd > 0 ? sd : parameter.priorSd)) continue;
      words +=
          fmt::format("{}{} = {} instead of {}", words.empty() ? "" : ", ", parameter.asked.name,
                      numberText(value, 4), withUnit(parameter.value, parameter.asked.unit, 4));
    }
    list.push_back(
        {{"nats", minimum.difference}, {"nats_of_data", minimum.ofData}, {"values", values}});
    const std::string how =
        minimum.isLikely()
            ? fmt::format("is {:.2g} % as likely as the estimate",
                          100 * std::exp(-minimum.difference))
            : std::string("fits the data about as well, and only the priors are against it");
    summary.warn(fmt::format("another minimum {}: {}; intervals enclose both", how, words));
  }
  return list;
}

}  // namespace

std::string estimateWords(const bio::CalibratedParameter& parameter) {
  const std::string was = fmt::format("was {}", numberText(parameter.model, 6));
  if (std::isnan(parameter.sd) && !std::isnan(parameter.lower)) {
    return fmt::format("{} = {}, or another value between {} and {} ({})", parameter.asked.name,
                       withUnit(parameter.value, parameter.asked.unit, 6),
                       numberText(parameter.lower, 4),
                       withUnit(parameter.upper, parameter.asked.unit, 4), was);
  }
  if (std::isnan(parameter.sd)) {
    return fmt::format("{} = {} ({}; no interval: {})", parameter.asked.name,
                       withUnit(parameter.value, parameter.asked.unit, 6), was, parameter.why);
  }
  return fmt::format("{} = {} ± {} ({})", parameter.asked.name, numberText(parameter.value, 6),
                     withUnit(parameter.sd, parameter.asked.unit, 3), was);
}

std::vector<info::discover::FittedNumber> fittedNumbers(const bio::Calibration& calibration) {
  std::vector<info::discover::FittedNumber> numbers;
  for (std::size_t i = 0; i < calibration.parameters.size(); ++i) {
    const bio::CalibratedParameter& parameter = calibration.parameters[i];
    if (bio::isKnot(parameter.target)) continue;
    const auto& prior = parameter.asked.prior;
    numbers.push_back({i, parameter.asked.name, parameter.asked.unit, parameter.model,
                       parameter.value, parameter.sd, prior ? prior->sd : std::nan(""),
                       prior ? (parameter.value - prior->mean) / prior->sd : std::nan("")});
  }
  return numbers;
}

void tellCalibrate(const CalibrateFindings& f, Summary& summary) {
  const bio::Calibration& c = f.calibration;
  if (!c.failure.empty()) {
    summary.set("status", "no solution");
    summary.set("why", c.failure);
    return;
  }
  summary.set("status", c.converged ? "ok" : "not converged");
  if (!c.converged) summary.set("why", info::describe(c.why));
  summary.set("rmse_train_deg", orNull(rmseAfter(f, false)));
  summary.set("rmse_train_before_deg", orNull(rmse(f.training, c.before)));
  summary.set("rmse_held_out_deg", orNull(rmseAfter(f, true)));
  summary.set("rmse_held_out_before_deg",
              f.heldOut ? orNull(rmse(*f.heldOut, c.heldOutBefore)) : Json(nullptr));
  if (!measuresOnlyAngles(f.training)) summary.set("channels", channelsJson(f));
  Json estimates = Json::object();
  for (const bio::CalibratedParameter& parameter : c.parameters) {
    if (bio::isKnot(parameter.target)) continue;  // of latent_excitations
    estimates[parameter.asked.name] = estimateJson(f, parameter);
    // of another minimum other_minima warns
    if (!parameter.why.empty() && !parameter.ofTrial && std::isnan(parameter.lower))
      summary.warn(parameter.why);
  }
  summary.set("estimates", estimates);
  for (const std::string& remark : c.remarks) summary.warn(remark);
  tellLatent(f, summary);
  tellPredictions(f, summary);
  const bool firstAreAngles = f.training.channels().front().areAngles;
  summary.set("noise_deg",
              firstAreAngles ? Json(c.noise.sd * bio::degreesPerRadian) : Json(nullptr));
  summary.set("noise_is", f.options.noise ? "given" : "from the residuals");
  summary.set("sample_scatter_deg", c.noiseFloor * bio::degreesPerRadian);
  summary.set("residual_above_noise", c.leavesMoreThanNoise());
  const double noises =
      f.options.noise ? rmse(f.training, c.after) / (bio::degreesPerRadian * *f.options.noise) : 0;
  if (noises > 3) {
    summary.warn(
        fmt::format("the residual is {:.3g} times the noise given by --noise-deg: these parameters "
                    "alone do not explain the trials",
                    noises));
  }
  summary.set("samples_per_independent_value", c.noise.correlationTime);
  summary.set("reduced_chi_square", orNull(c.reducedChiSquare));
  summary.set("iterations", c.iterations);
  if (c.starts.size() > 1) {
    summary.set("starts", c.starts.size());
    summary.set("starts_that_agree", c.agreeingStarts);
    summary.set("other_minima", otherMinima(c, summary));
  }
  if (f.options.bootstrap > 0) summary.set("bootstrap_converged", c.bootstrapConverged);
  summary.set("correlation", correlationJson(c));
}

}  // namespace app
