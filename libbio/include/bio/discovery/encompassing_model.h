#pragma once

#include <Eigen/Dense>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bio/discovery/drive_law.h"
#include "bio/discovery/motion_size.h"
#include "bio/discovery/sensor_law.h"
#include "bio/discovery/timed_force.h"
#include "bio/parameters/parameters.h"
#include "bio/simulation/musculoskeletal_system.h"
#include "bio/tables/trial.h"
#include "info/discovery/likelihood/discovery_problem.h"

namespace bio::discover {

/// The effect of a quantity on elementary numbers of model and EMG, or on the sensor.
struct Meaning {
  enum class Kind {
    scale,  ///< multiplies each number by value^weight
    shift,  ///< adds weight·value to each number
    tilt,  ///< turns gravity, so that its moment about the axis is that at q + value; additive like
           ///< shift
    bias,  ///< of the sensor (sensor_law.h), and the five below
    gain,
    clock,
    rate,
    lag,
    drift,
    timed,  ///< of a TimedForce: not a number of the model
    drive   ///< of a Drive: not a number of the model
  };
  struct Part {
    std::size_t number;
    double weight = 1;
  };
  Kind kind = Kind::shift;
  std::vector<Part> parts;
  std::size_t sensor = 0;  ///< of EncompassingModel::sensors(), for effects of a sensor
  /// Index in ParameterCatalogue of the one parameter that a scale multiplies, of which a result
  /// tells the value in place of the factor.
  std::optional<std::size_t> parameter = {};
};

/// Muscles whose names begin with the same capitals: TRIlong, TRIlat and TRImed are TRI.
struct MuscleGroup {
  std::string name;
  std::vector<std::size_t> muscles;  ///< indices into the system's
  /// Mean at mid-range [m], by EncompassingModel::coordinates(); > 0: pulls the coordinate up.
  Eigen::VectorXd momentArms;
};

/// A coordinate whose motion is in question: what it moves.
struct MovingCoordinate {
  int index = 0;  ///< in the skeleton
  Coordinate coordinate;
  std::vector<std::string> movedBodies;  ///< with mass, in order of distance from ground
  /// Unit axis in ground about which it turns all of them; zero if it does not.
  Eigen::Vector3d axis = Eigen::Vector3d::Zero();
  /// Σ m·|∂(mass centre)/∂q| over these bodies at mid-range [kg m]; [kg] if it slides.
  double massMoment = 0;
  MotionSize seen = {};  ///< as measured; zeros where it is not

  double middle() const { return (coordinate.rangeMin + coordinate.rangeMax) / 2; }
};

/// Quantities that trials are known to have (ExperimentalConditions), where the model can have
/// them.
struct ConditionQuantities {
  std::optional<std::size_t> massInHand;  ///< [kg]
  std::optional<std::size_t> armTurn;     ///< [rad]
};

/// Names of coordinates; one name is a list of one.
struct CoordinateNames {
  CoordinateNames(const char* name) : all{name} {}
  CoordinateNames(std::string name) : all{std::move(name)} {}
  CoordinateNames(std::vector<std::string> names) : all(std::move(names)) {}
  std::vector<std::string> all;
};

/// The encompassing model: a model with every effect of the catalogue built in, initially absent.
///
/// Elementary numbers θ_n (a muscle's F0, a body's mass, a constant of a force, …) are functions of
/// quantities x:
///     θ_n = θ_n0 · Π_scales x^weight + Σ_shifts weight·x
/// so that quantities may overlap (the F0 of one head, and of all three). A force whose amplitude
/// has its nominal value is switched off unless a derivative requires it; switched on, it adds ±0.
/// The effects (effects.h) build the model; afterwards it is constant.
class EncompassingModel {
 public:
  using Quantity = info::discover::Quantity;
  using Candidate = info::discover::Candidate;

  /// @param coordinates those whose motion is in question, at least one, free or prescribed in
  ///   `system`
  /// @param sensors what is measured; empty: the coordinates
  /// @throws std::invalid_argument what MusculoskeletalSystem throws; a coordinate that is not free
  EncompassingModel(const Model& model, const SystemOptions& system,
                    const CoordinateNames& coordinates, std::vector<Observable> sensors = {});

  // What effects ask ------------------------------------------------------------------------------

