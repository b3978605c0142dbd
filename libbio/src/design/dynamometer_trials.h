#pragma once

#include <vector>

#include "bio/design/design_inputs.h"
#include "bio/design/dynamometer_plan.h"

namespace bio {

/// The experiments that a question asks about, with their trials.
class DynamometerTrials {
 public:
  /// All must outlive it.
  DynamometerTrials(const MusculoskeletalSystem& system, const Coordinate& coordinate,
                    const DynamometerQuestion& question);

  struct List {
    std::vector<DynamometerExperiment> experiments;
    std::size_t outside = 0;  ///< releases that would leave the coordinate's range
  };
  /// All of them, in a fixed order. Those of isotonic contractions have no torque yet.
  List all() const;

  /// The name of the column of the coordinate, which is the last one.
  std::string coordinateColumn() const;
  /// Factor of the numbers in that column: degrees per radian, or 1.
  double unit() const;

 private:
  bool considers(DynamometerExperiment::Kind kind) const;
  void addContractions(const MuscleGroup& group, double effort, List& list) const;
  void addTurns(List& list) const;
  Table trialOf(const DynamometerExperiment& experiment) const;
  bool contracts(const DynamometerExperiment& experiment, const std::string& muscle) const;

  const MusculoskeletalSystem& system_;
  const Coordinate& coordinate_;
  const DynamometerQuestion& question_;
  std::vector<MuscleGroup> groups_;
};

}  // namespace bio
