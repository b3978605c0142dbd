#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "bio/model/model.h"

namespace bio {

/// The free coordinates of a simulation if its user names none, in the order of the model: those
/// that the model does not lock and that are measured; if there is none, those measured; without a
/// measurement all that the model does not lock. Dependent coordinates of couplers are left out. If
/// only one coordinate can be free it is that one, measured or not.
/// @param locked    coordinates that the user locks; left out
/// @param measured  names of the measured coordinates; may be empty
/// @param mayBeNone  whether none is an answer: something else moves, or is held
/// @throws std::invalid_argument if all coordinates are locked, unless none is an answer; names
///   those of `locked`
std::vector<std::string> freeByDefault(const Model& model, const std::set<std::string>& locked,
                                       const std::set<std::string>& measured,
                                       bool mayBeNone = false);

/// The coordinates that move on the model's own functions of time, in its order: prescribed, not
/// locked there, of their own.
/// @param otherwise  coordinates with another role by request; left out
/// @throws std::invalid_argument if the function of one is of a class that is not known
std::vector<std::string> prescribedByModel(const Model& model,
                                           const std::set<std::string>& otherwise);

/// The coordinates that are held in place, with their values [rad] or [m]: those of the model that
/// are neither free nor prescribed, at the user's value, else the default. Dependent coordinates of
/// couplers are left out.
/// @param locks  the user's values
std::map<std::string, double> heldCoordinates(const Model& model,
                                              const std::set<std::string>& freeOrPrescribed,
                                              const std::map<std::string, double>& locks);

}  // namespace bio
