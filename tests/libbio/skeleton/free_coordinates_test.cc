#include "bio/skeleton/free_coordinates.h"

#include <gmock/gmock.h>

#include <filesystem>

#include "bio/opensim/osim_file.h"
#include "support/throws_saying.h"

namespace bio {
namespace {

using testing::ElementsAre;

// The shipped elbow with only these coordinates unlocked.
Model elbowWithUnlocked(const std::set<std::string>& names) {
  Model model = readOsim(std::filesystem::path(FISHERHILL_SOURCE_DIR) / "models/elbow8.osim");
  for (Joint& joint : model.joints)
    for (Coordinate& one : joint.coordinates) one.locked = !names.contains(one.name);
  return model;
}

TEST(FreeByDefault, IsTheOnlyUnlockedCoordinateWhateverIsMeasured) {
  const Model model = elbowWithUnlocked({"elbow_flexion"});
  EXPECT_THAT(freeByDefault(model, {}, {}), ElementsAre("elbow_flexion"));
  EXPECT_THAT(freeByDefault(model, {}, {"elbow_flexion", "shoulder_elv"}),
              ElementsAre("elbow_flexion"));
}

TEST(FreeByDefault, AreTheMeasuredAmongSeveralUnlocked) {
  const Model model = elbowWithUnlocked({"elbow_flexion", "pro_sup", "shoulder_elv"});
  EXPECT_THAT(freeByDefault(model, {}, {"pro_sup", "elbow_flexion", "deviation"}),
              ElementsAre("elbow_flexion", "pro_sup"));
  EXPECT_THAT(freeByDefault(model, {"elbow_flexion"}, {"pro_sup", "elbow_flexion"}),
              ElementsAre("pro_sup"));
}

TEST(FreeByDefault, AreTheMeasuredWhereTheModelLocksThem) {
  EXPECT_THAT(freeByDefault(elbowWithUnlocked({"elbow_flexion", "pro_sup"}), {}, {"shoulder_elv"}),
              ElementsAre("shoulder_elv"));
  EXPECT_THAT(freeByDefault(elbowWithUnlocked({}), {}, {"shoulder_elv"}),
              ElementsAre("shoulder_elv"));
}

TEST(FreeByDefault, AreAllUnlockedWithoutAMeasurement) {
  const Model model = elbowWithUnlocked({"elbow_flexion", "pro_sup", "shoulder_elv"});
  EXPECT_THAT(freeByDefault(model, {}, {}),
              ElementsAre("shoulder_elv", "elbow_flexion", "pro_sup"));
}

TEST(FreeByDefault, RefusesAModelThatLocksAll) {
  support::throwsSaying([] { freeByDefault(elbowWithUnlocked({}), {}, {}); },
                        "every coordinate of the model is locked");
  support::throwsSaying(
      [] { freeByDefault(elbowWithUnlocked({"elbow_flexion"}), {"elbow_flexion"}, {}); },
      "elbow_flexion is locked by request");
}

TEST(PrescribedByModel, AreThoseThatItPrescribesAndDoesNotLock) {
  Model model = elbowWithUnlocked({"elbow_flexion", "shoulder_elv"});
  EXPECT_THAT(prescribedByModel(model, {}), testing::IsEmpty());
  for (Joint& joint : model.joints) {
    for (Coordinate& one : joint.coordinates) {
      if (one.name != "shoulder_elv" && one.name != "pro_sup") continue;
      one.prescribed = true;
      one.prescribedFunction = Function{1, SineFunction{}};
    }
  }
  EXPECT_THAT(prescribedByModel(model, {}), ElementsAre("shoulder_elv"));  // pro_sup is locked
  EXPECT_THAT(prescribedByModel(model, {"shoulder_elv"}), testing::IsEmpty());
  for (Joint& joint : model.joints) {
    for (Coordinate& one : joint.coordinates) one.prescribedFunction = {};
  }
  support::throwsSaying([&] { prescribedByModel(model, {}); }, "class that is not known");
  EXPECT_THAT(prescribedByModel(model, {"shoulder_elv"}), testing::IsEmpty());
}

TEST(HeldCoordinates, AreThoseThatDoNotMove) {
  const Model model = elbowWithUnlocked({"elbow_flexion"});
  const auto held = heldCoordinates(model, {"elbow_flexion"}, {{"pro_sup", 0.5}});
  EXPECT_FALSE(held.contains("elbow_flexion"));
  EXPECT_EQ(held.at("pro_sup"), 0.5);
  EXPECT_EQ(held.at("shoulder_elv"), findCoordinate(model, "shoulder_elv").defaultValue);
  EXPECT_FALSE(heldCoordinates(model, {"elbow_flexion", "pro_sup"}, {}).contains("pro_sup"));
}

}  // namespace
}  // namespace bio
