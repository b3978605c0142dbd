#include "robot/robot_laboratory.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "info/estimation/estimate.h"
#include "output/text.h"

namespace app {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

namespace {

info::LeastSquares problemOf(const info::PlannedExperiment& plan, const MatrixXd& recording) {
  return {plan.predictor, {recording, plan.covariance}, plan.parameters};
}

std::string percent(double share) {
  return fmt::format("{} %", numberText(100 * share, 3));
}

nlohmann::ordered_json pairOf(const VectorXd& v) {
  return {v[0], v[1]};
}

}  // namespace

LaboratoryEstimates estimateInLaboratory(const LaboratoryRobot& robot,
                                         const info::CartMotion& motion, int recordings,
                                         const CommandContext& context) {
  const info::PlannedExperiment plan = robot.experiment(motion);
  const auto errorOf = [&](const info::Estimate& estimate) {
    return Vector2d((estimate.parameters.cwiseQuotient(robot.truth).array() - 1).abs());
  };
  LaboratoryEstimates out;
  out.recording = robot.measure(motion, context.seed);
  out.shown = info::estimate(problemOf(plan, out.recording));
  out.error = errorOf(out.shown);
  std::vector<Vector2d> errors(static_cast<std::size_t>(recordings));
  info::parallelFor(recordings, context.threads, [&](int i) {
    const std::uint64_t seed = context.seed + static_cast<std::uint64_t>(i);
    errors[std::size_t(i)] = errorOf(info::estimate(problemOf(plan, robot.measure(motion, seed))));
  });
  for (Index i : {0, 1}) {
    std::vector<double> one;
    for (const Vector2d& error : errors) one.push_back(error[i]);
    std::nth_element(one.begin(), one.begin() + recordings / 2, one.end());
    out.medianError[i] = one[std::size_t(recordings / 2)];
  }
  return out;
}

void tellLaboratory(const LaboratoryRobot& robot, const info::LaboratoryEffects& effects,
                    const info::CartMotion& before, const info::CartMotion& after,
                    const CommandContext& context, Summary& summary, Report& report) {
  constexpr int recordings = 25;
  const auto slow = estimateInLaboratory(robot, before, recordings, context),
             fast = estimateInLaboratory(robot, after, recordings, context);
  const info::PlannedExperiment plan = robot.experiment(before);
  const Vector2d start(plan.parameters[0].start, plan.parameters[1].start);

  summary.set("laboratory", {{"out_of_plane_rad", effects.outOfPlane},
                             {"dry_friction_N_m", effects.dryFriction},
                             {"control_lag_s", effects.controlLag},
                             {"control_noise_m_per_s2", effects.controlNoise},
                             {"sensor_curvature", effects.sensorCurvature},
                             {"sensor_step", effects.sensorStep},
                             {"initial_estimate", pairOf(start)},
                             {"actual", pairOf(robot.truth)},
                             {"estimate_initial", pairOf(slow.shown.parameters)},
                             {"estimate_optimised", pairOf(fast.shown.parameters)},
                             {"error_initial", pairOf(slow.error)},
                             {"error_optimised", pairOf(fast.error)},
                             {"recordings", recordings},
                             {"median_error_initial", pairOf(slow.medianError)},
                             {"median_error_optimised", pairOf(fast.medianError)}});

  report.details.emplace_back(Section{"Simulated laboratory"});
  report.details.emplace_back(Paragraph{fmt::format(
      "The data are simulated with effects that the model lacks: initial angle {}° out of the "
      "plane, dry friction of {} N m, lag of the cart's speed of {} s, disturbance of its "
      "acceleration of {} m/s², sensor nonlinearity of {} at full range, and sensor resolution of "
      "{}.",
      numberText(effects.outOfPlane * 180 / std::numbers::pi, 3), numberText(effects.dryFriction),
      numberText(effects.controlLag), numberText(effects.controlNoise),
      percent(effects.sensorCurvature), numberText(effects.sensorStep, 3))});
  const std::string first = label(plan.parameters[0]), second = label(plan.parameters[1]);
  Table table{
      .title = fmt::format("Estimates, as in table {} of Wilson's thesis", robot.thesisTable),
      .columns = {"", first, second, first + ", Wilson's thesis", second + ", Wilson's thesis"},
      .rows = {}};
  const auto row = [&](const char* what, const VectorXd& value, std::size_t printed,
                       const std::vector<bool>& atBound = {false, false}) {
    const auto text = [&](Index i) {
      return numberText(value[i], 3) + (atBound[std::size_t(i)] ? " (at its bound)" : "");
    };
    table.rows.push_back(
        {what, text(0), text(1), robot.thesis[printed][0], robot.thesis[printed][1]});
  };
  const auto errors = [&](const std::string& what, const Vector2d& error,
                          const std::array<std::string, 2>& printed = {}) {
    table.rows.push_back({what, percent(error[0]), percent(error[1]), printed[0], printed[1]});
  };
  row("initial guess", start, 0);
  row("true value", robot.truth, 1);
  row("from the initial motion", slow.shown.parameters, 2, slow.shown.atBound);
  errors("error", slow.error, robot.thesis[3]);
  errors(fmt::format("median error of {} recordings", recordings), slow.medianError);
  row("from the optimised motion", fast.shown.parameters, 4, fast.shown.atBound);
  errors("error", fast.error, robot.thesis[5]);
  errors(fmt::format("median error of {} recordings", recordings), fast.medianError);
  report.details.emplace_back(table);
  const auto map = [&](const char* title, const info::CartMotion& motion,
                       const LaboratoryEstimates& estimates) {
    report.details.emplace_back(basinFigure(
        {title, robot.range, robot.truth}, problemOf(robot.experiment(motion), estimates.recording),
        estimates.shown.parameterHistory, context.threads));
  };
  map("Cost of the estimator, recording of the initial motion", before, slow);
  map("Cost of the estimator, recording of the optimised motion", after, fast);
}

}  // namespace app
