#pragma once

#include <string>
#include <vector>

#include "bio/discovery/encompassing_model.h"
#include "bio/tables/trial.h"

namespace bio::discover {

/// A model with effects added: an ordinary model, and the effects that a model file cannot express.
///
/// In the model, visc and stiffness are OpenSim's SpringGeneralizedForce, limit its
/// CoordinateLimitForce, payload the mass of a body, lever_inertia the inertia of one, coulomb,
/// stribeck, drag, powerdamp, cubic, limit_exp, const, handforce, spring and lever_weight its
/// ExpressionBasedCoordinateForce, biarticular a PathSpring, tilt the direction of gravity; errors
/// of parameters change the parameter; a missing muscle is the model's own, switched on. A force is
/// called <coordinate>_<id>, by which it is recognised again. Effects of EMG and sensor cannot be
/// written into a model: a simulation has to pass the excitations through `mapping`
/// (drivenExcitation), the commands through `drives` (withDrives), and to compare the sensor's
/// reading. A muscle that was switched on needs an
/// excitation (withSynergists).
struct Augmented {
  Model model;
  EmgMapping mapping;
  std::vector<SensorLaw> sensors;    ///< of EncompassingModel::sensors()
  std::vector<std::string> muscles;  ///< switched on
  DriveLaws drives = {};             ///< what a trial's torques, forces and controls pass through
};

/// The model at the given values of all quantities of `encompassing`, without the forces that are
/// absent.
Augmented augmentedModel(const EncompassingModel& encompassing, const Eigen::VectorXd& values);

/// One effect to add, with its estimates.
struct EffectToAdd {
  std::string id;             ///< of a candidate, or "formula"
  Eigen::VectorXd values;     ///< of its quantities, the amplitude first
  Eigen::VectorXd sds;        ///< standard deviations of the estimates; empty: unknown
  double logBayesFactor = 0;  ///< nats
  double probability = 0;     ///< 0: not known
};

/// Provenance of effects, for the model's credits.
struct EffectProvenance {
  std::string tool;               ///< name and version
  std::vector<std::string> data;  ///< e.g. "curl.sto SHA-256 …"
};

/// The added effects, their data and their uncertainty, in a sentence for the model's credits.
/// @throws std::invalid_argument for an id that is not in the catalogue of this model
std::string effectCredits(const EncompassingModel& encompassing,
                          const std::vector<EffectToAdd>& effects,
                          const EffectProvenance& provenance);

/// The model with effects and otherwise unchanged values; the effects, their data and their
/// uncertainty are written into the credits, e.g.
///   "Effects added by fisherhill 1.0 from curl.sto SHA-256 …; viscous joint damping (visc):
///    visc.viscosity 0.301 ± 0.004 N m s/rad, evidence 412 nats, probability 0.999"
/// @throws std::invalid_argument what EncompassingModel throws; an id that is not in the
///   catalogue of this model, or present in it already; a wrong number of values
Augmented addEffects(const EncompassingModel& encompassing, const std::vector<EffectToAdd>& effects,
                     const EffectProvenance& provenance);
/// The model with effects where its EncompassingModel, with `formula`, is not there yet.
Augmented addEffects(const Model& model, const SystemOptions& system,
                     const CoordinateNames& coordinates, const std::vector<EffectToAdd>& effects,
                     const EffectProvenance& provenance,
                     const std::vector<info::discover::FormulaTerm>& formula = {},
                     std::size_t axis = 0);

}  // namespace bio::discover
