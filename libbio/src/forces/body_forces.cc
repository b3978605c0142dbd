#include "bio/forces/body_forces.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "forces/bushing_deflection.h"

namespace bio {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Second derivatives of the natural cubic spline at its knots, by elimination.
std::vector<double> naturalBends(const std::vector<double>& x, const std::vector<double>& y) {
  const std::size_t n = x.size();
  std::vector<double> bend(n, 0.0), carry(n, 0.0);
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const double left = x[i] - x[i - 1], right = x[i + 1] - x[i];
    const double pivot = 2 * (left + right) - left * carry[i - 1];
    carry[i] = right / pivot;
    const double jump = 6 * ((y[i + 1] - y[i]) / right - (y[i] - y[i - 1]) / left);
    bend[i] = (jump - left * bend[i - 1]) / pivot;
  }
  for (std::size_t i = n - 1; i-- > 1;) bend[i] -= carry[i] * bend[i + 1];
  return bend;
}

/// Through the points; a natural spline from four of them on, as OpenSim's loads are.
PiecewiseCubic throughPoints(const std::vector<double>& x, const std::vector<double>& y) {
  const std::vector<double> bend =
      x.size() > 3 ? naturalBends(x, y) : std::vector<double>(x.size(), 0.0);
  std::vector<PiecewiseCubic::Segment> segments;
  segments.push_back({x.front(), y.front(), 0, 0, 0});
  for (std::size_t i = 0; i + 1 < x.size(); ++i) {
    const double h = x[i + 1] - x[i];
    segments.push_back({x[i], y[i], (y[i + 1] - y[i]) / h - h / 6 * (2 * bend[i] + bend[i + 1]),
                        bend[i] / 2, (bend[i + 1] - bend[i]) / (6 * h)});
  }
  segments.push_back({x.back(), y.back(), 0, 0, 0});
  return {x, std::move(segments)};
}

Vector6 wrench(const Vector3d& moment, const Vector3d& force) {
  Vector6 W;
  W << moment, force;
  return W;
}

/// Generalised forces of W on a segment and their slopes, from its derivatives by `slope(k)`.
template <class Slope>
void addWrench(const MovingSegment& on, const Vector6& W, const Slope& slope,
               Eigen::Ref<Eigen::VectorXd> tau, Eigen::Ref<Eigen::MatrixXd> tau_q) {
  const std::size_t n = on.S.size();
  for (std::size_t j = 0; j < n; ++j) tau[static_cast<Eigen::Index>(j)] += W.dot(on.S[j]);
  for (std::size_t k = 0; k < n; ++k) {
    const Vector6 W_k = slope(k);
    for (std::size_t j = 0; j < n; ++j) {
      tau_q(static_cast<Eigen::Index>(j), static_cast<Eigen::Index>(k)) +=
          W_k.dot(on.S[j]) + W.dot(on.dS[j * n + k]);
    }
  }
}

Vector3d turn(const MovingSegment& segment, std::size_t k) {
  return segment.S[k].head<3>();
}

}  // namespace

LoadCourse::LoadCourse(const BodyLoad& load) {
  begin_ = -std::numeric_limits<double>::infinity();
  end_ = -begin_;
  if (load.times.empty()) {
    if (load.functions.size() != 9) {
      throw std::invalid_argument(
          fmt::format("load '{}': {} functions of time, must be 9 or a table", load.name,
                      load.functions.size()));
    }
    for (const Function& function : load.functions) functions_.emplace_back(function);
    return;
  }
  if (load.rows.size() != load.times.size()) {
    throw std::invalid_argument(fmt::format("load '{}': {} times and {} rows, must agree",
                                            load.name, load.times.size(), load.rows.size()));
  }
  for (std::size_t k = 0; k < load.times.size(); ++k) {
    if (!std::isfinite(load.times[k]) || (k > 0 && !(load.times[k] > load.times[k - 1]))) {
      throw std::invalid_argument(
          fmt::format("load '{}': time = {} s in row {}, must be finite and rise", load.name,
                      load.times[k], k + 1));
    }
    for (const double number : load.rows[k]) {
      if (!std::isfinite(number)) {
        throw std::invalid_argument(fmt::format("load '{}': {} at time {} s, must be finite",
                                                load.name, number, load.times[k]));
      }
    }
  }
  begin_ = load.times.front();
  end_ = load.times.back();
  for (std::size_t c = 0; c < 9; ++c) {
    std::vector<double> y;
    for (const auto& row : load.rows) y.push_back(row[c]);
    splines_.push_back(throughPoints(load.times, y));
  }
}

