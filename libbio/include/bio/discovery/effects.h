#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "bio/discovery/encompassing_model.h"
#include "bio/discovery/user_effect.h"

namespace bio::discover {

/// One line of the catalogue: adds an effect, or a small family of them, to a model. An effect that
/// the base model already has becomes EncompassingModel::present(); one that the skeleton cannot
/// have (tilt, if gravity does not turn the joint) is left out. An effect belongs to the system, to
/// each of its coordinates, or to each of its sensors.
using OfSystem = void (*)(EncompassingModel& model);
using OfCoordinate = void (*)(EncompassingModel& model, const MovingCoordinate& at);
using OfSensor = void (*)(EncompassingModel& model, std::size_t sensor);
struct EffectEntry {
  const char* id;
  std::variant<OfSystem, OfCoordinate, OfSensor> add;
};

// clang-format off
/// The catalogue. τ is the generalised force on the coordinate, + up; w = q̇. Of several
/// coordinates, visc to lever_inertia, const, torque_from and torque_until are one per coordinate
/// (knee_angle_r.visc); handforce, spring, mass_from and mass_until are those of one coordinate
/// only. Of several sensors, bias to drift are one per sensor. Without muscles, fatigue, delay and
/// shape are left out, and drive_gain to drive_saturation are one per coordinate that a trial
/// drives.
///
/// | id | effect | amplitude |
/// |---|---|---|
/// | visc | −b·w | b N·m·s/rad |
/// | coulomb | −c·tanh(w/0.05); without muscles w/v, v about 1/80 of the RMS speed | c N·m |
/// | stribeck | −c·[1 + e^{−(w/v)²}]·tanh(w/0.05); without muscles w over that 1/80 | c N·m |
/// | drag | −c·w·|w| | c N·m·s² |
/// | powerdamp | −b·w·(w² + 0.01²)^{(n−1)/2} | b |
/// | stiffness | −k(q − q_r) | k N·m/rad |
/// | cubic | −k(q − q_r)³ | k N·m/rad³ |
/// | limit | OpenSim's CoordinateLimitForce, one stiffness for both ends | K N·m/rad |
/// | limit_exp | c·[e^{−k(q−r+h)} − e^{k(q−r−h)}], h half the coordinate's range | c N·m |
/// | lever_weight | +w·cos(q − r), of a prescribed rotation | w N·m |
/// | lever_inertia | −I·q̈, of a prescribed rotation: an inertia of its nearest body | I kg·m² |
/// | payload | a point at the mass centre of the farthest body | m kg |
/// | tilt | gravity's moment is that of q + δ | δ rad |
/// | const | +c | c N·m |
/// | handforce | horizontal force at that mass centre, in the plane of the joint | F N |
/// | spring | −k·max(0, L − L_r)·∂L/∂q, L from hand to shoulder (see band.cc) | k N/m |
/// | biarticular_i | −K·max(0, L − L_r)·∂L/∂q, L = L_0 − Σ r_j q_j over the joints that muscle group i crosses | K N/m |
/// | torque_from, torque_until, mass_from, mass_until | TimedForce (timed_force.h) | N·m or kg |
/// | fatigue | u_i·[1 − φ(1 − e^{−∫u_i dt/T})], every muscle | φ |
/// | missing_i | a muscle that the model has but switched off; its lengths within their tolerance | r = F0 over the model's |
/// | delay, shape, crosstalk_A_B, gain_i, offset_i | EmgMapping | |
/// | drive_gain, drive_delay, drive_lag, drive_saturation | DriveLaw; the gain of actuators is their optimal force | g, d, lag, a |
/// | mass, tau, Fmax_i, lopt_i, lslack_i, tendon, wrap_i | factors and shifts of parameters | |
/// | swap_A_B | channels of two muscles exchanged: EmgMapping | share, 1 where they are |
/// | saturated_i | the record of a muscle or group saturates (flatTops): EmgMapping | s, 1 goes on smoothly |
/// | bias, gain, clock, clock_rate, lag, drift | SensorLaw | |
// clang-format on
const std::vector<EffectEntry>& effectEntries();

/// Adds the base model's own uncertain parameters as nuisance parameters: every muscle's F0 (15 %
/// of the logarithm), optimal fibre length (4 %) and tendon slack length (2 %), the mass of the
/// moved bodies (5 %), the time scale of activation (20 %).
void addNuisances(EncompassingModel& model);

/// Adds a candidate "formula", a force outside the catalogue, c·(e_1 + r_2·e_2 + …); in a model an
/// ExpressionBasedCoordinateForce. Its quantities are c, r_2, ….
void addFormula(EncompassingModel& model, const MovingCoordinate& at,
                const std::vector<info::discover::FormulaTerm>& terms);

/// Ids of the candidates saturated_i that cannot be: those of muscles whose record has no flat top.
/// @param flat  muscles whose record has one
std::vector<std::string> unsaturated(const EncompassingModel& model,
                                     const std::vector<std::string>& flat);

/// Ids of the candidates of electrodes (gain, saturation, crosstalk, exchanged channels) that
/// cannot be, since a muscle in them has none; a group has none if none of its muscles has.
/// @param silent  muscles without an electrode
std::vector<std::string> withoutElectrode(const EncompassingModel& model,
                                          const std::vector<std::string>& silent);

/// What of the catalogue a model gets, and what beside it.
struct CatalogueChoice {
  /// Ids to exclude, of entries or of candidates, or their long names (effect_names.h).
  std::vector<std::string> without = {};
  std::vector<UserEffect> own = {};                       ///< effects beside those of the catalogue
  std::vector<info::discover::FormulaTerm> formula = {};  ///< of a candidate "formula"; empty: none
  std::size_t formulaAxis = 0;                            ///< the coordinate that it acts on
  std::vector<Observable> sensors = {};  ///< what is measured; empty: the coordinates
  /// How the coordinates move, which sizes the effects of a model without muscles; empty: as an
  /// elbow does.
  std::map<std::string, MotionSize> motions = {};
  /// What the trials command of coordinates in question, without muscles. A problem without a
  /// choice has those of its trials (commandsOf).
  std::optional<std::vector<DriveCommand>> drives = {};
};

/// addNuisances, and the entries of the choice; with a formula also addFormula.
/// @throws std::invalid_argument for an unknown id, with a list of the known ones; for an effect of
///   `own` with an id of the catalogue or of another, or on a coordinate that is not in question
EncompassingModel encompassingModel(const Model& model, const SystemOptions& system,
                                    const CoordinateNames& coordinates,
                                    const CatalogueChoice& choice = {});

}  // namespace bio::discover
