#pragma once

#include <string>
#include <vector>

#include "info/design/trajectory_search.h"
#include "robots/compliant_arm.h"

/// The task of chapter 6 of Wilson's thesis: swing a ball on a string over the edge of a box, with
/// a plan for a string length that may be wrong.
namespace info {

/// A box open at the top, to the left of the gripper; x to the right and z up from the gripper's
/// zero [m]. The ball is a point.
struct Box {
  double wall = -0.45;    ///< x of the near wall
  double opening = 0.25;  ///< > 0; the far wall is at wall − opening
  double edge = -0.30;    ///< z of the walls' upper edges, < 0
};

/// Options of the plan of a swing.
struct SwingOptions {
  double timeStep = 0.02;       ///< [s] > 0
  double crossing = 3.4;        ///< time at which the ball shall be above the near edge [s]
  double duration = 4.0;  ///< time at which the ball shall be at rest in the box [s] > crossing
  double clearance = 0.01;      ///< above the edge [m] ≥ 0
  double largestInput = 6;      ///< |u| < [m/s²] > 0
  double inputWeight = 1e-2;    ///< R of the effort, > 0
  double crossingWeight = 1e6;  ///< of gripper and angle at the crossing, > 0
  double endWeight = 1e3;       ///< of the state at the end, ≥ 0
  double mass = 0.2;            ///< [kg]; the motion does not depend on it
};

/// The plan of a swing: accelerations of the gripper at nodes, linear in between.
struct SwingPlan {
  double timeStep;
  std::vector<double> acceleration;  ///< [m/s²]
  SearchResult search;
  double crossingError;  ///< distance of the planned ball from its crossing point [m]
};

/// Plans by the discrete projection-operator search (discrete_projection.h): least effort, with the
/// ball `clearance` above the near edge at `crossing` and at rest in the middle of the box at the
/// end. Not converging is a result.
/// @param length ℓ assumed by the plan [m], longer than the depth of the edge below the gripper
/// @throws std::domain_error naming the violated rule, such as a string too short to clear the edge
SwingPlan planSwing(double length, const Box& box = {}, const SwingOptions& options = {});

/// The executed swing, every 5 ms, up to a collision of the ball with the near wall.
struct SwingRun {
  std::vector<double> time, gripper, ballX, ballZ;
  bool success;
  double crossingHeight;  ///< z of the ball at its first crossing of the near wall, relative to the
                          ///< edge [m]
  std::string why;        ///< the outcome in words
};

/// Executes a plan open loop on a compliant arm with a string of the true length. The geometric
/// criterion of success: the ball passes over the near edge, not over the far one, and sinks below
/// the edges in between; the walls then hold it. The simulation lasts one second longer than the
/// plan.
SwingRun executeSwing(const SwingPlan& plan, double trueLength, const Box& box = {},
                      const SystemOptions& arm = {.start = 0}, double mass = 0.2);

/// Whether a path (x, z) of the ball, given point by point, ends in the box; see executeSwing.
struct BoxVerdict {
  bool inside;
  double crossingHeight;
  std::string why;
};
BoxVerdict judge(const std::vector<double>& x, const std::vector<double>& z, const Box& box);

}  // namespace info
