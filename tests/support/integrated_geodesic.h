#pragma once

#include <cmath>

#include "bio/path/surface/chain.h"

/// The geodesic equations by a plain fourth-order Runge–Kutta rule: another way than the solver's.
namespace support {

struct WalkedPoint {
  Eigen::Vector3d x, u;
};

/// Along an ellipsoid: x″ = −(uᵀAu/|Ax|²) Ax in space.
inline WalkedPoint walkEllipsoid(const Eigen::Vector3d& semiAxes, WalkedPoint p, double s,
                                 int steps) {
  const Eigen::Array3d A = semiAxes.array().square().inverse();
  const auto bend = [&](const Eigen::Vector3d& x, const Eigen::Vector3d& u) {
    const Eigen::Array3d g = A * x.array();
    return Eigen::Vector3d((-(A * u.array().square()).sum() / g.square().sum()) * g);
  };
  const double h = s / steps;
  for (int i = 0; i < steps; ++i) {
    const Eigen::Vector3d f1 = bend(p.x, p.u);
    const Eigen::Vector3d u2 = p.u + 0.5 * h * f1;
    const Eigen::Vector3d f2 = bend(p.x + 0.5 * h * p.u, u2);
    const Eigen::Vector3d u3 = p.u + 0.5 * h * f2;
    const Eigen::Vector3d f3 = bend(p.x + 0.5 * h * u2, u3);
    const Eigen::Vector3d u4 = p.u + h * f3;
    const Eigen::Vector3d f4 = bend(p.x + h * u3, u4);
    p.x += h / 6 * (p.u + 2 * u2 + 2 * u3 + u4);
    p.u += h / 6 * (f1 + 2 * f2 + 2 * f3 + f4);
  }
  return p;
}

/// Along a torus, in its two angles: ψ round the ring, φ round the tube, ρ = R + r cos φ,
///     φ″ = −ρ sin φ ψ′²/r,   ψ″ = 2 r sin φ φ′ψ′/ρ
inline WalkedPoint walkTorus(double ring, double tube, const WalkedPoint& start, double s,
                             int steps) {
  const double rho0 = std::hypot(start.x[0], start.x[1]);
  const Eigen::Vector3d along(-start.x[1] / rho0, start.x[0] / rho0, 0);
  const double cos0 = (rho0 - ring) / tube, sin0 = start.x[2] / tube;
  const Eigen::Vector3d up(-sin0 * start.x[0] / rho0, -sin0 * start.x[1] / rho0, cos0);
  // angles and their rates
  Eigen::Array4d y(std::atan2(start.x[1], start.x[0]), std::atan2(sin0, cos0),
                   start.u.dot(along) / rho0, start.u.dot(up) / tube);
  const auto rate = [&](const Eigen::Array4d& z) {
    const double rho = ring + tube * std::cos(z[1]), sine = std::sin(z[1]);
    return Eigen::Array4d(z[2], z[3], 2 * tube * sine * z[3] * z[2] / rho,
                          -rho * sine * z[2] * z[2] / tube);
  };
  const double h = s / steps;
  for (int i = 0; i < steps; ++i) {
    const Eigen::Array4d f1 = rate(y), f2 = rate(y + 0.5 * h * f1), f3 = rate(y + 0.5 * h * f2),
                         f4 = rate(y + h * f3);
    y += h / 6 * (f1 + 2 * f2 + 2 * f3 + f4);
  }
  const double rho = ring + tube * std::cos(y[1]);
  const double c = std::cos(y[0]), d = std::sin(y[0]);
  const double rhoRate = -tube * std::sin(y[1]) * y[3];
  return {
      {rho * c, rho * d, tube * std::sin(y[1])},
      {rhoRate * c - rho * d * y[2], rhoRate * d + rho * c * y[2], tube * std::cos(y[1]) * y[3]}};
}

/// How far [m] from Q somebody ends who sets out from P along the path's first tangent, walks
/// straight to each contact and over the surfaces by the equations above: at each contact where the
/// solver says, but in the direction walked so far. Also counts the length walked.
inline double missOf(const Eigen::Vector3d& Q, const std::vector<bio::ChainObject>& objects,
                     const bio::ChainPath& path, int steps, double& walked) {
  WalkedPoint p{path.pieces[0].from, path.tangentP()};
  walked = 0;
  for (int i = 0; i < path.numContacts; ++i) {
    const bio::ChainContact& c = path.contacts[static_cast<std::size_t>(i)];
    const bio::ChainObject& o = objects[static_cast<std::size_t>(c.object)];
    const double straight = (c.A - p.x).dot(p.u);
    p.x += straight * p.u;
    p = {o.R_GS.transpose() * (p.x - o.p_GS), o.R_GS.transpose() * p.u};
    if (const auto* torus = std::get_if<bio::TorusSurface>(&o.surface)) {
      p = walkTorus(torus->ringRadius(), torus->tubeRadius(), p, c.arc, steps);
    } else {
      p = walkEllipsoid(std::get<bio::EllipsoidSurface>(o.surface).semiAxes(), p, c.arc, steps);
    }
    p = {o.R_GS * p.x + o.p_GS, o.R_GS * p.u};
    walked += straight + c.arc;
  }
  const double straight = (Q - p.x).dot(p.u);
  walked += straight;
  return (p.x + straight * p.u - Q).norm();
}

}  // namespace support
