// Two coordinates, and the names of the model's own markers, of a model that lies beside the
// project.
#include "apps/emg/filmed_motion.h"

namespace {

using filmed::Filmed;
using filmed::followMarkers;

TEST(Arm26, IsCalibratedFromItsMarkers) {
  const std::string arm26 =
      std::string(FISHERHILL_SOURCE_DIR) + "/../shared/data/models/opensim/arm26.osim";
  const Filmed filmed(arm26, {"r_shoulder_elev", "r_elbow_flex"},
                      {"r_acromion", "r_humerus_epicondyle", "r_radius_styloid"},
                      "BRA.max_isometric_force", 0.8);
  followMarkers(
      filmed, "[markers]\naxes = 'x z -y'\norigin_m = [0.5, -1, 0.25]\nmodel = '" + arm26 + "'\n");
}

}  // namespace
