#include "bio/discovery/encompassing_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace bio::discover {

using Eigen::Index;
using Eigen::Vector3d;
using Eigen::VectorXd;

EncompassingModel::EncompassingModel(const Model& model, const SystemOptions& system,
                                     const CoordinateNames& coordinates,
                                     std::vector<Observable> sensors)
    : base_(model),
      systemOptions_(system),
      system_(std::make_unique<const MusculoskeletalSystem>(model, system)),
      sensors_(std::move(sensors)),
      encompassing_(model) {
  if (coordinates.all.empty()) throw std::invalid_argument("no observed coordinate is given");
  for (const std::string& name : coordinates.all) {
    MovingCoordinate at;
    at.index = system_->skeleton().indexOf(name);
    if (at.index < 0)
      throw std::invalid_argument(fmt::format("observed coordinate '{}' is not free", name));
    at.coordinate = system_->skeleton().coordinates()[static_cast<std::size_t>(at.index)];
    coordinates_.push_back(std::move(at));
  }
  if (sensors_.empty()) {
    for (const std::string& name : coordinates.all) sensors_.push_back(ofCoordinate(name));
  }
  parameters_ = std::make_unique<const ParameterCatalogue>(
      model, *system_, StartPoint{system_->skeleton().defaultValues(), {}});
  for (MovingCoordinate& at : coordinates_) findBodies(at);
  for (const Body& body : base_.bodies) {
    const bool isMoved =
        std::any_of(coordinates_.begin(), coordinates_.end(), [&](const MovingCoordinate& at) {
          return std::count(at.movedBodies.begin(), at.movedBodies.end(), body.name) > 0;
        });
    if (isMoved) movedBodies_.push_back(body.name);
  }
  for (const MovingCoordinate& at : coordinates_) {
    const bool isAcross = at.axis.cross(base_.gravity).norm() > 1e-6 * base_.gravity.norm();
    if (axis_.isZero() && (isAcross || hasOneCoordinate())) axis_ = at.axis;
  }
  findGroups();
}

std::string EncompassingModel::idAt(const MovingCoordinate& at, const std::string& id) const {
  return hasOneCoordinate() ? id : at.coordinate.name + "." + id;
}

std::string EncompassingModel::idOf(std::size_t sensor, const std::string& id) const {
  return sensors_.size() == 1 ? id : nameOf(sensors_.at(sensor)) + "." + id;
}

void EncompassingModel::setMotions(const std::map<std::string, MotionSize>& motions) {
  for (MovingCoordinate& at : coordinates_) {
    const auto seen = motions.find(at.coordinate.name);
    at.seen = seen == motions.end() ? MotionSize{} : seen->second;
  }
}

bool EncompassingModel::knows(const std::string& id) const {
  return std::any_of(candidates_.begin(), candidates_.end(), [&](const Candidate& candidate) {
    return candidate.id == id || candidate.id.ends_with("." + id);
  });
}

std::size_t EncompassingModel::find(const std::string& quantity) const {
  for (std::size_t i = 0; i < quantities_.size(); ++i) {
    if (quantities_[i].name == quantity) return i;
  }
  throw std::invalid_argument(fmt::format("no quantity is called '{}'", quantity));
}

std::size_t EncompassingModel::number(const ParameterTarget& target, double nominal) {
  for (std::size_t i = 0; i < numbers_.size(); ++i) {
    if (numbers_[i].target == target) return i;
  }
  numbers_.push_back({target, nominal});
  return numbers_.size() - 1;
}

std::vector<Meaning::Part> EncompassingModel::numbers(const std::string& parameter) {
  const ModelParameter& found = parameters_->parameters()[parameters_->find(parameter)];
  std::vector<Meaning::Part> parts;
  for (const ParameterTarget& target : found.targets)
    parts.push_back({number(target, found.value)});
  return parts;
}

