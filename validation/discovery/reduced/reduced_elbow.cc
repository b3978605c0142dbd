#include "reduced/reduced_elbow.h"

#include <cmath>
#include <limits>

#include "info/autodiff/dual.h"
#include "reduced/reduced_quantities.h"

namespace reduced {

using Eigen::ArrayXd;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using info::Dual;

namespace {

constexpr double kTick = 0.01, kNode = 0.05, kFrictionSpeed = 0.05, kGravity = 9.81;
constexpr double kMassArm = 0.15, kHandArm = 0.34, kInertiaOfMass = 0.07 / 1.5, kLimitRate = 8;
constexpr double kRestAngle = 1.0, kMiddle = 1.2, kScaleFloor = 0.05;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

// Moment arm r0 + r1 sin q, and the fibre length at q = 0
struct Route {
  double r0, r1, length;
};
constexpr std::array<Route, kMuscles> kRoutes = {{{0.018, 0.022, 0.1656282},
                                                  {0.012, 0.013, 0.1126894},
                                                  {0.025, 0.04, 0.2255057},
                                                  {-0.022, -0.004, 0.0710494}}};

// Which of the input-like quantities moves activations; derivatives are carried in this order.
constexpr std::array<std::size_t, 5> kInputLike = {kTau, kDelay, kShape, kTriFromBic, kBicFromTri};

template <class T>
struct Activation {
  std::vector<std::array<T, kMuscles>> level, used;  // every half step; used: ∫level dt
};

// What reaches muscle m at time t: delayed, freed of crosstalk, reshaped.
template <class T>
std::array<T, kMuscles> drive(const Trial& trial, double t, const std::array<T, 5>& p) {
  const auto last = static_cast<std::ptrdiff_t>(trial.excitations.size()) - 2;
  const T place = (t - p[1]) / kTick;
  auto k = static_cast<std::ptrdiff_t>(std::floor(info::plainValue(place) + 1e-9));
  T share = place - static_cast<double>(k);
  if (k < 0) k = 0, share = T(0.0);
  if (k > last) k = last, share = T(1.0);
  const auto& from = trial.excitations[static_cast<std::size_t>(k)];
  const auto& to = trial.excitations[static_cast<std::size_t>(k) + 1];
  std::array<T, kMuscles> u;
  for (std::size_t m = 0; m < kMuscles; ++m) u[m] = from[m] + share * (to[m] - from[m]);
  const T biceps = u[0];
  u[0] = u[0] - p[4] * u[3];
  u[3] = u[3] - p[3] * biceps;
  const T A = p[2];
  for (T& x : u) {
    using std::exp;
    if (std::abs(info::plainValue(A)) < 1e-4)
      x = x + A * (0.5 * x * (x - 1.0));  // the series of what follows
    else
      x = (exp(A * x) - 1.0) / (exp(A) - 1.0);
  }
  return u;
}

template <class T>
Activation<T> activate(const Trial& trial, double half, std::size_t count, const VectorXd& values) {
  std::array<T, 5> p;
  for (std::size_t i = 0; i < 5; ++i) {
    p[i] = T(values[static_cast<Index>(kInputLike[i])]);
    if constexpr (!std::same_as<T, double>)
      p[i] = T(values[static_cast<Index>(kInputLike[i])], 5, static_cast<int>(i));
  }
  const T up = 1.0 / p[0], down = 0.5 * up;
  const auto rate = [&](const T& a, const T& u) { return (u - a) * (down + u * (up - down)); };
  Activation<T> result;
  result.level.resize(count);
  result.used.resize(count);
  std::array<T, kMuscles> u = drive<T>(trial, 0, p);
  for (std::size_t m = 0; m < kMuscles; ++m) {
    result.level[0][m] = u[m];
    result.used[0][m] = T(0.0);
  }
  for (std::size_t n = 0; n + 1 < count; ++n) {
    const double t = static_cast<double>(n) * half;
    const auto middle = drive<T>(trial, t + 0.5 * half, p), end = drive<T>(trial, t + half, p);
    for (std::size_t m = 0; m < kMuscles; ++m) {
      const T& a = result.level[n][m];
      const T k1 = rate(a, u[m]), k2 = rate(a + (0.5 * half) * k1, middle[m]);
      const T k3 = rate(a + (0.5 * half) * k2, middle[m]), k4 = rate(a + half * k3, end[m]);
      result.level[n + 1][m] = a + (half / 6) * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
      result.used[n + 1][m] = result.used[n][m] + (0.5 * half) * (a + result.level[n + 1][m]);
    }
    u = end;
  }
  return result;
}

// q̈ and its derivatives at one instant
struct Instant {
  double acceleration, byQ, bySpeed, scale, inertia;
  std::array<double, kMuscles> byLevel, byUsed;
  std::array<double, kShared> direct;
};

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

double plain(double x) {
  return x;
}
double plain(const Dual<5>& x) {
  return x.value();
}

}  // namespace

struct Elbow::Solution {
  VectorXd outputs, speeds, scale;
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> gamma;
};

template <bool derivatives>
Elbow::Solution Elbow::solve(int which, double h, const VectorXd& values, const VectorXd& latent,
                             const std::vector<std::size_t>& wanted, bool latentToo) const {
  using Level = std::conditional_t<derivatives, Dual<5>, double>;
  const Trial& trial = trials_[index(which)];
  const std::vector<double>& times = times_[index(which)];
  const auto samples = static_cast<Index>(times.size());
  const auto nodes = static_cast<Index>(nodes_[index(which)].size());
  const auto P = static_cast<Index>(wanted.size());
  const double duration = kTick * static_cast<double>(trial.excitations.size() - 1);
  const auto steps = static_cast<std::size_t>(std::lround(duration / h));
  const Activation<Level> act = activate<Level>(trial, 0.5 * h, 2 * steps + 1, values);

  Solution solution;
  solution.outputs = VectorXd::Constant(samples, kNaN);
  solution.speeds = VectorXd::Zero(samples);
  if (latentToo) solution.scale = VectorXd::Constant(nodes, kNaN);
  const Index columns = P + (latentToo ? nodes : 0);
  if (derivatives) solution.gamma.setConstant(samples, columns, kNaN);

  const auto start = static_cast<Index>(kShared) + 2 * which;
  const double bias = values[kBias], gain = values[kGain], clock = values[kClock];
  double q = values[start], w = values[start + 1];
  ArrayXd Sq = ArrayXd::Zero(columns), Sw = Sq;
  std::array<ArrayXd, 4> kq, kw;
  ArrayXd stageQ = Sq, stageW = Sw, oldQ = Sq, oldW = Sw;
  for (int s = 0; s < 4; ++s) kq[index(s)] = kw[index(s)] = Sq;
  std::vector<Index> inputColumns, directColumns;
  for (Index j = 0; j < P; ++j) {
    const std::size_t i = wanted[static_cast<std::size_t>(j)];
    if (i == static_cast<std::size_t>(start)) Sq[j] = 1;
    if (i == static_cast<std::size_t>(start) + 1) Sw[j] = 1;
  }

  const auto force = [&](double t, Index& node, double& share) {
    node = std::min<Index>(static_cast<Index>(t / kNode + 1e-9), nodes - 2);
    share = t / kNode - static_cast<double>(node);
    return latent.size() == 0 ? 0.0 : latent[node] + share * (latent[node + 1] - latent[node]);
  };

  const auto numTerms = static_cast<Index>(formula_.size());
  std::vector<StateTerm::Value> terms(formula_.size());
  // c·(e_1 + r_2·e_2 + …); of each term its share r_k
  const auto ratio = [&](Index k) { return k == 0 ? 1 : values[formulaAt_ + k]; };
  const auto formula = [&](double angle, double speed) {
    StateTerm::Value sum{0, 0, 0};
    for (Index k = 0; k < numTerms; ++k) {
      const StateTerm::Value e = formula_[static_cast<std::size_t>(k)].at(angle, speed);
      terms[static_cast<std::size_t>(k)] = e;
      sum = {sum.value + ratio(k) * e.value, sum.byQ + ratio(k) * e.byQ,
             sum.bySpeed + ratio(k) * e.bySpeed};
    }
    return sum;
  };
  const double amplitude = numTerms > 0 ? values[formulaAt_] : 0;

  Index sample = 0;
  Instant now;
  std::array<double, kMuscles> level, used;
  for (std::size_t n = 0; n < steps && sample < samples; ++n) {
    const double t0 = static_cast<double>(n) * h, q0 = q, w0 = w;
    const Index active =
        latentToo ? P + std::min<Index>(nodes, static_cast<Index>((t0 + h) / kNode + 1e-6) + 2) : P;
    std::array<double, 4> vq{}, vw{};
    for (std::size_t s = 0; s < 4; ++s) {
      const double reach = s == 0 ? 0 : s == 3 ? h : 0.5 * h;
      const std::size_t place = 2 * n + (s == 0 ? 0 : s == 3 ? 2 : 1);
      const double qs = s == 0 ? q0 : q0 + reach * vq[s - 1];
      const double ws = s == 0 ? w0 : w0 + reach * vw[s - 1];
      for (std::size_t m = 0; m < kMuscles; ++m) {
        level[m] = plain(act.level[place][m]);
        used[m] = plain(act.used[place][m]);
      }
      Index node = 0;
      double share = 0;
      const double d = force(t0 + reach, node, share);
      const StateTerm::Value shape = formula(qs, ws);
      evaluate<derivatives>(values, qs, ws, level, used, d + amplitude * shape.value, now);
      vq[s] = ws;
      vw[s] = now.acceleration;
      if (latentToo && s == 0 && share < 1e-6) solution.scale[node] = now.scale;
      if constexpr (derivatives) {
        auto nowQ = stageQ.head(active), nowW = stageW.head(active);
        if (s == 0) {
          nowQ = Sq.head(active);
          nowW = Sw.head(active);
        } else {
          nowQ = Sq.head(active) + reach * kq[s - 1].head(active);
          nowW = Sw.head(active) + reach * kw[s - 1].head(active);
        }
        now.byQ += amplitude * shape.byQ / now.inertia;
        now.bySpeed += amplitude * shape.bySpeed / now.inertia;
        kq[s].head(active) = nowW;
        kw[s].head(active) = now.byQ * nowQ + now.bySpeed * nowW;
        for (Index j = 0; j < P; ++j) {
          const std::size_t i = wanted[static_cast<std::size_t>(j)];
          if (i < kShared) kw[s][j] += now.direct[i];
          const Index k = static_cast<Index>(i) - formulaAt_;
          if (numTerms > 0 && k >= 0)
            kw[s][j] +=
                (k == 0 ? shape.value : amplitude * terms[static_cast<std::size_t>(k)].value) /
                now.inertia;
        }
        for (std::size_t c = 0; c < 5; ++c)
          for (Index j = 0; j < P; ++j) {
            if (wanted[static_cast<std::size_t>(j)] != kInputLike[c]) continue;
            for (std::size_t m = 0; m < kMuscles; ++m) {
              const auto i = static_cast<Index>(c);
              kw[s][j] += now.byLevel[m] * act.level[place][m].derivatives()[i] +
                          now.byUsed[m] * act.used[place][m].derivatives()[i];
            }
          }
        if (latentToo) {
          kw[s][P + node] += (1 - share) / now.inertia;
          kw[s][P + node + 1] += share / now.inertia;
        }
      }
    }
    q += h / 6 * (vq[0] + 2 * (vq[1] + vq[2]) + vq[3]);
    w += h / 6 * (vw[0] + 2 * (vw[1] + vw[2]) + vw[3]);
    if (!(std::abs(q) < 50)) return solution;
    if constexpr (derivatives) {
      oldQ.head(active) = Sq.head(active);
      oldW.head(active) = Sw.head(active);
      const auto part = [&](const ArrayXd& x) { return x.head(active); };
      Sq.head(active) += h / 6 * (part(kq[0]) + 2 * (part(kq[1]) + part(kq[2])) + part(kq[3]));
      Sw.head(active) += h / 6 * (part(kw[0]) + 2 * (part(kw[1]) + part(kw[2])) + part(kw[3]));
    }
    // samples within the step, by the cubic through both ends and their speeds
    for (; sample < samples; ++sample) {
      const double s = (times[static_cast<std::size_t>(sample)] - clock - t0) / h;
      if (s > 1 + 1e-9) break;
      const double h00 = (1 + 2 * s) * (1 - s) * (1 - s), h10 = s * (1 - s) * (1 - s);
      const double h01 = s * s * (3 - 2 * s), h11 = s * s * (s - 1);
      const double angle = h00 * q0 + h * h10 * w0 + h01 * q + h * h11 * w;
      const double speed =
          (6 * s * (s - 1) * (q0 - q)) / h + (1 - s) * (1 - 3 * s) * w0 + s * (3 * s - 2) * w;
      solution.outputs[sample] = (1 + gain) * angle + bias;
      solution.speeds[sample] = speed;
      if constexpr (derivatives) {
        auto row = solution.gamma.row(sample);
        row.setZero();
        row.head(active) = ((1 + gain) * (h00 * oldQ.head(active) + h * h10 * oldW.head(active) +
                                          h01 * Sq.head(active) + h * h11 * Sw.head(active)))
                               .matrix()
                               .transpose();
        for (Index j = 0; j < P; ++j) {
          const std::size_t i = wanted[static_cast<std::size_t>(j)];
          if (i == kBias) row[j] = 1;
          if (i == kGain) row[j] = angle;
          if (i == kClock) row[j] = -(1 + gain) * speed;
        }
      }
    }
  }
  if (latentToo) {  // the node at the end, and one beyond it
    for (Index i = 1; i < nodes; ++i)
      if (!std::isfinite(solution.scale[i])) solution.scale[i] = solution.scale[i - 1];
  }
  return solution;
}

Elbow::Elbow(std::vector<Trial> trials, const std::vector<std::string>& hidden, double step)
    : trials_(std::move(trials)), step_(step) {
  quantities_ = sharedQuantities();
  candidates_ = catalogue(hidden);
  for (std::size_t i = 0; i <= kTau; ++i) nuisances_.push_back(i);
  for (std::size_t t = 0; t < trials_.size(); ++t) {
    const Trial& trial = trials_[t];
    const std::string suffix = " of trial " + std::to_string(t + 1);
    nuisances_.push_back(quantities_.size());
    quantities_.push_back(
        {"start angle" + suffix, "rad", trial.startAngle, -3, 6, 0.05, false, static_cast<int>(t)});
    nuisances_.push_back(quantities_.size());
    quantities_.push_back({"start speed" + suffix, "rad/s", trial.startSpeed, -20, 20, 0.5, false,
                           static_cast<int>(t)});
    times_.emplace_back();
    for (Index k = 0; k < trial.angles.size(); ++k)
      times_.back().push_back(trial.firstSample + kTick * static_cast<double>(k));
    const double duration = kTick * static_cast<double>(trial.excitations.size() - 1);
    nodes_.emplace_back();
    for (int i = 0; (i - 1) * kNode < duration - 1e-9; ++i) nodes_.back().push_back(i * kNode);
  }
}

Elbow::Prediction Elbow::predict(int trial, const VectorXd& values, const VectorXd& latent,
                                 const std::vector<std::size_t>& wanted, bool latentToo) const {
  const Solution s = solve<true>(trial, step_, values, latent, wanted, latentToo);
  const auto P = static_cast<Index>(wanted.size());
  Prediction p;
  p.outputs = s.outputs;
  p.speeds = s.speeds;
  p.gamma = s.gamma.leftCols(P);
  if (latentToo) p.latentGamma = s.gamma.rightCols(s.gamma.cols() - P);
  p.latentScale = s.scale;
  return p;
}

VectorXd Elbow::outputs(int trial, const VectorXd& values, const VectorXd& latent) const {
  return solve<false>(trial, step_, values, latent, {}, false).outputs;
}

VectorXd Elbow::refinedOutputs(int trial, const VectorXd& values) const {
  return solve<false>(trial, 0.5 * step_, values, {}, {}, false).outputs;
}

std::unique_ptr<info::discover::DiscoveryProblem> Elbow::withFormula(
    const std::vector<info::discover::FormulaTerm>& terms,
    const std::vector<std::size_t>& kept) const {
  auto widened = std::make_unique<Elbow>(*this);
  widened->candidates_.clear();
  for (const std::size_t c : kept) widened->candidates_.push_back(candidates_[c]);
  if (formula_.empty()) widened->formulaAt_ = static_cast<Index>(quantities_.size());
  widened->quantities_.resize(static_cast<std::size_t>(widened->formulaAt_));
  widened->formula_.clear();
  info::discover::Candidate candidate{"formula", "force without a name", "", {}, {}, {}, {}, {}};
  VectorXd starts(static_cast<Index>(terms.size()));
  for (std::size_t k = 0; k < terms.size(); ++k) {
    const auto term = StateTerm::parse(terms[k].expression);
    if (!term) return nullptr;
    widened->formula_.push_back(*term);
    candidate.quantities.push_back(widened->quantities_.size());
    const double sd = terms[k].sd;
    candidate.sds.push_back(sd);
    starts[static_cast<Index>(k)] = terms[k].start;
    widened->quantities_.push_back(
        {"formula " + std::to_string(k + 1), "", 0, -20 * sd, 20 * sd, sd});
  }
  candidate.starts = {starts};
  widened->candidates_.push_back(std::move(candidate));
  return widened;
}

MatrixXd Elbow::inputs(int which) const {
  const Trial& trial = trials_[index(which)];
  const auto first = static_cast<std::size_t>(std::lround(trial.firstSample / kTick));
  MatrixXd u(trial.angles.size(), kMuscles);
  for (Index k = 0; k < u.rows(); ++k)
    for (Index m = 0; m < kMuscles; ++m)
      u(k, m) = trial.excitations[first + static_cast<std::size_t>(k)][static_cast<std::size_t>(m)];
  return u;
}

}  // namespace reduced