  const Model& base() const { return base_; }
  const MusculoskeletalSystem& system() const { return *system_; }
  const SystemOptions& systemOptions() const { return systemOptions_; }
  const std::vector<MovingCoordinate>& coordinates() const { return coordinates_; }
  std::vector<std::string> coordinateNames() const;
  /// Whether there is one coordinate, whose effects have short ids.
  bool hasOneCoordinate() const { return coordinates_.size() == 1; }
  /// The first coordinate, which is the only one where the model has one.
  const Coordinate& coordinate() const { return coordinates_.front().coordinate; }
  double middle() const { return coordinates_.front().middle(); }
  const std::vector<Observable>& sensors() const { return sensors_; }
  const std::vector<MuscleGroup>& groups() const { return groups_; }
  const ParameterCatalogue& parameters() const { return *parameters_; }
  /// Bodies with mass that any of the coordinates moves, in order of distance from ground.
  const std::vector<std::string>& movedBodies() const { return movedBodies_; }
  /// Axis of the first coordinate that turns its bodies across gravity; zero if none does.
  const Eigen::Vector3d& axis() const { return axis_; }
  /// A point of a body, in ground, at q of the first coordinate and the defaults of the others.
  Eigen::Vector3d positionOf(const std::string& body, const Eigen::Vector3d& point, double q) const;
  /// Moment arms of a system's muscles, each coordinate at mid-range [m]: muscles × coordinates.
  Eigen::MatrixXd momentArms(const MusculoskeletalSystem& system) const;
  /// ∂(mass centre of a body in ground)/∂q of the first coordinate.
  Eigen::Vector3d velocityOf(const std::string& body, double q) const;
  /// Id of an effect or quantity of a coordinate: "visc"; of several, "knee_angle_r.visc".
  std::string idAt(const MovingCoordinate& at, const std::string& id) const;
  /// Id of an effect or quantity of a sensor: "bias"; of several, "knee_angle_r.bias".
  std::string idOf(std::size_t sensor, const std::string& id) const;
  bool knows(const std::string& id) const;  ///< whether there is a candidate with this id
  std::size_t find(const std::string& quantity) const;  ///< @throws std::invalid_argument

  // What effects build ----------------------------------------------------------------------------

  /// Index of an elementary number; each target occurs once.
  std::size_t number(const ParameterTarget& target, double nominal);
  /// Elementary numbers of a parameter of the model, by name.
  std::vector<Meaning::Part> numbers(const std::string& parameter);
  double valueOf(const Meaning::Part& part) const { return numbers_.at(part.number).nominal; }
  std::size_t add(Quantity quantity, Meaning meaning);
  /// Lets a quantity change one more number.
  void extend(std::size_t quantity, Meaning::Part part) {
    meanings_.at(quantity).parts.push_back(part);
  }
  /// How the trials saw the coordinates move (motionSizes).
  void setMotions(const std::map<std::string, MotionSize>& motions);
  void setConditions(const ConditionQuantities& conditions) { conditions_ = conditions; }
  void addNuisance(std::size_t quantity) { nuisances_.push_back(quantity); }
  void add(Candidate candidate) { candidates_.push_back(std::move(candidate)); }
  /// Records an effect that the base model already has, so that it is not a candidate.
  void addPresent(const std::string& id, const std::string& what) { present_[id] = what; }
  /// Adds a force with its numbers at 0; it is switched on while one of its quantities (the
  /// amplitude first) requires it. Returns its index in the list of Model.
  std::size_t addLaw(SpringGeneralizedForce law);
  std::size_t addLaw(CoordinateLimitForce law);
  std::size_t addLaw(ExpressionBasedCoordinateForce law);
  std::size_t addLaw(ElasticPath law);
  /// Switches on a muscle that is switched off in the base model, while a quantity requires it. Its
  /// F0 becomes negligible and is the number whose index is returned. Its EMG is that of the trial,
  /// or the mean of those of `synergists` (at least one).
  std::size_t addMuscle(std::size_t muscle, std::vector<std::string> synergists);
  /// Takes what trials command, before the effects of drives. @throws std::invalid_argument if a
  /// coordinate is not in question
  void setCommands(const std::vector<DriveCommand>& commands);
  /// The drive of a coordinate; null: the trials do not drive it.
  Drive* driveOf(const MovingCoordinate& at);
  void addTimedForce(const TimedForce& force) { timedForces_.push_back(force); }
  /// Latest start and earliest end of the trials [s]: between them timed forces may change.
  void trialsLast(double first, double last);
  /// Removes candidates from the list; their quantities stay at nominal.
  void forget(const std::vector<std::string>& ids);
  /// Declares that two candidates are not equivalent: these data can distinguish them.
  void separate(const std::string& one, const std::string& other);
  /// Declares the quantities of the force added last, the amplitude first.
  void lawFollows(std::vector<std::size_t> quantities);

