#include "compare/compare_figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "bio/model/units.h"
#include "bio/simulation/integrator_names.h"
#include "output/text.h"

namespace app {
namespace {

std::string longName(bio::Integrator integrator) {
  switch (integrator) {
    case bio::Integrator::rungeKutta4:
      return "Runge–Kutta (rk4)";
    case bio::Integrator::variational:
      return "variational (vi)";
    case bio::Integrator::variationalLeft:
      return "left-forced variational (vi-left)";
    case bio::Integrator::variationalAdaptive:
      return "adaptive variational (vi-adaptive)";
    case bio::Integrator::cvode:
      break;
  }
  return "CVODE";
}

Eigen::Index shownRow(const CompareFindings& f) {
  return f.system.skeleton().indexOf(f.coordinate.name);
}

/// A motion in degrees, at most about a thousand points of it.
Series motionSeries(const CompareFindings& f, const std::string& name,
                    const std::vector<double>& time, const Eigen::MatrixXd& q,
                    SeriesStyle style = SeriesStyle::line) {
  Series series{.name = name, .style = style};
  const std::size_t every = time.size() / 1000 + 1;
  for (std::size_t k = 0; k < time.size(); k += every) {
    series.x.push_back(time[k]);
    series.y.push_back(q(shownRow(f), static_cast<Eigen::Index>(k)) * bio::degreesPerRadian);
  }
  if (!time.empty() && series.x.back() != time.back()) {
    series.x.push_back(time.back());
    series.y.push_back(q(shownRow(f), q.cols() - 1) * bio::degreesPerRadian);
  }
  return series;
}

Series referenceSeries(const CompareFindings& f) {
  return motionSeries(f, "reference", f.comparison.reference.motion.time,
                      f.comparison.reference.motion.q);
}

Figure emptyMotionFigure(const CompareFindings& f, const std::string& title) {
  return {
      .title = title, .xLabel = "Time [s]", .yLabel = fmt::format("{} [deg]", f.coordinate.name)};
}

void addCell(const CompareFindings& f, const bio::CompareCell& cell, Figure& figure,
             SeriesStyle style = SeriesStyle::dashed) {
  const std::string ending = isOk(cell) ? "" : fmt::format(" ({})", bio::name(cell.outcome));
  figure.series.push_back(motionSeries(
      f, fmt::format("{} at {} s{}", bio::name(cell.integrator), numberText(cell.step), ending),
      cell.time, cell.q, style));
}

}  // namespace

bool isOk(const bio::CompareCell& cell) {
  return cell.outcome == bio::Outcome::completed;
}

std::vector<const bio::CompareCell*> cellsOf(const CompareFindings& f, bio::Integrator integrator) {
  std::vector<const bio::CompareCell*> cells;
  for (const bio::CompareCell& cell : f.comparison.cells) {
    if (cell.integrator == integrator) cells.push_back(&cell);
  }
  return cells;
}

Figure rungeKuttaFigure(const CompareFindings& f) {
  const auto cells = cellsOf(f, bio::Integrator::rungeKutta4);
  Figure figure = emptyMotionFigure(f, "Runge–Kutta at three steps");
  figure.series.push_back(referenceSeries(f));
  const auto broken =
      std::find_if(cells.begin(), cells.end(), [](const auto* cell) { return !isOk(*cell); });
  const auto last = broken == cells.end() ? cells.end() : broken + 1;
  for (auto it = last - std::min<std::ptrdiff_t>(3, last - cells.begin()); it != last; ++it) {
    addCell(f, **it, figure);
  }
  figure.caption = broken == cells.end()
                       ? "It reaches the end at every step."
                       : fmt::format("At {} s: {}.", numberText((*broken)->step), (*broken)->why);
  return figure;
}

Figure variationalFigure(const CompareFindings& f) {
  const auto cells = cellsOf(f, bio::Integrator::variational);
  Figure figure = emptyMotionFigure(f, "The variational integrator at two steps");
  figure.series.push_back(referenceSeries(f));
  const bio::CompareCell* usual = nullptr;
  const bio::CompareCell* longest = nullptr;
  for (const auto* cell : cells) {
    if (!isOk(*cell)) continue;
    const auto distance = [](const auto* one) { return std::abs(std::log(one->step / 0.01)); };
    if (usual == nullptr || distance(cell) < distance(usual)) usual = cell;
    longest = cell;
  }
  if (usual != nullptr) {
    addCell(f, *usual, figure);
    figure.caption = fmt::format("RMS error at {} s: {:.2g} deg", numberText(usual->step),
                                 usual->error.rms * bio::degreesPerRadian);
    if (longest != usual) {
      addCell(f, *longest, figure);
      figure.caption += fmt::format("; at {} s: {:.2g} deg", numberText(longest->step),
                                    longest->error.rms * bio::degreesPerRadian);
    }
    figure.caption += ".";
  }
  return figure;
}

Figure workPrecisionFigure(const CompareFindings& f) {
  Figure figure{.title = "Work and precision",
                .xLabel = "Time to simulate [ms]",
                .yLabel = "RMS error [deg]",
                .caption =
                    "Each point is one step size. Lower left is better; failed runs are not shown. "
                    "Times are for one core of this machine.",
                .xScale = AxisScale::logarithmic,
                .yScale = AxisScale::logarithmic};
  for (const bio::Integrator integrator : f.options.integrators) {
    Series series{.name = longName(integrator)};
    for (const auto* cell : cellsOf(f, integrator)) {
      if (!isOk(*cell)) continue;
      series.x.push_back(cell->wallSeconds * 1e3);
      series.y.push_back(cell->error.rms * bio::degreesPerRadian);
    }
    figure.series.push_back(std::move(series));
  }
  return figure;
}

Figure errorFigure(const CompareFindings& f) {
  Figure figure{.title = "Error against step",
                .xLabel = "Step [s]",
                .yLabel = "RMS error [deg]",
                .xScale = AxisScale::logarithmic,
                .yScale = AxisScale::logarithmic};
  for (const bio::Integrator integrator : f.options.integrators) {
    if (integrator == bio::Integrator::cvode) continue;
    std::map<double, double> errors;
    for (const auto* cell : cellsOf(f, integrator)) {
      if (isOk(*cell)) errors[cell->step] = cell->error.rms;
    }
    for (const bio::ObservedOrder& order : f.comparison.orders) {
      if (order.integrator != integrator) continue;
      for (std::size_t i = 0; i < order.steps.size(); ++i) errors[order.steps[i]] = order.errors[i];
      if (std::isnan(order.order)) continue;
      figure.caption +=
          fmt::format("{}Observed order of {}: {:.2f}, from {} s to {} s.",
                      figure.caption.empty() ? "" : " ", bio::name(integrator), order.order,
                      numberText(order.steps.front()), numberText(order.steps.back()));
    }
    Series series{.name = longName(integrator)};
    for (const auto& [step, error] : errors) {
      series.x.push_back(step);
      series.y.push_back(error * bio::degreesPerRadian);
    }
    figure.series.push_back(std::move(series));
  }
  return figure;
}

ReportPart failureTimeline(const CompareFindings& f) {
  Figure figure{.title = "Where the runs ended",
                .xLabel = "Step [s]",
                .yLabel = "Time reached [s]",
                .xScale = AxisScale::logarithmic};
  std::string others;
  for (const bio::Integrator integrator : f.options.integrators) {
    Series series{.name = longName(integrator)};
    bool fails = false;
    for (const auto* cell : cellsOf(f, integrator)) {
      series.x.push_back(cell->step);
      series.y.push_back(isOk(*cell) ? f.options.startTime + f.options.duration : cell->failedAt);
      fails = fails || !isOk(*cell);
    }
    if (fails) {
      figure.series.push_back(std::move(series));
    } else {
      others += std::string(others.empty() ? "" : ", ") + bio::name(integrator);
    }
  }
  if (figure.series.empty()) return Paragraph{"Every run reached the end of the trial."};
  figure.caption =
      others.empty() ? "" : fmt::format("These reach the end at every step: {}.", others);
  return figure;
}

Figure besideFigure(const CompareFindings& f, const std::string& title) {
  Figure figure = emptyMotionFigure(f, title);
  figure.series.push_back(referenceSeries(f));
  for (const bio::Integrator integrator : f.options.integrators) {
    // the longest step that is within a degree
    const bio::CompareCell* best = nullptr;
    for (const auto* cell : cellsOf(f, integrator)) {
      if (isOk(*cell) && cell->error.rms < f.options.usefulError) best = cell;
    }
    if (best != nullptr && integrator != bio::Integrator::cvode) addCell(f, *best, figure);
  }
  return figure;
}

}  // namespace app
