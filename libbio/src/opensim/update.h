#pragma once

#include <tinyxml2.h>

#include <string>
#include <vector>

namespace bio::osim {

/// Brings a parsed file to the form that the reader knows, as OpenSim does when it loads one:
/// - of OpenSim 4.0's development (versions 30500 to 30516): <connectors> and connector_NAME_… or
///   socket_NAME_connectee_name become <socket_NAME>, places in a joint become its offset frames, a
///   reversed joint has its frames exchanged, frames of a FrameSet become components;
/// - parts without a name get their class's in lower case, a second one of a name the ending _0, _1, …;
/// - joints without coordinates get theirs, JOINT_coord_0, …; a body without a joint a FreeJoint to
///   the ground, free_BODY;
/// - coordinates of one name in several joints are called JOINT/NAME.
/// @returns what was changed, for the user
/// @throws FileError for a property that is given twice with different values, and for a number with
///   a comment inside
std::vector<std::string> update(tinyxml2::XMLDocument& document, const std::string& file);

}  // namespace bio::osim
