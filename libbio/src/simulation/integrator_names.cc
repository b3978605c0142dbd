#include "bio/simulation/integrator_names.h"

namespace bio {

const char* name(Integrator integrator) {
  switch (integrator) {
    case Integrator::variational:
      return "vi";
    case Integrator::variationalLeft:
      return "vi-left";
    case Integrator::variationalAdaptive:
      return "vi-adaptive";
    case Integrator::rungeKutta4:
      return "rk4";
    case Integrator::cvode:
      break;
  }
  return "cvode";
}

std::optional<Integrator> integratorNamed(const std::string& text) {
  for (const Integrator integrator :
       {Integrator::variational, Integrator::variationalLeft, Integrator::variationalAdaptive,
        Integrator::rungeKutta4, Integrator::cvode}) {
    if (text == name(integrator)) return integrator;
  }
  return std::nullopt;
}

double defaultStep(Integrator integrator) {
  return integrator == Integrator::rungeKutta4 ? 2e-4 : 0.01;
}

const char* name(Outcome outcome) {
  switch (outcome) {
    case Outcome::completed:
      return "ok";
    case Outcome::unstable:
      return "unstable";
    case Outcome::noSolution:
      return "no solution";
    case Outcome::stopped:
      break;
  }
  return "stopped";
}

}  // namespace bio
