#pragma once

#include <limits>
#include <string>
#include <variant>
#include <vector>

#include "bio/emg/emg_mapping.h"
#include "bio/model/model.h"
#include "bio/muscle/muscle_parameters.h"
#include "bio/simulation/musculoskeletal_system.h"
#include "info/information/parameter.h"

namespace bio {

// What a parameter sets; indices into the lists of Model ------------------------------------------

struct MuscleTarget {
  std::size_t muscle;
  MuscleQuantity quantity;
  friend bool operator==(const MuscleTarget&, const MuscleTarget&) = default;
};
/// A number of a muscle of another class than Schutte's.
struct MuscleNumberTarget {
  std::size_t muscle;
  std::size_t place;  ///< in the class's table of properties
  friend bool operator==(const MuscleNumberTarget&, const MuscleNumberTarget&) = default;
};
struct PointTarget {
  std::size_t muscle, point;
  int axis;  ///< 0 x, 1 y, 2 z of the location in the body
  friend bool operator==(const PointTarget&, const PointTarget&) = default;
};
struct WrapTarget {
  std::size_t wrap;
  enum class Quantity {
    radius,       ///< of a cylinder or sphere
    translation,  ///< in the body
    rotation,     ///< in the body
    semiAxis,     ///< of an ellipsoid
    outerRadius,  ///< of a torus
    innerRadius   ///< of a torus
  } quantity;
  int axis = 0;  ///< of a translation, a rotation or a semi-axis: 0 x, 1 y, 2 z
  /// Whether it is a radius or a semi-axis.
  bool isSize() const {
    return quantity != Quantity::translation && quantity != Quantity::rotation;
  }
  friend bool operator==(const WrapTarget&, const WrapTarget&) = default;
};
struct BodyTarget {
  std::size_t body;
  enum class Quantity { mass, massCenter, inertia } quantity;
  int element = 0;  ///< x y z of the mass centre; xx yy zz xy xz yz of the inertia about it
  friend bool operator==(const BodyTarget&, const BodyTarget&) = default;
};
struct LimitForceTarget {
  std::size_t force;
  enum class Quantity {
    upperLimit,
    upperStiffness,
    lowerLimit,
    lowerStiffness,
    damping,
    transition
  } quantity;
  friend bool operator==(const LimitForceTarget&, const LimitForceTarget&) = default;
};
struct SpringForceTarget {
  std::size_t force;
  enum class Quantity { stiffness, restLength, viscosity } quantity;
  friend bool operator==(const SpringForceTarget&, const SpringForceTarget&) = default;
};
/// A number of a force on bodies or of an actuator.
struct ForceNumberTarget {
  enum class Kind {
    pointSpring,  ///< PointSpringNumber
    bushing,      ///< rotational and translational stiffness, rotational and translational damping
    elasticPath,  ///< ElasticPathNumber
    actuator      ///< optimal force
  } kind;
  std::size_t force;
  enum PointSpringNumber { springStiffness, springRestLength };
  enum ElasticPathNumber { pathRestLength, pathScale, pathDamping, pathTransitionStrain };
  int number;  ///< place in that list; x, y, z of a bushing's each
  friend bool operator==(const ForceNumberTarget&, const ForceNumberTarget&) = default;
};
/// A constant of an expression.
struct ExpressionTarget {
  std::size_t force, constant;
  friend bool operator==(const ExpressionTarget&, const ExpressionTarget&) = default;
};
struct GravityTarget {
  int axis;  ///< 0 x, 1 y, 2 z of the ground
  friend bool operator==(const GravityTarget&, const GravityTarget&) = default;
};
struct EmgTarget {
  enum class What {
    gain,
    delay,
    nonlinearity,
    offset,
    crosstalk,
    saturation,
    fatigue,
    fatigueTime,
    latent
  } what;
  std::string muscle;  ///< of a gain, an offset, a saturation, a latent excitation, a crosstalk's
                       ///< receiver
  std::string from = {};  ///< of a crosstalk
  std::size_t knot = 0;   ///< of a latent excitation
  friend bool operator==(const EmgTarget&, const EmgTarget&) = default;
};
struct InitialTarget {
  int coordinate;  ///< free index
  bool isSpeed;
  friend bool operator==(const InitialTarget&, const InitialTarget&) = default;
};
using ParameterTarget =
    std::variant<MuscleTarget, PointTarget, WrapTarget, BodyTarget, LimitForceTarget,
                 SpringForceTarget, ExpressionTarget, GravityTarget, EmgTarget, InitialTarget,
                 MuscleNumberTarget, ForceNumberTarget>;

/// Whether it is a knot of a latent excitation.
inline bool isKnot(const ParameterTarget& target) {
  const auto* emg = std::get_if<EmgTarget>(&target);
  return emg && emg->what == EmgTarget::What::latent;
}

/// A parameter of the model, of the relation between EMG and excitation, or of the initial state,
/// with its name.
struct ModelParameter {
  std::string name;     ///< e.g. "TRI.radius", "BRA.tendon_slack_length", "hand.mass"
  std::string unit;     ///< "" for a pure number
  std::string meaning;  ///< one line
  double value;         ///< in the model [unit]
  double lower, upper;  ///< bounds for estimation and sweeps [unit]
  double sd;            ///< default prior standard deviation [unit] > 0
  std::vector<ParameterTarget> targets;  ///< all are set to the same value
  bool isGroup = false;                  ///< sets several parameters together; not part of "all"
  /// The smallest value that the geometry does not permit [unit], and the reason (radius_limit.h).
  double limit = std::numeric_limits<double>::infinity();
  std::string whyLimited = {};
};

/// Initial state of a simulation: coordinates and speeds; the fibres start in static equilibrium.
struct StartPoint {
  Eigen::VectorXd q;     ///< [rad] or [m]
  Eigen::VectorXd qDot;  ///< [rad/s] or [m/s]; empty: 0
  /// Speeds that the recording shows there: the prior standard deviation of a speed is at least as
  /// large [rad/s] or [m/s]; empty: 0.
  Eigen::VectorXd speedSd = {};
};

/// All parameters that affect the motion, by name.
///
/// Parameters of muscles have OpenSim's names (max_isometric_force, optimal_fiber_length,
/// tendon_slack_length, pennation_angle, damping, time_scale, activation1, activation2; of other
/// classes FmaxTendonStrain, TendonForceLengthCurve/strain_at_one_norm_force, …), points by their
/// index (TRIlong.point2.x), wrap objects by name (TRI.radius, TRI.translation.x,
/// TRI.rotation.x), bodies by name (hand.mass, hand.mass_center.x, hand.inertia.xx), passive forces
/// and actuators by name with OpenSim's names of their numbers
/// (elbow_flexion_ligaments.upper_stiffness, acl.slack_length, brace.rotational_stiffness.z,
/// motor.optimal_force). emg.BRA.gain, emg.delay, emg.nonlinearity;
/// initial.elbow_flexion, initial.elbow_flexion.speed. Groups: activation.time_scale, emg.gain, …
/// Behind them, for each muscle of EmgMapping::latent, emg.BRA.latent1, … of its knots, which
/// belong to one trial.
///
/// Bounds and prior standard deviations are generic defaults; positive quantities stay positive,
/// and a radius stays half a per cent below the smallest one for which a point of a path over the
/// surface lies inside.
class ParameterCatalogue {
 public:
  /// @param start initial state; one entry per free coordinate
  ParameterCatalogue(const Model& model, const MusculoskeletalSystem& system,
                     const StartPoint& start, const EmgMapping& mapping = {});

