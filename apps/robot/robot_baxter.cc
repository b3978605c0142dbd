#include "robot/robot_baxter.h"

#include <fmt/format.h>

#include <algorithm>

#include "options/number_rules.h"
#include "output/text.h"
#include "robot/robot_methods.h"
#include "robot/robot_search.h"

namespace app {
namespace {

void writeTables(const std::vector<BaxterTrial>& trials, OutputFolder& folder) {
  folder.write("estimates.csv", [&](std::ostream& out) {
    out << "trial,initial_m,time,length_m,length_deviation_m,mass_kg,converged,iterations\n";
    for (std::size_t i = 0; i < trials.size(); ++i)
      for (const auto& e : trials[i].learnt.estimates)
        out << fmt::format("{},{:.6g},{:.6g},{:.10g},{:.6g},{:.10g},{},{}\n", i + 1,
                           trials[i].initialLength, e.time, e.length, e.lengthSd, e.mass,
                           e.converged ? 1 : 0, e.iterations);
  });
  folder.write("samples.csv", [&](std::ostream& out) {
    out << "trial,time,reference_m,position_m,acceleration_m_per_s2,force_N,predicted_force_N,"
           "information_per_m2\n";
    for (std::size_t i = 0; i < trials.size(); ++i)
      for (const auto& s : trials[i].learnt.samples)
        out << fmt::format("{},{:.6g},{:.8g},{:.8g},{:.8g},{:.8g},{:.8g},{:.8g}\n", i + 1,
                           s.reading.time, s.reading.reference, s.reading.position,
                           s.reading.acceleration, s.reading.force, s.predictedForce,
                           s.information);
  });
  folder.write("task.csv", [&](std::ostream& out) {
    out << "trial,initial_m,estimate_m,success_without_estimation,success_with_estimation,"
           "height_without_m,height_with_m\n";
    for (std::size_t i = 0; i < trials.size(); ++i) {
      const BaxterTrial& t = trials[i];
      out << fmt::format("{},{:.6g},{:.10g},{},{},{:.6g},{:.6g}\n", i + 1, t.initialLength,
                         t.learnt.length(), t.withoutEstimation.success ? 1 : 0,
                         t.withEstimation.success ? 1 : 0, t.withoutEstimation.crossingHeight,
                         t.withEstimation.crossingHeight);
    }
  });
  folder.write("swing.csv", [&](std::ostream& out) {
    out << "trial,estimated,time,gripper_m,ball_x_m,ball_z_m\n";
    for (std::size_t i = 0; i < trials.size(); ++i)
      for (int estimated : {0, 1}) {
        const info::SwingRun& run =
            estimated ? trials[i].withEstimation : trials[i].withoutEstimation;
        for (std::size_t k = 0; k < run.time.size(); k += 4)
          out << fmt::format("{},{},{:.6g},{:.8g},{:.8g},{:.8g}\n", i + 1, estimated, run.time[k],
                             run.gripper[k], run.ballX[k], run.ballZ[k]);
      }
  });
  const info::Box box;
  for (const BaxterTrial& t : trials)
    if (!t.withoutEstimation.success && !t.withoutEstimation.time.empty()) {
      folder.write("swing_failure.svg",
                   [&](std::ostream& out) { out << swingDrawing(t.withoutEstimation, box); });
      break;
    }
  for (const BaxterTrial& t : trials)
    if (t.withEstimation.success) {
      folder.write("swing_success.svg",
                   [&](std::ostream& out) { out << swingDrawing(t.withEstimation, box); });
      break;
    }
}

void summarise(const info::robot::StringLengthResult& found, const BaxterRequest& request,
               Summary& summary) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  double worstLate = 0;
  std::size_t misses = 0, cycles = 0, skipped = 0;
  std::vector<double> busy;
  bool priority = true;
  for (const BaxterTrial& t : found.trials) {
    const auto& last = t.learnt.estimates.back();
    nlohmann::ordered_json one = {{"initial_m", t.initialLength},
                                  {"estimate_m", last.length},
                                  {"deviation_m", last.lengthSd}};
    if (request.estimateMass) one["mass_kg"] = last.mass;
    one["success_without_estimation"] = t.withoutEstimation.success;
    one["success_with_estimation"] = t.withEstimation.success;
    list.push_back(std::move(one));
    busy.insert(busy.end(), t.learnt.cycleSeconds.begin(), t.learnt.cycleSeconds.end());
    misses += t.learnt.controller.misses;
    cycles += t.learnt.controller.cycles;
    skipped += t.learnt.controller.skipped;
    worstLate = std::max(worstLate, t.learnt.controller.worstLate);
    priority = priority && t.learnt.realTimePriority;
  }
  std::sort(busy.begin(), busy.end());
  summary.set("trials", std::move(list));
  summary.set("true_length_m", request.trueLength);
  summary.set("mean_m", found.mean);
  summary.set("standard_deviation_m", found.sd);
  summary.set("largest_error_m", found.largestError);
  summary.set("successes_without_estimation", found.successesWithout);
  summary.set("successes_with_estimation", found.successesWith);
  summary.set("clipped_samples", found.clippedSamples);
  summary.set("mode",
              request.realTime ? "four threads in real time" : "one thread, simulated time");
  summary.set("cycle_ms", {{"median", busy.empty() ? 0 : 1e3 * busy[busy.size() / 2]},
                           {"worst", busy.empty() ? 0 : 1e3 * busy.back()}});
  summary.set("cycles", cycles);
  summary.set("deadline_misses", misses);
  if (request.realTime) {
    summary.set("cycles_skipped", skipped);
    summary.set("worst_wake_up_ms", 1e3 * worstLate);
    summary.set("real_time_priority", priority);
  }
  if (found.slack) summary.warn("the string was slack for a moment, where the model is not valid");
}

}  // namespace

