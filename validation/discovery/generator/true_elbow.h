#pragma once

#include <Eigen/Core>
#include <array>
#include <numbers>
#include <vector>

#include "generator/elbow_numbers.h"

namespace hidden {

inline constexpr double degree = std::numbers::pi / 180;  ///< [rad]

/// What happens between the recorded EMG and the muscle; absent by default.
struct InputChain {
  double delay = 0;          ///< the muscle sees the EMG of so long ago [s]
  double offset = 0;         ///< added to every channel
  double crosstalk = 0;      ///< share of the mean biceps EMG taken off each triceps channel
  double shape = 0;          ///< A of (e^{Au} − 1)/(e^A − 1); 0: straight
  std::vector<double> gain;  ///< per muscle; empty: 1
  bool commonDrive = false;  ///< the brachioradialis gets the mean EMG of biceps and brachialis
};

/// Torques and forces that the nominal elbow lacks; absent by default. Torque τ + for flexion,
/// q elbow angle, w its rate.
struct Extras {
  double viscous = 0;                         ///< −b·w [N m s]
  double coulomb = 0;                         ///< −τ_c·tanh(w/0.05) [N m]
  double stribeck = 0;                        ///< −Δ(1 + e^{−(w/0.3)²})·tanh(w/0.05) [N m]
  double drag = 0;                            ///< −c·w·|w| [N m s²]
  double powerDamping = 0;                    ///< −b·w·(w² + 0.01²)^{−1/4}, ~ sgn(w)√|w|
  double stiffness = 0, stiffnessRest = 1.2;  ///< −k(q − q_r) [N m/rad]
  double limit = 0;  ///< K of −K·s(x)·beyond, s the quintic step, at both ends [N m/rad]
  double limitUpper = 90 * degree, limitLower = 40 * degree;  ///< [rad]
  double limitTransition = 30 * degree;                       ///< [rad]
  double tilt = 0;                   ///< gravity's moment is that of q + δ [rad]
  double turn = 0;                   ///< the whole arm is turned so about the hinge [rad]
  double constant = 0;               ///< +τ_0 [N m]
  double handForce = 0;              ///< along the ground's x at the hand [N]
  double band = 0, bandRest = 0.28;  ///< −k·max(0, L − L_r)·∂L/∂q, hand to shoulder [N/m], [m]
  double fatigue = 0, fatigueTime = 0.3;  ///< contractile force × [1 − φ(1 − e^{−∫a dt/T})]
  double cubic = 0;                       ///< −k₃(q − 1.2)³ [N m/rad³]
  double hysteresis = 0;  ///< −α·z, ż = (w − |w|·z)/0.15, Bouc–Wen with n = 1 [N m]
  double tremor = 0, tremorFrequency = 5, tremorPhase = 0;  ///< α·sin(2πft + φ) [N m]
  double angleDamping = 0;                                  ///< −b·(q/1.2)²·w [N m s]
  double contact = 0, contactAngle = 1.2;     ///< +k·max(0, q_c − q) while it is there [N m/rad]
  double contactFrom = 1.2, contactTo = 2.8;  ///< [s]
};

/// The recorded EMG of one trial: values at rising times, straight between, held outside. Grows
/// while a trial is made.
struct Recording {
  std::vector<double> times;                   ///< [s]
  std::vector<std::array<double, 8>> emg;      ///< 0 … 1
  std::vector<std::array<double, 8>> unfaith;  ///< relative error n·c at the muscle; may be empty
  std::vector<double> torque;                  ///< known torque from outside [N m]; may be empty
};

/// The elbow that the data come from: one hinge, eight muscles with compliant tendons, and
/// whatever is hidden in it. State: q, w, 8 activations, 8 fibre lengths, [8 × ∫a dt if fatigue],
/// [z if hysteresis], [works if asked for: muscles, extras].
class TrueElbow {
 public:
  static constexpr Eigen::Index muscles = 8;

  TrueElbow(const ElbowNumbers& numbers, const InputChain& chain, const Extras& extras,
            bool countWork = false);

  Eigen::Index size() const { return size_; }
  const ElbowNumbers& numbers() const { return numbers_; }
  const InputChain& chain() const { return chain_; }
  const Extras& extras() const { return extras_; }

  /// Muscle–tendon length [m] and ∂ℓ/∂q [m/rad].
  struct MusculoskeletalSystem {
    double length, slope;
    bool wraps;
  };
  MusculoskeletalSystem arm(Eigen::Index muscle, double q) const;

  double inertia() const { return inertia_; }  ///< about the hinge [kg m²]
  double gravityMoment(double q) const;        ///< without tilt [N m]
  /// Torque of everything hidden, tilt's share of gravity included [N m].
  double extraTorque(double t, double q, double w, double z) const;

  /// Excitations of the muscles at time t, after the input chain.
  Eigen::Array<double, 8, 1> excitation(const Recording& recording, double t) const;

  /// Rest with activation = excitation at t = 0 and fibres in static equilibrium.
  Eigen::VectorXd start(const Recording& recording, double q) const;
  /// Net torque in that state.
  double startTorque(const Recording& recording, double q) const;

  /// ẏ; NaN where a fibre has left its domain.
  void rate(const Recording& recording, double t, const double* y, double* yDot) const;

 private:
  struct Variant {
    double fixedLength = 0;
    Vec P, Q;  ///< ends of the crossing span at 0, P on the upper arm
    int side = 1;
  };
  Variant variantOf(const Path& path, bool withConditional) const;

  ElbowNumbers numbers_;
  InputChain chain_;
  Extras extras_;
  Eigen::Index size_, fatigueAt_ = -1, hysteresisAt_ = -1, workAt_ = -1;
  double inertia_ = 0;
  Vec firstMoment_ = Vec::Zero();                 ///< Σ m (centre − hinge) at 0 [kg m]
  std::vector<std::array<Variant, 2>> variants_;  ///< without and with conditional points
};

}  // namespace hidden
