#include <cvodes/cvodes.h>
#include <fmt/format.h>
#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

#include <algorithm>
#include <iterator>
#include <memory>

#include "arm_dynamics.h"

namespace bio::stepping {
namespace {

/// Owners for SUNDIALS handles.
struct FreeContext {
  void operator()(SUNContext context) const { SUNContext_Free(&context); }
};
struct FreeVector {
  void operator()(N_Vector v) const { N_VDestroy(v); }
};
struct FreeMatrix {
  void operator()(SUNMatrix m) const { SUNMatDestroy(m); }
};
struct FreeSolver {
  void operator()(SUNLinearSolver s) const { SUNLinSolFree(s); }
};
struct FreeMemory {
  void operator()(void* memory) const { CVodeFree(&memory); }
};
template <class Handle, class Free>
using Owned = std::unique_ptr<std::remove_pointer_t<Handle>, Free>;

Eigen::Map<Eigen::VectorXd> view(N_Vector v) {
  return {N_VGetArrayPointer(v), static_cast<Eigen::Index>(N_VGetLength(v))};
}

template <int N>
int rightHandSide(double t, N_Vector y, N_Vector yDot, void* dynamics) {
  auto out = view(yDot);
  static_cast<ArmDynamics<N>*>(dynamics)->derivative(t, view(y), out);
  return out.allFinite() ? 0 : 1;  // 1: try a smaller step
}

template <int N>
int powers(double t, N_Vector y, N_Vector power, void* dynamics) {
  thread_local Eigen::VectorXd unused;
  unused.resize(view(y).size());
  const auto p = static_cast<ArmDynamics<N>*>(dynamics)->derivative(t, view(y), unused);
  view(power)[0] = p.muscle;
  view(power)[1] = p.passive;
  view(power)[2] = p.external;
  return std::isfinite(p.muscle) ? 0 : 1;
}

template <int N>
int jacobian(double t, N_Vector y, N_Vector, SUNMatrix J, void* dynamics, N_Vector, N_Vector,
             N_Vector) {
  const auto n = static_cast<Eigen::Index>(SUNDenseMatrix_Rows(J));
  Eigen::Map<Eigen::MatrixXd> out(SUNDenseMatrix_Data(J), n, n);
  static_cast<ArmDynamics<N>*>(dynamics)->jacobian(t, view(y), out);
  return out.allFinite() ? 0 : 1;
}

void check(int flag, const char* what) {
  if (flag < 0) throw std::runtime_error(fmt::format("CVODES: {} failed ({})", what, flag));
}

/// SUNDIALS' own messages do not go to the user's screen: the return flag says the same.
void silent(int, const char*, const char*, char*, void*) {}

template <int N>
Trajectory runAdaptive(const Arm& arm, const ExcitationSignal& excitation, const ArmState& start,
                       const SimulationOptions& options) {
  ArmDynamics<N> dynamics(arm, excitation, options.externalForce);
  const Eigen::Index size = dynamics.size();
  const auto n = static_cast<Eigen::Index>(arm.numMuscles());

  SUNContext rawContext = nullptr;
  check(SUNContext_Create(nullptr, &rawContext), "SUNContext_Create");
  const Owned<SUNContext, FreeContext> context(rawContext);
  const Owned<N_Vector, FreeVector> y(N_VNew_Serial(size, context.get()));
  const Owned<N_Vector, FreeVector> work(N_VNew_Serial(3, context.get()));
  view(y.get()) = dynamics.pack(start);
  view(work.get()).setZero();
  const Owned<SUNMatrix, FreeMatrix> matrix(SUNDenseMatrix(size, size, context.get()));
  const Owned<SUNLinearSolver, FreeSolver> solver(
      SUNLinSol_Dense(y.get(), matrix.get(), context.get()));
  const std::unique_ptr<void, FreeMemory> memory(CVodeCreate(CV_BDF, context.get()));
  void* cvode = memory.get();
  check(CVodeInit(cvode, rightHandSide<N>, options.startTime, y.get()), "CVodeInit");
  check(CVodeSetErrHandlerFn(cvode, silent, nullptr), "CVodeSetErrHandlerFn");
  check(CVodeSetUserData(cvode, &dynamics), "CVodeSetUserData");
  check(CVodeSStolerances(cvode, options.relativeTolerance, options.absoluteTolerance),
        "CVodeSStolerances");
  check(CVodeSetLinearSolver(cvode, solver.get(), matrix.get()), "CVodeSetLinearSolver");
  check(CVodeSetJacFn(cvode, jacobian<N>), "CVodeSetJacFn");
  check(CVodeSetMaxNumSteps(cvode, 200000), "CVodeSetMaxNumSteps");
  check(CVodeQuadInit(cvode, powers<N>, work.get()), "CVodeQuadInit");

  const std::size_t rows = numRows(options);
  Recorder recorder(arm, rows);
  Trajectory& trajectory = recorder.trajectory();
  const auto record = [&](double t) {
    const auto state = view(y.get());
    recorder.add(t, state.template head<N>(), state.template segment<N>(N), state.segment(2 * N, n),
                 state.tail(n), view(work.get())[0], view(work.get())[1], view(work.get())[2]);
  };
  record(options.startTime);
  const StopWatch watch;
  const std::vector<double>& outside = options.externalForce.times();
  std::vector<double> corners;
  std::set_union(excitation.times().begin(), excitation.times().end(), outside.begin(),
                 outside.end(), std::back_inserter(corners));
  std::size_t corner = 0;
  double reached = options.startTime;
  for (std::size_t k = 1; k < rows && trajectory.outcome == Outcome::completed; ++k) {
    const double target = rowTime(options, k);
    // no step reaches over a corner of the excitation or of the force from outside
    while (reached < target) {
      while (corner < corners.size() && corners[corner] <= reached) ++corner;
      const double stop = corner < corners.size() ? std::min(corners[corner], target) : target;
      check(CVodeSetStopTime(cvode, stop), "CVodeSetStopTime");
      const int flag = CVode(cvode, stop, y.get(), &reached, CV_NORMAL);
      if (flag < 0) {
        trajectory.outcome = Outcome::noSolution;
        trajectory.failedAt = reached;
        const std::unique_ptr<char, void (*)(void*)> name(CVodeGetReturnFlagName(flag), std::free);
        trajectory.why =
            fmt::format("no solution at t = {:.6g} s: CVODE says {}", reached, name.get());
        break;
      }
    }
    if (trajectory.outcome != Outcome::completed) break;
    double quadratureTime = 0;
    check(CVodeGetQuad(cvode, &quadratureTime, work.get()), "CVodeGetQuad");
    record(target);
    if (options.progress && !options.progress(target)) {
      trajectory.outcome = Outcome::stopped;
      trajectory.failedAt = target;
      trajectory.why = fmt::format("stopped at t = {:.6g} s", target);
    }
  }
  trajectory.wallSeconds = watch.seconds();
  check(CVodeGetNumSteps(cvode, &trajectory.steps), "CVodeGetNumSteps");
  check(CVodeGetNumNonlinSolvIters(cvode, &trajectory.newtonIterations),
        "CVodeGetNumNonlinSolvIters");
  return recorder.finish();
}

}  // namespace

Trajectory simulateCvode(const Arm& arm, const ExcitationSignal& excitation, const ArmState& start,
                         const SimulationOptions& options) {
  return withCoordinates(arm.skeleton().numCoordinates(), [&](auto N) {
    return runAdaptive<decltype(N)::value>(arm, excitation, start, options);
  });
}

}  // namespace bio::stepping
