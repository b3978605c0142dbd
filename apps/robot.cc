#include "robot.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "info/systems/laboratory.h"
#include "number_rules.h"
#include "quantity.h"
#include "result.h"
#include "robot_baxter.h"
#include "robot_information.h"
#include "robot_optimise.h"

namespace app {
namespace {

using info::LaboratoryEffects;

class Robot : public Command {
 public:
  About about() const override {
    return {"robot", "The motion of a robot that tells most about its parameters",
            "fisherhill robot double-pendulum --discrete"};
  }

  void addOptions(CLI::App& options) override {
    options
        .add_option(
            "ROBOT", robot_,
            "double-pendulum (cart, two links, angles measured), suspended-mass (cart, mass "
            "on a string, its force measured) or baxter (the same on a robot's arm, learnt "
            "while it moves)")
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
            fmt::format("{} does not go with {}", option->get_name(), robot_));
    if (isBaxter) return learn(context);
    const bool optimise = checkUse();
    OutputFolder folder(context, optimise ? optimiseFiles() : std::vector<std::string>{});
    Summary summary(context);
    Report report;
    report.title = fmt::format("What the {} tells", robot_);
    ExitStatus status;
    if (convergence_) {
      status = tellConvergence(experiment(), context, summary, report);
    } else if (optimise) {
      status = optimiseRobot(request(), context, summary, report, folder);
    } else {
      const std::optional<int> trials = boundOnly_ ? std::optional<int>() : trials_;
      status = tellInformation(experiment(), trials, context, summary, report);
    }
    deliver(context, summary, report, folder);
    return status;
  }

 private:
  ExitStatus learn(const CommandContext& context) const {
    OutputFolder folder(context, baxterFiles());
    Summary summary(context);
    Report report;
    report.title = "An arm learns the length of a string while it moves";
    const ExitStatus status = runBaxter(baxter_, context, summary, report, folder);
    deliver(context, summary, report, folder);
    return status;
  }

  void addStart(CLI::App& options) {
    options.add_flag("--discrete", discrete_,
                     "double-pendulum: optimise the variational integrator's motion in steps");
    options
        .add_option("--measure-every", stepsPerSample_,
                    "with --discrete: measure after every so many steps of 0.02 s (1)")
        ->check(positive())
        ->type_name("N");
    options
        .add_option("--amplitude", amplitude_, "cart motion amplitude*(1 - cos(2 pi t/period)) [m]")
        ->check(notNegative())
        ->type_name("A");
    options.add_option("--period", period_, "its period [s]")->check(positive())->type_name("T");
    options
        .add_option("--perturb", perturb_,
                    "add a small random smooth motion to the start, of about this input "
                    "[m/s^2; with --discrete m]")
        ->check(positive())
        ->type_name("SIZE");
    options
        .add_option("--warm-start", warmStart_, "start from the input of a motion_optimised.csv")
        ->check(CLI::ExistingFile)
        ->type_name("FILE");
  }

  void addObjective(CLI::App& options) {
    options
        .add_option("--objective", objective_,
                    "weight of a criterion of the information, instead of the robot's own: e "
                    "(1/least eigenvalue), a (trace of the bound), d (-ln det), condition")
        ->type_name("NAME=W");
    options
        .add_option("--input-weight", inputWeight_,
                    "weight R of the input's departure from the start's")
        ->type_name("R");
    options.add_option("--limits", limits_, "of the input [m/s^2; with --discrete m]: LOWER UPPER")
        ->expected(2)
        ->type_name("U");
    options
        .add_option("--tolerance", tolerance_,
                    "end where no direction promises to lower the cost by more than this")
        ->check(notNegative())
        ->type_name("J");
    options.add_option("--iterations", iterations_, "of the search, at most (100)")
        ->check(notNegative())
        ->type_name("N");
    options
        .add_option("--robust", robust_,
                    "optimise the worst case or the average over several values of the parameters")
        ->check(CLI::IsMember({"worst", "average"}))
        ->type_name("RULE");
    options
        .add_option("--candidate", candidates_,
                    "with --robust: a value of both parameters, as P1 P2, in the units of the "
                    "report; repeat it (default: the model's, and each alone +-30 %)")
        ->allow_extra_args(false)
        ->type_name("P");
  }

  void addLaboratory(CLI::App& options) {
    options.add_flag("--lab", lab_,
                     "estimate from recordings of a plant with what the model has not, of usual "
                     "sizes; the options below set one size each");
    options
        .add_option("--out-of-plane", outOfPlane_,
                    "swing out of the plane: angle at the start, 3deg")
        ->type_name("ANGLE");
    const auto size = [&](const char* name, std::optional<double>& value, const char* text,
                          const char* type) {
      options.add_option(name, value, text)->type_name(type);
    };
    size("--dry-friction", dryFriction_, "moment of each joint [N m], 1e-5; suspended mass 1e-4",
         "M");
    size("--control-lag", controlLag_, "of the cart's speed [s], 0.002", "T");
    size("--control-noise", controlNoise_, "of the cart's acceleration [m/s^2], 0.05", "SD");
    size("--sensor-curvature", sensorCurvature_,
         "departure from a straight line at full range (pi/2 rad or 3 N) [1], 0.01", "B");
    size("--sensor-step", sensorStep_, "resolution [rad or N], 0.001; suspended mass 3/1024", "S");
  }

