#include "generator/stiff_solver.h"

#include <cvodes/cvodes.h>
#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

#include <cmath>
#include <stdexcept>
#include <string>

namespace hidden {

struct StiffSolver::Handles {
  const TrueElbow& elbow;
  const Recording& recording;
  Eigen::VectorXd y;
  double reached = 0;
  SUNContext context = nullptr;
  N_Vector vector = nullptr;
  SUNMatrix matrix = nullptr;
  SUNLinearSolver linear = nullptr;
  void* cvode = nullptr;

  Handles(const TrueElbow& e, const Recording& r, const Eigen::VectorXd& start)
      : elbow(e), recording(r), y(start) {}
  Handles(const Handles&) = delete;
  Handles& operator=(const Handles&) = delete;
  ~Handles() {
    if (cvode) CVodeFree(&cvode);
    if (linear) SUNLinSolFree(linear);
    if (matrix) SUNMatDestroy(matrix);
    if (vector) N_VDestroy(vector);
    if (context) SUNContext_Free(&context);
  }

  static int rate(double t, N_Vector y, N_Vector yDot, void* self) {
    const auto& h = *static_cast<const Handles*>(self);
    double* out = N_VGetArrayPointer(yDot);
    h.elbow.rate(h.recording, t, N_VGetArrayPointer(y), out);
    return Eigen::Map<const Eigen::VectorXd>(out, h.y.size()).allFinite() ? 0 : 1;
  }
};

namespace {

void require(bool holds, const char* what) {
  if (!holds) throw std::runtime_error(std::string("CVODE: ") + what);
}

void silent(int, const char*, const char*, char*, void*) {}

}  // namespace

StiffSolver::StiffSolver(const TrueElbow& elbow, const Recording& recording,
                         const Eigen::VectorXd& start, double tolerance)
    : handles_(std::make_unique<Handles>(elbow, recording, start)) {
  Handles& h = *handles_;
  require(SUNContext_Create(nullptr, &h.context) == 0, "no context");
  h.vector = N_VMake_Serial(start.size(), h.y.data(), h.context);
  h.matrix = SUNDenseMatrix(start.size(), start.size(), h.context);
  h.linear = SUNLinSol_Dense(h.vector, h.matrix, h.context);
  h.cvode = CVodeCreate(CV_BDF, h.context);
  require(h.cvode && CVodeInit(h.cvode, Handles::rate, 0, h.vector) == 0 &&
              CVodeSetErrHandlerFn(h.cvode, silent, nullptr) == 0 &&
              CVodeSetUserData(h.cvode, &h) == 0 &&
              CVodeSStolerances(h.cvode, tolerance, tolerance) == 0 &&
              CVodeSetLinearSolver(h.cvode, h.linear, h.matrix) == 0 &&
              CVodeSetMaxNumSteps(h.cvode, 100000) == 0,
          "cannot be set up");
}

StiffSolver::~StiffSolver() = default;

const Eigen::VectorXd& StiffSolver::advanceTo(double t) {
  Handles& h = *handles_;
  if (t <= h.reached) return h.y;
  require(CVodeSetStopTime(h.cvode, t) == 0, "stop time");
  if (CVode(h.cvode, t, h.vector, &h.reached, CV_NORMAL) < 0) {
    throw std::runtime_error("CVODE: no solution at t = " + std::to_string(h.reached) + " s");
  }
  return h.y;
}

const Eigen::VectorXd& StiffSolver::state() const {
  return handles_->y;
}

}  // namespace hidden
