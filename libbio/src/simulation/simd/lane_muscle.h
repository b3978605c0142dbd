#pragma once

// What muscles of all classes do at a state, in lanes: the laws' own texts (bio/muscle,
// muscle/schutte_law.h) in numbers of lanes.

#include "bio/muscle/degroote_fregly2016.h"
#include "bio/muscle/thelen2003.h"
#include "simulation/simd/lane_curve.h"

namespace bio::lanes {
namespace {

/// Fibre velocity and tendon force with derivatives, as a step takes them.
struct Rate {
  LaneNumber fibreVelocity, tendonForce;
  LaneNumber dV_dFibreLength, dV_dMuscleTendonLength;
  LaneNumber dF_dFibreLength, dF_dMuscleTendonLength;
};
/// The force with a rigid tendon, and its derivatives.
struct RigidForce {
  LaneNumber tendonForce, dF_dPathLength, dF_dPathSpeed;
};
/// Arguments of both: activation, ℓ or L̇, L, ℓ̇ and h of a step.
struct MuscleState {
  LaneNumber activation, fibreLength, pathLength, velocity, step;
};

/// SchutteMuscle in lanes.
class LaneSchutte {
 public:
  struct Quantities {
    LaneNumber maxIsometricForce, damping;
  };
  struct Options {
    LaneNumber activationFloor;
    bool clampForce;
  };
  struct Curves {
    LaneCubic tendonForce, activeForce;
    const LaneCubic* passiveForce;
  };
  struct Pieces {
    LaneCubic::Elsewhere tendonForce, activeForce, passiveForce;
  };

  explicit LaneSchutte(const LawNumbers<Here>& law)
      : perFibre_(law.numbers[1]),
        perTendon_(law.numbers[2]),
        speedScale_(law.numbers[3]),
        thickness_(law.numbers[4]),
        quantities_{law.numbers[0], law.numbers[5]},
        options_{law.numbers[6], law.clampsForce},
        passive_(law.cubics[2]),
        curves_{LaneCubic(law.cubics[0]), LaneCubic(law.cubics[1]),
                law.hasPassiveCurve ? &passive_ : nullptr} {}
  LaneSchutte(const LaneSchutte&) = delete;
  LaneSchutte& operator=(const LaneSchutte&) = delete;

  const LaneNumber& perFibre() const { return perFibre_; }
  const LaneNumber& perTendon() const { return perTendon_; }
  const LaneNumber& speedScale() const { return speedScale_; }
  const LaneNumber& thickness() const { return thickness_; }
  const Quantities& quantities() const { return quantities_; }
  const Options& options() const { return options_; }
  const Curves& curves() const { return curves_; }

