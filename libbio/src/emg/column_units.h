#pragma once

#include "bio/emg/measured_coordinate.h"
#include "bio/tables/recording.h"

namespace bio {

/// Sets how a measured column's numbers become those of a trial: by the unit that the file states
/// for the channel and the one that the column's name stands for (Observable): NAME.moment and
/// NAME.torque [N m] or [N], NAME.speed [rad/s] or [m/s], MUSCLE.fiber_length [m],
/// MUSCLE.tendon_force [N], MUSCLE.pennation, MUSCLE.activation [1], BODY.MARKER.x [m], NAME_deg
/// [deg], NAME [rad] or [m].
/// @returns what was converted or assumed, for the summary; empty: nothing
/// @throws std::invalid_argument naming column, channel and unit where it is not known or is that
/// of
///   another quantity
std::string setUnit(const Channel& channel, MeasuredOptions& column);

/// The sentence that a column with a scale of its own was not converted, where the channel's unit
/// is of the same quantity and the scale is not its factor; else empty.
std::string scaledUnit(const Channel& channel, const MeasuredOptions& column);

}  // namespace bio
