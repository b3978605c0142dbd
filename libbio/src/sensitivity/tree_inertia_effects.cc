#include "sensitivity/tree_inertia_effects.h"

#include <algorithm>

namespace bio::stepping {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Mass, first and second moments in a segment's frame as an inertia in the ground.
SpatialInertia<double> momentsInGround(const Segment& moments, const Placement<double>& X) {
  SpatialInertia<double> I;
  const Vector3d turned = X.R * moments.massMoment;
  const Matrix3d second = X.R * moments.secondMoment * X.R.transpose() + turned * X.p.transpose() +
                          X.p * turned.transpose() + moments.mass * X.p * X.p.transpose();
  const Matrix3d J = second.trace() * Matrix3d::Identity() - second;
  I.mass = moments.mass;
  I.massMoment = turned + moments.mass * X.p;
  I.J = {J(0, 0), J(1, 1), J(2, 2), J(0, 1), J(0, 2), J(1, 2)};
  return I;
}

/// Mobilities from the ground to a segment, inside out.
std::vector<std::size_t> mobilitiesTo(const ArticulatedTree& tree, int segment) {
  std::vector<std::size_t> way;
  for (int m = tree.mobilityOf(segment); m >= 0;) {
    way.push_back(static_cast<std::size_t>(m));
    m = tree.mobilities()[static_cast<std::size_t>(m)].parent;
  }
  std::reverse(way.begin(), way.end());
  return way;
}

Vector3d linearPart(const SpatialVector<double>& h) {
  return {h[3], h[4], h[5]};
}

void addSegment(const ArticulatedTree& tree, const TreeMotion<double>& motion, int segment,
                const SpatialInertia<double>& change, const Eigen::VectorXd& v, Eigen::Index column,
                TreeRows& momentum, TreeRows& slope) {
  const std::vector<std::size_t> way = mobilitiesTo(tree, segment);
  SpatialVector<double> V = SpatialVector<double>::Zero();
  std::vector<SpatialVector<double>> b;
  for (const std::size_t m : way) {
    const double v_k = v[tree.mobilities()[m].coordinate];
    SpatialVector<double> bent = crossMotion(motion.screw[m], V);
    for (int i = 0; i < 6; ++i) bent[i] -= motion.screw1[m][i] * v_k;
    b.push_back(bent);
    for (int i = 0; i < 6; ++i) V[i] += motion.screw[m][i] * v_k;
  }
  const SpatialVector<double> H = change * V;
  for (std::size_t j = 0; j < way.size(); ++j) {
    const SpatialVector<double>& S = motion.screw[way[j]];
    const int k = tree.mobilities()[way[j]].coordinate;
    momentum(k, column) += dot(S, H);
    slope(k, column) += tree.gravity().dot(linearPart(change * S)) - dot(b[j], H);
  }
}

}  // namespace

void addTreeInertia(const MusculoskeletalSystem& system,
                    const SystemConfiguration<Eigen::Dynamic>& configuration,
                    const ParameterEffects& effects, const Eigen::VectorXd& v, TreeRows& momentum,
                    TreeRows& slope) {
  const ArticulatedTree& tree = *system.tree();
  const TreeMotion<double>& motion = configuration.motion();
  for (const auto& effect : effects.segments) {
    addSegment(tree, motion, configuration.places().segmentOf(effect.segment),
               momentsInGround(effect.change, configuration.placement(effect.segment)), v,
               effect.column, momentum, slope);
  }
  for (const QuantityEffect& effect : effects.gravity) {
    for (int s = 1; s < tree.numMassSegments(); ++s) {
      const TreeSegment& segment = tree.segments()[static_cast<std::size_t>(s)];
      const SpatialInertia<double> I =
          inertiaInGround(motion.segments[static_cast<std::size_t>(s)], segment.mass,
                          segment.massCenter, segment.inertia);
      for (const std::size_t m : mobilitiesTo(tree, s)) {
        slope(tree.mobilities()[m].coordinate, effect.column) +=
            effect.factor *
            linearPart(I * motion.screw[m])[static_cast<Eigen::Index>(effect.quantity)];
      }
    }
  }
}

}  // namespace bio::stepping
