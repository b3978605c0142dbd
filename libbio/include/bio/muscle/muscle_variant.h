#pragma once

#include <array>
#include <string_view>
#include <variant>

#include "bio/muscle/activation_variant.h"
#include "bio/muscle/degroote_fregly2016.h"
#include "bio/muscle/hill_muscle.h"
#include "bio/muscle/millard2012.h"
#include "bio/muscle/rigid_tendon.h"
#include "bio/muscle/thelen2003.h"

namespace bio::muscles {

/// Throws std::invalid_argument "muscle class NAME is not known".
[[noreturn]] void refuseClass(std::string_view className);

/// A list of muscle classes and what follows from it.
template <template <class> class... Shapes>
struct ClassList {
  static_assert((HillShape<Shapes<double>> && ...));
  /// The numbers of a muscle of any class.
  using Parameters = std::variant<typename Shapes<double>::Parameters...>;
  /// A muscle of any class, ready to be evaluated.
  using Muscle = std::variant<HillMuscle<Shapes<double>>...>;

  /// OpenSim's names of the classes.
  static constexpr std::array<std::string_view, sizeof...(Shapes)> names{
      Shapes<double>::className...};
  static constexpr bool has(std::string_view className) {
    return ((className == Shapes<double>::className) || ...);
  }

  /// A muscle of that class at OpenSim's defaults.
  /// @throws std::invalid_argument naming the class if it is not in the list
  static Parameters defaultsOf(std::string_view className) {
    Parameters p;
    const bool found = ((className == Shapes<double>::className
                             ? (p.template emplace<typename Shapes<double>::Parameters>(), true)
                             : false) ||
                        ...);
    if (!found) refuseClass(className);
    return p;
  }
};

/// The muscle classes that there are: a new one is its file and a name here.
using MuscleClasses = ClassList<Thelen2003, Millard2012, DeGrooteFregly2016, RigidTendon>;

using AnyParameters = MuscleClasses::Parameters;
using AnyMuscle = MuscleClasses::Muscle;

/// The muscle, after its rules were checked.
/// @throws std::invalid_argument naming number, value and rule
AnyMuscle compile(const AnyParameters& parameters);

/// The activation dynamics that the class and its switches mean.
AnyActivation activationOf(const AnyParameters& parameters);

}  // namespace bio::muscles
