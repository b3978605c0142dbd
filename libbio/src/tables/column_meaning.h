#pragma once

// Not public.

#include <string>

#include "bio/model/model.h"
#include "bio/tables/observable.h"
#include "bio/tables/table_file.h"

namespace bio {

/// Meaning of a column of a trial.
struct ColumnMeaning {
  enum class Kind { time, muscle, coordinate, applied, channel, extra } kind = Kind::extra;
  std::string name;
  bool inDegrees = false;
  const CoordinateActuator* actuator = nullptr;  ///< of which the column is the control
  Observable what = {};                          ///< of a coordinate or channel
};

/// The name that a column of an OpenSim 4 file stands for: "/jointset/elbow/elbow_flexion/value" is
/// elbow_flexion.
std::string plainName(const Model& model, const std::string& column);

ColumnMeaning meaningOf(const Model& model, const Table& table, const std::string& column);

}  // namespace bio