LoadCourse::At LoadCourse::at(double t) const {
  At at;
  if (t < begin_ || t > end_) return at;
  for (std::size_t c = 0; c < 9; ++c) {
    const CurveValue y = splines_.empty() ? functions_[c].evaluate(t) : splines_[c].evaluate(t);
    at.value[c] = y.value;
    at.slope[c] = y.slope;
  }
  return at;
}

BodyForces::BodyForces(const Model& model, const Skeleton& skeleton) {
  const int n = skeleton.numCoordinates();
  const auto place = [&](const std::string& kind, const std::string& name,
                         const std::string& body) -> const BodyPlacement& {
    try {
      return skeleton.placeOf(body);
    } catch (const std::invalid_argument& e) {
      throw std::invalid_argument(fmt::format("{} '{}': {}", kind, name, e.what()));
    }
  };
  for (const auto* loads : {&model.prescribedForces, &model.externalLoads}) {
    for (const BodyLoad& load : *loads) {
      if (!load.enabled) continue;
      const BodyPlacement& on = place("load", load.name, load.body);
      const BodyPlacement& force = place("load", load.name, load.forceFrame);
      const BodyPlacement& point = place("load", load.name, load.pointFrame);
      LoadCourse course(load);
      if (on.segment == 0) continue;
      loads_.push_back({placeOf(on.segment, n), placeOf(force.segment, n),
                        placeOf(point.segment, n), force.X_SB, point.X_SB, std::move(course)});
    }
  }
  for (std::size_t index = 0; index < model.pointSprings.size(); ++index) {
    const PointToPointSpring& spring = model.pointSprings[index];
    if (!spring.enabled) continue;
    Spring compiled{index, {}, {}, spring.stiffness, spring.restLength};
    std::array<std::size_t, 2> segments{};
    for (std::size_t i = 0; i < 2; ++i) {
      const BodyPlacement& on = place("PointToPointSpring", spring.name, spring.body[i]);
      segments[i] = on.segment;
      compiled.point[i] = on.X_SB.R * spring.point[i] + on.X_SB.p;
    }
    if (segments[0] == segments[1]) continue;
    for (std::size_t i = 0; i < 2; ++i) compiled.segment[i] = placeOf(segments[i], n);
    springs_.push_back(compiled);
  }
  for (std::size_t index = 0; index < model.bushings.size(); ++index) {
    const BushingForce& bushing = model.bushings[index];
    if (!bushing.enabled) continue;
    Bushing compiled;
    compiled.index = index;
    std::array<std::size_t, 2> segments{};
    for (std::size_t i = 0; i < 2; ++i) {
      const BodyPlacement& on = place("BushingForce", bushing.name, bushing.body[i]);
      segments[i] = on.segment;
      compiled.frame[i] = on.X_SB * placementOf(bushing.frame[i]);
    }
    if (segments[0] == segments[1]) continue;
    for (std::size_t i = 0; i < 2; ++i) compiled.segment[i] = placeOf(segments[i], n);
    compiled.stiffness << bushing.rotationalStiffness, bushing.translationalStiffness;
    compiled.damping << bushing.rotationalDamping, bushing.translationalDamping;
    bushings_.push_back(compiled);
  }
}

