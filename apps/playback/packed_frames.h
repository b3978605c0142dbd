#pragma once

#include <Eigen/Dense>
#include <nlohmann/json.hpp>
#include <vector>

#include "playback/played_frames.h"

namespace app {

/// Frames as playback.js reads them: {times, lines, centre, unit, data}.
///
/// `data` are 16-bit integers, least byte first, in base 64. Of each frame: each body's origin (3)
/// and turn as a quaternion x y z w in 1/32767 (4, all zero: not known); of each line the number of
/// its points, its radius [10 µm], its activation [1/10000] (−1: none) and the points (3 each).
/// Origins and points are `centre` + `unit` × integer [m] in ground, with the smallest unit that
/// reaches all of them: a motion within 2 m is drawn to 0.02 mm.
/// @param frames  at least one, with as many bodies and lines each; without bodies: not known
/// @throws std::invalid_argument if they are not
nlohmann::ordered_json packedFrames(const std::vector<PlayedFrame>& frames);

}  // namespace app