std::size_t EncompassingModel::add(Quantity quantity, Meaning meaning) {
  quantities_.push_back(std::move(quantity));
  meanings_.push_back(std::move(meaning));
  return quantities_.size() - 1;
}

std::size_t EncompassingModel::addLaw(SpringGeneralizedForce law) {
  law.enabled = false;
  encompassing_.springForces.push_back(std::move(law));
  laws_.push_back({Law::List::spring, encompassing_.springForces.size() - 1, {}});
  return laws_.back().index;
}
std::size_t EncompassingModel::addLaw(CoordinateLimitForce law) {
  law.enabled = false;
  encompassing_.limitForces.push_back(std::move(law));
  laws_.push_back({Law::List::limit, encompassing_.limitForces.size() - 1, {}});
  return laws_.back().index;
}
std::size_t EncompassingModel::addLaw(ExpressionBasedCoordinateForce law) {
  law.enabled = false;
  encompassing_.expressionForces.push_back(std::move(law));
  laws_.push_back({Law::List::expression, encompassing_.expressionForces.size() - 1, {}});
  return laws_.back().index;
}
std::size_t EncompassingModel::addLaw(ElasticPath law) {
  law.enabled = false;
  encompassing_.elasticPaths.push_back(std::move(law));
  laws_.push_back({Law::List::elasticPath, encompassing_.elasticPaths.size() - 1, {}});
  return laws_.back().index;
}
std::size_t EncompassingModel::addMuscle(std::size_t muscle, std::vector<std::string> synergists) {
  SchutteParameters& parameters = *encompassing_.muscles.at(muscle).schutte;
  synergists_[base_.muscles[muscle].name] = std::move(synergists);
  laws_.push_back({Law::List::muscle, muscle, {}});
  // as good as none: a force beside which any other stays as it is
  parameters.maxIsometricForce *= 1e-30;
  return number(MuscleTarget{muscle, MuscleQuantity::maxIsometricForce},
                parameters.maxIsometricForce);
}
void EncompassingModel::lawFollows(std::vector<std::size_t> quantities) {
  laws_.back().quantities = std::move(quantities);
}

void EncompassingModel::setCommands(const std::vector<DriveCommand>& commands) {
  for (const DriveCommand& command : commands) {
    if (std::none_of(coordinates_.begin(), coordinates_.end(), [&](const MovingCoordinate& at) {
          return at.coordinate.name == command.coordinate;
        }))
      throw std::invalid_argument(
          fmt::format("drive of '{}': must be a coordinate in question", command.coordinate));
    drives_.push_back({command});
  }
}

Drive* EncompassingModel::driveOf(const MovingCoordinate& at) {
  for (Drive& drive : drives_)
    if (drive.command.coordinate == at.coordinate.name) return &drive;
  return nullptr;
}

DriveLaws EncompassingModel::driveLawsAt(const VectorXd& values) const {
  DriveLaws laws;
  for (const Drive& drive : drives_)
    if (const DriveLaw law = driveLaw(drive, values); !law.isTrue())
      laws[drive.command.coordinate] = law;
  return laws;
}

void EncompassingModel::trialsLast(double first, double last) {
  constexpr double edge = 0.2;     // [s] of a trial's ends where nothing that changes shows
  constexpr double spacing = 0.6;  // [s] between starts of fits
  if (!(last - first > 4 * edge)) return;
  const double lower = first + edge, upper = last - edge;
  for (const TimedForce& force : timedForces_) {
    Quantity& time = quantities_[force.time];
    time.lower = lower;
    time.upper = upper;
    time.nominal = (lower + upper) / 2;
    time.sd = (upper - lower) / std::sqrt(12.0);
    for (Candidate& candidate : candidates_) {
      if (candidate.quantities.front() != force.amplitude) continue;
      candidate.sds[1] = time.sd;
      const double size = candidate.starts.front()[0];
      const auto count = static_cast<int>(std::ceil((upper - lower) / spacing));
      candidate.starts.clear();
      for (int k = 0; k < count; ++k) {
        candidate.starts.push_back(
            Eigen::Vector2d(size, lower + (upper - lower) * (k + 0.5) / count));
      }
    }
  }
}

