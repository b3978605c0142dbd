#include "calibrate/held_out_prediction.h"

#include <fmt/format.h>

#include <cmath>

#include "info/estimation/monte_carlo.h"
#include "output/angle_unit.h"
#include "output/json_text.h"
#include "output/text.h"

namespace app {
namespace {

/// Noise of the calibration trials' channel of this name; NaN if they have none.
double noiseOf(const CalibrateFindings& f, const std::string& channel) {
  const auto& all = f.training.channels();
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i].name == channel) return f.calibration.channelNoise[i].sd;
  }
  return std::nan("");
}

PredictedSeries predictionOf(const CalibrateFindings& f, const bio::MeasuredSeries& series,
                             Eigen::Index first) {
  const bio::MeasuredGroup& channel = f.heldOut->channels()[series.channel];
  const double unit = channel.areAngles ? radian : 1;
  const Eigen::Index n = series.values.size();
  const Eigen::VectorXd measured = unit * series.values;
  const Eigen::VectorXd predicted =
      unit * f.calibration.heldOutAfter.middleCols(first, n).transpose();
  const Eigen::VectorXd sd = unit * f.calibration.heldOutSd.segment(first, n);
  PredictedSeries one{f.heldOut->trials()[series.trial].file, nameOf(series.what),
                      channel.areAngles ? "deg" : channel.unit};
  one.noise = unit * noiseOf(f, channel.name);
  const double z = info::normalQuantile(f.options.confidence);
  const Eigen::ArrayXd half = z * (sd.array().square() + one.noise * one.noise).sqrt();
  Eigen::Index ofMeasured = 0, ofPredicted = 0;
  measured.cwiseAbs().maxCoeff(&ofMeasured);
  predicted.cwiseAbs().maxCoeff(&ofPredicted);
  one.measuredPeak = measured[ofMeasured];
  one.predictedPeak = predicted[ofPredicted];
  one.sdOfEstimates = sd[ofPredicted];
  one.lower = one.predictedPeak - half[ofPredicted];
  one.upper = one.predictedPeak + half[ofPredicted];
  if (std::isnan(one.noise)) {
    one.shareHeld = std::nan("");
    return one;
  }
  one.holdsPeak = one.lower <= one.measuredPeak && one.measuredPeak <= one.upper;
  one.shareHeld = ((measured - predicted).array().abs() <= half).cast<double>().mean();
  return one;
}

}  // namespace

std::vector<PredictedSeries> predictedSeries(const CalibrateFindings& f) {
  std::vector<PredictedSeries> all;
  if (!f.heldOut || f.calibration.heldOutSd.size() == 0) return all;
  Eigen::Index first = 0;
  for (const bio::MeasuredSeries& series : f.heldOut->series()) {
    all.push_back(predictionOf(f, series, first));
    first += series.values.size();
  }
  return all;
}

void tellPredictions(const CalibrateFindings& f, Summary& summary) {
  const std::vector<PredictedSeries> all = predictedSeries(f);
  if (all.empty()) return;
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const PredictedSeries& one : all) {
    list.push_back({{"file", one.file},
                    {"channel", one.channel},
                    {"unit", one.unit},
                    {"peak_measured", one.measuredPeak},
                    {"peak_predicted", orNull(one.predictedPeak)},
                    {"sd_of_estimates", orNull(one.sdOfEstimates)},
                    {"noise", orNull(one.noise)},
                    {"interval", {orNull(one.lower), orNull(one.upper)}},
                    {"holds_peak", nullptr},
                    {"share_of_samples_held", orNull(one.shareHeld)}});
    if (one.holdsPeak) list.back()["holds_peak"] = *one.holdsPeak;
  }
  summary.set("held_out_predictions", list);
}

Table predictionTable(const CalibrateFindings& f) {
  Table table{
      fmt::format("Peaks with intervals of {:g} %, from the covariance of the estimates and "
                  "the noise of one sample",
                  100 * f.options.confidence),
      {"trial", "channel", "measured", "predicted", "interval", "holds it",
       "samples in their intervals"},
      {}};
  for (const PredictedSeries& one : predictedSeries(f)) {
    table.rows.push_back(
        {one.file, one.channel, withUnit(one.measuredPeak, one.unit, 4),
         withUnit(one.predictedPeak, one.unit, 4),
         one.holdsPeak ? fmt::format("{} … {}", numberText(one.lower, 4), numberText(one.upper, 4))
                       : std::string("unknown noise"),
         !one.holdsPeak   ? "–"
         : *one.holdsPeak ? "yes"
                          : "no",
         one.holdsPeak ? fmt::format("{:.0f} %", 100 * one.shareHeld) : std::string("–")});
  }
  return table;
}

}  // namespace app