std::vector<CLI::Option*> addBaxterOptions(CLI::App& options, BaxterRequest& r) {
  const std::string group = "robot baxter";
  std::vector<CLI::Option*> all;
  const auto add = [&](CLI::Option* option) { all.push_back(option->group(group)); };
  const auto positive = [&](const char* name, double& value, const char* text, const char* unit) {
    add(options.add_option(name, value, text)
            ->check(app::positive())
            ->type_name(unit)
            ->capture_default_str());
  };
  add(options.add_flag("--real-time", r.realTime,
                       "run four threads in real time, each at its own rate and with deadlines"));
  positive("--duration", r.duration, "duration of a trial", "S");
  add(options
          .add_option(
              "--initial-length", r.initialLengths,
              "initial estimate of the length; may be repeated (nine values, 0.308 to 0.468)")
          ->check(between(0.05, 1.5))
          ->type_name("M"));
  positive("--payload", r.payload, "mass on the string, known unless --estimate-mass is given",
           "KG");
  positive("--true-length", r.trueLength, "true length of the string", "M");
  positive("--noise", r.noise, "standard deviation of the load cell's noise", "N");
  add(options
          .add_option("--disturbance", r.disturbance,
                      "unmeasured acceleration true length of the string's top")
          ->check(notNegative())
          ->type_name("M/S2")
          ->capture_default_str());
  add(options
          .add_option("--tracking-weight", r.trackingWeight,
                      "weight of tracking the middle position; without it nothing would move")
          ->check(notNegative())
          ->capture_default_str()
          ->type_name("Q"));
  add(options
          .add_option("--window", r.window,
                      "length of the estimation window; 0: all data since the start")
          ->check(notNegative())
          ->type_name("S"));
  add(options.add_flag("--estimate-mass", r.estimateMass, "estimate the mass as well"));
  add(options.add_flag("--ignore-clipping", r.ignoreClipping,
                       "treat clipped samples as measurements"));
  add(options.add_flag("--search-time", r.searchTime,
                       "let the controller postpone its action to a better time"));
  return all;
}

std::vector<std::string> baxterFiles() {
  return {"estimates.csv", "samples.csv",       "task.csv",
          "swing.csv",     "swing_failure.svg", "swing_success.svg"};
}

ExitStatus runBaxter(BaxterRequest request, const CommandContext& context, Summary& summary,
                     Report& report, OutputFolder& folder) {
  request.seed = context.seed;
  const info::robot::StringLengthResult found = [&] {
    WorkBars bars;
    request.progress = bars.progress();
    return info::robot::estimateStringLength(request);
  }();
  if (found.trials.empty()) {
    summary.set("first_decision", info::describe(found.firstDecision));
    report.verdict = fmt::format(
        "Nothing would move: {}. The load hangs at rest, where the force does not depend on the "
        "string's length (Γ = 0), and no small motion changes this to first order. Only a tracking "
        "weight starts a motion: --tracking-weight is {}, must be > 0.",
        info::describe(found.firstDecision), numberText(request.trackingWeight));
    return ExitStatus::answerIsNo;
  }
  summarise(found, request, summary);
  writeTables(found.trials, folder);
  reportBaxter(found.trials, request, report);
  sayStringLength(request, found, summary.methods());
  return ExitStatus::done;
}

}  // namespace app
