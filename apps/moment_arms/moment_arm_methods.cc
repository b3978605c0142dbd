#include "moment_arms/moment_arm_methods.h"

#include <fmt/format.h>

#include <algorithm>

#include "options/model_methods.h"
#include "output/text.h"

namespace app {
namespace {

void sayDerivatives(const char* which, Methods& methods) {
  methods.say(Methods::Part::model,
              fmt::format("{} exact derivatives of the path, not differences of lengths.", which));
}

void sayOtherCoordinates(Methods& methods) {
  methods.say(Methods::Part::model,
              "All other coordinates stay at the model's default values or where they are locked.");
}

}  // namespace

void sayMomentArms(const bio::Model& model, const bio::PathSample& sample,
                   const std::string& coordinate, const Eigen::VectorXd& shown,
                   const std::string& unit, Methods& methods) {
  methods.say(
      Methods::Part::model,
      fmt::format("Muscle–tendon lengths ℓ and moment arms r = −∂ℓ/∂q of {} were computed at {} "
                  "equally spaced values of {} from {} to {} {}.",
                  counted(sample.muscles.size(), "muscle"), shown.size(), coordinate,
                  numberText(shown[0]), numberText(shown[shown.size() - 1]), unit));
  sayOtherCoordinates(methods);
  sayPaths(model, sample.muscles, methods);
  sayDerivatives("Moment arms and their slopes are", methods);
}

void sayOpenSimDifferences(const std::vector<bio::OpenSimDifference>& differences,
                           Methods& methods) {
  if (differences.empty()) return;
  methods.say(Methods::Part::model,
              "The lengths that OpenSim's rule for wrap objects gives were computed for "
              "comparison.");
}

void sayPostures(const bio::Model& model, const bio::PathPostures& paths, Methods& methods) {
  methods.say(
      Methods::Part::model,
      fmt::format("Muscle–tendon lengths ℓ of {} and their slopes ∂ℓ/∂q, which are minus the "
                  "moment arms, were computed in {} postures that are given by {}.",
                  counted(paths.muscles.size(), "muscle"), paths.length.rows(),
                  listed(paths.coordinates)));
  sayOtherCoordinates(methods);
  sayPaths(model, paths.muscles, methods);
  sayDerivatives("Slopes are", methods);
}

void sayPathFits(const bio::Model& model, const std::vector<bio::MuscleFit>& fits,
                 const FitRequest& request, Methods& methods) {
  methods.say(
      Methods::Part::model,
      fmt::format(
          "The muscle–tendon length of {} was approximated by a polynomial of the coordinates "
          "that change it, of the lowest order up to {} that keeps the largest error within {} mm.",
          counted(fits.size(), "muscle"), request.order, numberText(request.tolerance)));
  std::vector<std::string> muscles;
  for (const bio::MuscleFit& fit : fits) muscles.push_back(fit.muscle);
  if (request.table.empty()) {
    methods.say(Methods::Part::model,
                "Its coefficients are least squares of lengths and slopes in postures that fill "
                "the ranges of the free coordinates, denser towards their ends; errors are over "
                "these and half as many others, which were not fitted.");
    sayOtherCoordinates(methods);
    sayPaths(model, muscles, methods);
  } else {
    methods.say(Methods::Part::model,
                "Its coefficients are least squares of the lengths in a table, and of their slopes "
                "where it has them; every fifth posture was not fitted, and errors are over all.");
  }
}

}  // namespace app
