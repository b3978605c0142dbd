#pragma once

#include <string>
#include <vector>

#include "info/design/trajectory_search.h"
#include "robots/compliant_arm.h"

/// Chapter 6's task: swing a ball on a string over the edge of a box, with a plan made from a
/// length that may be wrong.
namespace info {

/// A box open at the top, to the left of the gripper; x to the right and z up from the gripper's
/// zero [m]. The ball is a point.
struct Box {
  double wall = -0.45;    ///< x of the near wall
  double opening = 0.25;  ///< > 0; the far wall is at wall − opening
  double edge = -0.30;    ///< z of the walls' upper edges, < 0
};

/// How the swing is planned.
struct SwingOptions {
  double timeStep = 0.02;       ///< [s] > 0
  double crossing = 3.4;        ///< when the ball is to be over the near edge [s]
  double duration = 4.0;        ///< when all is to be at rest in the box [s] > crossing
  double clearance = 0.01;      ///< above the edge [m] ≥ 0
  double largestInput = 6;      ///< |u| < [m/s²] > 0
  double inputWeight = 1e-2;    ///< R of the effort, > 0
  double crossingWeight = 1e6;  ///< of gripper and angle at the crossing, > 0
  double endWeight = 1e3;       ///< of the state at the end, ≥ 0
  double mass = 0.2;            ///< [kg]; the motion does not depend on it
};

/// A swing as planned: accelerations of the gripper at nodes, linear in between.
struct SwingPlan {
  double timeStep;
  std::vector<double> acceleration;  ///< [m/s²]
  SearchResult search;
  double crossingError;  ///< how far the planned ball is from its crossing point [m]
};

/// Plans by the discrete projection-operator search (discrete_projection.h): least effort, with the
/// ball `clearance` above the near edge at `crossing` and at rest in the middle of the box at the
/// end. Not converging is a result.
/// @param length ℓ the plan believes in [m], longer than the edge is low
/// @throws std::domain_error naming a broken rule, such as a string too short to clear the edge
SwingPlan planSwing(double length, const Box& box = {}, const SwingOptions& options = {});

/// A swing as it went, every 5 ms, to where the ball meets the near wall if it does.
struct SwingRun {
  std::vector<double> time, gripper, ballX, ballZ;
  bool success;
  double
      crossingHeight;  ///< z of the ball over the near wall, first time, relative to the edge [m]
  std::string why;     ///< what became of the ball
};

/// Executes a plan open loop on an arm that lags and a ball on a string of the true length, and
/// judges by geometry: the ball must pass over the near edge, not over the far one, and sink below
/// the edges in between; walls keep it there. One second more than the plan is watched.
SwingRun executeSwing(const SwingPlan& plan, double trueLength, const Box& box = {},
                      const SystemOptions& arm = {.start = 0}, double mass = 0.2);

/// Whether a path (x, z) of the ball, point after point, ends in the box; see executeSwing.
struct BoxVerdict {
  bool inside;
  double crossingHeight;
  std::string why;
};
BoxVerdict judge(const std::vector<double>& x, const std::vector<double>& z, const Box& box);

}  // namespace info
