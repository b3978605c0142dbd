#include <fmt/format.h>

#include "discover/discover_verdict.h"
#include "output/text.h"

namespace app {

void sayDiscovery(const DiscoverFindings& f, Methods& methods) {
  constexpr auto inference = Methods::Part::inference;
  const info::discover::Options& options = f.options;
  methods.say(
      inference,
      fmt::format("{} candidate effects were compared by Bayes factors ({}); the evidence of a "
                  "hypothesis is Laplace's approximation at its most probable parameters ({}).",
                  f.data.candidates().size(), citation(Publication::kassRaftery1995),
                  citation(Publication::macKay1992)),
      {Publication::kassRaftery1995, Publication::macKay1992});
  methods.say(
      inference,
      fmt::format(
          "For each hypothesis all parameters of the model were fitted anew under their priors, "
          "together with a latent force ({}) that stands for errors of the inputs; its correlation "
          "time is {} s.",
          citation(Publication::alvarez2009), numberText(options.latentTime)),
      {Publication::alvarez2009});
  methods.say(inference,
              "The search takes Levenberg–Marquardt steps with geodesic acceleration (" +
                  citation(Publication::transtrum2012) +
                  ") and exact derivatives of the simulated motion.",
              {Publication::transtrum2012});
  methods.say(
      inference,
      fmt::format(
          "An effect is named if it raises the log evidence by at least {} nats and its amplitude "
          "differs from 0 by at least {} standard deviations; effects within {} nats of it count "
          "as "
          "indistinguishable.",
          numberText(options.evidence), numberText(options.significance),
          numberText(options.classWidth)));
  methods.say(
      inference,
      fmt::format("The innovations were tested for whiteness ({}) and size, each at the level {}.",
                  citation(Publication::ljungBox1978), numberText(options.level)),
      {Publication::ljungBox1978});
  methods.say(inference,
              options.sds
                  ? "The measurement noise was given."
                  : "The measurement noise was estimated from third differences of the data.");
  if (!options.heldOut.empty())
    methods.say(inference, fmt::format("{} held-out {} used for judging only, never for fitting.",
                                       options.heldOut.size(),
                                       options.heldOut.size() == 1 ? "trial was" : "trials were"));
  methods.assume(
      "Measurement noise is independent and normal; the priors of the parameters are right in "
      "size.");
  methods.assume(
      "What is missing is in the catalogue of effects, or else shows as an unexplained residual.");
  methods.assume("Outputs are nearly linear in what is uncertain, over its uncertainty.");
}

}  // namespace app
