#include "bio/muscle/first_order_activation.h"

#include <cmath>

#include "muscle/activation_pieces.h"

namespace bio::muscles {
namespace {

// Rising
// ------------------------------------------------------------------------------------------------

// e and z while rising, with s = t/τ_a, from e₀ and z₀ at σ = 0. λ± = −½ ± ω are the equations'
// eigenvalues, S the solution of S″ + S′ = 3/2 μS that starts with slope 1, Q its integral:
//     s = z₀(S + Q) + 3/2 e₀Q,   z = z₀(S′ + S) + 3/2 e₀S,   e = e₀S′ + μz₀S
struct Rise {
  double e0, z0, mu, span;  // span: of s
  double omega, high, low;  // λ+, λ−
  double half, perLow;      // 1/(2ω), 1/λ−
  bool isPlain;             // ω is real and not small

  Rise(double u0, double slope, double a0, double h, double time)
      : e0(u0 - a0), z0(0.5 + 1.5 * a0), mu(slope * time), span(h / time) {
    isPlain = mu > -0.1;
    omega = std::sqrt(isPlain ? 0.25 + 1.5 * mu : 1.0);
    low = -0.5 - omega;
    perLow = 1 / low;
    high = -1.5 * mu * perLow;
    half = 0.5 / omega;
  }
};

// (exp(x) − 1)/x, and exp(x)
struct Growth {
  double mean, power;
};
inline Growth growthOf(double x) {
  if (std::abs(x) < 0.02) {
    const double x2 = x * x;
    const double mean = (1 + x * (1.0 / 2)) +
                        x2 * ((1.0 / 6 + x * (1.0 / 24)) + x2 * (1.0 / 120 + x * (1.0 / 720)));
    return {mean, 1 + x * mean};
  }
  const double power = std::exp(x);
  return {(power - 1) / x, power};
}

struct RisePoint {
  double sigma;
  double Q, S, dS;
  double highMean, highPower, lowPower;
  double s, z, e;
};
inline RisePoint risePoint(const Rise& r, double sigma) {
  RisePoint p;
  p.sigma = sigma;
  const Growth high = growthOf(r.high * sigma);
  p.highMean = high.mean;
  p.highPower = high.power;
  p.lowPower = std::exp(r.low * sigma);
  p.Q = r.half * (sigma * high.mean - (p.lowPower - 1) * r.perLow);
  p.S = r.half * (high.power - p.lowPower);
  p.dS = r.half * (r.high * high.power - r.low * p.lowPower);
  p.s = r.z0 * (p.S + p.Q) + 1.5 * r.e0 * p.Q;
  p.z = r.z0 * (p.dS + p.S) + 1.5 * r.e0 * p.S;
  p.e = r.e0 * p.dS + r.mu * r.z0 * p.S;
  return p;
}

// σ where s = span, from a point beside it: the inverse function to third order.
inline double stepTo(const Rise& r, const RisePoint& p) {
  const double per = 1 / p.z;
  const double rho = (r.span - p.s) * per;
  const double bend = 0.75 * p.e * per;                  // z′/(2z)
  const double third = 0.25 * (r.mu * p.z - p.e) * per;  // z″/(6z)
  return rho * (1 + rho * (-bend + rho * (2 * bend * bend - third)));
}

struct Risen {
  bool found;
  RisePoint point;
  double z;
};
// By Newton's method of third order; not found where u falls below a, or falls fast.
Risen risen(const Rise& r) {
  if (!r.isPlain) return {};
  // the cubic that s begins with
  const double c2 = 0.75 * r.e0, c3 = (0.75 * r.mu * r.z0 - c2) * (1.0 / 3);
  double sigma = 2 * r.span / (r.z0 + std::sqrt(r.z0 * r.z0 + 4 * c2 * r.span));
  const double slope = r.z0 + sigma * (2 * c2 + 3 * c3 * sigma);
  if (slope > 0.5 * r.z0) sigma -= c3 * sigma * sigma * sigma / slope;
  for (int k = 0; k < 12; ++k) {
    const RisePoint p = risePoint(r, sigma);
    if (!(p.z > 0)) return {};
    const double step = stepTo(r, p);
    if (std::abs(step) < 1e-4) {
      // z at σ + step by Taylor: z′ = 3/2 e, e′ = −e + μz
      const double de = -p.e + r.mu * p.z, d2e = -de + 1.5 * r.mu * p.e;
      const double e = p.e + step * (de + 0.5 * step * d2e);
      const double z = p.z + 1.5 * step * (p.e + step * (0.5 * de + step * d2e * (1.0 / 6)));
      return {e >= 0 && z <= 2, p, z};
    }
    const double limit = 0.5 + sigma;
    sigma = std::max(sigma + std::clamp(step, -limit, limit), 0.0);
  }
  return {};
}

// ∂a₁ by the implicit function theorem on s(σ) = span and z(σ), in e₀, z₀, μ and span.
ActivationStep<3> risenWithDerivatives(const Rise& r, const Risen& end, double slope, double h,
                                       double time) {
  const RisePoint p = risePoint(r, end.point.sigma + stepTo(r, end.point));
  // R = ∂Q/∂μ with G(λ) = (e^{λσ} − 1)/λ: dλ± = ±¾/ω dμ, and G′ = σ²·Σ x^k/(k!(k+2)) for small x
  const double x = r.high * p.sigma;
  double highG;
  if (std::abs(x) < 0.5) {
    double sum = 0, factorial = 1.3076743680e12;  // 15!
    for (int k = 15; k >= 0; --k) {
      sum = sum * x + 1 / (factorial * (k + 2));
      if (k > 0) factorial /= k;
    }
    highG = p.sigma * p.sigma * sum;
  } else {
    highG = (p.sigma * p.highPower - p.sigma * p.highMean) / r.high;
  }
  const double lowG = (p.sigma * p.lowPower - (p.lowPower - 1) / r.low) / r.low;
  const double share = 0.75 / (r.omega * r.omega);
  const double R = share * (0.5 * (highG + lowG) - p.Q);
  const double dR = share * (0.5 * p.sigma * (p.highPower + p.lowPower) - p.S);
  const double d2R = 1.5 * p.Q + 1.5 * r.mu * R - dR;

  // s and z at fixed σ
  const double s_e = 1.5 * p.Q, s_z = p.S + p.Q;
  const double s_mu = r.z0 * (dR + R) + 1.5 * r.e0 * R;
  const double z_e = 1.5 * p.S, z_z = p.dS + p.S;
  const double z_mu = r.z0 * (d2R + dR) + 1.5 * r.e0 * dR;
  // a₁ = ⅔(z₁ − ½): per unit of z, and σ that follows s = span
  const double by_span = p.e / p.z;  // ⅔ z′/z
  const double by_e = 2.0 / 3 * z_e - by_span * s_e;
  const double by_z = 2.0 / 3 * z_z - by_span * s_z;
  const double by_mu = 2.0 / 3 * z_mu - by_span * s_mu;
  const double by_slope = by_mu * time;
  ActivationStep<3> step;
  step.value = 2.0 / 3 * (end.z - 0.5);
  step.d = {by_e - by_slope / h,
            by_slope / h,
            -by_e + 1.5 * by_z,
            by_span / time - by_slope * slope / h,
            by_mu * slope - by_span * h / (time * time),
            0,
            0};
  return step;
}

// Falling
// ------------------------------------------------------------------------------------------------

struct Fall {
  double w0, x, bend, span;
  bool isShort;  // one stretch of Gauss's rule is enough

