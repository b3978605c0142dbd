#pragma once

#include <gtest/gtest.h>

#include <filesystem>

#include "bio/analysis/replay.h"
#include "bio/opensim/osim_file.h"

/// The outside world: models and motions computed by OpenSim, kept beside the project.
namespace bio::fixtures {

inline std::filesystem::path reference(const std::string& file) {
  return std::filesystem::path(FISHERHILL_SOURCE_DIR) / ".." / "shared" / "reference" / file;
}

/// First line of a test that needs it. The files are not part of the project (their terms).
#define FISHERHILL_NEEDS_REFERENCE()                                                     \
  if (!std::filesystem::exists(bio::fixtures::reference("elbow8_reference.osim"))) {     \
    GTEST_SKIP() << "needs OpenSim's reference files in ../shared/reference, which are " \
                    "not part of the project";                                           \
  }                                                                                      \
  static_assert(true)

/// The reference elbow with one free coordinate.
inline MusculoskeletalSystem referenceArm() {
  return MusculoskeletalSystem(readOsim(reference("elbow8_reference.osim")),
                               {{{"elbow_flexion"}, {}}, {}, {}});
}

}  // namespace bio::fixtures
