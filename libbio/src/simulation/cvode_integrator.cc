#include <cvodes/cvodes.h>
#include <fmt/format.h>
#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

#include <algorithm>
#include <iterator>
#include <memory>

#include "simulation/switch_crossing.h"
#include "simulation/system_dynamics.h"

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

/// Context of CVODE's callbacks.
template <int N>
struct AdaptiveTask {
  SystemDynamics<N> dynamics;
  const std::vector<PathSwitch>& switches;
};

template <int N>
int rightHandSide(double t, N_Vector y, N_Vector yDot, void* task) {
  auto out = view(yDot);
  static_cast<AdaptiveTask<N>*>(task)->dynamics.derivative(t, view(y), out);
  return out.allFinite() ? 0 : 1;  // 1: try a smaller step
}

template <int N>
int powers(double t, N_Vector y, N_Vector power, void* task) {
  thread_local Eigen::VectorXd unused;
  unused.resize(view(y).size());
  const auto p = static_cast<AdaptiveTask<N>*>(task)->dynamics.derivative(t, view(y), unused);
  view(power)[0] = p.muscle;
  view(power)[1] = p.passive;
  view(power)[2] = p.external;
  return std::isfinite(p.muscle) ? 0 : 1;
}

template <int N>
int jacobian(double t, N_Vector y, N_Vector, SUNMatrix J, void* task, N_Vector, N_Vector,
             N_Vector) {
  const auto n = static_cast<Eigen::Index>(SUNDenseMatrix_Rows(J));
  Eigen::Map<Eigen::MatrixXd> out(SUNDenseMatrix_Data(J), n, n);
  static_cast<AdaptiveTask<N>*>(task)->dynamics.jacobian(t, view(y), out);
  return out.allFinite() ? 0 : 1;
}

template <int N>
int distances(double, N_Vector y, realtype* out, void* task) {
  for (const PathSwitch& s : static_cast<AdaptiveTask<N>*>(task)->switches) {
    *out++ = s.distance(view(y)[s.freeIndex]);
  }
  return 0;
}

void check(int flag, const char* what) {
  if (flag < 0) throw std::runtime_error(fmt::format("CVODES: {} failed ({})", what, flag));
}

/// SUNDIALS' own messages do not go to the user's screen: the return flag says the same.
void silent(int, const char*, const char*, char*, void*) {}

/// A whole motion; it begins anew where a path gains or loses points.
template <int N>
class AdaptiveRun {
 public:
  AdaptiveRun(const MusculoskeletalSystem& system, const ExcitationSignal& excitation,
              const SystemState& start, const SimulationOptions& options)
      : system_(system),
        options_(options),
        task_{{system, excitation, options.externalForce, options.prescribed}, system.switches()},
        recorder_(system, numRows(options)),
        reached_(options.startTime) {
    const std::vector<double>& outside = options.externalForce.times();
    std::set_union(excitation.times().begin(), excitation.times().end(), outside.begin(),
                   outside.end(), std::back_inserter(corners_));
    setUp(start);
  }

  Trajectory run() {
    Trajectory& trajectory = recorder_.trajectory();
    record(options_.startTime);
    const StopWatch watch;
    const std::size_t rows = numRows(options_);
    for (std::size_t k = 1; k < rows; ++k) {
      const double target = rowTime(options_, k);
      if (!advanceTo(target)) break;
      double quadratureTime = 0;
      check(CVodeGetQuad(cvode(), &quadratureTime, work_.get()), "CVodeGetQuad");
      record(target);
      if (options_.progress && !options_.progress(target)) {
        end(Outcome::stopped, target, fmt::format("stopped at t = {:.6g} s", target));
        break;
      }
    }
    trajectory.wallSeconds = watch.seconds();
    count();
    return recorder_.finish();
  }

 private:
  void setUp(const SystemState& start) {
    const Eigen::Index size = task_.dynamics.size();
    SUNContext rawContext = nullptr;
    check(SUNContext_Create(nullptr, &rawContext), "SUNContext_Create");
    context_.reset(rawContext);
    y_.reset(N_VNew_Serial(size, context_.get()));
    work_.reset(N_VNew_Serial(3, context_.get()));
    auto state = view(y_.get());
    state = task_.dynamics.pack(start);
    task_.dynamics.place(options_.startTime, state);
    view(work_.get()).setZero();
    matrix_.reset(SUNDenseMatrix(size, size, context_.get()));
    solver_.reset(SUNLinSol_Dense(y_.get(), matrix_.get(), context_.get()));
    memory_.reset(CVodeCreate(CV_BDF, context_.get()));
    check(CVodeInit(cvode(), rightHandSide<N>, options_.startTime, y_.get()), "CVodeInit");
    check(CVodeSetErrHandlerFn(cvode(), silent, nullptr), "CVodeSetErrHandlerFn");
    check(CVodeSetUserData(cvode(), &task_), "CVodeSetUserData");
    check(CVodeSStolerances(cvode(), options_.relativeTolerance, options_.absoluteTolerance),
          "CVodeSStolerances");
    check(CVodeSetLinearSolver(cvode(), solver_.get(), matrix_.get()), "CVodeSetLinearSolver");
    check(CVodeSetJacFn(cvode(), jacobian<N>), "CVodeSetJacFn");
    check(CVodeSetMaxNumSteps(cvode(), 200000), "CVodeSetMaxNumSteps");
    check(CVodeQuadInit(cvode(), powers<N>, work_.get()), "CVodeQuadInit");
    crossed_.assign(task_.switches.size(), 0);
    if (crossed_.empty()) return;
    task_.dynamics.holdConditions(start.q);
    check(CVodeRootInit(cvode(), static_cast<int>(crossed_.size()), distances<N>), "CVodeRootInit");
  }

