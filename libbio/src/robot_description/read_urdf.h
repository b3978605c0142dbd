#pragma once

#include "robot_description/model_maker.h"

namespace bio::robot {

/// A URDF, root element <robot>, as a model: its root link stands on the ground.
/// @throws FileError as readRobotDescription
Model readUrdf(const Documents& documents, const Element& robot);

}  // namespace bio::robot
