#include "apps/emg/filmed_motion.h"

namespace {

using filmed::Filmed;
using filmed::followMarkers;
using support::ProgramResult;
using support::runFisherHill;
using support::ScratchFolder;
using testing::HasSubstr;

// The shipped elbow with two markers, which the laboratory calls otherwise.
TEST(MarkersCommand, PointsOfTrcAndC3dBecomeMarkersThatAreFitted) {
  const ScratchFolder scratch;
  const std::string file = (scratch / "elbow.osim").string();
  bio::Model model = bio::readOsim(std::string(FISHERHILL_SOURCE_DIR) + "/models/elbow8.osim");
  model.markers = {{"shaft", "ulna", {0.02, -0.1, 0.01}}, {"knuckle", "hand", {0.01, -0.05, 0.02}}};
  bio::writeOsim(model, file);
  const Filmed filmed(file, {"elbow_flexion"}, {"S:ULN 1", "S:MCP3"}, "hand.mass", 1.3);
  followMarkers(filmed,
                "[markers]\naxes = 'x z -y'\norigin_m = [0.5, -1, 0.25]\n"
                "names = { 'S:ULN 1' = 'ulna.shaft', 'S:MCP3' = 'hand.knuckle' }\n");
}

TEST(MarkersCommand, AModelThatCannotBeReadIsOfTheConfiguration) {
  const ScratchFolder scratch;
  const std::string config = scratch.file(
      "c.toml",
      "[[electrode]]\nchannel = 'a'\nmuscles = ['BRA']\n\n[markers]\nmodel = 'no.osim'\n");
  const std::string raw = scratch.file("raw.csv", "time,a_mV\n0,1\n0.001,2\n0.002,1\n");
  const ProgramResult result =
      runFisherHill({"emg", raw, "--config", config, "--out", (scratch / "out").string()});
  EXPECT_EQ(result.status, 2) << result.err;
  EXPECT_THAT(result.err, HasSubstr("c.toml:5: [markers] model: "));
  EXPECT_THAT(result.err, HasSubstr("no.osim"));
}

// Two coordinates, and the names of the model's own markers.
TEST(MarkersCommand, AnArmOfTwoJointsIsCalibratedFromItsMarkers) {
  const ScratchFolder scratch;
  const std::string file = (scratch / "arm.osim").string();
  bio::Model model = bio::readOsim(std::string(FISHERHILL_SOURCE_DIR) + "/models/elbow8.osim");
  model.markers = {{"epicondyle", "humerus", {0.01, -0.28, 0.03}},
                   {"shaft", "ulna", {0.02, -0.1, 0.01}},
                   {"styloid", "radius", {0.03, -0.2, 0.02}}};
  bio::writeOsim(model, file);
  const Filmed filmed(file, {"shoulder_elv", "elbow_flexion"}, {"epicondyle", "shaft", "styloid"},
                      "BRA.max_isometric_force", 0.8);
  followMarkers(filmed,
                "[markers]\naxes = 'x z -y'\norigin_m = [0.5, -1, 0.25]\nmodel = '" + file + "'\n");
}

}  // namespace
