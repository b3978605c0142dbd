#include "bio/simulation/musculoskeletal_system.h"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <numeric>
#include <optional>
#include <stdexcept>

#include "bio/path/path_lengths.h"
#include "bio/path/posture_samples.h"
#include "info/parallel_for.h"
#include "model/listed_names.h"
#include "model/plausible.h"
#include "simulation/integrators.h"
#include "simulation/moved_mass.h"

namespace bio {
namespace {

/// [m]
double defaultLength(const Skeleton& skeleton, const Muscle& muscle, const MusclePath& path) {
  PathLengths lengths(skeleton);
  lengths.add(muscle, path);
  lengths.moveTo(skeleton.defaultValues());
  return lengths.along(0).length;
}

std::vector<int> indicesOf(const std::vector<std::string>& prescribed, const Skeleton& skeleton) {
  std::vector<int> indices;
  for (const std::string& name : prescribed) {
    const int index = skeleton.indexOf(name);
    if (index < 0) {
      throw std::invalid_argument(fmt::format(
          "prescribed coordinate '{}': the model has no such coordinate that can move", name));
    }
    if (std::find(indices.begin(), indices.end(), index) != indices.end()) {
      throw std::invalid_argument(fmt::format("coordinate '{}' is prescribed twice", name));
    }
    indices.push_back(index);
  }
  std::sort(indices.begin(), indices.end());
  return indices;
}

/// A muscle that carries the path of an elastic string through the code for muscles' paths.
Muscle asMuscle(const ElasticPath& elastic) {
  Muscle carrier;
  carrier.name = elastic.name;
  carrier.path = elastic.path;
  return carrier;
}

/// The path of one muscle, or why there is none.
class FoundPath {
 public:
  void find(const Model& model, const Skeleton& skeleton, const Muscle& muscle,
            const SystemOptions& options, const std::vector<Posture>& postures) noexcept {
    try {
      path_.emplace(model, skeleton, muscle, options.wrapAsCylinder, postures);
      if (options.tabulatePaths && path_->moves()) path_->tabulate(skeleton);
    } catch (...) {
      error_ = std::current_exception();
    }
  }
  /// @throws what was thrown when it was sought
  MusclePath&& path() {
    if (error_) std::rethrow_exception(error_);
    return std::move(path_.value());
  }

