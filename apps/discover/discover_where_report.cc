#include "discover/discover_where_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "output/text.h"

namespace app {
namespace {

using Eigen::VectorXd;
using info::discover::Score;

Figure scoreOverTime(const DiscoverFindings& f, std::size_t axis) {
  const auto& map = f.verdict.localisation;
  Figure figure{
      .title = "Score over time" + f.wording.named(axis),
      .xLabel = "Time [s]",
      .yLabel = "Score [standard deviations]",
      .caption = fmt::format("How strongly the data ask for {} of 0.25 s at each time, beyond what "
                             "the parameters and initial states can explain; values within ±2 are "
                             "noise. Dots: significant (false discovery rate at most 5 %).",
                             f.wording.push)};
  Series marks{.name = "significant", .style = SeriesStyle::points};
  for (const int trial : map.trials) {
    Series series{.name = f.data.trialName(trial)};
    for (const Score& score : map.times) {
      if (score.trial != trial || score.axis != axis) continue;
      series.x.push_back((score.from + score.to) / 2);
      series.y.push_back(score.z);
      if (score.significant) {
        marks.x.push_back(series.x.back());
        marks.y.push_back(score.z);
      }
    }
    figure.series.push_back(std::move(series));
  }
  if (!marks.x.empty()) figure.series.push_back(std::move(marks));
  return figure;
}

/// A heat map over an axis's position and speed.
std::string scoreMap(const DiscoverFindings& f, std::size_t axis) {
  std::vector<Score> scores;
  for (const Score& score : f.verdict.localisation.cells)
    if (score.axis == axis) scores.push_back(score);
  if (scores.empty()) return "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 1 1\"/>";
  double lowQ = HUGE_VAL, highQ = -HUGE_VAL, lowV = HUGE_VAL, highV = -HUGE_VAL;
  for (const Score& score : scores) {
    lowQ = std::min(lowQ, score.lowerQ);
    highQ = std::max(highQ, score.upperQ);
    lowV = std::min(lowV, score.lowerQDot);
    highV = std::max(highV, score.upperQDot);
  }
  // the strongest colour for the largest score, but for noise alone none
  double largest = 6;
  for (const Score& score : scores) largest = std::max(largest, std::abs(score.z));
  const ShownAxis& shown = f.wording.axes.at(axis);
  const double scale = shown.scale;
  constexpr double left = 110, right = 900, top = 10, bottom = 300;
  const auto x = [&](double q) { return left + (q - lowQ) / (highQ - lowQ) * (right - left); };
  const auto y = [&](double v) { return bottom - (v - lowV) / (highV - lowV) * (bottom - top); };
  std::string svg =
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 920 360\" width=\"100%\" "
      "font-family=\"sans-serif\" font-size=\"14\">\n";
  for (const Score& score : scores) {
    const double strength = std::abs(score.z) / largest;
    svg += fmt::format(
        "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"{}\" "
        "fill-opacity=\"{:.2f}\" stroke=\"{}\" stroke-width=\"{}\"/>"
        "<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">{:.1f}</text>\n",
        x(score.lowerQ) + 1, y(score.upperQDot) + 1, x(score.upperQ) - x(score.lowerQ) - 2,
        y(score.lowerQDot) - y(score.upperQDot) - 2, score.z > 0 ? "#E69F00" : "#56B4E9", strength,
        score.significant ? "#000" : "#ddd", score.significant ? 2.5 : 1,
        (x(score.lowerQ) + x(score.upperQ)) / 2, (y(score.lowerQDot) + y(score.upperQDot)) / 2 + 5,
        score.z);
  }
  for (int k = 0; k <= 4; ++k) {
    const double q = lowQ + k * (highQ - lowQ) / 4, v = lowV + k * (highV - lowV) / 4;
    svg += fmt::format(
        "<text x=\"{:.1f}\" y=\"{}\" text-anchor=\"middle\">{}</text><text x=\"{}\" y=\"{:.1f}\" "
        "text-anchor=\"end\">{}</text>\n",
        x(q), bottom + 20, numberText(scale * q, 3), left - 8, y(v) + 5, numberText(scale * v, 3));
  }
  svg += fmt::format(
      "<text x=\"{}\" y=\"{}\" text-anchor=\"middle\" font-weight=\"bold\">{} [{}]</text>"
      "<text transform=\"translate(22 {}) rotate(-90)\" text-anchor=\"middle\" "
      "font-weight=\"bold\">Speed [{}/s]</text>\n",
      (left + right) / 2, bottom + 46, htmlText(shown.name), shown.unit, (top + bottom) / 2,
      shown.unit);
  return svg + "</svg>\n";
}

Figure missingForce(const DiscoverFindings& f, std::size_t axis) {
  const auto& map = f.verdict.localisation;
  Figure figure{.title = "Missing force" + f.wording.named(axis),
                .xLabel = "Time [s]",
                .yLabel = f.wording.axes.at(axis).force,
                .caption =
                    "Posterior mean of the latent force of the base model, ±2 standard deviations. "
                    "It is found by smoothing; the measurements are not differentiated."};
  for (std::size_t k = 0; k < map.trials.size(); ++k) {
    Series series{.name = f.data.trialName(map.trials[k]),
                  .x = info::discover::nodeTimes(f.data, map.trials[k])};
    const auto own = [&](const VectorXd& all) {
      return VectorXd(info::discover::onAxis(all, axis, f.data.axes().size()));
    };
    const VectorXd r = own(map.force[k]), sd = own(map.forceSd[k]);
    const VectorXd low = r - 2 * sd, high = r + 2 * sd;
    series.y.assign(r.begin(), r.end());
    series.bandLow.assign(low.begin(), low.end());
    series.bandHigh.assign(high.begin(), high.end());
    figure.series.push_back(std::move(series));
  }
  return figure;
}

}  // namespace

std::vector<ReportPart> whereTheyDisagree(const DiscoverFindings& f) {
  const auto& map = f.verdict.localisation;
  if (map.times.empty()) return {};
  std::vector<ReportPart> parts;
  parts.emplace_back(
      Section{"Where model and data disagree",
              "When, and in which positions and speeds, the model as it is lacks a force."});
  const std::size_t axes = f.wording.axes.size();
  for (std::size_t axis = 0; axis < axes; ++axis) parts.emplace_back(scoreOverTime(f, axis));
  if (f.wording.hasMap) {
    for (std::size_t axis = 0; axis < axes; ++axis) {
      const ShownAxis& shown = f.wording.axes.at(axis);
      parts.emplace_back(VectorDrawing{
          fmt::format("Score over {} and speed{}", shown.position, f.wording.named(axis)),
          scoreMap(f, axis),
          fmt::format("Orange: the data ask for an additional force that raises {}; "
                      "blue: one that lowers it; the stronger, the larger the score; "
                      "framed: significant. {}",
                      shown.name, map.cells.empty() ? "" : "White: not visited.")});
    }
  } else {
    parts.emplace_back(Paragraph{"There is no map over angle and speed: no angle was measured."});
  }
  for (std::size_t axis = 0; axis < axes; ++axis) parts.emplace_back(missingForce(f, axis));
  Table muscles{"Score by " + f.wording.input,
                {f.wording.input, "score [standard deviations]", "significant"},
                {}};
  for (const Score& score : map.inputs) {
    muscles.rows.push_back({score.input + f.wording.named(score.axis), numberText(score.z, 3),
                            score.significant ? "yes" : "no"});
  }
  parts.emplace_back(std::move(muscles));
  return parts;
}

}  // namespace app