void EncompassingModel::forget(const std::vector<std::string>& ids) {
  std::erase_if(candidates_, [&](const Candidate& candidate) {
    return std::any_of(ids.begin(), ids.end(), [&](const std::string& id) {
      return candidate.id == id || candidate.id.ends_with("." + id);
    });
  });
}

void EncompassingModel::separate(const std::string& one, const std::string& other) {
  for (Candidate& candidate : candidates_) {
    if (candidate.id == one) std::erase(candidate.equivalents, other);
    if (candidate.id == other) std::erase(candidate.equivalents, one);
  }
}

VectorXd EncompassingModel::nominal() const {
  VectorXd values(static_cast<Index>(quantities_.size()));
  for (Index i = 0; i < values.size(); ++i) {
    values[i] = quantities_[static_cast<std::size_t>(i)].nominal;
  }
  return values;
}

EncompassingModel::Numbers EncompassingModel::numbersAt(const VectorXd& values) const {
  const auto n = static_cast<Index>(numbers_.size());
  Numbers numbers{VectorXd::Ones(n), VectorXd::Zero(n)};
  for (std::size_t i = 0; i < meanings_.size(); ++i) {
    const double value = values[static_cast<Index>(i)];
    for (const Meaning::Part& part : meanings_[i].parts) {
      const auto k = static_cast<Index>(part.number);
      if (meanings_[i].kind == Meaning::Kind::scale) {
        numbers.product[k] *= part.weight == 1 ? value : std::pow(value, part.weight);
      }
      if (meanings_[i].kind == Meaning::Kind::shift || meanings_[i].kind == Meaning::Kind::tilt)
        numbers.sum[k] += part.weight * value;
    }
  }
  return numbers;
}

ParameterCatalogue::Setting EncompassingModel::settingAt(
    const VectorXd& values, const std::vector<std::size_t>& wanted) const {
  ParameterCatalogue::Setting setting{encompassing_, {}, {}, {}};
  setting.start.q = system_->skeleton().defaultValues();
  setting.start.qDot = VectorXd::Zero(setting.start.q.size());
  const Numbers numbers = numbersAt(values);
  for (std::size_t i = 0; i < numbers_.size(); ++i) {
    const double value = numbers.at(i, numbers_[i]);
    if (value != numbers_[i].nominal) {
      setTarget(setting, numbers_[i].target, value, numbers_[i].nominal);
    }
  }
  for (std::size_t i = 0; i < meanings_.size(); ++i) {
    const double angle = values[static_cast<Index>(i)];
    if (meanings_[i].kind != Meaning::Kind::tilt || angle == 0) continue;
    setting.model.gravity = Eigen::AngleAxisd(-angle, axis_) * setting.model.gravity;
  }
  for (const Law& law : laws_) {
    const std::size_t amplitude = law.quantities.front();
    bool on = values[static_cast<Index>(amplitude)] != quantities_[amplitude].nominal;
    for (const std::size_t quantity : law.quantities) {
      on = on || std::find(wanted.begin(), wanted.end(), quantity) != wanted.end();
    }
    switch (law.list) {
      case Law::List::spring:
        setting.model.springForces[law.index].enabled = on;
        break;
      case Law::List::limit:
        setting.model.limitForces[law.index].enabled = on;
        break;
      case Law::List::expression:
        setting.model.expressionForces[law.index].enabled = on;
        break;
      case Law::List::elasticPath:
        setting.model.elasticPaths[law.index].enabled = on;
        break;
      case Law::List::muscle:
        setting.model.muscles[law.index].enabled = on;
        break;
    }
  }
  return setting;
}

