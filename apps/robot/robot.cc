#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "command/command.h"
#include "options/number_rules.h"
#include "options/quantity.h"
#include "report/result.h"
#include "robot/robot_baxter.h"
#include "robot/robot_information.h"
#include "robot/robot_methods.h"
#include "robot/robot_optimise.h"
#include "robot_options/robot_program.h"
#include "robots/laboratory.h"

namespace app {
namespace {

using info::LaboratoryEffects;

class Robot : public Command {
 public:
  About about() const override {
    return {"robot", "Find the motion of a robot that is most informative about its parameters",
            "fisherhill robot double-pendulum --discrete"};
  }

  void addOptions(CLI::App& options) override {
    options
        .add_option("ROBOT", robot_,
                    "double-pendulum (two links on a cart, angles measured), suspended-mass (mass "
                    "on a string below a cart, its force measured) or baxter (the same on a robot "
                    "arm that estimates the string's length while it moves)")
        ->required()
        ->check(CLI::IsMember({"double-pendulum", "suspended-mass", "baxter"}))
        ->type_name("");
    const auto common = options.get_options().size();
    addStart(options);
    addObjective(options);
    addLaboratory(options);
    addJudging(options);
    for (CLI::Option* option : options.get_options()) cartOptions_.push_back(option);
    cartOptions_.erase(cartOptions_.begin(),
                       cartOptions_.begin() + static_cast<std::ptrdiff_t>(common));
    baxterOptions_ = addBaxterOptions(options, baxter_);
  }

  ExitStatus run(const CommandContext& context) override {
    const bool isBaxter = robot_ == "baxter";
    for (const CLI::Option* option : isBaxter ? cartOptions_ : baxterOptions_)
      if (option->count() > 0)
        throw std::invalid_argument(
            fmt::format("{} cannot be combined with {}", option->get_name(), robot_));
    if (isBaxter) return learn(context);
    const bool optimise = checkUse();
    OutputFolder folder(context, optimise ? optimiseFiles() : std::vector<std::string>{});
    Summary summary(context);
    Report report;
    report.title = robot_ == "double-pendulum" ? "Information about the double pendulum"
                                               : "Information about the suspended mass";
    ExitStatus status;
    if (convergence_) {
      status =
          tellConvergence(info::robot::plannedExperiment(experiment()), context, summary, report);
      sayConvergence(experiment(), context.seed, summary.methods());
    } else if (optimise) {
      status = optimiseRobot(request(), warmStart_, context, summary, report, folder);
    } else {
      const std::optional<int> trials = boundOnly_ ? std::optional<int>() : trials_;
      const info::PlannedExperiment plan = info::robot::plannedExperiment(experiment());
      status = tellInformation(plan, trials, context, summary, report);
      const bool simulates = trials && status == ExitStatus::done;
      sayInformation(experiment(), plan, simulates ? *trials : 0, context.seed, summary.methods());
    }
    deliver(context, summary, report, folder);
    return status;
  }

 private:
  ExitStatus learn(const CommandContext& context) const {
    OutputFolder folder(context, baxterFiles());
    Summary summary(context);
    Report report;
    report.title = "A robot arm estimates the length of a string while it moves";
    const ExitStatus status = runBaxter(baxter_, context, summary, report, folder);
    deliver(context, summary, report, folder);
    return status;
  }

  void addStart(CLI::App& options) {
    options.add_flag("--discrete", discrete_,
                     "double-pendulum: optimise the discrete motion of the variational integrator");
    options
        .add_option("--measure-every", stepsPerSample_,
                    "with --discrete: number of steps of 0.02 s between measurements (1)")
        ->check(positive())
        ->type_name("N");
    options
        .add_option("--amplitude", amplitude_, "cart motion amplitude*(1 - cos(2 pi t/period)) [m]")
        ->check(notNegative())
        ->type_name("A");
    options.add_option("--period", period_, "period of the cart motion [s]")
        ->check(positive())
        ->type_name("T");
    options
        .add_option("--perturb", perturb_,
                    "add a small smooth random motion to the initial one; size of its input "
                    "[m/s^2; with --discrete m]")
        ->check(positive())
        ->type_name("SIZE");
    options
        .add_option("--warm-start", warmStart_, "start from the input of this motion_optimised.csv")
        ->check(CLI::ExistingFile)
        ->type_name("FILE");
  }