 private:
  LaneNumber perFibre_, perTendon_, speedScale_, thickness_;
  Quantities quantities_;
  Options options_;
  LaneCubic passive_;
  Curves curves_;
};

template <class Shape>
muscles::HillMuscle<Shape> hillMuscle(const LawNumbers<Here>& law) {
  using Parameters = typename Shape::Parameters;
  Parameters p;
  for (std::size_t i = 0; i < Parameters::count; ++i) Parameters::at(p, i) = law.numbers[i];
  p.ignoreTendonCompliance = law.ignoresTendonCompliance;
  if constexpr (std::is_same_v<Shape, muscles::DeGrooteFregly2016<LaneNumber>>) {
    p.ignorePassiveFibreForce = law.ignoresPassiveForce;
  }
  if constexpr (std::is_same_v<Shape, muscles::RigidTendon<LaneNumber>>) {
    p.curves = {LaneCubic(law.cubics[0]), LaneCubic(law.cubics[1]), LaneCubic(law.cubics[2])};
  }
  if constexpr (std::is_same_v<Shape, muscles::Millard2012<LaneNumber>>) {
    return muscles::HillMuscle<Shape>(
        Shape(p, {law.damping, muscles::BezierCurve<LaneNumber, 2>(law.tendon),
                  muscles::BezierCurve<LaneNumber, 5>(law.active),
                  muscles::BezierCurve<LaneNumber, 2>(law.passive),
                  muscles::BezierCurve<LaneNumber, 4>(law.forceVelocity),
                  muscles::MillardSpeed<LaneNumber>(law)}));
  } else {
    return muscles::HillMuscle<Shape>(p);
  }
}

/// The members of FibreRateDerivatives.
struct FullRate {
  LaneNumber fibreVelocity, tendonForce;
  LaneNumber dV_dActivation, dV_dFibreLength, dV_dMuscleTendonLength;
  LaneNumber dF_dFibreLength, dF_dMuscleTendonLength;
};

// Worthwhile for the shortest law alone: a twentieth of a batch's instructions.
[[gnu::always_inline]] inline void evaluateRate(const LaneSchutte& muscle, const MuscleState& s,
                                                Rate& rate) {
  LaneSchutte::Pieces none;
  const schutte::ForceBalance<LaneNumber> f =
      schutte::forceBalance(muscle, s.activation, s.fibreLength, s.pathLength, none);
  const FullRate r = schutte::assemble<FullRate>(
      muscle, f, schutte::velocity(f.P, f.A, muscle.quantities().damping));
  rate = {r.fibreVelocity,          r.tendonForce,     r.dV_dFibreLength,
          r.dV_dMuscleTendonLength, r.dF_dFibreLength, r.dF_dMuscleTendonLength};
}

template <class Shape>
[[gnu::noinline]] void evaluateRate(const muscles::HillMuscle<Shape>& muscle, const MuscleState& s,
                                    Rate& rate) {
  const muscles::FibreRate<LaneNumber> r =
      muscle.rateNear(s.activation, s.fibreLength, s.pathLength, s.velocity, s.step);
  rate = {r.fibreVelocity,  r.tendonForce,     r.dV_dFibreLength,
          r.dV_dPathLength, r.dF_dFibreLength, r.dF_dPathLength};
}

template <class Shape>
[[gnu::noinline]] void evaluateForce(const muscles::HillMuscle<Shape>& muscle, const MuscleState& s,
                                     RigidForce& force) {
  const muscles::RigidRate<LaneNumber> r = muscle.rigidRate(s.activation, s.pathLength, s.velocity);
  force = {r.tendonForce, r.dF_dPathLength, r.dF_dPathSpeed};
}
// Schutte's class has no rigid tendon.
inline void evaluateForce(const LaneSchutte&, const MuscleState&, RigidForce&) {}

/// A muscle of any class. By hand, since a std::variant brings functions that the linker shares
/// between files, and these may be compiled for AVX2.
class AnyLaneMuscle {
 public:
  AnyLaneMuscle() = default;
  AnyLaneMuscle(const AnyLaneMuscle&) = delete;
  AnyLaneMuscle& operator=(const AnyLaneMuscle&) = delete;
  ~AnyLaneMuscle() {
    if (law_) visit([](auto& muscle) { delete &muscle; });
  }

  void set(const LawNumbers<Here>& law) {
    class_ = law.law;
    switch (class_) {
      case LaneClass::schutte:
        law_ = new LaneSchutte(law);
        break;
      case LaneClass::thelen:
        law_ = new Thelen(hillMuscle<Thelen::Shape>(law));
        break;
      case LaneClass::millard:
        law_ = new Millard(hillMuscle<Millard::Shape>(law));
        break;
      case LaneClass::deGroote:
        law_ = new DeGroote(hillMuscle<DeGroote::Shape>(law));
        break;
      case LaneClass::rigidTendon:
        law_ = new Rigid(hillMuscle<Rigid::Shape>(law));
    }
  }

  void rate(const MuscleState& s, Rate& rate) const {
    visit([&](const auto& muscle) { evaluateRate(muscle, s, rate); });
  }
  void force(const MuscleState& s, RigidForce& force) const {
    visit([&](const auto& muscle) { evaluateForce(muscle, s, force); });
  }

 private:
  using Thelen = muscles::HillMuscle<muscles::Thelen2003<LaneNumber>>;
  using Millard = muscles::HillMuscle<muscles::Millard2012<LaneNumber>>;
  using DeGroote = muscles::HillMuscle<muscles::DeGrooteFregly2016<LaneNumber>>;
  using Rigid = muscles::HillMuscle<muscles::RigidTendon<LaneNumber>>;

  /// The one switch between classes.
  template <class F>
  void visit(const F& f) const {
    switch (class_) {
      case LaneClass::schutte:
        return f(*static_cast<LaneSchutte*>(law_));
      case LaneClass::thelen:
        return f(*static_cast<Thelen*>(law_));
      case LaneClass::millard:
        return f(*static_cast<Millard*>(law_));
      case LaneClass::deGroote:
        return f(*static_cast<DeGroote*>(law_));
      case LaneClass::rigidTendon:
        return f(*static_cast<Rigid*>(law_));
    }
    __builtin_unreachable();
  }

  LaneClass class_ = LaneClass::schutte;
  void* law_ = nullptr;
};

}  // namespace
}  // namespace bio::lanes
