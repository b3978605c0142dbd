#include <memory>

#include "bio/opensim/osim_file.h"
#include "bio/parameters/parameters.h"
#include "bio/simulation/musculoskeletal_system.h"
#include "options/quantity.h"
#include "reading.h"

namespace {

using bio::Model;
using bio::MusculoskeletalSystem;
using bio::ParameterCatalogue;

const ParameterCatalogue& elbowCatalogue() {
  static const Model model = bio::readOsim(FISHERHILL_SOURCE_DIR "/models/elbow8.osim");
  bio::SystemOptions options;
  options.skeleton.freeCoordinates = {"elbow_flexion"};
  static const MusculoskeletalSystem system(model, options);
  static const ParameterCatalogue catalogue(model, system, {Eigen::VectorXd::Constant(1, 0.5), {}});
  return catalogue;
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int*, char***) {
  elbowCatalogue();
  return 0;
}

// What is typed on the command line: numbers, angles, assignments, names of parameters.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const ParameterCatalogue& catalogue = elbowCatalogue();
  const std::string word(fuzz::textOf(data, size));
  const auto refused = [](auto read) {
    try {
      read();
    } catch (const std::invalid_argument&) {
    }
  };
  refused([&] { app::parseNumber(word); });
  refused([&] { app::parseAngle(word); });
  refused([&] { app::parseAssignment(word); });
  refused([&] { catalogue.select({word}); });
  return 0;
}
