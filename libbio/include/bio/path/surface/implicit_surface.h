#pragma once

#include <Eigen/Dense>
#include <cmath>
#include <concepts>

namespace bio {

/// How a surface's function changes with one of its own numbers θ (a radius, a semi-axis).
struct NumberDerivative {
  double value;              ///< ∂g/∂θ
  Eigen::Vector3d gradient;  ///< ∂∇g/∂θ
};

/// A closed or endless surface g(x) = 0 in its own frame S, g < 0 inside; ∇g ≠ 0 on it.
///
/// - numNumbers: how many numbers of its own it has; number(i) [m] and ofNumber(x, i), i below it
/// - value(x), gradient(x), hessianTimes(x, u) = ∇²g u, thirdTwice(x, u) = D³g(u, u, ·)
/// - size() [m]: tolerances are relative to it
/// Units of g are the surface's own: only ratios of its derivatives matter.
template <class S>
concept ImplicitSurface = requires(const S& s, const Eigen::Vector3d& x, const Eigen::Vector3d& u,
                                   int i) {
  { S::numNumbers } -> std::convertible_to<int>;
  { s.number(i) } -> std::same_as<double>;
  { s.size() } -> std::same_as<double>;
  { s.value(x) } -> std::same_as<double>;
  { s.gradient(x) } -> std::same_as<Eigen::Vector3d>;
  { s.hessianTimes(x, u) } -> std::same_as<Eigen::Vector3d>;
  { s.thirdTwice(x, u) } -> std::same_as<Eigen::Vector3d>;
  { s.ofNumber(x, i) } -> std::same_as<NumberDerivative>;
};

/// At a point of a surface, for a direction u in it: the frame and how it bends.
struct SurfaceFrame {
  Eigen::Vector3d n;  ///< outward unit normal
  Eigen::Vector3d u;  ///< the direction, made a unit tangent
  Eigen::Vector3d b;  ///< n × u
  double normal;      ///< κ = II(u, u) [1/m], < 0 where the surface is convex along u
  double twist;       ///< τ = II(u, b) [1/m]
  double sideways;    ///< II(b, b) [1/m]; Gauss's curvature is normal·sideways − twist²
};

/// The frame at x for a direction that need not be quite tangent. II(u, w) = −uᵀ∇²g w/|∇g|.
template <ImplicitSurface S>
SurfaceFrame surfaceFrame(const S& surface, const Eigen::Vector3d& x,
                          const Eigen::Vector3d& direction) {
  const Eigen::Vector3d gradient = surface.gradient(x);
  const double perGradient = 1 / gradient.norm();
  SurfaceFrame frame;
  frame.n = gradient * perGradient;
  frame.u = (direction - frame.n * frame.n.dot(direction)).normalized();
  frame.b = frame.n.cross(frame.u);
  const Eigen::Vector3d alongU = surface.hessianTimes(x, frame.u);
  frame.normal = -perGradient * alongU.dot(frame.u);
  frame.twist = -perGradient * alongU.dot(frame.b);
  frame.sideways = -perGradient * frame.b.dot(surface.hessianTimes(x, frame.b));
  return frame;
}

/// The point of the surface that Newton's steps along the gradient lead to from a point near it.
template <ImplicitSurface S>
Eigen::Vector3d ontoSurface(const S& surface, Eigen::Vector3d x) {
  for (int i = 0; i < 40; ++i) {
    const Eigen::Vector3d gradient = surface.gradient(x);
    const Eigen::Vector3d step = gradient * (surface.value(x) / gradient.squaredNorm());
    x -= step;
    // the next step would be the square of this one, over the size
    if (!(step.norm() > 1e-9 * surface.size())) break;
  }
  return x;
}

}  // namespace bio