  void* cvode() const { return memory_.get(); }

  void record(double t) {
    const auto n = static_cast<Eigen::Index>(system_.numMuscles());
    auto state = view(y_.get());
    task_.dynamics.place(t, state);
    const auto work = view(work_.get());
    const auto& parts = task_.dynamics;
    recorder_.add(t, parts.coordinates(state), parts.speeds(state), parts.activations(state),
                  state.tail(n), work[0], work[1], work[2]);
  }

  bool end(Outcome outcome, double at, const std::string& why) {
    Trajectory& trajectory = recorder_.trajectory();
    trajectory.outcome = outcome;
    trajectory.failedAt = at;
    trajectory.why = why;
    return false;
  }

  /// False where there is no solution.
  bool advanceTo(double target) {
    // no step reaches over a corner of the excitation or of the force from outside, nor a switch
    int switches = 0;
    while (reached_ < target) {
      while (corner_ < corners_.size() && corners_[corner_] <= reached_) ++corner_;
      const double stop = corner_ < corners_.size() ? std::min(corners_[corner_], target) : target;
      check(CVodeSetStopTime(cvode(), stop), "CVodeSetStopTime");
      const int flag = CVode(cvode(), stop, y_.get(), &reached_, CV_NORMAL);
      if (flag < 0) {
        const std::unique_ptr<char, void (*)(void*)> name(CVodeGetReturnFlagName(flag), std::free);
        return end(Outcome::noSolution, reached_,
                   fmt::format("no solution at t = {:.6g} s: CVODE says {}{}", reached_, name.get(),
                               whatWasLost()));
      }
      if (flag != CV_ROOT_RETURN) continue;
      beginAnew();
      if (++switches > 100 * mostSwitchesInAStep) {
        return end(
            Outcome::noSolution, reached_,
            fmt::format(
                "no solution at t = {:.6g} s: conditional path points switch on and off endlessly",
                reached_));
      }
    }
    return true;
  }

  /// The path for which even short steps failed.
  std::string whatWasLost() const {
    const Eigen::VectorXd& at = task_.dynamics.lostAt();
    if (at.size() == 0) return {};
    return ": " + describeLostPath(system_, at);
  }

  /// At a switch: from here on the equations are others.
  void beginAnew() {
    check(CVodeGetRootInfo(cvode(), crossed_.data()), "CVodeGetRootInfo");
    const auto state = view(y_.get());
    Eigen::Matrix<double, N, 1> held = task_.dynamics.coordinates(state);
    for (std::size_t i = 0; i < crossed_.size(); ++i) {
      if (crossed_[i] != 0) held = beyondSwitch(task_.switches[i], held, -crossed_[i]);
    }
    task_.dynamics.holdConditions(held);
    double quadratureTime = 0;
    check(CVodeGetQuad(cvode(), &quadratureTime, work_.get()), "CVodeGetQuad");
    count();
    check(CVodeReInit(cvode(), reached_, y_.get()), "CVodeReInit");
    check(CVodeQuadReInit(cvode(), work_.get()), "CVodeQuadReInit");
  }

  /// Adds the solver's own counts, which begin anew with it.
  void count() {
    long more = 0;
    check(CVodeGetNumSteps(cvode(), &more), "CVodeGetNumSteps");
    recorder_.trajectory().steps += more;
    check(CVodeGetNumNonlinSolvIters(cvode(), &more), "CVodeGetNumNonlinSolvIters");
    recorder_.trajectory().newtonIterations += more;
  }

  const MusculoskeletalSystem& system_;
  const SimulationOptions& options_;
  AdaptiveTask<N> task_;
  Recorder recorder_;
  double reached_;               ///< [s]
  std::vector<double> corners_;  ///< of what drives the system [s]
  std::size_t corner_ = 0;
  std::vector<int> crossed_;  ///< by switch: whether, and which way
  Owned<SUNContext, FreeContext> context_;
  Owned<N_Vector, FreeVector> y_, work_;
  Owned<SUNMatrix, FreeMatrix> matrix_;
  Owned<SUNLinearSolver, FreeSolver> solver_;
  std::unique_ptr<void, FreeMemory> memory_;
};

}  // namespace

Trajectory simulateCvode(const MusculoskeletalSystem& system, const ExcitationSignal& excitation,
                         const SystemState& start, const SimulationOptions& options) {
  return withCoordinates(system.skeleton(), [&](auto N) {
    return AdaptiveRun<decltype(N)::value>(system, excitation, start, options).run();
  });
}

}  // namespace bio::stepping
