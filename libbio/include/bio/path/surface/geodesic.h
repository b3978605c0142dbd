#pragma once

#include <Eigen/Dense>
#include <array>

#include "bio/path/surface/surface.h"

namespace bio {

/// A point of a geodesic, with its neighbours: a starts beside it in parallel, r starts with it at
/// an angle,
///     y″ + K y = 0,   a(0) = 1, a′(0) = 0,   r(0) = 0, r′(0) = 1
/// so that a start moved by β along b = n × u and turned by θ about n moves the point by
/// (βa + θr) b and turns its direction by βa′ + θr′ (Jacobi). a r′ − a′ r = 1 (Wronski).
struct GeodesicPoint {
  Eigen::Vector3d x;  ///< [m], in the surface's frame
  Eigen::Vector3d u;  ///< unit tangent
  double a, aSlope;   ///< [1], [1/m]
  double r, rSlope;   ///< [m], [1]
};

/// Where the geodesic from x (on the surface) in direction u (a unit tangent) has come after length
/// s [m], which may be negative.
///
///     x″ = −(uᵀ∇²g u/|∇g|²)∇g
/// Sphere and cylinder in closed form; ellipsoid and torus by Störmer's rule, extrapolated (Hairer,
/// Nørsett, Wanner, Solving ODEs I, II.14), on the equation from which a conserved quantity has
/// removed the velocity. Error ≤ about `tolerance` in a, r′, and times the surface's size in
/// x, r. Not finite where more than 400 steps would be needed.
GeodesicPoint shootGeodesic(const Surface& surface, const Eigen::Vector3d& x,
                            const Eigen::Vector3d& u, double s, double tolerance = 1e-13);

/// The end of a geodesic by g, ∇g, ∇²g alone, for any ImplicitSurface: Gragg's midpoint rule,
/// extrapolated. For a surface without a conserved quantity; some three times slower.
template <ImplicitSurface S>
GeodesicPoint shootByDerivatives(const S& surface, const Eigen::Vector3d& x,
                                 const Eigen::Vector3d& u, double s, double tolerance = 1e-13);
extern template GeodesicPoint shootByDerivatives(const EllipsoidSurface&, const Eigen::Vector3d&,
                                                 const Eigen::Vector3d&, double, double);
extern template GeodesicPoint shootByDerivatives(const TorusSurface&, const Eigen::Vector3d&,
                                                 const Eigen::Vector3d&, double, double);
extern template GeodesicPoint shootByDerivatives(const SphereSurface&, const Eigen::Vector3d&,
                                                 const Eigen::Vector3d&, double, double);
extern template GeodesicPoint shootByDerivatives(const CylinderSurface&, const Eigen::Vector3d&,
                                                 const Eigen::Vector3d&, double, double);

/// How the length of a taut string over a surface follows one of the surface's numbers θ.
///
/// The string feels the normal shift −g_θ/|∇g| of the surface under it, so that
///     ∂L/∂θ = ∫ F ds,   F = −(uᵀ∇²g u) g_θ/|∇g|²
/// and beside come the changes of that integral as the geodesic's start moves sideways by 1 m and
/// turns by 1 rad, and F at both ends, by which it changes as they slide along.
struct NumberIntegral {
  double length;       ///< ∂L/∂θ
  double sideways;     ///< ∫ (D_bF a + F_u·(τ a n + a′ b)) ds
  double turned;       ///< the same with r for a
  double first, last;  ///< F at the two ends
};

/// NumberIntegral of every number of the surface (the first numNumbersOf), by Gauss's rule of eight
/// points on each step.
std::array<NumberIntegral, maxSurfaceNumbers> numberIntegrals(const Surface& surface,
                                                              const Eigen::Vector3d& x,
                                                              const Eigen::Vector3d& u, double s);

}  // namespace bio