std::size_t BodyForces::placeOf(std::size_t segment, int numCoordinates) {
  for (std::size_t i = 0; i < segments_.size(); ++i) {
    if (segments_[i].segment == segment) return i;
  }
  const auto n = static_cast<std::size_t>(numCoordinates);
  segments_.push_back({segment,
                       {},
                       std::vector<Vector6>(n, Vector6::Zero()),
                       std::vector<Vector6>(n * n, Vector6::Zero())});
  return segments_.size() - 1;
}

void BodyForces::add(double t, const std::vector<MovingSegment>& segments, const Eigen::VectorXd& v,
                     BodyForceSums& sums) const {
  for (const Load& load : loads_) addLoad(load, t, segments, sums);
  for (const Spring& spring : springs_) addSpring(spring, segments, sums);
  for (const Bushing& bushing : bushings_) addBushing(bushing, segments, v, sums);
}

void BodyForces::addLoad(const Load& load, double t, const std::vector<MovingSegment>& segments,
                         BodyForceSums& sums) const {
  const LoadCourse::At at = load.course.at(t);
  const MovingSegment& on = segments[load.on];
  const MovingSegment& axes = segments[load.forceFrame];
  const MovingSegment& carrier = segments[load.pointFrame];
  const Matrix3d R = axes.X.R * load.X_force.R;
  const auto part = [](const std::array<double, 9>& numbers, std::size_t first) {
    return Vector3d(numbers[first], numbers[first + 1], numbers[first + 2]);
  };
  const Matrix3d R_point = carrier.X.R * load.X_point.R;
  const Vector3d x = R_point * part(at.value, 3) + carrier.X.R * load.X_point.p + carrier.X.p;
  const Vector3d F = R * part(at.value, 0), T = R * part(at.value, 6);
  addWrench(
      on, wrench(x.cross(F) + T, F),
      [&](std::size_t k) {
        const Vector3d w = turn(axes, k);
        const Vector3d F_k = w.cross(F);
        return wrench(carrier.moves(k, x).cross(F) + x.cross(F_k) + w.cross(T), F_k);
      },
      sums.load, sums.load_q);
  const Vector3d F_t = R * part(at.slope, 0), x_t = R_point * part(at.slope, 3);
  const Vector6 W_t = wrench(x_t.cross(F) + x.cross(F_t) + R * part(at.slope, 6), F_t);
  for (std::size_t j = 0; j < on.S.size(); ++j) {
    sums.load_t[static_cast<Eigen::Index>(j)] += W_t.dot(on.S[j]);
  }
}

void BodyForces::addSpring(const Spring& spring, const std::vector<MovingSegment>& segments,
                           BodyForceSums& sums) const {
  const MovingSegment& a = segments[spring.segment[0]];
  const MovingSegment& b = segments[spring.segment[1]];
  const Vector3d x_a = a.X.R * spring.point[0] + a.X.p, x_b = b.X.R * spring.point[1] + b.X.p;
  const Vector3d apart = x_b - x_a;
  const double distance = apart.norm();
  const Vector3d t = distance > 0 ? Vector3d(apart / distance) : Vector3d::Zero();
  const double slack = distance > 0 ? spring.restLength / distance : 0;
  const Vector3d F = -spring.stiffness * (1 - slack) * apart;  // on b
  const auto F_k = [&](std::size_t k) -> Vector3d {
    const Vector3d d_k = b.moves(k, x_b) - a.moves(k, x_a);
    return -spring.stiffness * ((1 - slack) * d_k + slack * t * t.dot(d_k));
  };
  const auto slopeAt = [&](const MovingSegment& on, const Vector3d& x, double sign) {
    return [&, x, sign](std::size_t k) {
      const Vector3d f = F_k(k);
      return Vector6(sign * wrench(on.moves(k, x).cross(F) + x.cross(f), f));
    };
  };
  addWrench(b, wrench(x_b.cross(F), F), slopeAt(b, x_b, 1), sums.passive, sums.passive_q);
  addWrench(a, -wrench(x_a.cross(F), F), slopeAt(a, x_a, -1), sums.passive, sums.passive_q);
}