MusculoskeletalSystem EncompassingModel::systemOf(
    const ParameterCatalogue::Setting& setting) const {
  const Model& model = setting.model;
  const auto isShaped = [&](std::size_t m) {
    const Path& path = model.muscles[m].path;
    if (path != base_.muscles[m].path || !base_.muscles[m].enabled) return true;
    for (std::size_t w = 0; w < model.wrapObjects.size(); ++w) {
      if (model.wrapObjects[w] == base_.wrapObjects[w]) continue;
      for (const PathWrap& over : path.wraps) {
        if (over.wrapObject == model.wrapObjects[w].name) return true;
      }
    }
    return false;
  };
  std::vector<std::string> shaped;
  for (std::size_t m = 0; m < model.muscles.size(); ++m) {
    if (model.muscles[m].enabled && isShaped(m)) shaped.push_back(model.muscles[m].name);
  }
  return {model, systemOptions_, *system_, shaped};
}

ParameterDirection EncompassingModel::direction(const VectorXd& values,
                                                std::size_t quantity) const {
  const Meaning& meaning = meanings_.at(quantity);
  ParameterDirection direction;
  if (meaning.kind == Meaning::Kind::tilt) {
    double angle = 0;
    for (std::size_t i = 0; i < meanings_.size(); ++i) {
      if (meanings_[i].kind == Meaning::Kind::tilt) angle += values[static_cast<Index>(i)];
    }
    const Vector3d turned = Eigen::AngleAxisd(-angle, axis_) * base_.gravity;
    const Vector3d rate = -axis_.cross(turned);
    for (int k = 0; k < 3; ++k) direction.push_back({GravityTarget{k}, rate[k], 1});
  }
  if (meaning.parts.empty()) return direction;
  const Numbers numbers = numbersAt(values);
  for (const Meaning::Part& part : meaning.parts) {
    const Number& number = numbers_[part.number];
    double weight = part.weight;
    if (meaning.kind == Meaning::Kind::scale) {
      weight *= number.nominal * numbers.product[static_cast<Index>(part.number)] /
                values[static_cast<Index>(quantity)];
    }
    if (weight == 0) continue;
    direction.push_back({number.target, weight, numbers.at(part.number, number)});
  }
  return direction;
}

SensorLaw EncompassingModel::sensorAt(const VectorXd& values, std::size_t sensor) const {
  SensorLaw law;
  for (std::size_t i = 0; i < meanings_.size(); ++i) {
    if (meanings_[i].sensor != sensor) continue;
    const double value = values[static_cast<Index>(i)];
    if (meanings_[i].kind == Meaning::Kind::bias) law.bias += value;
    if (meanings_[i].kind == Meaning::Kind::gain) law.gain += value;
    if (meanings_[i].kind == Meaning::Kind::clock) law.clock += value;
    if (meanings_[i].kind == Meaning::Kind::rate) law.rate += value;
    if (meanings_[i].kind == Meaning::Kind::lag) law.lag += value;
    if (meanings_[i].kind == Meaning::Kind::drift) law.drift += value;
  }
  return law;
}

Trial withSynergists(Trial trial, const EncompassingModel& encompassing) {
  for (const auto& [muscle, synergists] : encompassing.synergists()) {
    const auto has = [&](const std::string& name) {
      return std::find(trial.muscles.begin(), trial.muscles.end(), name);
    };
    if (has(muscle) != trial.muscles.end()) continue;
    VectorXd mean = VectorXd::Zero(trial.times.size());
    for (const std::string& synergist : synergists) {
      const auto at = has(synergist);
      if (at == trial.muscles.end()) {
        throw std::invalid_argument(
            fmt::format("{}: no excitation of muscle '{}'", trial.file, synergist));
      }
      mean += trial.excitations.col(at - trial.muscles.begin());
    }
    trial.muscles.push_back(muscle);
    trial.excitations.conservativeResize(Eigen::NoChange, trial.excitations.cols() + 1);
    trial.excitations.rightCols<1>() = mean / static_cast<double>(synergists.size());
  }
  return trial;
}

}  // namespace bio::discover
