#pragma once

// The step of lane_model.h, for the one file per instruction set that compiles it.

#include <limits>

#include "simulation/newton_limits.h"
#include "simulation/simd/lane_muscle.h"
#include "simulation/simd/lane_path.h"

namespace bio::lanes {
namespace {

namespace newton = stepping::newton;

/// Newton's corrections fall quadratically: is the next one within the tolerance? See
/// VariationalStepper::isLast.
inline Mask isLast(const Real& correction, const Real& previous, double tolerance) {
  const Real ratio = correction / previous;
  return (correction < tolerance) |
         ((correction <= newton::worthwhile) & (correction <= 0.1 * previous) &
          (correction * ratio * ratio < 0.01 * tolerance));
}

/// The step's solver for some systems, with their muscles' laws.
class StepSolver final : public LaneSolver<Here> {
 public:
  explicit StepSolver(const LaneModel<Here>& system)
      : system_(system), laws_(new AnyLaneMuscle[static_cast<std::size_t>(system.numMuscles)]) {
    LawNumbers<Here> law;
    for (int i = 0; i < system.numMuscles; ++i) {
      gather(system.muscles[i].of, law);
      laws_[i].set(law);
    }
  }
  ~StepSolver() override { delete[] laws_; }

  void solve(LaneStep<Here>& step) override;

 private:
  struct Moving {
    const Real &v, &perStep, &share, &bold;
    const SineCosine& turn;
  };
  struct MuscleSums {
    Real force, dTau, eliminated, carried;
    Mask settled;  ///< lanes in which a fibre was
  };
  void addMuscles(LaneStep<Here>& step, const Mask& running, const Moving& moving,
                  MuscleSums& sums);
  Real evaluateFibre(int i, const Real& pathLength, LaneStep<Here>& step, const Moving& moving,
                     Rate& rate) const;
  void settleFibre(int i, const Real& pathLength, Mask unsettled, Real correction,
                   LaneStep<Here>& step, const Moving& moving, Rate& rate) const;
  void addRigid(const AnyLaneMuscle& law, MuscleStep<Here>& kept, const PathJet& path,
                const Moving& moving, MuscleSums& sums);
  Real correctFibres(LaneStep<Here>& step, const Real& dq);

