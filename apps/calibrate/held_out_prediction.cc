#include "calibrate/held_out_prediction.h"

#include <fmt/format.h>

#include "bio/calibration/predicted_series.h"
#include "bio/model/units.h"
#include "output/json_text.h"
#include "output/text.h"

namespace app {
namespace {

/// A prediction in the unit that people see.
struct ShownSeries {
  std::string file, channel, unit;
  bio::PredictedSeries values;
};

std::vector<ShownSeries> shownSeries(const CalibrateFindings& f) {
  std::vector<ShownSeries> all;
  if (!f.heldOut) return all;
  for (bio::PredictedSeries& one :
       bio::predictedSeries(f.training, *f.heldOut, f.calibration, f.options.confidence)) {
    const bio::MeasuredSeries& series = f.heldOut->series()[one.series];
    const bio::MeasuredGroup& channel = f.heldOut->channels()[series.channel];
    const double factor = channel.areAngles ? bio::degreesPerRadian : 1;
    for (double* value : {&one.measuredPeak, &one.predictedPeak, &one.sdOfEstimates, &one.noise,
                          &one.lower, &one.upper}) {
      *value *= factor;
    }
    all.push_back({f.heldOut->trials()[series.trial].file, nameOf(series.what),
                   channel.areAngles ? "deg" : channel.unit, one});
  }
  return all;
}

}  // namespace

void tellPredictions(const CalibrateFindings& f, Summary& summary) {
  const std::vector<ShownSeries> all = shownSeries(f);
  if (all.empty()) return;
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const ShownSeries& shown : all) {
    const bio::PredictedSeries& series = shown.values;
    list.push_back({{"file", shown.file},
                    {"channel", shown.channel},
                    {"unit", shown.unit},
                    {"peak_measured", series.measuredPeak},
                    {"peak_predicted", orNull(series.predictedPeak)},
                    {"sd_of_estimates", orNull(series.sdOfEstimates)},
                    {"noise", orNull(series.noise)},
                    {"interval", {orNull(series.lower), orNull(series.upper)}},
                    {"holds_peak", nullptr},
                    {"share_of_samples_held", orNull(series.shareHeld)}});
    if (series.holdsPeak) list.back()["holds_peak"] = *series.holdsPeak;
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
  for (const ShownSeries& shown : shownSeries(f)) {
    const bio::PredictedSeries& series = shown.values;
    table.rows.push_back(
        {shown.file, shown.channel, withUnit(series.measuredPeak, shown.unit, 4),
         withUnit(series.predictedPeak, shown.unit, 4),
         series.holdsPeak
             ? fmt::format("{} … {}", numberText(series.lower, 4), numberText(series.upper, 4))
             : std::string("unknown noise"),
         !series.holdsPeak   ? "–"
         : *series.holdsPeak ? "yes"
                             : "no",
         series.holdsPeak ? fmt::format("{:.0f} %", 100 * series.shareHeld) : std::string("–")});
  }
  return table;
}

}  // namespace app
