#include "discover/suggested_experiments.h"

#include <gmock/gmock.h>

#include "bio/opensim/osim_file.h"

namespace app {
namespace {

/// All that is suggested for a shipped model, one line each.
std::string suggested(const std::string& model, const std::vector<std::string>& coordinates) {
  const bio::discover::EncompassingModel of(
      bio::readOsim(FISHERHILL_SOURCE_DIR "/models/" + model + ".osim"),
      bio::SystemOptions{{coordinates, {}}, {}, {}}, coordinates);
  const FollowUps known = followUpsOfModels(of);
  std::string all = known.otherwise + "\n" + known.ifUnknown + "\n" + known.ifNamed;
  for (const Intervention& one : known.interventions) all += "\n" + one.sentence;
  return all;
}

TEST(SuggestedExperiments, PutAMassWhereTheLimbEnds) {
  const std::string system = suggested("elbow8", {"elbow_flexion"});
  EXPECT_THAT(system, testing::HasSubstr("with a known mass, e.g. 1 kg, in the hand: the effect of "
                                         "gravity grows with it, a force on the hand does not."));
  EXPECT_THAT(system, testing::HasSubstr("and with a known mass in the hand: these data cannot"));
  EXPECT_THAT(system, testing::HasSubstr("(column elbow_flexion.torque)"));
  EXPECT_THAT(system, testing::Not(testing::HasSubstr("what its lever weighs")));
  EXPECT_THAT(suggested("elbow8", {"elbow_flexion", "shoulder_elv"}),
              testing::HasSubstr("(column elbow_flexion.torque or shoulder_elv.torque)"));
  const std::string leg = suggested("ankle_ta", {"ankle_angle"});
  EXPECT_THAT(leg, testing::HasSubstr("with a known mass, e.g. 1 kg, on foot: the effect of "
                                      "gravity grows with it, a force on foot does not."));
  EXPECT_THAT(leg, testing::HasSubstr("and with a known mass on foot: these data cannot"));
  EXPECT_THAT(leg, testing::Not(testing::HasSubstr("the hand")));
}

}  // namespace
}  // namespace app