  LaneModel<Here> system_;
  AnyLaneMuscle* laws_;
};

/// Forces of the muscles, and fibre lengths eliminated one by one.
inline void StepSolver::addMuscles(LaneStep<Here>& step, const Mask& running, const Moving& moving,
                                   MuscleSums& sums) {
  for (int i = 0; i < system_.numMuscles; ++i) {
    const LaneMuscle<Here>& muscle = system_.muscles[i];
    MuscleStep<Here>& kept = step.muscles[i];
    const PathJet path = muscleTendonLength(system_, muscle, step.place, moving.turn);
    kept.momentArm = path.slope;
    if (!muscle.hasFibreState) {
      addRigid(laws_[i], kept, path, moving, sums);
      continue;
    }
    Rate r;
    const Real correction = evaluateFibre(i, path.length, step, moving, r);
    const Mask isBold = running & (absolute(correction) * muscle.perFibre > moving.bold);
    if (any(isBold)) [[unlikely]] {
      sums.settled |= isBold;
      settleFibre(i, path.length, isBold, correction, step, moving, r);
    }
    sums.force -= r.tendonForce.v * path.slope;
    sums.dTau -= r.dF_dMuscleTendonLength.v / 2 * path.slope * path.slope;
    sums.dTau -= r.tendonForce.v / 2 * path.curvature;
    const Real G = moving.share / 2 * r.dF_dFibreLength.v * kept.inverse * path.slope;
    sums.eliminated -= G * r.dV_dMuscleTendonLength.v / 2 * path.slope;
    sums.carried += G * kept.residual;
    kept.dV_dMuscleTendonLength = r.dV_dMuscleTendonLength.v;
    kept.dF_dFibreLength = r.dF_dFibreLength.v;
  }
}

/// See VariationalStepper::evaluateFibre.
[[gnu::always_inline]] inline Real StepSolver::evaluateFibre(int i, const Real& pathLength,
                                                             LaneStep<Here>& step,
                                                             const Moving& moving,
                                                             Rate& rate) const {
  MuscleStep<Here>& kept = step.muscles[i];
  const Real l_m = (kept.fibreLength + kept.fibreLengthEnd) / 2;
  const Real v = (kept.fibreLengthEnd - kept.fibreLength) / step.length;
  laws_[i].rate({kept.activation, l_m, pathLength, v, step.length}, rate);
  kept.residual = v - rate.fibreVelocity.v;
  kept.inverse = 1 / (moving.perStep - rate.dV_dFibreLength.v / 2);
  return -kept.residual * kept.inverse;
}

/// See VariationalStepper::settleFibre. Lanes that are not unsettled, or no longer, keep their end,
/// and with that their rate. Apart from what every muscle does, so that this stays quick.
[[gnu::noinline]] void StepSolver::settleFibre(int i, const Real& pathLength, Mask unsettled,
                                               Real correction, LaneStep<Here>& step,
                                               const Moving& moving, Rate& rate) const {
  constexpr double infinite = std::numeric_limits<double>::infinity();
  Real& end = step.muscles[i].fibreLengthEnd;
  Real low = same(-infinite);
  Real high = same(infinite);
  for (int tries = 0; tries < newton::mostTries && any(unsettled); ++tries) {
    const Mask falls = correction < 0;
    high = choose(unsettled & falls, end, high);
    low = choose(unsettled & ~falls, end, low);
    const Real next = end + correction;
    const Real within = choose((low < next) & (next < high), next, (low + high) / 2);
    end = choose(unsettled, within, end);
    correction = evaluateFibre(i, pathLength, step, moving, rate);
    unsettled &= absolute(correction) * system_.muscles[i].perFibre > newton::bold;
  }
}

/// The force of a muscle with a rigid tendon, whose fibre has no equation and stays as it is.
inline void StepSolver::addRigid(const AnyLaneMuscle& law, MuscleStep<Here>& kept,
                                 const PathJet& path, const Moving& moving, MuscleSums& sums) {
  RigidForce r;
  law.force({kept.activation, kept.fibreLength, path.length, path.slope * moving.v, 0.0}, r);
  const Real F_q = (r.dF_dPathLength.v / 2 + r.dF_dPathSpeed.v * moving.perStep) * path.slope +
                   r.dF_dPathSpeed.v / 2 * path.curvature * moving.v;
  sums.force -= r.tendonForce.v * path.slope;
  sums.dTau -= path.slope * F_q;
  sums.dTau -= r.tendonForce.v / 2 * path.curvature;
  kept.residual = kept.inverse = same(0);
  kept.dV_dMuscleTendonLength = kept.dF_dFibreLength = same(0);
}

/// Makes fibres' corrections of their residuals; the largest, of ℓ0.
inline Real StepSolver::correctFibres(LaneStep<Here>& step, const Real& dq) {
  Real largest = same(0);
  for (int i = 0; i < system_.numMuscles; ++i) {
    MuscleStep<Here>& kept = step.muscles[i];
    const Real C_dq = -kept.dV_dMuscleTendonLength / 2 * kept.momentArm * dq;
    kept.residual = -(kept.residual + C_dq) * kept.inverse;  // now δℓ
    largest = larger(largest, absolute(kept.residual) * system_.muscles[i].perFibre);
  }
  return largest;
}

/// See VariationalStepper::solve, whose comments are not repeated.
inline void StepSolver::solve(LaneStep<Here>& step) {
  const LaneModel<Here>& system = system_;
  const Real none = same(0);
  const Real real = same(1);
  const Real& h = step.length;
  const Real perStep = 1 / h;
  const Real share = step.symmetric ? h / 2 : h;
  const Real dMv = system.mass * perStep;
  Real bold = same(newton::bold);  // of the iteration that comes
  for (int l = 0; l < width; ++l) {
    if (step.iterations[l] == 0) bold[l] = newton::boldAtFirst;
  }
  Mask running = step.wanted;
  step.converged = running ^ running;
  while (all(running == step.wanted)) {
    const Real q_m = (step.q + step.qEnd) / 2;
    const Real v = (step.qEnd - step.q) / h;
    const SineCosine turn = sineCosine(q_m);
    // the last small changes leave the points of paths as they are, or an iteration that ends at
    // a conditional one would go to and fro
    step.place = choose(absolute(q_m - step.place) < newton::near, step.place, q_m);

    // skeleton and gravity
    const Real Mv = system.mass * v;
    const Real L_q = system.gravityCosine * turn.sine - system.gravitySine * turn.cosine;
    const Real dL_q = (system.gravityCosine * turn.cosine + system.gravitySine * turn.sine) / 2;

    PassiveForce<Here> passive{none, none, none};
    if (system.hasForces) passiveForce(system, running, q_m, v, passive);
    const Real dPassive = passive.dForce_dq / 2 + passive.dForce_dqDot / h;
    MuscleSums sums{none, dPassive, none, none, running ^ running};
    addMuscles(step, running, {v, perStep, share, bold, turn}, sums);
    bold = same(newton::bold);
    Real& force = sums.force;
    const Real& dTau = sums.dTau;

    const Real R = Mv - h / 2 * L_q - share * (force + passive.force + step.external) - step.p;
    const Real J = dMv - h / 2 * dL_q - share * dTau - sums.eliminated;
    const Real dq = (sums.carried - R) / J;
    const Real size = absolute(dq);
    const Real fibreSize = correctFibres(step, dq);
    // what is not a number, or wild, is given up
    running &= (size < 1e6) & (fibreSize < 1e6);

    Real shorten = choose(size > newton::largestTurn, newton::largestTurn / size, real);
    shorten = choose(fibreSize * shorten > newton::largestFibreStep,
                     newton::largestFibreStep / fibreSize, shorten);
    step.qEnd = choose(running, step.qEnd + shorten * dq, step.qEnd);
    for (int i = 0; i < system.numMuscles; ++i) {
      MuscleStep<Here>& kept = step.muscles[i];
      kept.fibreLengthEnd =
          choose(running, kept.fibreLengthEnd + shorten * kept.residual, kept.fibreLengthEnd);
    }
    const Real correction = larger(size, fibreSize);
    const Mask last =
        running & isLast(correction, choose((shorten == 1) & ~sums.settled, step.previous, none),
                         step.newtonTolerance);
    step.previous = correction;
    for (int l = 0; l < width; ++l) {
      if (step.wanted[l] != 0 && ++step.iterations[l] >= step.maxIterations) running[l] = 0;
    }
    if (!any(last)) continue;

    // ends of the lanes that have come to theirs, to first order in the last correction
    for (int i = 0; i < system.numMuscles; ++i) {
      const MuscleStep<Here>& kept = step.muscles[i];
      force -= kept.dF_dFibreLength / 2 * kept.residual * kept.momentArm;
    }
    force += (dTau - dPassive) * dq;
    const Real passiveEnd = passive.force + dPassive * dq;
    const Real moved = step.qEnd - step.q;
    Real p = Mv + dMv * dq + h / 2 * (L_q + dL_q * dq);
    if (step.symmetric) p += share * (force + passiveEnd + step.external);
    step.pEnd = choose(last, p, step.pEnd);
    step.muscleWork = choose(last, force * moved, step.muscleWork);
    step.passiveWork = choose(last, passiveEnd * moved, step.passiveWork);
    step.externalWork = choose(last, step.external * moved, step.externalWork);
    step.converged = last;
    running &= ~last;
  }
  step.done = step.wanted & ~running;
}

}  // namespace
}  // namespace bio::lanes