  void addObjective(CLI::App& options) {
    options
        .add_option(
            "--objective", objective_,
            "weight of an information criterion, instead of the robot's default: e (1/smallest "
            "eigenvalue), a (trace of the bound), d (-ln det), condition (condition number)")
        ->type_name("NAME=W");
    options
        .add_option("--input-weight", inputWeight_,
                    "weight R of the input's deviation from the initial input")
        ->type_name("R");
    options
        .add_option("--limits", limits_,
                    "limits of the input [m/s^2; with --discrete m]: LOWER UPPER")
        ->expected(2)
        ->type_name("U");
    options
        .add_option("--tolerance", tolerance_,
                    "stop when the expected decrease of the cost is below this")
        ->check(notNegative())
        ->type_name("J");
    options
        .add_option("--iterations", iterations_, "largest number of iterations of the search (100)")
        ->check(notNegative())
        ->type_name("N");
    options
        .add_option("--robust", robust_,
                    "optimise the worst case or the average over several values of the parameters")
        ->check(CLI::IsMember({"worst", "average"}))
        ->type_name("RULE");
    options
        .add_option("--candidate", candidates_,
                    "with --robust: values of both parameters, as P1 P2, in the units of the "
                    "report; may be repeated (default: the model's values, and each alone +-30 %)")
        ->allow_extra_args(false)
        ->type_name("P");
  }

  void addLaboratory(CLI::App& options) {
    options.add_flag("--lab", lab_,
                     "estimate from data simulated with unmodelled effects (friction, lag, sensor "
                     "error) of typical size; the options below set one size each");
    options
        .add_option("--out-of-plane", outOfPlane_,
                    "initial angle out of the plane of motion (3deg)")
        ->type_name("ANGLE");
    const auto size = [&](const char* name, std::optional<double>& value, const char* text,
                          const char* type) {
      options.add_option(name, value, text)->type_name(type);
    };
    size("--dry-friction", dryFriction_,
         "dry friction moment of each joint [N m] (1e-5; suspended-mass 1e-4)", "M");
    size("--control-lag", controlLag_, "lag of the cart's speed [s] (0.002)", "T");
    size("--control-noise", controlNoise_, "disturbance of the cart's acceleration [m/s^2] (0.05)",
         "SD");
    size("--sensor-curvature", sensorCurvature_,
         "relative nonlinearity of the sensor at full range (pi/2 rad or 3 N) (0.01)", "B");
    size("--sensor-step", sensorStep_,
         "resolution of the sensor [rad or N] (0.001; suspended-mass 3/1024)", "S");
  }

  void addJudging(CLI::App& options) {
    options.add_flag("--as-is", asIs_,
                     "evaluate the initial motion with simulated experiments; do not optimise");
    options.add_flag("--bound-only", boundOnly_,
                     "compute the Cramér-Rao bound only, without simulated experiments");
    options
        .add_option(
            "--unknown", unknown_,
            "double-pendulum: unknown parameters, m1,c (mass and damping) or m1,m2 (both masses)")
        ->check(CLI::IsMember({"m1,c", "m1,m2"}))
        ->type_name("NAMES");
    options.add_flag("--undamped", undamped_, "double-pendulum with --unknown m1,m2: no damping");
    options
        .add_option("--trials", trials_,
                    "number of simulated experiments, each with an estimate (300)")
        ->check(positive())
        ->type_name("N");
    options.add_flag("--convergence", convergence_,
                     "suspended-mass: compare the convergence of three estimators");
  }

  // True where a motion is to be optimised.
  bool checkUse() const {
    const auto must = [](bool holds, const char* rule) {
      if (!holds) throw std::invalid_argument(rule);
    };
    must(!convergence_ || !pendulum(), "--convergence requires suspended-mass");
    must(pendulum() || (!undamped_ && unknown_ == "m1,c"),
         "--unknown and --undamped require double-pendulum");
    must(!undamped_ || unknown_ == "m1,m2", "--undamped requires --unknown m1,m2");
    const bool optimise = !convergence_ && !boundOnly_ && !asIs_ && unknown_ == "m1,c";
    const bool searching = discrete_ || perturb_ || !warmStart_.empty() || !objective_.empty() ||
                           inputWeight_ || !limits_.empty() || tolerance_ || iterations_ ||
                           !robust_.empty() || effects();
    must(optimise || !searching,
         "--discrete, --perturb, --warm-start, --objective, --input-weight, --limits, --tolerance, "
         "--iterations, --robust and --lab concern the optimisation and cannot be combined with "
         "--as-is, --bound-only, --convergence or --unknown m1,m2");
    must(!discrete_ || pendulum(), "--discrete requires double-pendulum");
    must(discrete_ || stepsPerSample_ == 1, "--measure-every requires --discrete");
    must(!discrete_ || !effects(), "--lab and its sizes cannot be combined with --discrete");
    must(candidates_.empty() || !robust_.empty(), "--candidate requires --robust");
    return optimise;
  }

