#include "robots/box_task.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "info/design/discrete_projection.h"
#include "info/dynamics/free_parameters.h"
#include "info/dynamics/integrate.h"

namespace info {
namespace {

using Length = FreeParameters<SuspendedMass, 1>;

void check(double length, const Box& box, const SwingOptions& o) {
  const auto rule = [](const char* what, double value, const char* unit, bool good,
                       const std::string& text) {
    if (!good || !std::isfinite(value))
      throw std::domain_error(
          fmt::format("swing, {}: {} {}, must be {} and finite", what, value, unit, text));
  };
  rule("edge of the box", box.edge, "m", box.edge < 0, "< 0");
  rule("wall of the box", box.wall, "m", true, "any");
  rule("opening of the box", box.opening, "m", box.opening > 0, "> 0");
  rule("clearance", o.clearance, "m", o.clearance >= 0, "≥ 0");
  rule("string", length, "m", length > -box.edge - o.clearance,
       fmt::format("> {} (else the ball hangs above the edge)", -box.edge - o.clearance));
  rule("time step", o.timeStep, "s", o.timeStep > 0, "> 0");
  rule("crossing", o.crossing, "s", o.crossing >= o.timeStep, "≥ time step");
  rule("duration", o.duration, "s", o.duration > o.crossing, "> crossing");
  rule("largest input", o.largestInput, "m/s²", o.largestInput > 0, "> 0");
  rule("input weight", o.inputWeight, "", o.inputWeight > 0, "> 0");
  rule("crossing weight", o.crossingWeight, "", o.crossingWeight > 0, "> 0");
  rule("end weight", o.endWeight, "", o.endWeight >= 0, "≥ 0");
}

// A ball that meets the near wall from outside ends there; what was recorded after is no motion.
void stopAtTheWall(SwingRun& run, const Box& box) {
  for (std::size_t k = 1; k < run.time.size(); ++k)
    if (run.ballX[k - 1] > box.wall && run.ballX[k] <= box.wall && run.ballZ[k] < box.edge) {
      for (std::vector<double>* column : {&run.time, &run.gripper, &run.ballX, &run.ballZ})
        column->resize(k);
      return;
    } else if (run.ballX[k] <= box.wall) {
      return;
    }
}

}  // namespace

SwingPlan planSwing(double length, const Box& box, const SwingOptions& o) {
  check(length, box, o);
  const auto steps = static_cast<std::size_t>(std::lround(o.duration / o.timeStep));
  const auto crossing = static_cast<std::size_t>(std::lround(o.crossing / o.timeStep));

  StepDesign design;
  design.timeStep = o.timeStep;
  design.x0 = Eigen::VectorXd::Zero(4);
  design.desiredInput.assign(steps + 1, Eigen::VectorXd::Zero(1));
  design.outputCovariance = Eigen::MatrixXd::Identity(1, 1);
  design.inputWeight = design.modelInput = Eigen::MatrixXd::Constant(1, 1, o.inputWeight);
  design.modelState = Eigen::MatrixXd::Zero(9, 9);
  design.gainState = Eigen::MatrixXd::Identity(5, 5);
  design.gainInput = Eigen::MatrixXd::Identity(1, 1);
  design.limits = {Eigen::VectorXd::Constant(1, -o.largestInput),
                   Eigen::VectorXd::Constant(1, o.largestInput), 1e-3};

  // over the edge: −ℓ cos φ = edge + clearance, x − ℓ sin φ = wall
  const double angle = std::acos(-(box.edge + o.clearance) / length);
  const Eigen::Vector4d over(box.wall + length * std::sin(angle), angle, 0, 0);
  const Eigen::Vector4d in(box.wall - 0.5 * box.opening, 0, 0, 0);
  design.waypoints = {
      {crossing, over,
       Eigen::Vector4d(o.crossingWeight, o.crossingWeight * length * length, 0, 0).asDiagonal()},
      {steps, in, (o.endWeight * Eigen::Vector4d(1, 0.1, 0.1, 0.01)).asDiagonal()}};

  StepProjection projection(
      extend(Rk4<Length>{Length{{}, {o.mass, length}}, o.timeStep}, Vector<double, 1>(length)),
      design);
  SwingPlan plan{o.timeStep, {}, {}, 0};
  plan.search = search(projection, {.maxIterations = 200, .slopeTolerance = 1e-6});
  for (const Eigen::VectorXd& u : projection.motion().u) plan.acceleration.push_back(u[0]);
  const Eigen::VectorXd& at = projection.motion().x[crossing];
  plan.crossingError = std::hypot(at[0] - length * std::sin(at[1]) - box.wall,
                                  -length * std::cos(at[1]) - box.edge - o.clearance);
  return plan;
}

BoxVerdict judge(const std::vector<double>& x, const std::vector<double>& z, const Box& box) {
  const double far = box.wall - box.opening;
  BoxVerdict out{false, std::numeric_limits<double>::quiet_NaN(), ""};
  for (std::size_t k = 1; k < x.size(); ++k) {
    const bool over = x[k] <= box.wall && x[k] > far;
    if (over && x[k - 1] > box.wall) {
      const double share = (box.wall - x[k - 1]) / (x[k] - x[k - 1]);
      const double height = z[k - 1] + share * (z[k] - z[k - 1]) - box.edge;
      if (std::isnan(out.crossingHeight)) out.crossingHeight = height;
      if (!(height > 0)) {
        out.why = fmt::format("hits the near wall {:.1f} cm below its edge", -100 * height);
        return out;
      }
    }
    if (over && z[k] < box.edge) {
      out.inside = true;
      out.why = "in the box";
      return out;
    }
    if (x[k] <= far) {
      out.why = "flies over the far wall";
      return out;
    }
  }
  out.why = std::isnan(out.crossingHeight) ? "never reaches the box" : "leaves the box again";
  return out;
}

SwingRun executeSwing(const SwingPlan& plan, double trueLength, const Box& box,
                      const SystemOptions& arm, double mass) {
  CompliantArm robot(arm, {}, {.acceleration = 0}, Vector<double, 2>(mass, trueLength), 1, 0);
  SwingRun run{};
  std::vector<double> ballX, ballZ;
  const double end = plan.timeStep * static_cast<double>(plan.acceleration.size() - 1);
  const long ticks = std::lround((end + 1) / CompliantArm::tick);
  for (long k = 0; k <= ticks; ++k) {
    const double x = robot.state()[0], angle = robot.state()[1];
    ballX.push_back(x - trueLength * std::sin(angle));
    ballZ.push_back(-trueLength * std::cos(angle));
    if (k % 5 == 0) {
      run.time.push_back(robot.time());
      run.gripper.push_back(x);
      run.ballX.push_back(ballX.back());
      run.ballZ.push_back(ballZ.back());
    }
    // linear between the plan's nodes, taken at the middle of the tick; zero after it
    const double at = (robot.time() + 0.5 * CompliantArm::tick) / plan.timeStep;
    const auto node = static_cast<std::size_t>(at);
    double command = 0;
    if (node + 1 < plan.acceleration.size()) {
      const double share = at - static_cast<double>(node);
      command = (1 - share) * plan.acceleration[node] + share * plan.acceleration[node + 1];
    }
    robot.advance(command);
  }
  const BoxVerdict verdict = judge(ballX, ballZ, box);
  stopAtTheWall(run, box);
  run.success = verdict.inside;
  run.crossingHeight = verdict.crossingHeight;
  run.why = verdict.why;
  return run;
}

}  // namespace info
