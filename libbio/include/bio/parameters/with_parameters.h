#pragma once

#include <map>
#include <string>
#include <vector>

#include "bio/model/model.h"
#include "bio/simulation/musculoskeletal_system.h"

namespace bio {

/// A value for a parameter.
struct NamedValue {
  std::string name;      ///< as ParameterCatalogue::find takes it
  double value = 0;      ///< in the parameter's unit
  bool isAngle = false;  ///< was written as one: its parameter must be an angle
};

/// A number of a model that was set.
struct SetNumber {
  std::string name;   ///< the catalogue's
  std::string unit;   ///< "" for a pure number
  double value = 0;   ///< [unit]
  double before = 0;  ///< in the model that was given [unit]
};

/// A model with other numbers.
struct ModelWithParameters {
  Model model;
  std::vector<SetNumber> numbers;   ///< in the order in which they were given
  std::vector<NamedValue> ofTrial;  ///< those of emg.… and initial.…, which no model holds
};

/// The model with some of its parameters at other values, for all that is done with it: what is
/// estimated has its start and the mean of its prior there.
///
/// Parameters are those of ParameterCatalogue with the free coordinates of the options.
/// @throws std::invalid_argument for an unknown name, with the nearest ones; one given twice; two
///   that set the same number; an angle for what is none; a value that is not finite, that the
///   geometry does not permit or with which no MusculoskeletalSystem can be made
ModelWithParameters withParameters(const Model& model, const SystemOptions& options,
                                   const std::vector<NamedValue>& values);

/// @throws std::invalid_argument if there is a value of a trial
void requireOfModel(const ModelWithParameters& set);

/// Options under which the catalogue has every number of the model, for what has no trial: free is
/// what the model does not lock; if it locks all, all that the user does not lock.
/// @param locks  the user's values [rad] or [m]
SystemOptions optionsOfWholeModel(const Model& model, const std::map<std::string, double>& locks);

}  // namespace bio