  bool pendulum() const { return robot_ == "double-pendulum"; }

  std::optional<LaboratoryEffects> effects() const {
    const bool any = lab_ || !outOfPlane_.empty() || dryFriction_ || controlLag_ || controlNoise_ ||
                     sensorCurvature_ || sensorStep_;
    if (!any) return {};
    LaboratoryEffects e;
    if (lab_)
      e = pendulum() ? info::usualDoublePendulumEffects() : info::usualSuspendedMassEffects();
    if (!outOfPlane_.empty()) e.outOfPlane = parseAngle(outOfPlane_);
    e.dryFriction = dryFriction_.value_or(e.dryFriction);
    e.controlLag = controlLag_.value_or(e.controlLag);
    e.controlNoise = controlNoise_.value_or(e.controlNoise);
    e.sensorCurvature = sensorCurvature_.value_or(e.sensorCurvature);
    e.sensorStep = sensorStep_.value_or(e.sensorStep);
    return e;
  }

  std::optional<info::InformationWeights> objective() const {
    if (objective_.empty()) return {};
    info::InformationWeights weights;
    for (const std::string& text : objective_) {
      const Assignment assignment = parseAssignment(text);
      if (assignment.name == "e")
        weights.e = assignment.value;
      else if (assignment.name == "a")
        weights.a = assignment.value;
      else if (assignment.name == "d")
        weights.d = assignment.value;
      else if (assignment.name == "condition")
        weights.condition = assignment.value;
      else
        throw std::invalid_argument(
            fmt::format("--objective {}: criterion must be e, a, d or condition", text));
    }
    return weights;
  }

  MotionRequest request() const {
    MotionRequest r;
    r.pendulum = pendulum();
    r.discrete = discrete_;
    r.amplitude = amplitude_;
    r.period = period_;
    r.perturb = perturb_;
    r.trials = trials_;
    r.objective = objective();
    r.inputWeight = inputWeight_;
    if (!limits_.empty()) r.limits = std::pair(limits_[0], limits_[1]);
    r.tolerance = tolerance_;
    r.iterations = iterations_;
    r.stepsPerSample = stepsPerSample_;
    if (!robust_.empty())
      r.robust = robust_ == "worst" ? info::RobustRule::worst : info::RobustRule::average;
    for (const auto& [first, second] : candidates_) r.candidates.emplace_back(first, second);
    r.laboratory = effects();
    return r;
  }

  info::robot::ExperimentRequest experiment() const {
    return {.pendulum = pendulum(),
            .amplitude = amplitude_,
            .period = period_,
            .bothMasses = unknown_ != "m1,c",
            .undamped = undamped_};
  }

  std::string robot_;
  std::string unknown_ = "m1,c";
  std::string warmStart_, robust_, outOfPlane_;
  bool boundOnly_ = false, undamped_ = false, convergence_ = false, discrete_ = false,
       asIs_ = false, lab_ = false;
  std::optional<double> amplitude_, period_, perturb_, inputWeight_, tolerance_, dryFriction_,
      controlLag_, controlNoise_, sensorCurvature_, sensorStep_;
  std::optional<int> iterations_;
  std::vector<std::string> objective_;
  std::vector<double> limits_;
  std::vector<std::pair<double, double>> candidates_;
  int trials_ = 300, stepsPerSample_ = 1;
  BaxterRequest baxter_;
  std::vector<CLI::Option*> cartOptions_, baxterOptions_;
};

}  // namespace

/// `fisherhill robot double-pendulum|suspended-mass`: finds the motion that is most informative
/// about the robot's parameters (robot_optimise.h), or computes the information of a given motion
/// and the performance of estimators on it. Status 1 if the parameters are not separately
/// identifiable, or if no better motion was found.
std::unique_ptr<Command> robotCommand() {
  return std::make_unique<Robot>();
}

}  // namespace app
