#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "output/text.h"
#include "robot/robot_baxter.h"

namespace app {
namespace {

const BaxterTrial& nearest(const std::vector<BaxterTrial>& trials, double length) {
  return *std::min_element(trials.begin(), trials.end(), [&](const auto& a, const auto& b) {
    return std::abs(a.initialLength - length) < std::abs(b.initialLength - length);
  });
}

template <class F>
Series ofSamples(const std::string& name, const BaxterTrial& trial, const F& value,
                 SeriesStyle style = SeriesStyle::line) {
  Series series{.name = name, .style = style};
  for (const auto& sample : trial.learnt.samples) {
    series.x.push_back(sample.reading.time);
    series.y.push_back(value(sample));
  }
  return series;
}

Figure estimatesFigure(const std::vector<BaxterTrial>& trials, double trueLength) {
  Figure figure{
      .title = "Estimates over time",
      .xLabel = "Time [s]",
      .yLabel = "Length [m]",
      .caption =
          "Each trial starts from a different length. Compare figure 6.3 of Wilson's thesis."};
  for (const BaxterTrial& trial : trials) {
    Series series{.name = fmt::format("{:.3f} m", trial.initialLength)};
    for (const auto& e : trial.learnt.estimates) {
      series.x.push_back(e.time);
      series.y.push_back(e.length);
    }
    figure.series.push_back(std::move(series));
  }
  figure.series.push_back({.name = "true",
                           .x = {0, trials[0].learnt.estimates.back().time},
                           .y = {trueLength, trueLength},
                           .style = SeriesStyle::dashed});
  return figure;
}

std::string points(const std::vector<double>& x, const std::vector<double>& z) {
  std::string text;
  for (std::size_t k = 0; k < x.size(); k += 4)
    text += fmt::format("{:.1f},{:.1f} ", 1000 * x[k], -1000 * z[k]);
  return text;
}

// One attribute of one shape over time; values every 20 ms.
template <class F>
std::string motion(const char* attribute, const info::SwingRun& run, const F& value) {
  constexpr int held = 40;  // frames that the last one stays
  std::string values;
  for (std::size_t k = 0; k < run.time.size(); k += 4)
    values += fmt::format("{}{:.1f}", k ? ";" : "", value(k));
  for (int k = 0; k < held; ++k) values += fmt::format(";{:.1f}", value(run.time.size() - 1));
  return fmt::format(
      "<animate attributeName=\"{}\" dur=\"{:.2f}s\" repeatCount=\"indefinite\" values=\"{}\"/>",
      attribute, run.time.back() + 0.02 * held, values);
}

/// Opens a drawing in millimetres, wide enough for the whole path of the ball.
std::string picture(const std::vector<const info::SwingRun*>& runs) {
  double left = -780, right = 880;
  for (const info::SwingRun* run : runs) {
    for (const double x : run->ballX) {
      left = std::min(left, 1000 * x - 30);
      right = std::max(right, 1000 * x + 30);
    }
  }
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"{:.0f} -60 {:.0f} 560\" "
      "width=\"100%\">\n",
      left, right - left);
}

std::string boxLines(const info::Box& box) {
  const double left = 1000 * (box.wall - box.opening), right = 1000 * box.wall,
               top = -1000 * box.edge;
  return fmt::format(
      "<path d=\"M{0:.0f} {2:.0f}V470H{1:.0f}V{2:.0f}\" fill=\"#f3e6d3\" stroke=\"#7a4b00\" "
      "stroke-width=\"5\"/>\n<line x1=\"-760\" y1=\"0\" x2=\"860\" y2=\"0\" stroke=\"#bbb\" "
      "stroke-width=\"3\"/>\n",
      left, right, top);
}

std::string pathFigure(const BaxterTrial& trial, const info::Box& box) {
  std::string svg = picture({&trial.withoutEstimation, &trial.withEstimation}) + boxLines(box);
  svg += fmt::format(
      "<polyline points=\"{}\" fill=\"none\" stroke=\"#D55E00\" stroke-width=\"4\" "
      "stroke-dasharray=\"14 8\"/>\n",
      points(trial.withoutEstimation.ballX, trial.withoutEstimation.ballZ));
  svg +=
      fmt::format("<polyline points=\"{}\" fill=\"none\" stroke=\"#0072B2\" stroke-width=\"4\"/>\n",
                  points(trial.withEstimation.ballX, trial.withEstimation.ballZ));
  svg += fmt::format(
      "<text x=\"-760\" y=\"-22\" font-size=\"26\" fill=\"#0072B2\">planned with {:.3f} m "
      "(estimate)</text><text x=\"-300\" y=\"-22\" font-size=\"26\" fill=\"#D55E00\">planned with "
      "{:.3f} m (initial)</text>\n",
      trial.learnt.length(), trial.initialLength);
  return svg + "</svg>\n";
}

std::string yesNo(const info::SwingRun& run) {
  return fmt::format("{}: {}", run.success ? "success" : "fail", run.why);
}

}  // namespace

