#include "model_reading.h"

// A stranger's URDF or MJCF, whose copy is an OpenSim model.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static fuzz::InputFile file("robot.xml"), copy("copy.osim");
  fuzz::readsModel(file, copy, data, size, bio::rewriteOsim);
  return 0;
}
