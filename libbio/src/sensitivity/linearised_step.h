#pragma once

// A step of the variational integrator and its derivatives in the states; not public.

#include "simulation/coordinate_sums.h"
#include "simulation/other_forces.h"
#include "simulation/step_tape.h"

namespace bio::stepping {

/// One part of a tape with its residuals (S1) to (S3) of docs/theory/sensitivity.md linearised in
/// the states and in the times at its ends, for sweeps in either direction.
template <int N>
class LinearisedStep {
 public:
  using Index = Eigen::Index;
  using Vector = Eigen::Matrix<double, N, 1>;
  using Matrix = Eigen::Matrix<double, N, N>;

  struct OfMuscle {
    FibreRateDerivatives r;              ///< of an elastic muscle at the middle
    muscles::RigidRate<double> rigid{};  ///< of one with a rigid tendon
    double activation = 0;               ///< at the middle
    double l_m = 0, l_v = 0;             ///< fibre length at the middle [m], and its rate [m/s]
    double stretch = 0;                  ///< of the fibre over the step [m]
    double perJ = 0;                     ///< 1/J_i; 0 where the fibre is held
    double half = 0;                     ///< V_L/2J_i
    double speed = 0;                    ///< of the path [m/s]; rigid tendon
    bool hasFibre = false;
    bool isHeld = false;
  };

  LinearisedStep(const MusculoskeletalSystem& system, const SimulationOptions& options,
                 SystemConfiguration<N>& configuration)
      : system_(system),
        options_(options),
        symmetric_(bio::isSymmetric(options.integrator)),
        configuration_(configuration),
        others_(system),
        muscles_(system.numMuscles()),
        pieces_(system.numMuscles()) {}

  /// Moves the configuration to the middle of part i.
  void moveTo(const StepTape& tape, std::size_t i) {
    const StepTape::Part& part = tape.parts()[i];
    begin_ = tape.times()[part.begin].value;
    end_ = tape.times()[part.end].value;
    h_ = end_ - begin_;
    middle_ = begin_ + h_ / 2;
    share_ = symmetric_ ? h_ / 2 : h_;
    endShare_ = symmetric_ ? share_ : 0;
    q_m_ = (tape.q(i) + tape.q(i + 1)) / 2;
    v_ = (tape.q(i + 1) - tape.q(i)) / h_;
    configuration_.moveTo(q_m_);
    addSkeleton();
    addPassive();
    for (std::size_t m = 0; m < system_.numMuscles(); ++m) addMuscle(m, tape, i);
    combine();
  }

  double begin() const { return begin_; }
  double end() const { return end_; }
  double middle() const { return middle_; }
  double h() const { return h_; }
  double share() const { return share_; }        ///< of the forces in F⁻ [s]
  double endShare() const { return endShare_; }  ///< of the forces in F⁺ [s]
  bool isSymmetric() const { return symmetric_; }
  const Vector& q_m() const { return q_m_; }
  const Vector& v() const { return v_; }
  const OfMuscle& muscle(std::size_t m) const { return muscles_[m]; }
  /// Pieces of the muscle's curves at the middle.
  SchuttePieces& pieces(std::size_t m) { return pieces_[m]; }
  const OtherForces<N>& others() const { return others_; }
  /// Slope of the external force at the middle; without meaning if there is none.
  const Eigen::VectorXd& externalSlope() const { return externalSlope_; }

  const Matrix& perJ() const { return perJ_; }  ///< J⁻¹ from residuals to dq′
  /// Map of the known dq′ of prescribed coordinates, 0 or due to a time that moves, to that of all
  /// others; their columns of perJ() are 0.
  const Matrix& givenColumns() const { return givenColumns_; }
  const Matrix& residualAtBegin() const { return residualAtBegin_; }  ///< ∂R/∂q at fixed force
  const Matrix& momentumAtEnd() const { return momentumAtEnd_; }      ///< ∂p′/∂q′
  const Matrix& momentumAtBegin() const { return momentumAtBegin_; }  ///< ∂p′/∂q
  const Vector& residualInLength() const { return residualInLength_; }  ///< ∂R/∂h
  const Vector& momentumInLength() const { return momentumInLength_; }  ///< ∂p′/∂h

  /// Speeds of the prescribed coordinates at the end, 0 for the others.
  Vector givenSpeeds() const {
    Vector q = Vector::Zero(countOf<N>(system_)), speed = q;
    options_.prescribed.place(end_, q, speed);
    return speed;
  }

 private:
  /// (M v) and L_q = ½ vᵀ∂M v − ∂V over the middle configuration and the speed
  void addSkeleton() {
    const int n = countOf<N>(system_);
    const EnergyDerivatives<N>& energy = configuration_.energy(v_);
    M_ = energy.T_vv;
    L_q_ = -energy.V_q;
    Mv_q_.setZero(n, n);
    L_qq_ = -energy.V_qq;
    L_qv_.setZero(n, n);
    if (!system_.skeleton().hasConstantInertia()) {
      L_q_ += energy.T_q;
      Mv_q_ = energy.T_vq;
      L_qv_ = energy.T_vq.transpose();
      L_qq_ += energy.T_qq;
    }
  }

