#pragma once

#include "bio/opensim/osim_file.h"

namespace bio::fixtures {

/// The shipped eight-muscle elbow.
inline Model elbowModel() {
  return readOsim(std::string(FISHERHILL_SOURCE_DIR) + "/models/elbow8.osim");
}

}  // namespace bio::fixtures
