#pragma once

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "second_ways/simbody_tree.h"

/// The equations of motion of a robot by hand, from the numbers of its description: the second way
/// to what the translators make. Nothing of it is shared with them.
namespace hand {

using Eigen::Matrix3d;
using Eigen::Vector3d;

inline Matrix3d turn(const Vector3d& axis, double angle) {
  return Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix();
}
/// About fixed axes: roll about x, then pitch about y, then yaw about z.
inline Matrix3d rollPitchYaw(double roll, double pitch, double yaw) {
  return turn(Vector3d::UnitZ(), yaw) * turn(Vector3d::UnitY(), pitch) *
         turn(Vector3d::UnitX(), roll);
}

struct Motion {
  std::string name;
  bool turns;
  Vector3d axis;                       ///< in the body, of any length
  Vector3d anchor = Vector3d::Zero();  ///< in the body
  double zero = 0;
};

struct Link {
  int parent;  ///< −1: the ground
  Vector3d p;  ///< in the parent, where all motions displace nothing
  Matrix3d R;
  std::vector<Motion> motions;
  double mass = 0;
  Vector3d center = Vector3d::Zero();   ///< in the link
  Matrix3d inertia = Matrix3d::Zero();  ///< about the centre, in axes of the link
};

struct Dynamics {
  Eigen::MatrixXd mass;
  Eigen::VectorXd gravity;
};

/// Σ over bodies of m JᵥᵀJᵥ + JωᵀIJω and m Jᵥᵀg; coordinates in the order of links and motions.
inline Dynamics dynamics(const std::vector<Link>& links, const Vector3d& g,
                         const std::map<std::string, double>& q) {
  struct Moving {
    bool turns;
    Vector3d axis, point;  ///< in the ground
  };
  struct Placed {
    Matrix3d R;
    Vector3d p;
    std::vector<std::size_t> movedBy;
  };
  std::vector<Moving> moving;
  std::vector<Placed> placed;
  for (const Link& link : links) {
    Placed at{Matrix3d::Identity(), Vector3d::Zero(), {}};
    if (link.parent >= 0) at = placed[static_cast<std::size_t>(link.parent)];
    at.p += at.R * link.p;
    at.R = (at.R * link.R).eval();
    for (const Motion& motion : link.motions) {
      const double value = q.at(motion.name) - motion.zero;
      const Vector3d axis = at.R * motion.axis.normalized();
      const Vector3d point = at.p + at.R * motion.anchor;
      at.movedBy.push_back(moving.size());
      moving.push_back({motion.turns, axis, point});
      if (motion.turns) {
        const Matrix3d T = turn(axis, value);
        at.R = (T * at.R).eval();
        at.p = point + T * (at.p - point);
      } else {
        at.p += axis * value;
      }
    }
    placed.push_back(at);
  }
  const auto n = static_cast<Eigen::Index>(moving.size());
  Dynamics sum{Eigen::MatrixXd::Zero(n, n), Eigen::VectorXd::Zero(n)};
  for (std::size_t i = 0; i < links.size(); ++i) {
    const Vector3d center = placed[i].p + placed[i].R * links[i].center;
    Eigen::MatrixXd Jv = Eigen::MatrixXd::Zero(3, n), Jw = Jv;
    for (const std::size_t k : placed[i].movedBy) {
      const auto column = static_cast<Eigen::Index>(k);
      const Moving& m = moving[k];
      Jv.col(column) = m.turns ? m.axis.cross(center - m.point).eval() : m.axis;
      if (m.turns) Jw.col(column) = m.axis;
    }
    const Matrix3d I = placed[i].R * links[i].inertia * placed[i].R.transpose();
    sum.mass += links[i].mass * Jv.transpose() * Jv + Jw.transpose() * I * Jw;
    sum.gravity += links[i].mass * Jv.transpose() * g;
  }
  return sum;
}

/// Mass matrix and gravity of a model by Simbody, rows in the order of the links' motions; those
/// that follow others are left out.
inline Dynamics dynamics(const bio::Model& model, const std::vector<Link>& links,
                         const std::map<std::string, double>& q) {
  std::vector<std::string> names;
  for (const Link& link : links) {
    for (const Motion& motion : link.motions) names.push_back(motion.name);
  }
  const bio::SimbodyTree::Dynamics found = bio::SimbodyTree(model).reducedTo(names, q);
  return {found.massMatrix, found.gravityForce};
}

/// Mass matrix, gravity's moments and accelerations at rest of a model by Simbody are those by
/// hand.
inline void expectTheSame(const bio::Model& model, const std::vector<Link>& links,
                          const std::map<std::string, double>& q) {
  const Dynamics expected = dynamics(links, model.gravity, q), found = dynamics(model, links, q);
  // measured 1e-15, 4e-15 and 3e-13
  EXPECT_LT((found.mass - expected.mass).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_LT((found.gravity - expected.gravity).cwiseAbs().maxCoeff(), 1e-11);
  const Eigen::VectorXd acceleration = expected.mass.ldlt().solve(expected.gravity);
  EXPECT_LT((found.mass.ldlt().solve(found.gravity) - acceleration).cwiseAbs().maxCoeff(), 1e-9);
}

/// A value within ±most for every motion.
inline std::map<std::string, double> drawnPosture(const std::vector<Link>& links, double most,
                                                  std::mt19937& random) {
  std::uniform_real_distribution<double> value(-most, most);
  std::map<std::string, double> q;
  for (const Link& link : links)
    for (const Motion& motion : link.motions) q[motion.name] = value(random);
  return q;
}

/// expectTheSame at eight postures.
inline void expectTheSame(const bio::Model& model, const std::vector<Link>& links, double most,
                          unsigned seed = 4) {
  std::mt19937 random(seed);
  for (int posture = 0; posture < 8; ++posture)
    expectTheSame(model, links, drawnPosture(links, most, random));
}

/// The accelerations M⁻¹(τ − ½Ṁq̇ …) of a motion: gravity less the forces of speed, which are
/// d(M q̇)/dt − ½ ∂(q̇ᵀMq̇)/∂q by central differences.
template <class MassMatrix>
Eigen::VectorXd accelerations(const MassMatrix& massAt, const Eigen::VectorXd& gravity,
                              const Eigen::VectorXd& q, const Eigen::VectorXd& v) {
  const double h = 1e-5;
  const Eigen::Index n = q.size();
  Eigen::VectorXd rest = gravity - (massAt(q + h * v) - massAt(q - h * v)) * v / (2 * h);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Eigen::VectorXd e = Eigen::VectorXd::Unit(n, i) * h;
    rest[i] += 0.5 * v.dot((massAt(q + e) - massAt(q - e)) * v) / (2 * h);
  }
  return massAt(q).ldlt().solve(rest);
}

}  // namespace hand
