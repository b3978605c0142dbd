#pragma once

#include <Eigen/Dense>
#include <array>
#include <limits>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "bio/muscle/curves/function.h"
#include "bio/muscle/muscle_variant.h"
#include "bio/muscle/schutte_parameters.h"

/// A musculoskeletal model as plain data: the content of an .osim file. SI units and radians
/// throughout. Names are unique within their list and refer to each other by name.
namespace bio {

/// Placement of a frame in its parent: p_parent = R(orientation) p_frame + translation.
struct FramePlacement {
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();  ///< [m]
  Eigen::Vector3d orientation = Eigen::Vector3d::Zero();  ///< body-fixed x-y-z angles [rad]
  friend bool operator==(const FramePlacement&, const FramePlacement&) = default;
};

// Skeleton ----------------------------------------------------------------------------------------

/// A mesh of a body, for pictures only.
struct BodyGeometry {
  std::string file;                                 ///< .vtp
  Eigen::Vector3d scale = Eigen::Vector3d::Ones();  ///< along x, y and z
  friend bool operator==(const BodyGeometry&, const BodyGeometry&) = default;
};

struct Body {
  std::string name;
  double mass = 0;                                       ///< [kg] ≥ 0
  Eigen::Vector3d massCenter = Eigen::Vector3d::Zero();  ///< in the body frame [m]
  std::array<double, 6> inertia = {0, 0, 0,
                                   0, 0, 0};  ///< xx yy zz xy xz yz about massCenter [kg m²]
  std::vector<BodyGeometry> geometry;
  friend bool operator==(const Body&, const Body&) = default;
};

struct Coordinate {
  std::string name;
  bool isRotation = true;   ///< radians, else metres
  double defaultValue = 0;  ///< [rad] or [m]
  double rangeMin = 0;      ///< [rad] or [m]
  double rangeMax = 0;      ///< [rad] or [m], ≥ rangeMin
  bool locked = false;
  bool clamped = false;
  bool prescribed = false;  ///< it moves on prescribedFunction, unless it is locked
  /// Course over time [s], in radians or metres; none: not prescribed, or of an unknown class.
  std::optional<Function> prescribedFunction = {};
  bool isPrescribed() const { return prescribed && !locked; }
  friend bool operator==(const Coordinate&, const Coordinate&) = default;
};

/// One of the six axes of a custom joint: rotation about, or translation along, `axis` by
/// function(coordinate). Without a coordinate the function is a constant.
struct TransformAxis {
  std::string coordinate;  ///< empty: constant
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();
  Function function;  ///< [rad] or [m]
  friend bool operator==(const TransformAxis&, const TransformAxis&) = default;
};

enum class JointKind { weld, pin, slider, custom };

/// parent body · parentFrame · motion(q) · childFrame⁻¹ = child body.
/// A pin turns about z, a slider moves along x of the parent frame; a custom joint turns about
/// axes[0], axes[1], axes[2] (body-fixed, in that order) and shifts along axes[3..5], all given in
/// the parent frame.
struct Joint {
  std::string name;
  JointKind kind = JointKind::weld;
  std::string parentBody;  ///< "ground" for the ground
  FramePlacement parentFrame;
  std::string childBody;
  FramePlacement childFrame;
  std::vector<Coordinate> coordinates;
  std::array<TransformAxis, 6> axes;  ///< used by custom joints only
  friend bool operator==(const Joint&, const Joint&) = default;
};

/// dependent = function(independent)
struct CoordinateCoupler {
  std::string name;
  std::string independent;
  std::string dependent;
  Function function;
  friend bool operator==(const CoordinateCoupler&, const CoordinateCoupler&) = default;
};

// Paths -------------------------------------------------------------------------------------------

enum class WrapShape { cylinder, sphere, ellipsoid, torus };

struct WrapObject {
  std::string name;
  std::string body;
  WrapShape shape = WrapShape::cylinder;
  FramePlacement frame;          ///< of the shape in its body; a cylinder's axis is its z
  std::string quadrant = "all";  ///< all, x, +x, -x, y, +y, -y, z, +z, -z
  bool active = true;
  double radius = 0;       ///< cylinder, sphere [m] > 0; torus: inner radius
  double outerRadius = 0;  ///< torus [m]
  double length = 0;       ///< cylinder [m] > 0
  Eigen::Vector3d semiAxes = Eigen::Vector3d::Zero();  ///< ellipsoid [m] > 0
  friend bool operator==(const WrapObject&, const WrapObject&) = default;
};

/// The point counts only while lower ≤ coordinate ≤ upper.
struct PointCondition {
  std::string coordinate;
  double lower = 0;  ///< [rad] or [m]
  double upper = 0;
  friend bool operator==(const PointCondition&, const PointCondition&) = default;
};

/// Location by three functions of coordinates, each held within its coordinate's range as in
/// OpenSim: beyond it the point stays where it is at the range's end.
struct PointMotion {
  std::array<std::string, 3> coordinate;  ///< empty: constant
  std::array<Function, 3> location;       ///< x, y, z in the body frame [m]
  friend bool operator==(const PointMotion&, const PointMotion&) = default;
};

struct PathPoint {
  std::string name;
  std::string body;
  Eigen::Vector3d location = Eigen::Vector3d::Zero();  ///< in the body frame [m]
  std::optional<PointCondition> condition;
  std::optional<PointMotion> motion;  ///< replaces location, which is then zero
  friend bool operator==(const PathPoint&, const PathPoint&) = default;
};

struct PathWrap {
  std::string wrapObject;
  int firstPoint = -1;  ///< 1-based, −1: the first point of the path
  int lastPoint = -1;   ///< 1-based, −1: the last point
  friend bool operator==(const PathWrap&, const PathWrap&) = default;
};

/// Σ_k c_k Π_i x_i^(e_ki) over all exponents with Σ_i e_ki ≤ order, in the order of OpenSim's
/// MultivariatePolynomialFunction: those of the last argument rise first. For x, y of order 2:
///     1, y, y², x, xy, x²
/// (a PolynomialFunction of one argument has the opposite order.)
struct MultivariatePolynomial {
  /// OpenSim's limit.
  static constexpr int maxDimension = 6;
  int dimension = 1;                 ///< number of arguments, 1 to maxDimension
  int order = 0;                     ///< largest sum of exponents ≥ 0
  std::vector<double> coefficients;  ///< as many as numTerms(dimension, order)
  /// (order + dimension)! / (order! dimension!); none if that exceeds 10⁶.
  static std::optional<std::size_t> numTerms(int dimension, int order);
  /// @throws std::invalid_argument a dimension, an order or a number of coefficients that cannot
  ///   be, a coefficient that is not finite
  void requireRules() const;
  friend bool operator==(const MultivariatePolynomial&, const MultivariatePolynomial&) = default;
};

/// A length as a function of coordinates in place of points: OpenSim's FunctionBasedPath.
struct PathFunction {
  std::vector<std::string> coordinates;  ///< the arguments, each once
  /// [m]; a Function has one argument
  std::variant<MultivariatePolynomial, Function> length;
  friend bool operator==(const PathFunction&, const PathFunction&) = default;
};

struct Path {
  std::vector<PathPoint> points;              ///< at least 2, none if there is a function
  std::vector<PathWrap> wraps;                ///< a span uses the first one that it penetrates
  std::optional<PathFunction> function = {};  ///< instead of points and wraps
  friend bool operator==(const Path&, const Path&) = default;
};

// Forces ------------------------------------------------------------------------------------------

struct Muscle {
  std::string name;
  std::string className;  ///< as in the file, e.g. Schutte1993Muscle_Deprecated
  bool enabled = true;    ///< false: appliesForce=false / isDisabled=true
  Path path;
  std::optional<SchutteParameters> schutte;  ///< present if the class is a Schutte muscle
  /// Present if it is another class that can be simulated (muscle_variant.h).
  std::optional<muscles::AnyParameters> hill = {};
  bool canBeSimulated() const { return schutte || hill; }
  friend bool operator==(const Muscle&, const Muscle&) = default;
};

/// Smooth one-sided springs at a coordinate's limits with a damper between (OpenSim's units are
/// degrees; here radians).
struct CoordinateLimitForce {
  std::string name;
  std::string coordinate;
  double upperLimit = 0;      ///< [rad]
  double upperStiffness = 0;  ///< [N m/rad] ≥ 0
  double lowerLimit = 0;      ///< [rad] ≤ upperLimit
  double lowerStiffness = 0;  ///< [N m/rad] ≥ 0
  double damping = 0;         ///< [N m s/rad] ≥ 0, acts with the springs
  double transition = 0;      ///< [rad] > 0, width over which stiffness rises from 0
  bool enabled = true;
  friend bool operator==(const CoordinateLimitForce&, const CoordinateLimitForce&) = default;
};

/// −stiffness·(q − restLength) − viscosity·q̇
struct SpringGeneralizedForce {
  std::string name;
  std::string coordinate;
  double stiffness = 0;   ///< [N m/rad]
  double restLength = 0;  ///< [rad]
  double viscosity = 0;   ///< [N m s/rad] ≥ 0
  bool enabled = true;
  friend bool operator==(const SpringGeneralizedForce&, const SpringGeneralizedForce&) = default;
};

/// A named constant of an expression.
struct NamedConstant {
  std::string name;
  double value = 0;
  friend bool operator==(const NamedConstant&, const NamedConstant&) = default;
};

/// Generalised force given as an expression in q and qdot.
struct ExpressionBasedCoordinateForce {
  std::string name;
  std::string coordinate;
  std::string expression;  ///< e.g. "-10*q-5*qdot" [N m]
  bool enabled = true;
  /// Named constants in the expression; in a file they are replaced by their values.
  std::vector<NamedConstant> constants = {};
  friend bool operator==(const ExpressionBasedCoordinateForce&,
                         const ExpressionBasedCoordinateForce&) = default;
};

/// Force, point of application and torque on a body, each three numbers of time: OpenSim's
/// ExternalForce (a table) or PrescribedForce (functions).
struct BodyLoad {
  std::string name;
  std::string body;                   ///< on which it acts, not "ground"
  std::string forceFrame = "ground";  ///< body in whose axes force and torque are given
  std::string pointFrame = "ground";  ///< body in whose frame the point is given
  std::vector<double> times;          ///< [s] strictly rising; empty: `functions` hold
  /// One row per time: force [N], point [m], torque [N m]; natural cubic splines from four rows,
  /// straight lines between two or three, one row: constant. 0 before and after.
  std::vector<std::array<double, 9>> rows;
  std::vector<Function> functions;  ///< the same nine, of time, if there is no table
  bool enabled = true;
  friend bool operator==(const BodyLoad&, const BodyLoad&) = default;
};

/// A spring between points of two bodies: force stiffness·(d − restLength) that pulls them
/// together, d their distance.
struct PointToPointSpring {
  std::string name;
  std::array<std::string, 2> body;       ///< "ground" for the ground
  std::array<Eigen::Vector3d, 2> point;  ///< in the body's frame [m]
  double stiffness = 0;                  ///< [N/m] ≥ 0
  double restLength = 0;                 ///< [m] ≥ 0
  bool enabled = true;
  friend bool operator==(const PointToPointSpring&, const PointToPointSpring&) = default;
};

/// A linear bushing between a frame F of the first body and M of the second: with θ the body-fixed
/// x-y-z angles of M in F and d its place there, generalised forces −K(θ, d) − C(θ̇, ḋ).
struct BushingForce {
  std::string name;
  std::array<std::string, 2> body;
  std::array<FramePlacement, 2> frame;                               ///< F, M
  Eigen::Vector3d rotationalStiffness = Eigen::Vector3d::Zero();     ///< [N m/rad] ≥ 0
  Eigen::Vector3d translationalStiffness = Eigen::Vector3d::Zero();  ///< [N/m] ≥ 0
  Eigen::Vector3d rotationalDamping = Eigen::Vector3d::Zero();       ///< [N m s/rad] ≥ 0
  Eigen::Vector3d translationalDamping = Eigen::Vector3d::Zero();    ///< [N s/m] ≥ 0
  bool enabled = true;
  friend bool operator==(const BushingForce&, const BushingForce&) = default;
};

enum class ElasticPathKind {
  ligament,        ///< scale·curve(L/L₀) where L > L₀
  spring,          ///< PathSpring: scale·(L − L₀)(1 + damping·L̇) where L > L₀
  blankevoort1991  ///< scale·(ε²/2ε_t, from ε_t on ε − ε_t/2) + damping·ε̇ while it lengthens
};

/// A string without state between points of bodies, over wrap objects as a muscle.
struct ElasticPath {
  std::string name;
  ElasticPathKind kind = ElasticPathKind::ligament;
  Path path;
  double restLength = 0;        ///< L₀ [m] > 0
  double scale = 0;             ///< [N] (ligament, Blankevoort), [N/m] (spring) ≥ 0
  double damping = 0;           ///< [s/m] (spring), [N s] (Blankevoort) ≥ 0
  double transitionStrain = 0;  ///< ε_t > 0 (Blankevoort)
  Function curve;               ///< of a ligament
  bool enabled = true;
  friend bool operator==(const ElasticPath&, const ElasticPath&) = default;
};

/// control·optimalForce on a coordinate; the control is a column of the trial.
struct CoordinateActuator {
  std::string name;
  std::string coordinate;
  double optimalForce = 1;  ///< [N m] or [N] at control 1
  bool enabled = true;
  friend bool operator==(const CoordinateActuator&, const CoordinateActuator&) = default;
};

// What was fitted with the model ------------------------------------------------------------------

/// Initial state of the simulation of one trial, fitted together with the model's parameters.
struct TrialStart {
  std::string file;        ///< name of the trial, for information: it is recognised by its SHA-256
  std::string sha256;      ///< of that file, 64 hexadecimal digits
  std::string coordinate;  ///< of the model
  double value = 0;        ///< [rad] or [m]
  double speed = 0;        ///< [rad/s] or [m/s]
  friend bool operator==(const TrialStart&, const TrialStart&) = default;
};

/// Settings that reproduce the simulations of the trials to which a model was fitted. In a file
/// they are the element FisherHill of the model, which OpenSim ignores.
struct FittedSimulation {
  std::optional<double> step;      ///< of the variational integrators [s] > 0
  std::vector<TrialStart> starts;  ///< at most one per trial and coordinate
  bool empty() const { return !step && starts.empty(); }
  friend bool operator==(const FittedSimulation&, const FittedSimulation&) = default;
};

/// A point of a body that motion capture follows.
struct Marker {
  std::string name;
  std::string body;
  Eigen::Vector3d location = Eigen::Vector3d::Zero();  ///< in the body [m]
  friend bool operator==(const Marker&, const Marker&) = default;
};

struct Model {
  std::string name;
  std::string credits;  ///< who made it, and where its numbers come from
  std::string publications;
  Eigen::Vector3d gravity = {0, -9.80665, 0};  ///< [m/s²] in ground
  std::vector<Body> bodies;                    ///< without ground
  std::vector<Joint> joints;                   ///< parents before children
  std::vector<CoordinateCoupler> couplers;
  std::vector<WrapObject> wrapObjects;
  std::vector<Muscle> muscles;
  std::vector<CoordinateLimitForce> limitForces;
  std::vector<SpringGeneralizedForce> springForces;
  std::vector<ExpressionBasedCoordinateForce> expressionForces;
  std::vector<Marker> markers;
  std::vector<BodyLoad> prescribedForces;  ///< PrescribedForce
  std::vector<BodyLoad> externalLoads;     ///< of ExternalLoads, which a model file does not hold
  std::vector<PointToPointSpring> pointSprings;
  std::vector<BushingForce> bushings;
  std::vector<ElasticPath> elasticPaths;
  std::vector<CoordinateActuator> actuators;
  FittedSimulation fitted;
  std::vector<std::string> warnings;  ///< one line each: what was read but is not simulated
  std::vector<std::string> remarks;   ///< one line each: content that was interpreted differently
  friend bool operator==(const Model&, const Model&) = default;
};

/// Names of the muscle classes that can be simulated, for messages.
std::string simulatedClasses();

/// The named item, or throws std::invalid_argument with a list of the existing names.
const Body& findBody(const Model& model, const std::string& name);
const Coordinate& findCoordinate(const Model& model, const std::string& name);
/// Null if there is none of that name.
const Coordinate* coordinateOrNull(const Model& model, const std::string& name);
const WrapObject& findWrapObject(const Model& model, const std::string& name);
const Muscle& findMuscle(const Model& model, const std::string& name);

}  // namespace bio