  const std::vector<ModelParameter>& parameters() const { return parameters_; }

  /// Index of a name; spelling variants are understood (optimal_fibre_length, pennation, x for
  /// translation.x of a wrap object). @throws std::invalid_argument with the nearest names
  std::size_t find(const std::string& name) const;

  /// Whether a parameter has exactly this name.
  bool has(const std::string& name) const;

  /// Indices of names, in order, each once. A name may contain `*`; "all" means all except groups.
  /// @throws std::invalid_argument as find does, if a pattern matches nothing, or if a group is
  ///   named beside one of its members
  std::vector<std::size_t> select(const std::vector<std::string>& names) const;

  /// Values in the model.
  Eigen::VectorXd values(const std::vector<std::size_t>& selection) const;

  /// @param what prefix of the message: "" or "upper bound of "
  /// @throws std::invalid_argument for a value at the parameter's limit or beyond, saying why
  void requireBelowLimit(std::size_t index, double value, const std::string& what = {}) const;

  /// As parameters for estimators; if requested, the default standard deviation becomes the prior.
  std::vector<info::Parameter> asEstimated(const std::vector<std::size_t>& selection,
                                           bool withPriors) const;

  /// The model, EMG mapping and start with some parameters at other values.
  struct Setting {
    Model model;
    EmgMapping mapping;
    StartPoint start;
    Eigen::VectorXd values;  ///< of every parameter of the catalogue
  };
  /// @throws std::invalid_argument for a value that is not finite or at its limit or beyond, or
  ///   sizes that differ. Other rules are checked when a MusculoskeletalSystem is made.
  Setting at(const std::vector<std::size_t>& selection, const Eigen::VectorXd& values) const;
  /// The values of the model.
  Setting nominal() const { return at({}, Eigen::VectorXd(0)); }

  const Model& model() const { return model_; }

 private:
  Model model_;
  EmgMapping mapping_;
  StartPoint start_;
  std::vector<std::string> muscles_;  ///< of the system
  std::vector<ModelParameter> parameters_;
};

/// A direction in several elementary numbers, whose derivative is one column: dθ = Σ weight·dx.
struct TargetStep {
  ParameterTarget target;
  double weight = 1;
  double value = 1;  ///< of the target; used only for a scale of a curve
};
using ParameterDirection = std::vector<TargetStep>;

/// Sets the value of a target. Scales of curves multiply those of `setting`; a moving path point is
/// shifted by value − nominal; the radius of an ellipsoid is that of the semi-axes equal to
/// nominal.
/// @throws std::invalid_argument for a value that is not finite
void setTarget(ParameterCatalogue::Setting& setting, const ParameterTarget& target, double value,
               double nominal);

}  // namespace bio
