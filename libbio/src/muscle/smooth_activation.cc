#include "bio/muscle/smooth_activation.h"

#include <algorithm>
#include <cmath>

namespace bio::muscles {
namespace {

using PerStage = std::array<double, 3>;

// Gauss's method with three stages.
constexpr double root15 = 3.8729833462074170;
constexpr std::array<PerStage, 3> coupling{
    {{5.0 / 36, 2.0 / 9 - root15 / 15, 5.0 / 36 - root15 / 30},
     {5.0 / 36 + root15 / 24, 2.0 / 9, 5.0 / 36 - root15 / 24},
     {5.0 / 36 + root15 / 30, 2.0 / 9 + root15 / 15, 5.0 / 36}}};
constexpr PerStage stageWeight{5.0 / 18, 8.0 / 18, 5.0 / 18};
constexpr PerStage stagePlace{0.5 - root15 / 10, 0.5, 0.5 + root15 / 10};

inline double tanhOf(double x) {
  if (std::abs(x) < 0.1) {
    const double y = x * x;
    return x *
           (1 + y * (-1.0 / 3 + y * (2.0 / 15 + y * (-17.0 / 315 +
                                                     y * (62.0 / 2835 + y * (-1382.0 / 155925))))));
  }
  return 1 - 2 / (std::exp(2 * x) + 1);
}

// The law with what all its evaluations share.
struct SmoothLaw {
  double perRise, perFall, smoothing;  // 1/τ_a, 1/τ_d, b
  explicit SmoothLaw(const SmoothActivation<double>& law)
      : perRise(1 / law.activationTime),
        perFall(1 / law.deactivationTime),
        smoothing(law.smoothing) {}
};

// The rate as the law has it, with what its derivatives are made of.
struct Rate {
  double e, t, z, perZ;
  double toRise, toFall;  // 1/(τ_a z), z/τ_d
  double value, byActivation, byExcitation;
};
inline Rate rateAt(const SmoothLaw& law, double u, double a) {
  Rate r;
  r.e = u - a;
  r.t = 0.5 * tanhOf(law.smoothing * r.e);
  r.z = 0.5 + 1.5 * a;
  r.perZ = 1 / r.z;
  r.toRise = r.perZ * law.perRise;
  r.toFall = r.z * law.perFall;
  const double g = (0.5 + r.t) * r.toRise + (0.5 - r.t) * r.toFall;
  const double bend = 0.5 * law.smoothing * (1 - 4 * r.t * r.t) * (r.toRise - r.toFall);
  const double byZ = -(0.5 + r.t) * r.toRise * r.perZ + (0.5 - r.t) * r.toFall * r.perZ;
  r.value = g * r.e;
  r.byExcitation = g + r.e * bend;
  r.byActivation = 1.5 * r.e * byZ - r.byExcitation;
  return r;
}

// The solution of M x = b by cofactors.
inline PerStage solveStages(const std::array<PerStage, 3>& M, const PerStage& b) {
  const PerStage p{M[1][1] * M[2][2] - M[1][2] * M[2][1], M[1][2] * M[2][0] - M[1][0] * M[2][2],
                   M[1][0] * M[2][1] - M[1][1] * M[2][0]};
  const PerStage q{M[0][2] * M[2][1] - M[0][1] * M[2][2], M[0][0] * M[2][2] - M[0][2] * M[2][0],
                   M[0][1] * M[2][0] - M[0][0] * M[2][1]};
  const PerStage r{M[0][1] * M[1][2] - M[0][2] * M[1][1], M[0][2] * M[1][0] - M[0][0] * M[1][2],
                   M[0][0] * M[1][1] - M[0][1] * M[1][0]};
  const double per = 1 / (M[0][0] * p[0] + M[0][1] * p[1] + M[0][2] * p[2]);
  return {per * (p[0] * b[0] + q[0] * b[1] + r[0] * b[2]),
          per * (p[1] * b[0] + q[1] * b[1] + r[1] * b[2]),
          per * (p[2] * b[0] + q[2] * b[1] + r[2] * b[2])};
}

// The stages' matrix I − d diag(J) A.
inline std::array<PerStage, 3> matrixOf(const PerStage& J, double d) {
  const PerStage j{d * J[0], d * J[1], d * J[2]};
  return {{{1 - j[0] * coupling[0][0], -j[0] * coupling[0][1], -j[0] * coupling[0][2]},
           {-j[1] * coupling[1][0], 1 - j[1] * coupling[1][1], -j[1] * coupling[1][2]},
           {-j[2] * coupling[2][0], -j[2] * coupling[2][1], 1 - j[2] * coupling[2][2]}}};
}
inline std::array<PerStage, 3> stagesTransposed(const std::array<PerStage, 3>& M) {
  return {{{M[0][0], M[1][0], M[2][0]}, {M[0][1], M[1][1], M[2][1]}, {M[0][2], M[1][2], M[2][2]}}};
}

struct Stages {
  PerStage k;  // ȧ at the stages
  std::array<Rate, 3> rate;
};

void evaluateStages(const SmoothLaw& law, const PerStage& u, double a, double d, Stages& s) {
  for (std::size_t i = 0; i < 3; ++i) {
    const double way = coupling[i][0] * s.k[0] + coupling[i][1] * s.k[1] + coupling[i][2] * s.k[2];
    s.rate[i] = rateAt(law, u[i], a + d * way);
  }
}

// The rates at the stages of a stretch d from a, where u at the stages is given; s.rate belongs to
// the last iterate but one, off by less than 1e-6.
Stages stagesOf(const SmoothLaw& law, const PerStage& u, double a, double d) {
  // to begin with the law is taken for linear about u in the middle and a
  const Rate first = rateAt(law, u[1], a);
  const double outward = first.byExcitation * (u[2] - u[1]);
  const double J0 = first.byActivation;
  Stages s;
  s.k = solveStages(matrixOf({J0, J0, J0}, d),
                    {first.value - outward, first.value, first.value + outward});
  for (int iteration = 0; iteration < 20; ++iteration) {
    evaluateStages(law, u, a, d, s);
    PerStage excess, J;
    for (std::size_t i = 0; i < 3; ++i) {
      excess[i] = s.rate[i].value - s.k[i];
      J[i] = s.rate[i].byActivation;
    }
    const PerStage change = solveStages(matrixOf(J, d), excess);
    double largest = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      s.k[i] += change[i];
      largest = std::max(largest, std::abs(change[i]));
    }
    // what is left is about the square
    if (!(largest * d > 1e-6)) break;
  }
  return s;
}

// As many stretches as the time constants and the sharpness of the change between them ask for.
double stretchesOf(const SmoothActivation<double>& law, double h) {
  const double time = std::min(law.activationTime, law.deactivationTime);
  return std::ceil(h / time * (1 + 0.2 * law.smoothing) - 1e-9);
}

}  // namespace