  Fall(double u0, double slope, double a0, double h, double time)
      : w0(1 / (0.5 + 1.5 * a0)), span(h / time) {
    const double first = 0.5 + 1.5 * u0, change = 1.5 * slope * h;
    x = (first + 0.5 * change) * span;
    bend = 0.5 * change * span;
    isShort =
        std::max(std::abs(first), std::abs(first + change)) * span <= 1 && std::abs(bend) <= 1;
  }
};

struct Fallen {
  double w, decay;
  double sum, first, second;  // Gauss's sums of f, r f and r(1 − r) f
};
inline Fallen fallen(const Fall& f) {
  Fallen r{0, std::exp(-f.x), 0, 0, 0};
  for (std::size_t i = 0; i < 5; ++i) {
    const double at = detail::gaussPoint[i], bent = at * (1 - at);
    const double term = detail::gaussWeight[i] * std::exp(-(at * f.x + bent * f.bend));
    r.sum += term;
    r.first += at * term;
    r.second += bent * term;
  }
  r.w = f.w0 * r.decay + f.span * r.sum;
  return r;
}

ActivationStep<3> fallenWithDerivatives(const Fall& f, const Fallen& end, double u0, double u1,
                                        double time) {
  const double z1 = 1 / end.w;
  const double per = -2.0 / 3 * z1 * z1;  // ∂a₁/∂w
  const double by_x = per * (-f.w0 * end.decay - f.span * end.first);
  const double by_bend = -per * f.span * end.second;
  // x = (½ + ¾(u₀ + u₁)) span, bend = ¾(u₁ − u₀) span
  const double by_span =
      per * end.sum + by_x * (0.5 + 0.75 * (u0 + u1)) + by_bend * 0.75 * (u1 - u0);
  ActivationStep<3> step;
  step.value = 2.0 / 3 * (z1 - 0.5);
  step.d = {0.75 * f.span * (by_x - by_bend),
            0.75 * f.span * (by_x + by_bend),
            per * end.decay * -1.5 * f.w0 * f.w0,
            by_span / time,
            0,
            -by_span * f.span / time,
            0};
  return step;
}

/// u and a are one but for rounding: there is no branch to tell, and no change of it.
bool isLevel(double u0, double u1, double a0) {
  return std::abs(u0 - a0) + std::abs(u1 - a0) < 1e-13;
}

ActivationStep<3> throughDuals(const FirstOrderActivation<double>& law, double u0, double u1,
                               double a0, double h) {
  using D = info::Dual<7>;
  const FirstOrderActivation<D> dual{D(law.activationTime, 7, 4), D(law.deactivationTime, 7, 5),
                                     D(law.minimum, 7, 6)};
  const D end = detail::stepInPieces(dual, D(u0, 7, 0), D(u1, 7, 1), D(a0, 7, 2), D(h, 7, 3));
  ActivationStep<3> step;
  step.value = end.value();
  for (std::size_t i = 0; i < 7; ++i) step.d[i] = end.derivatives()[static_cast<int>(i)];
  return step;
}

}  // namespace

template <>
double FirstOrderActivation<double>::step(const double& u0, const double& u1, const double& a0,
                                          const double& h) const {
  if (h > 0 && a0 >= minimum && a0 <= 1) {
    if (isLevel(u0, u1, a0)) return a0;
    const double slope = (u1 - u0) / h;
    if (u0 > a0 || (u0 == a0 && slope > 0)) {
      const Risen end = risen(Rise(u0, slope, a0, h, activationTime));
      if (end.found) return 2.0 / 3 * (end.z - 0.5);
    } else if (const Fall f(u0, slope, a0, h, deactivationTime); f.isShort) {
      const double a1 = 2.0 / 3 * (1 / fallen(f).w - 0.5);
      if (a1 >= u1 && a1 >= minimum) return a1;
    }
  }
  return detail::stepInPieces(*this, u0, u1, a0, h);
}

template <>
ActivationStep<3> FirstOrderActivation<double>::stepWithDerivatives(double u0, double u1, double a0,
                                                                    double h) const {
  if (h > 0 && a0 >= minimum && a0 <= 1) {
    const double slope = (u1 - u0) / h;
    const bool level = isLevel(u0, u1, a0);
    if (!level && (u0 > a0 || (u0 == a0 && slope > 0))) {
      const Rise r(u0, slope, a0, h, activationTime);
      const Risen end = risen(r);
      if (end.found) return risenWithDerivatives(r, end, slope, h, activationTime);
    } else if (const Fall f(u0, slope, a0, h, deactivationTime); f.isShort) {
      const Fallen end = fallen(f);
      const double a1 = 2.0 / 3 * (1 / end.w - 0.5);
      if (level || (a1 >= u1 && a1 >= minimum)) {
        return fallenWithDerivatives(f, end, u0, u1, deactivationTime);
      }
    }
  }
  return throughDuals(*this, u0, u1, a0, h);
}

}  // namespace bio::muscles
