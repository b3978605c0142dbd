#pragma once

#include <string>
#include <vector>

#include "bio/model/model.h"

namespace bio {

/// Outcome of a conversion of a model's muscles.
struct MuscleConversion {
  std::size_t converted = 0;      ///< muscles of another class before
  std::vector<std::string> lost;  ///< one line per number or kind of number that is not carried
};

/// Makes every muscle that can be simulated one of the named class: Thelen2003, Millard2012,
/// DeGrooteFregly2016 or Schutte1993, or OpenSim's whole name of one of them or RigidTendonMuscle;
/// RigidTendon is Millard2012 with ignore_tendon_compliance.
///
/// Numbers of both classes are carried: the five common numbers, switches and control limits; the
/// strains of tendon and passive fibre at F0, fibre damping, least activation and time constants
/// under whatever name. Everything else stands at OpenSim's default of the new class, and what the
/// old class had there that was not its default is named in `lost`, as are curves. Between
/// Schutte's class and the others
///     V = 1/t_s,   τ_a = t_s/(c₁ + c₂),   τ_d = t_s/c₂,
/// the rates of activation at full excitation and at rest, and strains are where its splines reach
/// F0.
/// @throws std::invalid_argument for a class that is not one of these, a muscle whose numbers break
///   a rule of the new class
MuscleConversion convertMuscles(Model& model, const std::string& className);

}  // namespace bio