  // What it is then -------------------------------------------------------------------------------

  const std::vector<Quantity>& quantities() const { return quantities_; }
  const std::vector<std::size_t>& nuisances() const { return nuisances_; }
  const ConditionQuantities& conditions() const { return conditions_; }
  const std::vector<Candidate>& candidates() const { return candidates_; }
  /// Ids of effects that the base model already has, with the elements concerned.
  const std::map<std::string, std::string>& present() const { return present_; }
  Eigen::VectorXd nominal() const;
  /// Muscles whose EMG represents that of a muscle which was added.
  const std::map<std::string, std::vector<std::string>>& synergists() const { return synergists_; }

  /// Model and EMG mapping at values; the start is the default position at rest.
  /// @param wanted quantities whose derivatives are required: their forces are switched on
  ParameterCatalogue::Setting settingAt(const Eigen::VectorXd& values,
                                        const std::vector<std::size_t>& wanted) const;
  /// The compiled model of a setting; paths with unchanged numbers are those of system().
  MusculoskeletalSystem systemOf(const ParameterCatalogue::Setting& setting) const;
  /// Derivatives of the numbers with respect to a quantity; empty for one of the sensor.
  ParameterDirection direction(const Eigen::VectorXd& values, std::size_t quantity) const;
  SensorLaw sensorAt(const Eigen::VectorXd& values, std::size_t sensor = 0) const;
  std::size_t sensorOf(std::size_t quantity) const { return meanings_[quantity].sensor; }
  const std::vector<TimedForce>& timedForces() const { return timedForces_; }
  const std::vector<Drive>& drives() const { return drives_; }
  DriveLaws driveLawsAt(const Eigen::VectorXd& values) const;
  std::optional<std::size_t> parameterOf(std::size_t quantity) const {
    return meanings_[quantity].parameter;
  }
  Meaning::Kind kindOf(std::size_t quantity) const { return meanings_[quantity].kind; }

 private:
  struct Number {
    ParameterTarget target;
    double nominal;
  };
  struct Law {
    enum class List { spring, limit, expression, elasticPath, muscle } list;
    std::size_t index;
    std::vector<std::size_t> quantities;
  };
  /// Products of scales and sums of shifts, one per number.
  struct Numbers {
    Eigen::VectorXd product, sum;
    double at(std::size_t i, const Number& number) const {
      const auto k = static_cast<Eigen::Index>(i);
      return number.nominal * product[k] + sum[k];
    }
  };
  Numbers numbersAt(const Eigen::VectorXd& values) const;
  void findBodies(MovingCoordinate& at) const;
  void findGroups();

  Model base_;
  SystemOptions systemOptions_;
  std::unique_ptr<const MusculoskeletalSystem> system_;
  std::vector<MovingCoordinate> coordinates_;
  std::vector<Observable> sensors_;
  std::unique_ptr<const ParameterCatalogue> parameters_;
  std::vector<std::string> movedBodies_;
  Eigen::Vector3d axis_ = Eigen::Vector3d::Zero();
  std::vector<MuscleGroup> groups_;

  Model encompassing_;
  std::vector<Number> numbers_;
  std::vector<Quantity> quantities_;
  std::vector<Meaning> meanings_;
  std::vector<std::size_t> nuisances_;
  std::vector<Candidate> candidates_;
  std::map<std::string, std::string> present_;
  std::vector<Law> laws_;
  std::vector<TimedForce> timedForces_;
  std::vector<Drive> drives_;
  ConditionQuantities conditions_;
  std::map<std::string, std::vector<std::string>> synergists_;
};

/// The trial with an excitation for every muscle that was added: its own, or the mean of its
/// synergists. @throws std::invalid_argument if the trial lacks one of them
Trial withSynergists(Trial trial, const EncompassingModel& encompassing);

}  // namespace bio::discover
