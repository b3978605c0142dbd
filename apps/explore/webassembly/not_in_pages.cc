// What the library can do and a page cannot: these stand where the linker asks for them.

#include <stdexcept>

#include "bio/robot_description/robot_description.h"
#include "info/parallel_for.h"
#include "simulation/integrators.h"
#include "tables/formats/foreign_format.h"

// A page has one thread.
namespace info {

void parallelFor(int n, int, const std::function<void(int)>& body) {
  for (int i = 0; i < n; ++i) body(i);
}

}  // namespace info

namespace bio {

ModelFormat modelFormat(const tinyxml2::XMLDocument&) {
  return ModelFormat::openSim;
}

Model readRobotDescription(const tinyxml2::XMLDocument&, const std::filesystem::path&) {
  throw std::invalid_argument("a page carries robots as OpenSim models");
}

namespace tables {

std::string looksLike(const std::string&) {
  return "";
}

}  // namespace tables

namespace stepping {

Trajectory simulateCvode(const MusculoskeletalSystem&, const ExcitationSignal&, const SystemState&,
                         const SimulationOptions&) {
  throw std::invalid_argument("a page has no CVODE");
}

}  // namespace stepping
}  // namespace bio
