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
  const OdeField& field;
  std::exception_ptr thrown = nullptr;
};

/// 0: fine, 1: not finite, try a smaller step, −1: stop.
int field(realtype t, N_Vector x, N_Vector xDot, void* data) {
  Call& call = *static_cast<Call*>(data);
  try {
    call.field(t, NV_DATA_S(x), NV_DATA_S(xDot));
  } catch (...) {
    call.thrown = std::current_exception();
    return -1;
  }
  const bool finite =
      Eigen::Map<const Eigen::VectorXd>(NV_DATA_S(xDot), NV_LENGTH_S(xDot)).allFinite();
  return finite ? 0 : 1;
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

void check(const Eigen::VectorXd& x0, const std::vector<double>& times,
           const AdaptiveOptions& options) {
  requirePositive("relative tolerance", options.relativeTolerance, "");
  requirePositive("absolute tolerance", options.absoluteTolerance, "");
  if (!(options.largestTimeStep >= 0.0) || !std::isfinite(options.largestTimeStep))
    throw std::domain_error(fmt::format("largest time step: value is {} s, must be >= 0 and finite",
                                        options.largestTimeStep));
  if (options.maxSteps <= 0)
    throw std::domain_error(
        fmt::format("largest number of steps: value is {}, must be > 0", options.maxSteps));
  if (!x0.allFinite()) throw std::domain_error("start x_0: must be finite");
  if (times.empty()) throw std::domain_error("times: number is 0, must be >= 1");
  if (!std::isfinite(times.front()))
    throw std::domain_error(fmt::format("times: time 0 is {} s, must be finite", times.front()));
  for (std::size_t k = 1; k < times.size(); ++k)
    if (!(times[k] > times[k - 1]) || !std::isfinite(times[k]))
      throw std::domain_error(fmt::format("times: time {} is {} s after {} s, must be increasing",
                                          k, times[k], times[k - 1]));
}

}  // namespace

AdaptiveTrajectory solveOde(const OdeField& rate, const Eigen::VectorXd& x0,
                            const std::vector<double>& times, const AdaptiveOptions& options) {
  check(x0, times, options);
  const Eigen::Index n = x0.size();
  AdaptiveTrajectory out;
  const auto store = [&](double t, const double* x) {
    out.times.push_back(t);
    out.x.push_back(Eigen::Map<const Eigen::VectorXd>(x, n));
    out.reachedTime = t;
  };
  store(times.front(), x0.data());
  if (times.size() == 1) return out;

  // The solver and what it owns; destruction runs in reverse order.
  SUNContext rawContext = nullptr;
  require(SUNContext_Create(nullptr, &rawContext), "SUNContext_Create");
  const Owned<SUNContext> context(rawContext);
  const Owned<N_Vector> x(N_VNew_Serial(n, context.get()));
  std::copy_n(x0.data(), n, NV_DATA_S(x.get()));
  const Owned<SUNMatrix> matrix(SUNDenseMatrix(n, n, context.get()));
  const Owned<SUNLinearSolver> linear(SUNLinSol_Dense(x.get(), matrix.get(), context.get()));
  const std::unique_ptr<void, Releases> memory(CVodeCreate(CV_BDF, context.get()));
  void* const cvode = memory.get();

  Call call{rate};
  require(CVodeSetErrHandlerFn(cvode, silent, nullptr), "CVodeSetErrHandlerFn");
  require(CVodeInit(cvode, field, times.front(), x.get()), "CVodeInit");
  require(CVodeSetUserData(cvode, &call), "CVodeSetUserData");
  require(CVodeSStolerances(cvode, options.relativeTolerance, options.absoluteTolerance),
          "CVodeSStolerances");
  require(CVodeSetLinearSolver(cvode, linear.get(), matrix.get()), "CVodeSetLinearSolver");
  require(CVodeSetMaxNumSteps(cvode, options.maxSteps), "CVodeSetMaxNumSteps");
  require(CVodeSetMaxStep(cvode, options.largestTimeStep), "CVodeSetMaxStep");
  // u may be undefined beyond the last time
  require(CVodeSetStopTime(cvode, times.back()), "CVodeSetStopTime");
  for (std::size_t k = 1; k < times.size(); ++k) {
    double reached = times[k - 1];
    const int flag = CVode(cvode, times[k], x.get(), &reached, CV_NORMAL);
    if (call.thrown) std::rethrow_exception(call.thrown);
    if (flag < 0) {
      out.complete = false;
      double current = reached;
      if (CVodeGetCurrentTime(cvode, &current) == CV_SUCCESS) out.reachedTime = current;
      out.why = fmt::format("stopped at {:.6g} s: {}", out.reachedTime, inWords(flag));
      break;
    }
    store(times[k], NV_DATA_S(x.get()));
  }
  return out;
}

}  // namespace info