template <>
double SmoothActivation<double>::step(double u0, double u1, double a0, double h) const {
  if (!(h > 0)) return a0;
  const SmoothLaw law(*this);
  const double count = stretchesOf(*this, h);
  const double d = h / count, du = (u1 - u0) / count;
  double a = a0;
  for (double m = 0; m < count; ++m) {
    const double u = u0 + m * du;
    const Stages s = stagesOf(
        law, {u + stagePlace[0] * du, u + stagePlace[1] * du, u + stagePlace[2] * du}, a, d);
    a += d * (stageWeight[0] * s.k[0] + stageWeight[1] * s.k[1] + stageWeight[2] * s.k[2]);
  }
  return a;
}

// By the implicit function theorem on the stages' equations k = f(u, a + d A k), with multipliers l
// of (I − d J A)ᵀ l = d b.
template <>
ActivationStep<3> SmoothActivation<double>::stepWithDerivatives(double u0, double u1, double a0,
                                                                double h) const {
  ActivationStep<3> r;
  r.value = a0;
  r.d[2] = 1;
  if (!(h > 0)) return r;
  const SmoothLaw law(*this);
  const double count = stretchesOf(*this, h);
  const double d = h / count, du = (u1 - u0) / count;
  for (double m = 0; m < count; ++m) {
    const double u = u0 + m * du;
    const PerStage at{u + stagePlace[0] * du, u + stagePlace[1] * du, u + stagePlace[2] * du};
    Stages s = stagesOf(law, at, r.value, d);
    evaluateStages(law, at, r.value, d, s);
    PerStage J;
    for (std::size_t i = 0; i < 3; ++i) J[i] = s.rate[i].byActivation;
    const PerStage l = solveStages(stagesTransposed(matrixOf(J, d)),
                                   {d * stageWeight[0], d * stageWeight[1], d * stageWeight[2]});
    double carried = 1, mean = 0;
    std::array<double, 7> own{};
    for (std::size_t i = 0; i < 3; ++i) {
      const Rate& f = s.rate[i];
      carried += l[i] * J[i];
      mean += stageWeight[i] * s.k[i];
      const double spread = 0.5 * f.e * (1 - 4 * f.t * f.t) * (f.toRise - f.toFall);  // of g by b
      const double share = (m + stagePlace[i]) / count;
      own[0] += l[i] * f.byExcitation * (1 - share);
      own[1] += l[i] * f.byExcitation * share;
      const double way =
          coupling[i][0] * s.k[0] + coupling[i][1] * s.k[1] + coupling[i][2] * s.k[2];
      own[3] += l[i] * J[i] * way / count;
      own[4] -= l[i] * f.e * (0.5 + f.t) * f.toRise * law.perRise;
      own[5] -= l[i] * f.e * (0.5 - f.t) * f.toFall * law.perFall;
      own[6] += l[i] * f.e * spread;
    }
    own[3] += mean / count;
    r.value += d * mean;
    for (std::size_t i = 0; i < 7; ++i) r.d[i] = carried * r.d[i] + own[i];
  }
  return r;
}

}  // namespace bio::muscles
