#include "bio/review/model_review.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <stdexcept>

#include "bio/model/units.h"
#include "bio/muscle/curves/curves.h"
#include "model/plausible.h"
#include "skeleton/principal_moments.h"

namespace bio {
namespace {

struct Reviewer {
  const Model& model;
  std::vector<Remark> remarks;

  template <class... Args>
  void say(const std::string& subject, fmt::format_string<Args...> text, Args&&... args) {
    remarks.push_back({subject, fmt::format(text, std::forward<Args>(args)...)});
  }

  void reviewBody(const Body& body);
  void reviewEndOfChain();
  void reviewCourse(const std::string& subject, const Coordinate& coordinate);
  void reviewCoordinate(const Coordinate& coordinate);
  void reviewAxes(const Joint& joint);
  void reviewWrap(const WrapObject& wrap);
  void reviewMuscle(const Muscle& muscle);
  void reviewParameters(const std::string& subject, const SchutteParameters& p);
  void reviewCurves(const std::string& subject, const SchutteParameters& p);
  void reviewForces();
};

void Reviewer::reviewBody(const Body& body) {
  const std::string subject = fmt::format("body '{}'", body.name);
  const auto& i = body.inertia;
  const double sum = i[0] + i[1] + i[2];
  const double largest = std::max({i[0], i[1], i[2]});
  if (largest > (sum - largest) * (1 + 1e-9)) {
    say(subject,
        "moment of inertia = {:.4g} kg m², violates the triangle inequality: above the sum of the "
        "other two ({:.4g})",
        largest, sum - largest);
  }
  // Off-diagonal terms may make a matrix that no mass distribution has.
  const Eigen::Vector3d principal = principalMoments(body);
  if (hasNegativeMoment(principal)) {
    say(subject, "least principal moment of inertia = {:.4g} kg m², must be ≥ 0",
        principal.minCoeff());
    remarks.back().weight = Weight::error;
  } else if (principal(2) > (principal(0) + principal(1)) * (1 + 1e-9) &&
             largest <= (sum - largest) * (1 + 1e-9)) {
    say(subject,
        "principal moment of inertia = {:.4g} kg m², violates the triangle inequality: above the "
        "sum of the other two ({:.4g})",
        principal(2), principal(0) + principal(1));
  }
  if (body.mass > 0 && std::sqrt(largest / body.mass) > 1) {
    say(subject,
        "radius of gyration = {:.3g} m from inertia {} kg m² and mass {} kg, usually below 1 m",
        std::sqrt(largest / body.mass), largest, body.mass);
  }
  if (body.massCenter.norm() > 3) {
    say(subject, "mass centre {:.3g} m from its origin, usually below 3 m: millimetres?",
        body.massCenter.norm());
  }
  if (body.mass > 200) say(subject, "mass = {} kg, usually below 200 kg: grams?", body.mass);
}

void Reviewer::reviewEndOfChain() {
  std::set<std::string> parents;
  for (const Joint& joint : model.joints) parents.insert(joint.parentBody);
  for (const Joint& joint : model.joints) {
    const bool isFree = std::any_of(joint.coordinates.begin(), joint.coordinates.end(),
                                    [](const Coordinate& c) { return !c.locked; });
    if (!isFree || parents.contains(joint.childBody)) continue;
    if (!(findBody(model, joint.childBody).mass > 0)) {
      say(fmt::format("body '{}'", joint.childBody),
          "mass = 0 kg at the end of the chain: joint '{}' has nothing to move", joint.name);
    }
  }
}

void Reviewer::reviewCourse(const std::string& subject, const Coordinate& coordinate) {
  if (coordinate.prescribed && coordinate.locked) {
    say(subject, "is prescribed and locked: it is locked, as in OpenSim");
  }
  if (!coordinate.isPrescribed() || !coordinate.prescribedFunction) return;
  const Function& course = *coordinate.prescribedFunction;
  if (std::holds_alternative<PiecewiseLinearFunction>(course.shape)) {
    say(subject,
        "its prescribed_function has corners, where the speed jumps: the reaction does not show "
        "these impacts");
  }
  try {
    const double first = FunctionEvaluator(course).evaluate(0).value;
    if (coordinate.isRotation && std::abs(first) > degreesBeyond) {
      say(subject, "its prescribed_function is {:.4g} rad at 0 s, usually within ±4π: degrees?",
          first);
    }
  } catch (const std::invalid_argument& error) {
    say(subject, "its prescribed_function: {}", error.what());
    remarks.back().weight = Weight::error;
  }
}

void Reviewer::reviewCoordinate(const Coordinate& coordinate) {
  const std::string subject = fmt::format("coordinate '{}'", coordinate.name);
  const double encompassing =
      std::max(std::abs(coordinate.rangeMin), std::abs(coordinate.rangeMax));
  if (coordinate.isRotation && encompassing > degreesBeyond) {
    say(subject, "range = {} to {} rad, usually within ±4π: degrees?", coordinate.rangeMin,
        coordinate.rangeMax);
  }
  if (coordinate.isRotation && std::abs(coordinate.defaultValue) > degreesBeyond) {
    say(subject, "default = {} rad, usually within ±4π: degrees?", coordinate.defaultValue);
  }
  const double slack = 1e-6;
  if (coordinate.defaultValue < coordinate.rangeMin - slack ||
      coordinate.defaultValue > coordinate.rangeMax + slack) {
    say(subject, "default = {}, outside its range {} to {}", coordinate.defaultValue,
        coordinate.rangeMin, coordinate.rangeMax);
  }
  reviewCourse(subject, coordinate);
  if (coordinate.clamped && !coordinate.isPrescribed() && !coordinate.locked) {
    say(subject, "is clamped, but the simulation does not stop it at the ends of its range");
  }
}

void Reviewer::reviewAxes(const Joint& joint) {
  if (joint.kind != JointKind::custom) return;
  for (std::size_t i = 0; i < 6; ++i) {
    const double length = joint.axes[i].axis.norm();
    if (std::abs(length - 1) > 1e-3 && !joint.axes[i].coordinate.empty()) {
      say(fmt::format("joint '{}'", joint.name), "axis {} has length {:.4g}, usually 1", i + 1,
          length);
    }
  }
}

void Reviewer::reviewWrap(const WrapObject& wrap) {
  if (sizeOf(wrap) > largestWrap) {
    say(fmt::format("wrap object '{}'", wrap.name),
        "radius = {} m, usually below {} m: millimetres?", sizeOf(wrap), largestWrap);
  }
}

void Reviewer::reviewMuscle(const Muscle& muscle) {
  const std::string subject = fmt::format("muscle '{}'", muscle.name);
  for (const PathPoint& point : muscle.path.points) {
    if (point.location.norm() > 3) {
      say(subject, "point '{}' is {:.3g} m from its body's origin, usually below 3 m: millimetres?",
          point.name, point.location.norm());
    }
    if (point.condition && std::max(std::abs(point.condition->lower),
                                    std::abs(point.condition->upper)) > degreesBeyond) {
      say(subject, "point '{}' is active from {} to {} rad, usually within ±4π: degrees?",
          point.name, point.condition->lower, point.condition->upper);
    }
  }
  const std::vector<PathPoint>& points = muscle.path.points;
  const bool atOnePlace =
      !points.empty() && std::all_of(points.begin(), points.end(), [&](const PathPoint& p) {
        return !p.motion && p.body == points.front().body &&
               (p.location - points.front().location).norm() < shortestPath;
      });
  if (atOnePlace) say(subject, "all its points coincide: its path has no length");
  if (muscle.schutte) {
    reviewParameters(subject, *muscle.schutte);
    reviewCurves(subject, *muscle.schutte);
  }
}

void Reviewer::reviewParameters(const std::string& subject, const SchutteParameters& p) {
  if (p.maxIsometricForce < 1 || p.maxIsometricForce > 20000) {
    say(subject, "maximum isometric force = {} N, usually 1 to 20000 N", p.maxIsometricForce);
  }
  if (p.optimalFibreLength < 0.005 || p.optimalFibreLength > 0.6) {
    say(subject, "optimal fibre length = {} m, usually 0.005 to 0.6 m", p.optimalFibreLength);
  }
  const double ratio = p.tendonSlackLength / p.optimalFibreLength;
  if (ratio < 0.1 || ratio > 15) {
    say(subject, "tendon slack length / optimal fibre length = {:.3g}, usually 0.1 to 15", ratio);
  }
  if (p.pennation > std::numbers::pi / 4) {
    say(subject, "pennation = {} rad, usually below π/4: degrees?", p.pennation);
  }
  if (p.timeScale < 0.01 || p.timeScale > 1) {
    say(subject, "time scale = {} s, usually 0.01 to 1 s", p.timeScale);
  }
  if (p.damping > 1) say(subject, "damping = {}, usually below 1", p.damping);
}

void Reviewer::reviewCurves(const std::string& subject, const SchutteParameters& p) {
  const auto falls = [](const SplineFunction& curve) {
    return !std::is_sorted(curve.y.begin(), curve.y.end());
  };
  const auto least = [](const SplineFunction& curve) {
    return *std::min_element(curve.y.begin(), curve.y.end());
  };
  if (falls(p.tendonForceLength))
    say(subject, "the tendon curve falls somewhere, usually it rises");
  if (p.passiveForceLength && falls(*p.passiveForceLength)) {
    say(subject, "the passive curve falls somewhere, usually it rises");
  }
  if (least(p.tendonForceLength) < 0 || least(p.activeForceLength) < 0 ||
      (p.passiveForceLength && least(*p.passiveForceLength) < 0)) {
    say(subject, "a curve has a value below 0, usually muscle forces pull");
  }
  const auto& active = p.activeForceLength;
  const auto peak = std::max_element(active.y.begin(), active.y.end());
  const double at = active.x[static_cast<std::size_t>(peak - active.y.begin())];
  if (std::abs(*peak - 1) > 0.1 || std::abs(at - 1) > 0.2) {
    say(subject, "the active curve peaks with {} at {}, usually with 1 at 1", *peak, at);
  }
}

void Reviewer::reviewForces() {
  for (const CoordinateLimitForce& force : model.limitForces) {
    const double limit = std::max(std::abs(force.upperLimit), std::abs(force.lowerLimit));
    if (findCoordinate(model, force.coordinate).isRotation && limit < 0.1 && limit > 0) {
      say(fmt::format("force '{}'", force.name),
          "limits within {:.3g} deg of 0, usually wider: written in radians?",
          limit * degreesPerRadian);
    }
  }
  for (const SpringGeneralizedForce& force : model.springForces) {
    const std::string subject = fmt::format("force '{}'", force.name);
    if (findCoordinate(model, force.coordinate).isRotation &&
        std::abs(force.restLength) > degreesBeyond) {
      say(subject, "rest length = {} rad, usually within ±4π: degrees?", force.restLength);
    }
    if (force.stiffness < 0) say(subject, "stiffness = {}, usually ≥ 0", force.stiffness);
  }
}

}  // namespace

std::vector<Remark> reviewNumbers(const Model& model) {
  Reviewer reviewer{model, {}};
  bool anyFree = false;
  for (const Body& body : model.bodies) reviewer.reviewBody(body);
  for (const Joint& joint : model.joints) {
    reviewer.reviewAxes(joint);
    for (const Coordinate& coordinate : joint.coordinates) {
      anyFree = anyFree || !coordinate.locked;
      reviewer.reviewCoordinate(coordinate);
    }
  }
  reviewer.reviewEndOfChain();
  for (const WrapObject& wrap : model.wrapObjects) reviewer.reviewWrap(wrap);
  for (const Muscle& muscle : model.muscles) reviewer.reviewMuscle(muscle);
  reviewer.reviewForces();
  if (model.muscles.empty()) reviewer.say("model", "has no muscle");
  if (!anyFree) reviewer.say("model", "has no free coordinate: nothing can move");
  const double g = model.gravity.norm();
  if (g > 0 && std::abs(g - 9.81) > 0.1) {
    reviewer.say("model", "gravity = {} m/s², usually 9.81 or 0", g);
  }
  return std::move(reviewer.remarks);
}

}  // namespace bio