 private:
  std::optional<MusclePath> path_;
  std::exception_ptr error_;
};

/// One per muscle; empty where it is switched off. Taut paths over general surfaces are most of
/// what a large model takes to compile.
std::vector<FoundPath> findPaths(const Model& model, const Skeleton& skeleton,
                                 const SystemOptions& options, PostureSamples& postures) {
  std::vector<FoundPath> found(model.muscles.size());
  std::vector<const std::vector<Posture>*> lists;
  for (const Muscle& muscle : model.muscles) {
    lists.push_back(muscle.enabled ? &postures.of(muscle) : nullptr);
  }
  info::parallelFor(static_cast<int>(found.size()), options.threads, [&](int i) {
    const auto muscle = static_cast<std::size_t>(i);
    if (!lists[muscle]) return;
    found[muscle].find(model, skeleton, model.muscles[muscle], options, *lists[muscle]);
  });
  return found;
}

/// A muscle of any class on its path.
/// @param curves, others  own what a muscle of Schutte's class, or of another, refers to
SystemMuscle simulated(const Muscle& muscle, MusclePath path, const SchutteOptions& options,
                       std::vector<std::unique_ptr<const SchutteCurves>>& curves,
                       std::vector<std::unique_ptr<const muscles::AnyMuscle>>& others) {
  try {
    if (muscle.schutte) {
      const SchutteParameters& s = *muscle.schutte;
      curves.push_back(std::make_unique<const SchutteCurves>(s));
      const SchutteMuscle<double> law(schutteQuantities(s), *curves.back(), options);
      const SchutteActivation<double> activation{s.timeScale, s.activation1, s.activation2};
      return {muscle.name, SimulatedMuscle(law), ActivationDynamics(activation), std::move(path)};
    }
    others.push_back(std::make_unique<const muscles::AnyMuscle>(muscles::compile(*muscle.hill)));
    return {muscle.name, SimulatedMuscle(*others.back()),
            ActivationDynamics(muscles::activationOf(*muscle.hill)), std::move(path)};
  } catch (const std::invalid_argument& e) {
    throw std::invalid_argument(fmt::format("muscle '{}': {}", muscle.name, e.what()));
  }
}

}  // namespace

MusculoskeletalSystem::MusculoskeletalSystem(const Model& model, const SystemOptions& options)
    : MusculoskeletalSystem(model, options, nullptr, {}) {}

MusculoskeletalSystem::MusculoskeletalSystem(const Model& model, const SystemOptions& options,
                                             const MusculoskeletalSystem& like,
                                             const std::vector<std::string>& shaped)
    : MusculoskeletalSystem(model, options, &like, shaped) {}

bool MusculoskeletalSystem::isPrescribed(int coordinate) const {
  return std::binary_search(prescribed_.begin(), prescribed_.end(), coordinate);
}

const Function* MusculoskeletalSystem::courseOf(int coordinate) const {
  const auto at = courses_.find(coordinate);
  return at == courses_.end() ? nullptr : &at->second;
}

MusculoskeletalSystem MusculoskeletalSystem::withAllPrescribed() && {
  prescribed_.resize(skeleton_.coordinates().size());
  std::iota(prescribed_.begin(), prescribed_.end(), 0);
  return std::move(*this);
}

const MusclePath* MusculoskeletalSystem::pathOf(const std::string& muscle) const {
  for (const SystemMuscle& one : muscles_) {
    if (one.name == muscle) return &one.path;
  }
  return nullptr;
}

void MusculoskeletalSystem::addTreePaths(const Model& model) {
  if (!skeleton_.tree()) return;
  tree_ = std::make_unique<ArticulatedTree>(*skeleton_.tree());
  for (const SystemMuscle& muscle : muscles_) {
    treePaths_.emplace_back(*tree_, skeleton_, findMuscle(model, muscle.name),
                            muscle.path.compiled());
  }
  for (const SystemElasticPath& elastic : elasticPaths_) {
    for (const ElasticPath& given : model.elasticPaths) {
      if (given.name != elastic.name) continue;
      treePaths_.emplace_back(*tree_, skeleton_, asMuscle(given), elastic.path.compiled());
      break;
    }
  }
}

void MusculoskeletalSystem::addSwitches(const MusclePath& path) {
  for (const PathSwitch& s : path.switches()) {
    const bool known =
        std::any_of(switches_.begin(), switches_.end(), [&](const PathSwitch& other) {
          return other.freeIndex == s.freeIndex && other.value == s.value;
        });
    if (!known) switches_.push_back(s);
  }
}

void MusculoskeletalSystem::addElasticPaths(const Model& model, const SystemOptions& options,
                                            const MusculoskeletalSystem* like,
                                            PostureSamples& postures) {
  for (const ElasticPath& elastic : model.elasticPaths) {
    if (!elastic.enabled) continue;
    const Muscle carrier = asMuscle(elastic);
    std::optional<MusclePath> path;
    if (like) {
      for (const SystemElasticPath& one : like->elasticPaths_) {
        if (one.name == elastic.name) path = one.path;
      }
    }
    if (!like || (!path && elastic.path.function)) {
      try {
        path.emplace(model, skeleton_, carrier, options.wrapAsCylinder, postures.of(carrier));
      } catch (const UnsupportedWrap& e) {
        warnings_.push_back(fmt::format("{}: '{}' is left out", e.what(), elastic.name));
        continue;
      }
      warnings_.insert(warnings_.end(), path->warnings().begin(), path->warnings().end());
    }
    if (!path || !path->moves()) continue;
    addSwitches(*path);
    elasticPaths_.push_back({elastic.name, ElasticPathLaw(elastic), std::move(*path)});
  }
}

MusculoskeletalSystem::MusculoskeletalSystem(const Model& model, const SystemOptions& options,
                                             const MusculoskeletalSystem* like,
                                             const std::vector<std::string>& shaped)
    : skeleton_(model, options.skeleton),
      prescribed_(indicesOf(options.prescribed, skeleton_)),
      coordinateForces_(model, skeleton_),
      bodyForces_(model, skeleton_) {
  for (const int k : prescribed_) {
    const Coordinate& coordinate = skeleton_.coordinates()[static_cast<std::size_t>(k)];
    if (coordinate.prescribed && coordinate.prescribedFunction) {
      courses_.emplace(k, *coordinate.prescribedFunction);
    }
  }
  for (const CoordinateActuator& actuator : model.actuators) {
    if (actuator.enabled && skeleton_.indexOf(actuator.coordinate) >= 0) {
      actuators_.push_back(actuator);
    }
  }
  if (like) {
    isSingularInDefaultPosture_ = like->isSingularInDefaultPosture_;
  } else {
    isSingularInDefaultPosture_ = !requireMovedMass(model, skeleton_);
    warnings_ = lockRemarks(model, options.skeleton);
    notes_ = adviceOnCylinders(options.wrapAsCylinder);
  }
  PostureSamples postures(model, skeleton_);
  std::vector<FoundPath> found;
  if (!like) found = findPaths(model, skeleton_, options, postures);
  std::vector<std::string> unmoved;
  for (std::size_t m = 0; m < model.muscles.size(); ++m) {
    const Muscle& muscle = model.muscles[m];
    if (!muscle.enabled) {
      notes_.push_back(fmt::format("muscle '{}' is switched off in the model", muscle.name));
      continue;
    }
    std::optional<MusclePath> compiled;
    const bool isShaped = std::find(shaped.begin(), shaped.end(), muscle.name) != shaped.end();
    const MusclePath* ready = like && !isShaped ? like->pathOf(muscle.name) : nullptr;
    if (like && !isShaped && !ready) continue;  // left out there, for a reason that still holds
    try {
      if (ready) {
        compiled = *ready;
      } else if (like) {
        compiled.emplace(model, skeleton_, muscle, options.wrapAsCylinder, postures.of(muscle));
      } else {
        compiled = found[m].path();
      }
    } catch (const UnsupportedWrap& e) {
      warnings_.push_back(fmt::format("{}: the muscle is left out", e.what()));
      continue;
    }
    MusclePath& path = *compiled;
    if (!like) {
      warnings_.insert(warnings_.end(), path.warnings().begin(), path.warnings().end());
      if (const double length = defaultLength(skeleton_, muscle, path); length < shortestPath) {
        warnings_.push_back(
            fmt::format("muscle '{}': its path is {:.3g} m long in the default "
                        "posture, usually more than 1 mm",
                        muscle.name, length));
      }
    }
    if (!path.moves()) {
      unmoved.push_back(muscle.name);
      continue;
    }
    if (!muscle.canBeSimulated()) {
      throw std::invalid_argument(
          fmt::format("muscle '{}' is a {}; the classes that can be "
                      "simulated are {}",
                      muscle.name, muscle.className, simulatedClasses()));
    }
    for (const std::string& note : path.notes()) notes_.push_back(note);
    addSwitches(path);
    muscles_.push_back(simulated(muscle, std::move(path), options.muscle, curves_, others_));
  }
  for (std::string& note : unmovedMuscles(unmoved)) notes_.push_back(std::move(note));
  addElasticPaths(model, options, like, postures);
  addTreePaths(model);
  for (const Marker& marker : model.markers) {
    const BodyPlacement& place = skeleton_.placeOf(marker.body);
    markers_.push_back({marker.body + "." + marker.name, place.segment,
                        place.X_SB.R * marker.location + place.X_SB.p});
  }
  if (muscles_.empty()) notes_.push_back("no muscle acts on the free coordinates");
}

}  // namespace bio
