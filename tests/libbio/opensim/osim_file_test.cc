#include "bio/opensim/osim_file.h"

#include <gmock/gmock.h>

#include <filesystem>

#include "libbio/opensim/osim3_hinge.h"
#include "libbio/opensim/osim_round_trips.h"
#include "support/throws_saying.h"

namespace bio {
namespace {

using testing::IsEmpty;

const std::filesystem::path osimRoot = FISHERHILL_SOURCE_DIR;

// Every model that is shipped, one of each muscle class among them.
std::vector<std::filesystem::path> shippedModels() {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(osimRoot / "models")) {
    if (entry.path().extension() == ".osim") files.push_back(entry.path());
  }
  return files;
}

// The same hinge as an OpenSim 3 and as an OpenSim 4 document.
class BothFormats : public testing::Test {
 protected:
  const support::ScratchFolder folder_;
  const std::filesystem::path three_ = folder_.file("three.osim", osim_rules::hingeOfOpenSim3),
                              four_ = osimRoot / "tests/fuzz/seeds/osim/hinge4";
};

TEST_F(BothFormats, AreReadAsTheSameModel) {
  const Model three = readOsim(three_), four = readOsim(four_);
  EXPECT_THAT(three.warnings, IsEmpty());
  EXPECT_EQ(three.joints, four.joints);
  EXPECT_EQ(three.bodies, four.bodies);
  EXPECT_EQ(three.muscles, four.muscles);
  EXPECT_EQ(three, four);
}

TEST(OsimFile, WrittenBackUnchangedIsTheSameFile) {
  EXPECT_GE(shippedModels().size(), 6u);
  for (const auto& file : shippedModels()) osim_round_trips::writesTheSameFile(file);
}

TEST_F(BothFormats, AreWrittenBackUnchanged) {
  osim_round_trips::writesTheSameFile(three_);
  osim_round_trips::writesTheSameFile(four_);
}

TEST(OsimFile, OneChangedNumberLeavesAllElseAsItWas) {
  for (const auto& file : shippedModels()) osim_round_trips::leavesAllElseAsItWas(file);
}

TEST_F(BothFormats, KeepAllElseWhenOneNumberChanges) {
  osim_round_trips::leavesAllElseAsItWas(three_);
  osim_round_trips::leavesAllElseAsItWas(four_);
}

TEST_F(BothFormats, TakeEveryKindOfChange) {
  osim_round_trips::writesEveryKindOfChange(three_, "q");
  osim_round_trips::writesEveryKindOfChange(four_, "q");
  for (const char* name : {"elbow8.osim", "elbow8_passive.osim"}) {
    osim_round_trips::writesEveryKindOfChange(osimRoot / "models" / name, "elbow_flexion");
  }
}

TEST_F(BothFormats, AreWrittenAfreshWithTheSameContent) {
  osim_round_trips::aFreshDocumentSaysTheSame(three_);
  osim_round_trips::aFreshDocumentSaysTheSame(four_);
  for (const auto& file : shippedModels()) osim_round_trips::aFreshDocumentSaysTheSame(file);
}

TEST(OsimFile, MusclesOfOtherClassesAreNotWrittenAfresh) {
  const support::ScratchFolder folder;
  Model model = readOsim(osimRoot / "models/elbow8_Thelen2003.osim");
  model.muscles[0].hill.reset();
  model.muscles[0].className = "Delp1990Muscle_Deprecated";
  support::throwsSaying([&] { writeOsim(model, folder / "fresh.osim"); },
                        "Delp1990Muscle_Deprecated");
  EXPECT_FALSE(std::filesystem::exists(folder / "fresh.osim"));
}

}  // namespace
}  // namespace bio
