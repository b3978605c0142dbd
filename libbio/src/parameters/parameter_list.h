#pragma once

// The list that a ParameterCatalogue is made of, and the groups of parameters that are added to it;
// not public.

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "bio/parameters/parameters.h"

namespace bio {

/// Default prior of a kind of quantity: bounds, and how well it is known beforehand.
struct DefaultPrior {
  double lower, upper, sd;
};

/// Parameters in the order in which they are added; bounds hold the value.
class ParameterList {
 public:
  void add(std::string name, const char* unit, std::string meaning, double value,
           DefaultPrior prior, std::vector<ParameterTarget> targets, bool isGroup = false) {
    all_.push_back({std::move(name), unit, std::move(meaning), value, std::min(prior.lower, value),
                    std::max(prior.upper, value), prior.sd, std::move(targets), isGroup});
  }
  void add(ModelParameter parameter) { all_.push_back(std::move(parameter)); }
  ModelParameter& last() { return all_.back(); }
  const std::vector<ModelParameter>& all() const { return all_; }
  std::vector<ModelParameter> take() { return std::move(all_); }

 private:
  std::vector<ModelParameter> all_;
};

/// Numbers of coordinate forces, forces on bodies, elastic paths and actuators that act in the
/// system.
void addForceParameters(const Model& model, const MusculoskeletalSystem& system,
                        ParameterList& list);

/// Gains, delay and shape of the relation between EMG and excitation.
void addEmgParameters(const MusculoskeletalSystem& system, const EmgMapping& mapping,
                      ParameterList& list);
/// Corrections of excitations without an electrode, one for each knot; as many as the trial has.
void addLatentParameters(const EmgMapping& mapping, ParameterList& list);

/// Where a simulation starts, and how fast.
void addStartParameters(const MusculoskeletalSystem& system, const StartPoint& start,
                        ParameterList& list);

}  // namespace bio
