#pragma once

// The effects, one function each; not public.

#include <optional>

#include "bio/discover/effects.h"

namespace bio::discover {

/// `known.mass` [kg] and `known.turn` [rad], which trials are known to have, where the model can
/// have them; no candidates. Before all others.
void addKnownChanges(WidestModel& model);
void addViscousDamping(WidestModel& model);
void addCoulombFriction(WidestModel& model);
void addStribeckFriction(WidestModel& model);
void addQuadraticDrag(WidestModel& model);
void addPowerDamping(WidestModel& model);
void addStiffness(WidestModel& model);
void addLimits(WidestModel& model);
void addPayload(WidestModel& model);
void addTilt(WidestModel& model);
void addConstantTorque(WidestModel& model);
void addHandForce(WidestModel& model);
void addElasticBand(WidestModel& model);
void addTimedForces(WidestModel& model);
void addMissingMuscles(WidestModel& model);
void addDelay(WidestModel& model);
void addShape(WidestModel& model);
void addFatigue(WidestModel& model);
void addCrosstalk(WidestModel& model);
void addExchangedChannels(WidestModel& model);
void addElectrodeGains(WidestModel& model);
void addBaselines(WidestModel& model);
void addMassError(WidestModel& model);
void addActivationError(WidestModel& model);
void addMuscleErrors(WidestModel& model);
void addTendonCompliance(WidestModel& model);
void addWrapErrors(WidestModel& model);
void addSensorErrors(WidestModel& model);

/// A quantity that is 0 while its effect is absent.
inline info::discover::Quantity amplitude(std::string name, std::string unit, double lower,
                                          double upper, double deviation) {
  return {std::move(name), std::move(unit), 0, lower, upper, deviation, false};
}
/// A quantity that shapes an effect.
inline info::discover::Quantity shape(std::string name, std::string unit, double nominal,
                                      double lower, double upper, double deviation) {
  return {std::move(name), std::move(unit), nominal, lower, upper, deviation, false};
}
/// A factor, known to a share of itself.
inline info::discover::Quantity factor(std::string name, double lower, double upper,
                                       double deviation) {
  return {std::move(name), "", 1, lower, upper, deviation, true};
}

/// A candidate of one quantity or of several, each with its own deviation as prior.
info::discover::Candidate candidate(const WidestModel& model, std::string id, std::string name,
                                    std::string sentence, info::discover::EffectKind kind,
                                    std::vector<std::size_t> quantities,
                                    const std::vector<std::vector<double>>& starts,
                                    std::vector<std::string> equivalents = {});

/// Name of the law that an effect adds to a model: "elbow_flexion_visc".
std::string lawName(const WidestModel& model, const std::string& id);

/// Adds an effect given as an expression in q, qdot and its quantities (by the names of
/// `constants`). Present if the model has a law of that name.
struct ExpressionEffect {
  std::string id, name, sentence, expression;
  std::vector<std::string> constants;
  std::vector<info::discover::Quantity> quantities;
  std::vector<std::vector<double>> starts;
  std::vector<std::string> equivalents = {};
};
/// @return the law's index in the model's list; nothing if it is present
std::optional<std::size_t> addExpression(WidestModel& model, const ExpressionEffect& effect);

}  // namespace bio::discover
