#pragma once

#include <optional>
#include <string>

#include "bio/design/dynamometer_plan.h"

/// The words of experiments on a dynamometer, and what is considered where nothing is said.
namespace bio {

/// "isometric", "isokinetic", "passive", "release", "isotonic"
const char* name(DynamometerExperiment::Kind kind);
/// @throws std::invalid_argument for any other word
DynamometerExperiment::Kind dynamometerKindNamed(const std::string& word);

/// A question without an empty list, each sorted and every value once. What is empty becomes
///
///     kinds         all
///     positions     four over the middle four fifths of the coordinate's range
///     speeds        30 and 120 °/s (or mm/s), as far as such turns fit between the positions
///     efforts       30, 60 and 100 % MVC
///     releases      10° (or 10 mm)
///     releaseSpeed  200 °/s (or mm/s), less where the rate (eight samples) or `fastest` require it
///     loads         50 and 80 %
///
/// Lists of experiments that are not considered stay empty where they are (speeds, releases).
/// @param releaseSpeed  replaces that of the question
/// @throws std::invalid_argument for a value out of its range, or a list for experiments that are
///   not considered
DynamometerQuestion withDefaults(DynamometerQuestion question, const Coordinate& coordinate,
                                 const std::optional<double>& releaseSpeed = {});

/// "hold at 60 deg; rest 0.5 s, then …": to the person on the dynamometer.
/// @param turns  whether the coordinate is a rotation
std::string instructionOf(const DynamometerExperiment& experiment, bool turns);

}  // namespace bio