// Moment and force in F are E⁻ᵀf_θ and f_d.
void BodyForces::addBushing(const Bushing& bushing, const std::vector<MovingSegment>& segments,
                            const Eigen::VectorXd& v, BodyForceSums& sums) const {
  const MovingSegment& a = segments[bushing.segment[0]];
  const MovingSegment& b = segments[bushing.segment[1]];
  const BushingDeflection deflection(a.X * bushing.frame[0], b.X * bushing.frame[1]);
  const Placement<double>& X_F = deflection.X_F;
  const Vector3d& p = deflection.p;
  const Matrix3d &E = deflection.E, &perE = deflection.perE;
  const std::size_t n = a.S.size();
  const auto slopeOf = [&](std::size_t k) { return deflection.slope(a.S[k], b.S[k]); };
  Vector6 rate = Vector6::Zero(), V_a = rate, V_b = rate;
  for (std::size_t j = 0; j < n; ++j) {
    const double v_j = v[static_cast<Eigen::Index>(j)];
    rate += v_j * slopeOf(j);
    V_a += v_j * a.S[j];
    V_b += v_j * b.S[j];
  }
  const auto E_k = [&](const Vector6& d_k) {  // ∂_kE
    Matrix3d change = Matrix3d::Zero();
    change.col(1) = d_k[0] * E.col(0).cross(E.col(1));
    change.col(2) = (d_k[0] * E.col(0) + d_k[1] * E.col(1)).cross(E.col(2));
    return change;
  };
  const Vector6 f =
      -(bushing.stiffness.cwiseProduct(deflection.value) + bushing.damping.cwiseProduct(rate));
  const Vector3d moment = perE.transpose() * f.head<3>();
  const Vector3d M = X_F.R * moment, F = X_F.R * f.tail<3>();
  const auto slope = [&](std::size_t k) {
    const Vector6 d_k = slopeOf(k);
    const Matrix3d bent = E_k(d_k);
    const Vector3d w = turn(a, k);
    // the rate's: screws turn with the coordinates, F's axes with the first body, M's origin moves
    Vector6 dV_a = Vector6::Zero(), dV_b = dV_a;
    for (std::size_t j = 0; j < n; ++j) {
      const double v_j = v[static_cast<Eigen::Index>(j)];
      dV_a += v_j * a.dS[j * n + k];
      dV_b += v_j * b.dS[j * n + k];
    }
    Vector6 rate_k = deflection.relative(dV_a, dV_b);
    const Vector3d turning = (V_b - V_a).head<3>();
    const Vector3d shifting = (V_b - V_a).tail<3>() + turning.cross(p);
    rate_k.head<3>() += X_F.R.transpose() * turning.cross(w);
    rate_k.tail<3>() += X_F.R.transpose() * (shifting.cross(w) + turning.cross(b.moves(k, p)));
    rate_k.head<3>() = perE * (rate_k.head<3>() - bent * rate.head<3>());
    const Vector6 f_k =
        -(bushing.stiffness.cwiseProduct(d_k) + bushing.damping.cwiseProduct(rate_k));
    const Vector3d moment_k = perE.transpose() * (f_k.head<3>() - bent.transpose() * moment);
    const Vector3d F_k = w.cross(F) + X_F.R * f_k.tail<3>();
    return wrench(w.cross(M) + X_F.R * moment_k + b.moves(k, p).cross(F) + p.cross(F_k), F_k);
  };
  const Vector6 W = wrench(M + p.cross(F), F);
  addWrench(b, W, slope, sums.passive, sums.passive_q);
  addWrench(
      a, -W, [&](std::size_t k) { return Vector6(-slope(k)); }, sums.passive, sums.passive_q);
  for (std::size_t k = 0; k < n; ++k) {
    const Vector6 d_k = slopeOf(k);
    for (std::size_t j = 0; j < n; ++j) {
      sums.passive_v(static_cast<Eigen::Index>(j), static_cast<Eigen::Index>(k)) -=
          slopeOf(j).dot(bushing.damping.cwiseProduct(d_k));
    }
  }
}

}  // namespace bio
