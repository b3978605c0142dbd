#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "discovery/effects/effects.h"

// An elastic band. Priors: bands of physiotherapy, some ten to a few hundred N/m, as long at rest
// as they are put on without force.
//
// No band is drawn out to more than six times its length at rest: natural rubber breaks at
// elongations of 500 to 800 %, bands are measured up to 250 % (Page, Labbe & Topp 2000). It
// matters: a spring without any length at rest pulls in proportion to the sine of the joint's
// angle, just as a weight does.

namespace bio::discover {
namespace {

using Eigen::Vector3d;

constexpr double kMostDrawn = 6;

/// The body that the joint of the coordinate hangs on; empty: it is coupled to another joint.
std::string parentOf(const EncompassingModel& model) {
  for (const Joint& joint : model.base().joints) {
    for (const Coordinate& coordinate : joint.coordinates) {
      if (coordinate.name == model.coordinate().name) return joint.parentBody;
    }
  }
  return {};
}

}  // namespace

// Where the joint is a plain hinge L² = A + B cos q + C sin q.
void addElasticBand(EncompassingModel& model) {
  const std::string parent = parentOf(model);
  if (parent.empty() || model.movedBodies().empty() || !model.hasOneCoordinate()) return;
  const std::string& hand = model.movedBodies().back();
  const Vector3d center = findBody(model.base(), hand).massCenter;
  const auto squaredLength = [&](double q) {
    const Vector3d anchor = model.positionOf(parent, Vector3d::Zero(), q);
    return (model.positionOf(hand, center, q) - anchor).squaredNorm();
  };
  const double half = std::numbers::pi / 2;
  const double A = (squaredLength(0) + squaredLength(2 * half)) / 2;
  const double B = squaredLength(0) - A, C = squaredLength(half) - A;
  for (const double q : {0.7, 1.9}) {
    const double hinge = A + B * std::cos(q) + C * std::sin(q);
    if (std::abs(squaredLength(q) - hinge) > 1e-9 * A) return;
  }
  if (!(std::hypot(B, C) > 1e-3 * A)) return;  // anchored on the axis: it pulls nowhere
  const Coordinate& q = model.coordinate();
  const double atLower = std::sqrt(squaredLength(q.rangeMin)),
               atUpper = std::sqrt(squaredLength(q.rangeMax)),
               longest = std::sqrt(A + std::hypot(B, C)), least = longest / kMostDrawn,
               shortest = std::max(least, std::min(atLower, atUpper));
  const double size = heaviness(model), start = 20 * size;
  const std::string length =
      fmt::format("sqrt({:.17g}+({:.17g})*cos(q)+({:.17g})*sin(q))", A, B, C);
  const std::string slope = fmt::format("(({:.17g})*cos(q)-({:.17g})*sin(q))/(2*{})", C, B, length);
  addExpression(
      model, model.coordinates().front(),
      {"spring",
       "elastic band",
       fmt::format("An elastic band pulls the {} towards the near end of the {}.", hand, parent),
       fmt::format("-k*max({}-rest,0)*{}", length, slope),
       {"k", "rest"},
       {amplitude("spring.stiffness", "N/m", 0, 1000 * size, 50 * size),
        shape("spring.rest", "m", shortest, least, longest, 0.3 * longest)},
       {{start, std::max(least, 0.5 * shortest)},
        {start, shortest},
        {start, (shortest + longest) / 2}}});
}

}  // namespace bio::discover
