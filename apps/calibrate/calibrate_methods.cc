#include "calibrate/calibrate_methods.h"

#include <fmt/format.h>

#include <algorithm>

#include "bio/model/units.h"
#include "calibrate/latent_excitations.h"
#include "output/text.h"

namespace app {

void sayCalibration(const CalibrateFindings& f, Methods& methods) {
  constexpr auto inference = Methods::Part::inference;
  const bio::CalibrationOptions& options = f.options;
  const auto& parameters = f.calibration.parameters;
  const auto asked = std::count_if(parameters.begin(), parameters.end(), [](const auto& parameter) {
    return !parameter.ofTrial && !bio::isKnot(parameter.target);
  });
  methods.say(
      inference,
      fmt::format(
          "{} {} estimated from {} {} by {}, with exact derivatives of the simulated motion.",
          asked, asked == 1 ? "parameter was" : "parameters were", f.training.trials().size(),
          f.training.trials().size() == 1 ? "trial" : "trials",
          options.priors || !options.prior.empty()
              ? "maximum a posteriori (least squares with normal priors and bounds)"
              : "least squares within bounds"));
  if (options.loss.kind == info::RobustLoss::Kind::huber)
    methods.say(inference, "Large residuals were given less weight by Huber's loss.");
  if (options.loss.kind == info::RobustLoss::Kind::student)
    methods.say(
        inference,
        "Residuals were taken as distributed by Student's t, which bounds the weight of outliers.");
  const double noise = f.calibration.noise.sd * bio::degreesPerRadian;
  if (options.noise) {
    methods.say(inference,
                fmt::format("The noise of measured angles was taken as white and normal with a "
                            "standard deviation of {:.3g} deg.",
                            noise));
  } else if (noise > 0) {
    methods.say(
        inference,
        "The standard deviation of the measurement noise and the number of samples that count as "
        "independent were taken from the residuals.");
  }
  if (options.starts > 1)
    methods.say(inference, fmt::format("The search began at {} points.", options.starts));
  methods.say(
      inference,
      fmt::format("Intervals are {:g} % confidence intervals from the Fisher information at the "
                  "estimate; where the likelihood at their ends contradicts them, from the profile "
                  "likelihood.",
                  100 * options.confidence));
  if (options.bootstrap > 0)
    methods.say(inference, fmt::format("Further intervals are of {} bootstrap replicates.",
                                       options.bootstrap));
  methods.say(inference,
              "A parameter counts as identifiable if its Cramér–Rao bound, combined with the "
              "prior, is at most "
              "half the prior standard deviation.");
  if (f.heldOut != nullptr)
    methods.say(inference, "Held-out trials were used for judging only, never for fitting.");
  methods.assume(
      "The model with other values of these parameters describes the limb; a bias from what it "
      "lacks is not in the intervals.");
}

}  // namespace app
