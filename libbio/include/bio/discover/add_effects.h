#pragma once

#include <string>
#include <vector>

#include "bio/discover/widest_model.h"
#include "bio/trial.h"

namespace bio::discover {

/// A model with effects added: an ordinary model, and what no model file says.
///
/// In the model, visc and stiffness are OpenSim's SpringGeneralizedForce, limit its
/// CoordinateLimitForce, payload the mass of a body, coulomb, stribeck, drag, powerdamp, const and
/// handforce its ExpressionBasedCoordinateForce, tilt the direction of gravity; errors of
/// parameters change the parameter; a missing muscle is the model's own, switched on. A law is
/// called <coordinate>_<id>, by which it is known again. EMG and sensor have no place in a model:
/// who simulates passes excitations through `mapping` (drivenExcitation), and compares the sensor's
/// reading. A muscle that was switched on needs an excitation (withProxies).
struct Augmented {
  Model model;
  EmgMapping mapping;
  SensorLaw sensor;
  std::vector<std::string> muscles;  ///< switched on
};

/// The model at values of all quantities of `widest`; laws that are absent are not in it.
Augmented augmentedModel(const WidestModel& widest, const Eigen::VectorXd& values);

/// One effect to add, and what is known of it.
struct EffectToAdd {
  std::string id;              ///< of a candidate, or "formula"
  Eigen::VectorXd values;      ///< of its quantities, the amplitude first
  Eigen::VectorXd deviations;  ///< of the estimates; empty: not known
  double logBayesFactor = 0;   ///< nats
  double probability = 0;      ///< 0: not known
};

/// Where effects come from, for the model's credits.
struct EffectProvenance {
  std::string tool;               ///< name and version
  std::vector<std::string> data;  ///< e.g. "curl.sto SHA-256 …"
};

/// What was added, from what and how sure, in a sentence for the model's credits.
/// @throws std::invalid_argument for an id that is not in the catalogue of this model
std::string effectCredits(const WidestModel& widest, const std::vector<EffectToAdd>& effects,
                          const EffectProvenance& provenance);

/// The model with effects, its other numbers as they are; what was added, from what and how sure is
/// written into the credits, e.g.
///   "Effects added by fisherhill 1.0 from curl.sto SHA-256 …; viscous joint damping (visc):
///    visc.viscosity 0.301 ± 0.004 N m s/rad, evidence 412 nats, probability 0.999"
/// @throws std::invalid_argument what WidestModel throws; an id that is not in the catalogue of
/// this
///   model, or present in it already; values that are too many or too few
Augmented addEffects(const Model& model, const ArmOptions& arm, const std::string& coordinate,
                     const std::vector<EffectToAdd>& effects, const EffectProvenance& provenance,
                     const std::vector<info::discover::FormulaTerm>& formula = {});

}  // namespace bio::discover
