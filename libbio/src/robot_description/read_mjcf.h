#pragma once

#include "robot_description/model_maker.h"

namespace bio::robot {

/// MuJoCo's MJCF, root element <mujoco>, as a model: the worldbody is the ground.
/// @throws FileError as readRobotDescription
Model readMjcf(const Documents& documents, const Element& root);

}  // namespace bio::robot