  void addJudging(CLI::App& options) {
    options.add_flag("--as-is", asIs_, "judge the start, with simulated trials; do not optimise");
    options.add_flag("--bound-only", boundOnly_, "the Cramér-Rao bound, without simulated trials");
    options
        .add_option("--unknown", unknown_,
                    "double-pendulum: m1,c (mass and damping) or m1,m2 (both masses)")
        ->check(CLI::IsMember({"m1,c", "m1,m2"}))
        ->type_name("NAMES");
    options.add_flag("--undamped", undamped_, "double-pendulum with --unknown m1,m2: no damping");
    options.add_option("--trials", trials_, "simulated experiments, each estimated (300)")
        ->check(positive())
        ->type_name("N");
    options.add_flag("--convergence", convergence_,
                     "suspended-mass: how fast three estimators converge");
  }

  // True where a motion is to be optimised.
  bool checkUse() const {
    const auto must = [](bool holds, const char* rule) {
      if (!holds) throw std::invalid_argument(rule);
    };
    must(!convergence_ || !pendulum(), "--convergence goes with suspended-mass");
    must(pendulum() || (!undamped_ && unknown_ == "m1,c"),
         "--unknown and --undamped go with double-pendulum");
    must(!undamped_ || unknown_ == "m1,m2", "--undamped goes with --unknown m1,m2");
    const bool optimise = !convergence_ && !boundOnly_ && !asIs_ && unknown_ == "m1,c";
    const bool searching = discrete_ || perturb_ || !warmStart_.empty() || !objective_.empty() ||
                           inputWeight_ || !limits_.empty() || tolerance_ || iterations_ ||
                           !robust_.empty() || effects();
    must(optimise || !searching,
         "--discrete, --perturb, --warm-start, --objective, --input-weight, --limits, "
         "--tolerance, --iterations, --robust and --lab go with optimising, without --as-is, "
         "--bound-only, --convergence and --unknown m1,m2");
    must(!discrete_ || pendulum(), "--discrete goes with double-pendulum");
    must(discrete_ || stepsPerSample_ == 1, "--measure-every goes with --discrete");
    must(!discrete_ || !effects(), "--lab and its sizes go without --discrete");
    must(candidates_.empty() || !robust_.empty(), "--candidate goes with --robust");
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
      const Assignment one = parseAssignment(text);
      if (one.name == "e")
        weights.e = one.value;
      else if (one.name == "a")
        weights.a = one.value;
      else if (one.name == "d")
        weights.d = one.value;
      else if (one.name == "condition")
        weights.condition = one.value;
      else
        throw std::invalid_argument(
            fmt::format("--objective {}: no such criterion, rule: e, a, d or condition", text));
    }
    return weights;
  }

  OptimiseRequest request() const {
    OptimiseRequest r;
    r.pendulum = pendulum();
    r.discrete = discrete_;
    r.amplitude = amplitude_;
    r.period = period_;
    r.perturb = perturb_;
    r.warmStart = warmStart_;
    r.trials = trials_;
    r.objective = objective();
    r.inputWeight = inputWeight_;
    if (!limits_.empty()) r.limits = std::pair(limits_[0], limits_[1]);
    r.tolerance = tolerance_;
    r.iterations = iterations_;
    r.stepsPerSample = stepsPerSample_;
    if (!robust_.empty())
      r.robust = robust_ == "worst" ? info::CandidateRule::worst : info::CandidateRule::average;
    for (const auto& [first, second] : candidates_) r.candidates.emplace_back(first, second);
    r.lab = effects();
    return r;
  }

  info::PlannedExperiment experiment() const {
    using info::DoublePendulumUnknowns;
    if (!pendulum())
      return info::suspendedMassExperiment(
          amplitude_ || period_
              ? info::cosineMotion(amplitude_.value_or(0.0476), period_.value_or(5), 5, 100, 1)
              : info::suspendedMassStart());
    const info::CartMotion motion =
        amplitude_ || period_
            ? info::cosineMotion(amplitude_.value_or(0.05), period_.value_or(5), 5, 30, 2)
            : info::doublePendulumStart();
    return unknown_ == "m1,c"
               ? info::doublePendulumExperiment(motion)
               : info::doublePendulumExperiment(motion, DoublePendulumUnknowns::bothMasses,
                                                undamped_ ? 0.0 : 5e-4);
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

std::unique_ptr<Command> robotCommand() {
  return std::make_unique<Robot>();
}

}  // namespace app
