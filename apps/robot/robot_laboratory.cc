#include "robot/robot_laboratory.h"

#include <fmt/format.h>

#include "bio/model/units.h"
#include "output/text.h"

namespace app {

using Eigen::Index;
using Eigen::Vector2d;
using Eigen::VectorXd;
using info::robot::LaboratoryEstimates;

namespace {

std::string percent(double share) {
  return fmt::format("{} %", numberText(100 * share, 3));
}

nlohmann::ordered_json pairOf(const VectorXd& v) {
  return {v[0], v[1]};
}

}  // namespace

void tellLaboratory(const info::robot::LaboratoryComparison& found, const ThesisLaboratory& thesis,
                    const CommandContext& context, Summary& summary, Report& report) {
  const info::LaboratoryEffects& effects = found.effects;
  const LaboratoryEstimates &slow = found.before, &fast = found.after;
  const int recordings = found.recordings;
  summary.set("laboratory", {{"out_of_plane_rad", effects.outOfPlane},
                             {"dry_friction_N_m", effects.dryFriction},
                             {"control_lag_s", effects.controlLag},
                             {"control_noise_m_per_s2", effects.controlNoise},
                             {"sensor_curvature", effects.sensorCurvature},
                             {"sensor_step", effects.sensorStep},
                             {"initial_estimate", pairOf(found.start)},
                             {"actual", pairOf(found.truth)},
                             {"estimate_initial", pairOf(slow.first.parameters)},
                             {"estimate_optimised", pairOf(fast.first.parameters)},
                             {"error_initial", pairOf(slow.error)},
                             {"error_optimised", pairOf(fast.error)},
                             {"recordings", recordings},
                             {"median_error_initial", pairOf(slow.medianError)},
                             {"median_error_optimised", pairOf(fast.medianError)}});

  report.details.emplace_back(Section{
      "Simulated laboratory",
      "Estimates from data with effects that the model lacks: the better motion should still give "
      "the smaller error."});
  report.details.emplace_back(Paragraph{fmt::format(
      "The data are simulated with effects that the model lacks: initial angle {}° out of the "
      "plane, dry friction of {} N m, lag of the cart's speed of {} s, disturbance of its "
      "acceleration of {} m/s², sensor nonlinearity of {} at full range, and sensor resolution of "
      "{}.",
      numberText(effects.outOfPlane * bio::degreesPerRadian, 3), numberText(effects.dryFriction),
      numberText(effects.controlLag), numberText(effects.controlNoise),
      percent(effects.sensorCurvature), numberText(effects.sensorStep, 3))});
  const std::string first = label(slow.problem.parameters()[0]),
                    second = label(slow.problem.parameters()[1]);
  Table table{
      .title = fmt::format("Estimates, as in table {} of Wilson's thesis", thesis.table),
      .columns = {"", first, second, first + ", Wilson's thesis", second + ", Wilson's thesis"},
      .rows = {}};
  const auto row = [&](const char* what, const VectorXd& value, std::size_t printed,
                       const std::vector<bool>& atBound = {false, false}) {
    const auto text = [&](Index i) {
      return numberText(value[i], 3) + (atBound[std::size_t(i)] ? " (at its bound)" : "");
    };
    table.rows.push_back(
        {what, text(0), text(1), thesis.printed[printed][0], thesis.printed[printed][1]});
  };
  const auto errors = [&](const std::string& what, const Vector2d& error,
                          const std::array<std::string, 2>& printed = {}) {
    table.rows.push_back({what, percent(error[0]), percent(error[1]), printed[0], printed[1]});
  };
  row("initial guess", found.start, 0);
  row("true value", found.truth, 1);
  row("from the initial motion", slow.first.parameters, 2, slow.first.atBound);
  errors("error", slow.error, thesis.printed[3]);
  errors(fmt::format("median error of {} recordings", recordings), slow.medianError);
  row("from the optimised motion", fast.first.parameters, 4, fast.first.atBound);
  errors("error", fast.error, thesis.printed[5]);
  errors(fmt::format("median error of {} recordings", recordings), fast.medianError);
  report.details.emplace_back(table);
  const auto map = [&](const char* title, const LaboratoryEstimates& estimates) {
    report.details.emplace_back(basinFigure({title, thesis.range, found.truth}, estimates.problem,
                                            estimates.first.parameterHistory, context.threads));
  };
  map("Cost of the estimator, recording of the initial motion", slow);
  map("Cost of the estimator, recording of the optimised motion", fast);
}

}  // namespace app
