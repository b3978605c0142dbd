#include "reduced/reduced_dynamics.h"

#include <cmath>

namespace reduced {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

constexpr double kFrictionSpeed = 0.05, kGravity = 9.81;
constexpr double kMassArm = 0.15, kHandArm = 0.34, kInertiaOfMass = 0.07 / 1.5, kLimitRate = 8;
constexpr double kRestAngle = 1.0, kMiddle = 1.2, kScaleFloor = 0.05;

// Moment arm r0 + r1 sin q, and the fibre length at q = 0
struct Route {
  double r0, r1, length;
};
constexpr std::array<Route, kMuscles> kRoutes = {{{0.018, 0.022, 0.1656282},
                                                  {0.012, 0.013, 0.1126894},
                                                  {0.025, 0.04, 0.2255057},
                                                  {-0.022, -0.004, 0.0710494}}};

}  // namespace

template <bool derivatives>
void evaluate(const VectorXd& v, double q, double w, const std::array<double, kMuscles>& level,
              const std::array<double, kMuscles>& used, double latent, Instant& now) {
  const auto value = [&](std::size_t i) { return v[static_cast<Index>(i)]; };
  const double sine = std::sin(q), cosine = std::cos(q);
  double torque = latent, byQ = 0, bySpeed = 0, squares = kScaleFloor * kScaleFloor;
  auto& direct = now.direct;
  if constexpr (derivatives) direct.fill(0);

  for (std::size_t m = 0; m < kMuscles; ++m) {
    const Route& route = kRoutes[m];
    const double F0 = value(kForce + m), optimal = value(kLength + m);
    const double dr = m == 0 ? value(kWrapBic) : m == 3 ? value(kWrapTri) : 0;
    const double r = route.r0 + route.r1 * sine + dr, r_q = route.r1 * cosine;
    const double l =
        (route.length - route.r0 * q - route.r1 * (1 - cosine) - dr * (q - kMiddle)) / optimal;
    const double s = -r * w / (10 * optimal), x = l - 1;
    const double fl = std::exp(-5 * x * x), fl_l = -10 * x * fl;
    const double fp = x > 0 ? 4 * x * x : 0, fp_l = x > 0 ? 8 * x : 0;
    const double below = s < 0 ? 1 - 4 * s : 1 + 10 * s;
    const double fv = (s < 0 ? 1 + s : 1 + 15 * s) / below, fv_s = 5 / (below * below);
    const double a = level[m], phi = value(kFatigue), T = value(kFatigueTime);
    const double spent = phi != 0 || derivatives ? std::exp(-used[m] / T) : 1;
    const double left = 1 - phi * (1 - spent);
    const double active = F0 * fl * fv * left, F = active * a + F0 * fp * left;
    torque += r * F;
    squares += (r * active * a) * (r * active * a);
    if constexpr (derivatives) {
      const double F_l = F0 * left * (a * fl_l * fv + fp_l), F_s = F0 * left * a * fl * fv_s;
      byQ += r_q * F + r * (F_l * (-r / optimal) - F_s * r_q * w / (10 * optimal));
      bySpeed -= r * F_s * r / (10 * optimal);
      now.byLevel[m] = r * active;
      now.byUsed[m] = -r * F / left * phi * spent / T;
      direct[kForce + m] = r * F / F0;
      direct[kLength + m] = -r * (F_l * l + F_s * s) / optimal;
      const double byArm = F - r * (F_l * (q - kMiddle) + F_s * w / 10) / optimal;
      if (m == 0) direct[kWrapBic] = byArm;
      if (m == 3) direct[kWrapTri] = byArm;
      direct[kFatigue] -= r * F / left * (1 - spent);
      direct[kFatigueTime] += r * F / left * phi * spent * used[m] / (T * T);
    }
  }

  // weight of forearm and payload
  const double mass = value(kMass), payload = value(kPayload), tilt = value(kTilt);
  const double first = mass * kMassArm + payload * kHandArm;
  const double leanSine = tilt != 0 ? std::sin(q + tilt) : sine;
  torque -= kGravity * first * leanSine;
  const double inertia = mass * kInertiaOfMass + payload * kHandArm * kHandArm;
  // friction and springs
  const double contact = std::tanh(w / kFrictionSpeed);
  const double bump = 1 + std::exp(-w * w / (value(kStribeckSpeed) * value(kStribeckSpeed)));
  torque -= value(kViscous) * w + value(kCoulomb) * contact + value(kStribeck) * bump * contact +
            value(kDrag) * w * std::abs(w) + value(kStiffness) * (q - kRestAngle);
  const double A = value(kLimit);
  const double flexed =
      A != 0 || derivatives ? std::exp(kLimitRate * (q - value(kLimitFlexed))) : 0;
  const double extended =
      A != 0 || derivatives ? std::exp(-kLimitRate * (q - value(kLimitExtended))) : 0;
  torque -= A * (flexed - extended);
  torque += value(kConstant) + value(kHandForce) * kHandArm * cosine;

  now.acceleration = torque / inertia;
  now.scale = std::sqrt(squares);
  now.inertia = inertia;
  if constexpr (derivatives) {
    const double leanCosine = std::cos(q + tilt), slope = (1 - contact * contact) / kFrictionSpeed;
    const double vs = value(kStribeckSpeed), bump_w = -2 * w / (vs * vs) * (bump - 1);
    byQ -= kGravity * first * leanCosine + value(kStiffness) +
           A * kLimitRate * (flexed + extended) + value(kHandForce) * kHandArm * sine;
    bySpeed -= value(kViscous) + value(kCoulomb) * slope +
               value(kStribeck) * (bump_w * contact + bump * slope) +
               2 * value(kDrag) * std::abs(w);
    direct[kViscous] = -w;
    direct[kCoulomb] = -contact;
    direct[kStribeck] = -bump * contact;
    direct[kStribeckSpeed] = -value(kStribeck) * contact * (bump - 1) * 2 * w * w / (vs * vs * vs);
    direct[kDrag] = -w * std::abs(w);
    direct[kStiffness] = -(q - kRestAngle);
    direct[kLimit] = -(flexed - extended);
    direct[kLimitFlexed] = A * kLimitRate * flexed;
    direct[kLimitExtended] = A * kLimitRate * extended;
    direct[kTilt] = -kGravity * first * leanCosine;
    direct[kConstant] = 1;
    direct[kHandForce] = kHandArm * cosine;
    direct[kMass] = -kGravity * kMassArm * leanSine - now.acceleration * kInertiaOfMass;
    direct[kPayload] = -kGravity * kHandArm * leanSine - now.acceleration * kHandArm * kHandArm;
    const double inverse = 1 / inertia;
    for (double& d : direct) d *= inverse;
    for (std::size_t m = 0; m < kMuscles; ++m) {
      now.byLevel[m] *= inverse;
      now.byUsed[m] *= inverse;
    }
    now.byQ = byQ * inverse;
    now.bySpeed = bySpeed * inverse;
  }
}

template void evaluate<false>(const VectorXd&, double, double, const std::array<double, kMuscles>&,
                              const std::array<double, kMuscles>&, double, Instant&);
template void evaluate<true>(const VectorXd&, double, double, const std::array<double, kMuscles>&,
                             const std::array<double, kMuscles>&, double, Instant&);

}  // namespace reduced
