#pragma once

#include <Eigen/Dense>
#include <cmath>
#include <numbers>

namespace support {

/// Length of a path round a cylinder and its derivative along a motion of p2, by the chain of
/// intermediate vectors of Appendix A of Wilson's thesis, with its misprints corrected: another
/// algorithm for what bio::wrapCylinder computes. Wraps counter-clockwise about Vc, up to half a
/// turn.
struct AppendixACylinder {
  Eigen::Vector3d px;  ///< a point of the axis
  Eigen::Vector3d Vc;  ///< unit vector of the axis
  double r;

  struct Result {
    double length;
    double derivative;  ///< along Dp2
    bool wraps;         ///< by (A.1)
  };

  Result operator()(const Eigen::Vector3d& p1, const Eigen::Vector3d& p2,
                    const Eigen::Vector3d& Dp2) const {
    using Vec = Eigen::Vector3d;
    const Vec d = p2 - p1;
    const Vec n = Vc.cross(d);
    if (!((px - p1).dot(n) / n.norm() < r)) return {d.norm(), d.dot(Dp2) / d.norm(), false};

    // distances from the axis and to the contacts
    const auto distance = [&](const Vec& p) { return (p - px).cross(p - (px + Vc)).norm(); };
    const double g1 = distance(p1), g2 = distance(p2);
    const double l1 = std::sqrt(g1 * g1 - r * r), l2 = std::sqrt(g2 * g2 - r * r);

    // contacts seen along the axis
    const Vec a1 = Vc.cross(p1 - px), a2 = Vc.cross(p2 - px);
    const Vec V1p = a1 / a1.norm(), V2p = a2 / a2.norm();
    const Vec V1c = Vc.cross(V1p), V2c = Vc.cross(V2p);
    const double q2 = std::sqrt(1 - r * r / (g2 * g2));
    const Vec E1p = p1 + (g1 - r * r / g1) * V1c + r * std::sqrt(1 - r * r / (g1 * g1)) * V1p;
    const Vec E2p = p2 + (g2 - r * r / g2) * V2c - r * q2 * V2p;

    // wrapped angle and length
    const Vec c = (E1p - E2p).cross(Vc);
    const double m = (px - E1p).dot(c) / c.norm();
    const double beta = std::numbers::pi - 2 * std::asin(m / r);
    const double h = d.dot(Vc);
    const double s = l1 + l2 + r * beta;
    const double length = std::sqrt(h * h + s * s);

    // the same chain differentiated
    const Vec cross = (p2 - px).cross(p2 - (px + Vc));
    const double Dg2 = -Dp2.cross(Vc).dot(cross) / cross.norm();
    const Vec Da2 = Vc.cross(Dp2);
    const Vec DV2p = Da2 / a2.norm() - a2.dot(Da2) / std::pow(a2.norm(), 3) * a2;
    const Vec b2 = Vc.cross(V2p);
    const Vec Db2 = Vc.cross(DV2p);
    const Vec DV2c = Db2 / b2.norm() - b2.dot(Db2) / std::pow(b2.norm(), 3) * b2;
    const Vec DE2p = Dp2 + Dg2 * (r * r / (g2 * g2) + 1) * V2c + (g2 - r * r / g2) * DV2c -
                     r * r * r * Dg2 / (g2 * g2 * g2 * q2) * V2p - r * q2 * DV2p;
    const Vec Dc = DE2p.cross(Vc);
    const double Dm =
        -(px - E1p).dot(Dc) / c.norm() + c.dot(Dc) / std::pow(c.norm(), 3) * (px - E1p).dot(c);
    const double Dbeta = -2 * Dm / (r * std::sqrt(1 - m * m / (r * r)));
    const double Dh = Dp2.dot(Vc);
    const double Dl2 = g2 * Dg2 / l2;
    return {length, (h * Dh + s * (Dl2 + r * Dbeta)) / length, true};
  }
};

}  // namespace support