std::string swingDrawing(const info::SwingRun& run, const info::Box& box) {
  std::string svg = picture({&run}) + boxLines(box);
  svg +=
      fmt::format("<polyline points=\"{}\" fill=\"none\" stroke=\"#c8c8c8\" stroke-width=\"3\"/>\n",
                  points(run.ballX, run.ballZ));
  const auto gripper = [&](std::size_t k) { return 1000 * run.gripper[k]; };
  const auto left = [&](std::size_t k) { return 1000 * run.gripper[k] - 30; };
  const auto x = [&](std::size_t k) { return 1000 * run.ballX[k]; };
  const auto y = [&](std::size_t k) { return -1000 * run.ballZ[k]; };
  svg += fmt::format(
      "<rect x=\"-30\" y=\"-26\" width=\"60\" height=\"30\" rx=\"5\" fill=\"#444\">{}</rect>\n",
      motion("x", run, left));
  svg += fmt::format(
      "<line x1=\"0\" y1=\"0\" x2=\"0\" y2=\"368\" stroke=\"#222\" "
      "stroke-width=\"3\">{}{}{}</line>\n",
      motion("x1", run, gripper), motion("x2", run, x), motion("y2", run, y));
  svg +=
      fmt::format("<circle cx=\"0\" cy=\"368\" r=\"16\" fill=\"{}\">{}{}</circle>\n",
                  run.success ? "#0072B2" : "#D55E00", motion("cx", run, x), motion("cy", run, y));
  return svg + "</svg>\n";
}

void reportBaxter(const std::vector<BaxterTrial>& trials, const BaxterRequest& request,
                  Report& report) {
  const info::Box box;
  std::size_t without = 0, with = 0;
  double worst = 0;
  Table task{
      .title = "Task: swing the ball into the box (table 6.1 of Wilson's thesis)",
      .columns = {"Initial length [m]", "Estimate [m]", "Without estimation", "With estimation"},
      .rows = {}};
  for (const BaxterTrial& t : trials) {
    without += t.withoutEstimation.success;
    with += t.withEstimation.success;
    worst = std::max(worst, std::abs(t.learnt.length() - request.trueLength));
    task.rows.push_back({fmt::format("{:.3f}", t.initialLength),
                         fmt::format("{:.4f}", t.learnt.length()), yesNo(t.withoutEstimation),
                         yesNo(t.withEstimation)});
  }
  report.verdict = fmt::format(
      "After {} s all estimates are within {} mm of the true {} m; the ball lands in the box in {} "
      "of {} trials without estimation, in {} with it.",
      numberText(request.duration), numberText(1000 * worst, 3), numberText(request.trueLength),
      without, trials.size(), with);
  report.mainFigure = estimatesFigure(trials, request.trueLength);
  report.details.emplace_back(
      Section{"Task",
              "The ball is swung into a box, planned with the initial and with the estimated "
              "length; the true string decides."});
  report.details.emplace_back(task);

  const BaxterTrial& low = nearest(trials, 0.35);
  const BaxterTrial& high = nearest(trials, 0.45);
  report.details.emplace_back(VectorDrawing{
      .title = fmt::format("Path of the ball, initial length {:.3f} m", high.initialLength),
      .svg = pathFigure(high, box),
      .caption =
          "Both plans carried out with the true string. Compare figure 6.8 of Wilson's thesis."});
  if (!high.withoutEstimation.time.empty())
    report.details.emplace_back(
        VectorDrawing{.title = fmt::format("Planned with {:.3f} m", high.initialLength),
                      .svg = swingDrawing(high.withoutEstimation, box),
                      .caption = yesNo(high.withoutEstimation)});
  if (!high.withEstimation.time.empty())
    report.details.emplace_back(VectorDrawing{
        .title = fmt::format("Planned with the estimate, {:.3f} m", high.learnt.length()),
        .svg = swingDrawing(high.withEstimation, box),
        .caption = yesNo(high.withEstimation)});

  report.details.emplace_back(
      Section{"Course of a trial",
              "What the arm did and measured, and how its information about the length grew."});
  report.details.emplace_back(Figure{
      .title = fmt::format("Force, initial length {:.3f} m", low.initialLength),
      .xLabel = "Time [s]",
      .yLabel = "Force [N]",
      .series = {ofSamples(
                     "measured", low, [](const auto& s) { return s.reading.force; },
                     SeriesStyle::points),
                 ofSamples("predicted", low, [](const auto& s) { return s.predictedForce; })},
      .caption =
          "Predicted with the estimate at that time. Compare figure 6.4 of Wilson's thesis."});
  report.details.emplace_back(Figure{
      .title = fmt::format("Information, initial length {:.3f} m", low.initialLength),
      .xLabel = "Time [s]",
      .yLabel = "Information about the length [1/m²]",
      .series = {ofSamples("accrued", low, [](const auto& s) { return s.information; })},
      .caption =
          "Samples that the sensor clips are not counted. Compare figure 6.5 of Wilson's thesis."});
  report.details.emplace_back(Figure{
      .title = fmt::format("Gripper, initial length {:.3f} m", high.initialLength),
      .xLabel = "Time [s]",
      .yLabel = "Position [m]",
      .series = {ofSamples(
                     "reference", high, [](const auto& s) { return s.reading.reference; },
                     SeriesStyle::dashed),
                 ofSamples("actual", high, [](const auto& s) { return s.reading.position; })},
      .caption = "Compare figure 6.7 of Wilson's thesis."});
}

}  // namespace app
