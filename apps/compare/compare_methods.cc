#include "compare/compare_methods.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "bio/model/units.h"
#include "bio/simulation/integrator_names.h"
#include "output/text.h"

namespace app {
namespace {

/// "rk4, the classical …"
std::string described(bio::Integrator integrator) {
  const std::string variational =
      fmt::format("a midpoint variational integrator ({})", citation(Publication::wilson));
  const auto of = [&](const std::string& words) {
    return fmt::format("{}, {}", bio::name(integrator), words);
  };
  switch (integrator) {
    case bio::Integrator::rungeKutta4:
      return of("the classical Runge–Kutta method of fourth order");
    case bio::Integrator::variational:
      return of(variational + " with the forces shared by both ends of a step");
    case bio::Integrator::variationalLeft:
      return of(variational + " with the forces at the beginning of a step");
    case bio::Integrator::variationalAdaptive:
      return of(variational + " with shorter steps where its estimated errors ask for them");
    case bio::Integrator::cvode:
      break;
  }
  return of(fmt::format("CVODE of SUNDIALS ({}) with variable steps, its output at the step given",
                        citation(Publication::hindmarsh2005)));
}

void sayRuns(const bio::CompareOptions& options, Methods& methods) {
  std::vector<std::string> names, steps;
  std::vector<Publication> cited;
  for (const bio::Integrator integrator : options.integrators) {
    names.push_back(described(integrator));
    if (integrator == bio::Integrator::cvode) cited.push_back(Publication::hindmarsh2005);
    if (bio::isVariational(integrator)) cited.push_back(Publication::wilson);
  }
  for (const double step : options.steps) steps.push_back(numberText(step));
  methods.say(Methods::Part::simulation,
              fmt::format("The same motion, from one initial state under the same inputs, was "
                          "simulated with steps of {} s by {}.",
                          listed(steps), fmt::join(names, "; ")),
              cited);
}

void sayReference(const CompareFindings& f, Methods& methods) {
  const bio::ConvergedReference& reference = f.comparison.reference;
  if (!reference.completed()) return;
  methods.say(
      Methods::Part::simulation,
      fmt::format("The reference is CVODE ({}) with a relative tolerance of {:g}, beside "
                  "which it was run with {:g}; {}.",
                  citation(Publication::hindmarsh2005), reference.relativeTolerance,
                  reference.looserTolerance,
                  reference.confirmed()
                      ? fmt::format("the variational integrator with steps of {} s confirms "
                                    "it",
                                    numberText(reference.secondStep))
                      : "it is disputed"),
      {Publication::hindmarsh2005});
  methods.say(Methods::Part::simulation,
              "Errors are differences from the reference over all free rotations, root mean square "
              "over the rows of a run.");
  const auto hasOrder = [](const bio::ObservedOrder& order) { return std::isfinite(order.order); };
  if (std::any_of(f.comparison.orders.begin(), f.comparison.orders.end(), hasOrder)) {
    methods.say(Methods::Part::simulation,
                "Observed orders are slopes of a straight line through the logarithms of error and "
                "step, by least squares, above ten times the accuracy of the reference.");
  }
  if (!f.comparison.limits.empty()) {
    methods.say(Methods::Part::simulation,
                fmt::format("The largest stable step is the longest with which a run reaches the "
                            "end with an error below {} deg, found by bisection to {} %.",
                            numberText(f.options.usefulError * bio::degreesPerRadian),
                            numberText(100 * (f.options.stepResolution - 1), 2)));
  }
  methods.say(Methods::Part::simulation,
              fmt::format("Times are medians of at least {}.", counted(f.options.timings, "run")));
}

}  // namespace

void sayComparison(const CompareFindings& f, Methods& methods) {
  sayRuns(f.options, methods);
  sayReference(f, methods);
}

void sayMuscleClasses(const MuscleFindings& f, Methods& methods) {
  std::vector<std::string> names;
  for (std::size_t i = 1; i < f.classes.size(); ++i) names.push_back(f.classes[i].name);
  const bool turns = f.coordinate.isRotation;
  methods.say(Methods::Part::simulation,
              fmt::format("The trial was simulated with the muscles as they are in the model and "
                          "with all of them as {}, with the same values of the parameters that the "
                          "classes share, the same excitations and fibres in static equilibrium at "
                          "the start.",
                          listed(names)));
  methods.say(Methods::Part::inference,
              fmt::format("Differences are from the model as it is; what no change of its own "
                          "parameters explains is the residual of linear least squares in the "
                          "maximum isometric force, optimal fibre length and tendon slack length "
                          "of every muscle, under their default priors, with a noise of {} {} in a "
                          "sample of {}.",
                          numberText(f.noise * bio::positionUnit(turns).factor),
                          bio::positionUnit(turns).name, f.coordinate.name));
  methods.assume("Outputs are linear in the parameters over their prior uncertainty.");
}

}  // namespace app
