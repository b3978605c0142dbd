// A system that the thesis does not have, optimised by the same code: a planar arm of two driven
// links that carries an unknown payload, in the vertical plane.
//
//     θ = (payload [kg], friction of the elbow [N m s]),  y = (q1, q2) [rad],  σ = 0.01 rad at 50
//     Hz
// Prints the information before and after; fails unless λ_min grows by a factor of 10 and more, the
// torques stay within their limits, and the bound's variances fall.
#include <fmt/format.h>

#include <cmath>

#include "info/design/discrete_projection.h"
#include "info/dynamics/integrate.h"
#include "info/information/symmetric_eigen.h"

namespace {

using namespace info;

/// Two uniform links hang from a shoulder, torques u at shoulder and elbow, a point mass at the
/// tip. q1 from hanging down, q2 relative.
struct TwoLinkArm {
  static constexpr int stateSize = 4, inputSize = 2, parameterSize = 2, outputSize = 2;
  double length = 0.4, mass1 = 2.0, mass2 = 1.5, friction1 = 0.2, gravity = 9.81;

  std::vector<std::string> parameterNames() const { return {"payload", "friction"}; }
  template <class T>
  Vector<T, 4> f(const Vector<T, 4>& x, const Vector<T, 2>& u, const Vector<T, 2>& theta) const {
    using std::cos, std::sin;
    const double square = length * length;
    const T sum = x[0] + x[1], rate = x[2] + x[3];
    // absolute angles α = q1, β = q1 + q2: A α̈ + C cos(β−α) β̈ = a, C cos(β−α) α̈ + B β̈ = b
    const T A = theta[0] * square + (mass1 / 3 + mass2) * square;
    const T B = theta[0] * square + mass2 / 3 * square;
    const T C = theta[0] * square + mass2 / 2 * square;
    const T cosine = C * cos(x[1]), sine = C * sin(x[1]);
    const T weight1 = (theta[0] + mass1 / 2 + mass2) * (gravity * length);
    const T weight2 = (theta[0] + mass2 / 2) * (gravity * length);
    const T elbow = u[1] - theta[1] * x[3];
    const T a = u[0] - friction1 * x[2] - elbow + sine * rate * rate - weight1 * sin(x[0]);
    const T b = elbow - sine * x[2] * x[2] - weight2 * sin(sum);
    const T determinant = A * B - cosine * cosine;
    const T alpha = (B * a - cosine * b) / determinant, beta = (A * b - cosine * a) / determinant;
    Vector<T, 4> xDot;
    xDot << x[2], x[3], alpha, beta - alpha;
    return xDot;
  }
  template <class T>
  Vector<T, 2> g(const Vector<T, 4>& x, const Vector<T, 2>&, const Vector<T, 2>&) const {
    return x.template head<2>();
  }
};

double least(const Eigen::MatrixXd& I) {
  return info::symmetricEigenvalues(I)[0];
}

}  // namespace

int main() {
  constexpr double step = 0.02;
  const Vector<double, 2> theta(0.5, 0.1);
  StepDesign design;
  design.timeStep = step;
  design.x0 = Eigen::VectorXd::Zero(4);
  // a gentle swing, 3 s
  for (int k = 0; k <= 150; ++k)
    design.desiredInput.push_back(
        Eigen::Vector2d(1.0 * std::sin(2 * step * k), 0.3 * std::sin(3 * step * k)));
  design.outputCovariance = 1e-4 * Eigen::MatrixXd::Identity(2, 2);
  design.information.e = 1e4;
  design.inputWeight = 1e-3 * Eigen::MatrixXd::Identity(2, 2);
  design.limits = {Eigen::Vector2d(-12, -6), Eigen::Vector2d(12, 6), 1e-3};
  design.modelState = 1e-3 * Eigen::MatrixXd::Identity(14, 14);
  design.modelInput = 0.1 * Eigen::MatrixXd::Identity(2, 2);
  design.gainState = Eigen::MatrixXd::Identity(6, 6);
  design.gainInput = Eigen::MatrixXd::Identity(2, 2);

  StepProjection projection(extend(Rk4<TwoLinkArm>{{}, step}, theta), design);
  const SearchResult result =
      search(projection, {.maxIterations = 60, .slopeTolerance = 1e-2, .largestMove = 1});
  const double before = least(result.informationStart), after = least(result.information);
  double torque1 = 0, torque2 = 0;
  for (const auto& u : projection.motion().u) {
    torque1 = std::max(torque1, std::abs(u[0]));
    torque2 = std::max(torque2, std::abs(u[1]));
  }
  const Eigen::MatrixXd slow = result.informationStart.inverse(),
                        fast = result.information.inverse();
  fmt::print("two-link arm: least eigenvalue {:.4g} to {:.4g}, factor {:.4g}, {} iterations, {}\n",
             before, after, after / before, result.iterations, describe(result.why));
  fmt::print("deviation of payload {:.3g} to {:.3g} kg, of friction {:.3g} to {:.3g} N m s\n",
             std::sqrt(slow(0, 0)), std::sqrt(fast(0, 0)), std::sqrt(slow(1, 1)),
             std::sqrt(fast(1, 1)));
  fmt::print("largest torques {:.3g} and {:.3g} N m, limits 12 and 6\n", torque1, torque2);
  const bool good = after >= 10 * before && torque1 < 12 && torque2 < 6 &&
                    fast(0, 0) < slow(0, 0) && fast(1, 1) < slow(1, 1);
  return good ? 0 : 1;
}
