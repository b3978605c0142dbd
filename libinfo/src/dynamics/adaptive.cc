#include "info/dynamics/adaptive.h"

#include <cvodes/cvodes.h>
#include <fmt/format.h>
#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

#include <cmath>
#include <exception>
#include <memory>
#include <stdexcept>

namespace info {

namespace {

struct Releases {
  void operator()(SUNContext c) const { SUNContext_Free(&c); }
  void operator()(N_Vector v) const { N_VDestroy(v); }
  void operator()(SUNMatrix m) const { SUNMatDestroy(m); }
  void operator()(SUNLinearSolver s) const { SUNLinSolFree(s); }
  void operator()(void* memory) const { CVodeFree(&memory); }
};
template <class T>
using Owned = std::unique_ptr<std::remove_pointer_t<T>, Releases>;

/// The problem as the C callbacks see it; an exception of the field waits here until CVODES
/// returns.
struct Call {
  const OdeProblem& problem;
  long evaluations = 0;
  std::exception_ptr thrown;
  Eigen::MatrixXd psi, psiDot;

  /// 0: fine, 1: not finite, try a smaller step, −1: stop.
  template <class Work>
  int guarded(const Work& work) {
    try {
      return work() ? 0 : 1;
    } catch (...) {
      thrown = std::current_exception();
      return -1;
    }
  }
};

bool finite(const double* values, Eigen::Index count) {
  return Eigen::Map<const Eigen::VectorXd>(values, count).allFinite();
}

int field(realtype t, N_Vector x, N_Vector xDot, void* data) {
  Call& call = *static_cast<Call*>(data);
  return call.guarded([&] {
    ++call.evaluations;
    call.problem.field(t, NV_DATA_S(x), NV_DATA_S(xDot));
    return finite(NV_DATA_S(xDot), call.problem.size);
  });
}

int fieldJacobian(realtype t, N_Vector x, N_Vector, SUNMatrix J, void* data, N_Vector, N_Vector,
                  N_Vector) {
  Call& call = *static_cast<Call*>(data);
  return call.guarded([&] {
    call.problem.jacobian(t, NV_DATA_S(x), SM_DATA_D(J));
    return finite(SM_DATA_D(J), call.problem.size * call.problem.size);
  });
}

int sensitivityField(int count, realtype t, N_Vector x, N_Vector, N_Vector* s, N_Vector* sDot,
                     void* data, N_Vector, N_Vector) {
  Call& call = *static_cast<Call*>(data);
  return call.guarded([&] {
    const Eigen::Index n = call.problem.size;
    for (int j = 0; j < count; ++j)
      call.psi.col(j) = Eigen::Map<const Eigen::VectorXd>(NV_DATA_S(s[j]), n);
    call.problem.sensitivity(t, NV_DATA_S(x), call.psi.data(), call.psiDot.data());
    for (int j = 0; j < count; ++j)
      Eigen::Map<Eigen::VectorXd>(NV_DATA_S(sDot[j]), n) = call.psiDot.col(j);
    return call.psiDot.allFinite();
  });
}

void silent(int, const char*, const char*, char*, void*) {}

void require(int flag, const char* function) {
  if (flag < 0) throw std::runtime_error(fmt::format("{}: refused with flag {}", function, flag));
}

std::string inWords(int flag) {
  switch (flag) {
    case CV_TOO_MUCH_WORK:
      return "the limit on the number of steps was reached";
    case CV_TOO_MUCH_ACC:
      return "the tolerances are below the rounding error";
    case CV_ERR_FAILURE:
      return "the error test failed at the smallest step";
    case CV_CONV_FAILURE:
      return "Newton's method found no solution at the smallest step";
    case CV_FIRST_RHSFUNC_ERR:
      return "the right-hand side is not finite at the start";
    case CV_REPTD_RHSFUNC_ERR:
    case CV_UNREC_RHSFUNC_ERR:
      return "the right-hand side is not finite at any step";
    default:
      return fmt::format("CVODES flag {}", flag);
  }
}

void requirePositive(const char* quantity, double value, const char* unit) {
  if (!(value > 0.0) || !std::isfinite(value))
    throw std::domain_error(
        fmt::format("{}: value is {} {}, must be > 0 and finite", quantity, value, unit));
}

void check(const OdeProblem& problem, const Eigen::VectorXd& x0, const Eigen::MatrixXd& psi0,
           const std::vector<double>& times, const AdaptiveOptions& options) {
  requirePositive("relative tolerance", options.relativeTolerance, "");
  requirePositive("absolute tolerance", options.absoluteTolerance, "");
  if (!(options.largestTimeStep >= 0.0) || !std::isfinite(options.largestTimeStep))
    throw std::domain_error(fmt::format("largest time step: value is {} s, must be >= 0 and finite",
                                        options.largestTimeStep));
  if (options.maxSteps <= 0)
    throw std::domain_error(
        fmt::format("largest number of steps: value is {}, must be > 0", options.maxSteps));
  requireLength("start x_0", x0.size(), problem.size);
  requireLength("psi_0 columns", psi0.cols(), problem.sensitivityCount);
  if (!x0.allFinite()) throw std::domain_error("start x_0: must be finite");
  if (!psi0.allFinite()) throw std::domain_error("start psi_0: must be finite");
  if (times.empty()) throw std::domain_error("times: number is 0, must be >= 1");
  if (!std::isfinite(times.front()))
    throw std::domain_error(fmt::format("times: time 0 is {} s, must be finite", times.front()));
  for (std::size_t k = 1; k < times.size(); ++k)
    if (!(times[k] > times[k - 1]) || !std::isfinite(times[k]))
      throw std::domain_error(fmt::format("times: time {} is {} s after {} s, must be increasing",
                                          k, times[k], times[k - 1]));
}

}  // namespace

AdaptiveTrajectory<dynamic, dynamic> solveOde(const OdeProblem& problem, const Eigen::VectorXd& x0,
                                              const Eigen::MatrixXd& psi0,
                                              const std::vector<double>& times,
                                              const AdaptiveOptions& options) {
  check(problem, x0, psi0, times, options);
  const Eigen::Index n = problem.size, p = problem.sensitivityCount;
  AdaptiveTrajectory<dynamic, dynamic> out;
  const auto store = [&](double t, const Eigen::VectorXd& x, const Eigen::MatrixXd& psi) {
    out.times.push_back(t);
    out.x.push_back(x);
    if (p > 0) out.psi.push_back(psi);
    out.reachedTime = t;
  };
  store(times.front(), x0, psi0);
  if (times.size() == 1) return out;

  // The solver and what it owns; destruction runs in reverse order.
  SUNContext rawContext = nullptr;
  require(SUNContext_Create(nullptr, &rawContext), "SUNContext_Create");
  const Owned<SUNContext> context(rawContext);
  const auto vectorOf = [&](const double* values) {
    Owned<N_Vector> v(N_VNew_Serial(n, context.get()));
    std::copy_n(values, n, NV_DATA_S(v.get()));
    return v;
  };
  const Owned<N_Vector> x = vectorOf(x0.data());
  std::vector<Owned<N_Vector>> psi;
  std::vector<N_Vector> psiPointers;
  for (Eigen::Index j = 0; j < p; ++j) {
    psi.push_back(vectorOf(psi0.col(j).data()));
    psiPointers.push_back(psi.back().get());
  }
  const Owned<SUNMatrix> matrix(SUNDenseMatrix(n, n, context.get()));
  const Owned<SUNLinearSolver> linear(SUNLinSol_Dense(x.get(), matrix.get(), context.get()));
  const std::unique_ptr<void, Releases> memory(CVodeCreate(CV_BDF, context.get()));
  void* const cvode = memory.get();

  Call call{problem, 0, nullptr, psi0, psi0};
  require(CVodeSetErrHandlerFn(cvode, silent, nullptr), "CVodeSetErrHandlerFn");
  require(CVodeInit(cvode, field, times.front(), x.get()), "CVodeInit");
  require(CVodeSetUserData(cvode, &call), "CVodeSetUserData");
  require(CVodeSStolerances(cvode, options.relativeTolerance, options.absoluteTolerance),
          "CVodeSStolerances");
  require(CVodeSetLinearSolver(cvode, linear.get(), matrix.get()), "CVodeSetLinearSolver");
  if (problem.jacobian) require(CVodeSetJacFn(cvode, fieldJacobian), "CVodeSetJacFn");
  require(CVodeSetMaxNumSteps(cvode, options.maxSteps), "CVodeSetMaxNumSteps");
  require(CVodeSetMaxStep(cvode, options.largestTimeStep), "CVodeSetMaxStep");
  // u may be undefined beyond the last time
  require(CVodeSetStopTime(cvode, times.back()), "CVodeSetStopTime");
  if (p > 0) {
    require(CVodeSensInit(cvode, int(p), CV_STAGGERED, sensitivityField, psiPointers.data()),
            "CVodeSensInit");
    std::vector<double> absolute(std::size_t(p), options.absoluteTolerance);
    require(CVodeSensSStolerances(cvode, options.relativeTolerance, absolute.data()),
            "CVodeSensSStolerances");
    require(CVodeSetSensErrCon(cvode, SUNTRUE), "CVodeSetSensErrCon");
  }

  Eigen::MatrixXd psiNow = psi0;
  for (std::size_t k = 1; k < times.size(); ++k) {
    double reached = times[k - 1];
    int flag = CVode(cvode, times[k], x.get(), &reached, CV_NORMAL);
    if (call.thrown) std::rethrow_exception(call.thrown);
    if (flag >= 0 && p > 0)
      flag = std::min(flag, CVodeGetSens(cvode, &reached, psiPointers.data()));
    if (flag < 0) {
      out.complete = false;
      double current = reached;
      if (CVodeGetCurrentTime(cvode, &current) == CV_SUCCESS) out.reachedTime = current;
      out.why = fmt::format("stopped at {:.6g} s: {}", out.reachedTime, inWords(flag));
      break;
    }
    for (Eigen::Index j = 0; j < p; ++j)
      psiNow.col(j) = Eigen::Map<const Eigen::VectorXd>(NV_DATA_S(psiPointers[std::size_t(j)]), n);
    store(times[k], Eigen::Map<const Eigen::VectorXd>(NV_DATA_S(x.get()), n), psiNow);
  }
  CVodeGetNumSteps(cvode, &out.steps);
  out.evaluations = call.evaluations;
  return out;
}

}  // namespace info