  void addPassive() {
    const int n = countOf<N>(system_);
    f_.setZero(n);
    f_q_.setZero(n, n);
    f_v_.setZero(n, n);
    system_.coordinateForces().template add<N>(q_m_, v_, f_, f_q_, f_v_);
    if (!options_.externalForce.empty()) {
      ExternalForce::At external = options_.externalForce.at(middle_);
      f_ += external.value;
      externalSlope_ = std::move(external.slope);
    }
    if (others_.any()) {
      others_.add(middle_, configuration_, v_, f_, f_q_, f_v_);
      f_ += others_.load();
      f_q_ += others_.load_q();
    }
    f_end_.setZero(n, n);
  }

  void addMuscle(std::size_t m, const StepTape& tape, std::size_t i) {
    const auto sm = static_cast<Index>(m);
    const SimulatedMuscle& muscle = system_.muscles()[m].muscle;
    const LengthJet<N>& path = configuration_.length(m);
    OfMuscle& here = muscles_[m];
    here.activation = tape.middleActivation(i + 1)[sm];
    here.hasFibre = muscle.hasFibreState();
    if (!here.hasFibre) {
      here.speed = path.dL_dq.dot(v_);
      here.rigid = muscle.rigidRate(here.activation, path.length, here.speed);
      const muscles::RigidRate<double>& r = here.rigid;
      addAlong<N>(f_, -r.tendonForce, path);
      F_q_ = r.dF_dPathLength * path.dL_dq;
      addSecondTimes<N>(F_q_, r.dF_dPathSpeed, path, v_);
      f_q_.noalias() -= path.dL_dq * F_q_.transpose();
      addSecond<N>(f_q_, -r.tendonForce, path);
      addOuter<N>(f_v_, -r.dF_dPathSpeed, path);
      return;
    }
    const double l0 = tape.fibreLength(i)[sm], l1 = tape.fibreLength(i + 1)[sm];
    here.l_m = (l0 + l1) / 2;
    here.stretch = l1 - l0;
    here.l_v = here.stretch / h_;
    here.r = muscle.rateNear(here.activation, here.l_m, path.length, here.l_v, h_, pieces_[m]);
    const FibreRateDerivatives& r = here.r;
    here.isHeld = muscle.isHeld(l1);
    here.perJ = here.isHeld ? 0 : 1 / (1 / h_ - r.dV_dFibreLength / 2);
    here.half = r.dV_dMuscleTendonLength / 2 * here.perJ;
    addAlong<N>(f_, -r.tendonForce, path);
    addOuter<N>(f_q_, -r.dF_dMuscleTendonLength, path);
    addSecond<N>(f_q_, -r.tendonForce, path);
    addOuter<N>(f_end_, -(r.dF_dFibreLength / 2 * here.half), path);
  }

  /// With q_mid = (q_begin + q_end)/2 and v = (q_end − q_begin)/h, the chain rule gives the
  /// derivatives of any x(q_mid, v): x_end = x_q/2 + x_v/h, x_begin = x_q/2 − x_v/h,
  /// x_h = −x_v v/h.
  void combine() {
    const double h = h_;
    q_ = Mv_q_ - h / 2 * L_qq_ - share_ * f_q_;
    by_v_ = M_ - h / 2 * L_qv_ - share_ * f_v_;
    J_ = q_ / 2 + by_v_ / h - share_ * f_end_;
    invert();
    residualAtBegin_ = q_ / 2 - by_v_ / h;
    residualInLength_ = -by_v_ * v_ / h - L_q_ / 2 - share_ / h * f_;
    q_ = Mv_q_ + h / 2 * L_qq_ + endShare_ * f_q_;
    by_v_ = M_ + h / 2 * L_qv_ + endShare_ * f_v_;
    momentumAtEnd_ = q_ / 2 + by_v_ / h + endShare_ * f_end_;
    momentumAtBegin_ = q_ / 2 - by_v_ / h;
    momentumInLength_ = -by_v_ * v_ / h + L_q_ / 2 + endShare_ / h * f_;
  }

  void invert() {
    if (system_.prescribed().empty()) {
      perJ_ = J_.inverse();
      return;
    }
    for (const int k : system_.prescribed()) {
      J_.row(k).setZero();
      J_(k, k) = 1;
    }
    givenColumns_ = J_.inverse();
    perJ_ = givenColumns_;
    for (const int k : system_.prescribed()) perJ_.col(k).setZero();
  }

  const MusculoskeletalSystem& system_;
  const SimulationOptions& options_;
  bool symmetric_;
  SystemConfiguration<N>& configuration_;
  OtherForces<N> others_;
  std::vector<OfMuscle> muscles_;
  std::vector<SchuttePieces> pieces_;  ///< of each muscle's last state
  double begin_ = 0, end_ = 0, middle_ = 0, h_ = 0, share_ = 0, endShare_ = 0;
  Eigen::VectorXd externalSlope_;
  Vector q_m_, v_, L_q_, f_, F_q_, residualInLength_, momentumInLength_;
  Matrix M_, Mv_q_, L_qq_, L_qv_;
  Matrix f_q_, f_v_, f_end_;  ///< f_end: df through the fibres that dq′ moves
  Matrix q_, by_v_, J_, perJ_, givenColumns_;
  Matrix residualAtBegin_, momentumAtEnd_, momentumAtBegin_;
};

}  // namespace bio::stepping
