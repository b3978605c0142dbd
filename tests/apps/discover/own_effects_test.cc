#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "support/run_program.h"
#include "support/scratch_folder.h"

// Effects of the user's own in the commands that take them.
namespace {

using nlohmann::json;
using support::ProgramResult;
using support::runFisherHill;
using support::ScratchFolder;
using testing::HasSubstr;

const std::string example = "emg_data/effects.toml";

TEST(OwnEffects, AreListedBesideTheCatalogue) {
  const ProgramResult plain = runFisherHill({"discover", "models/elbow8.osim", "--list-effects"});
  const ProgramResult more =
      runFisherHill({"discover", "models/elbow8.osim", "--list-effects", "--effect", example});
  EXPECT_EQ(more.status, 0) << more.err;
  EXPECT_THAT(plain.out, testing::Not(HasSubstr("thinning")));
  EXPECT_THAT(more.out, HasSubstr("thinning.c [N m s/rad], thinning.v [rad/s]"));
  EXPECT_EQ(more.out.size() - plain.out.size(),
            more.out.find('\n', more.out.find("thinning")) -
                more.out.rfind('\n', more.out.find("thinning")));
}

TEST(OwnEffects, AreChecked) {
  EXPECT_EQ(runFisherHill({"check", example, "models/elbow8.osim"}).status, 0);
  const ScratchFolder scratch;
  const std::string file = scratch.file(
      "knee.toml",
      "[[effect]]\nid = \"a\"\ncoordinate = \"knee\"\nexpression = \"c*q\"\n[[effect.parameter]]\n"
      "name = \"c\"\nlower = 0\nupper = 1\nsd = 1\n");
  EXPECT_EQ(runFisherHill({"check", file}).status, 0);
  const ProgramResult result = runFisherHill({"check", file, "models/elbow8.osim"});
  EXPECT_EQ(result.status, 1);
  EXPECT_THAT(result.out, HasSubstr("has no coordinate 'knee'"));
  const ProgramResult searched = runFisherHill(
      {"discover", "models/elbow8.osim", "emg_data/hidden_a/train_1.sto", "--effect", file});
  EXPECT_EQ(searched.status, 2);
  EXPECT_THAT(searched.err, HasSubstr("coordinate = \"knee\", which is not in question"));
}

TEST(OwnEffects, AreRefusedWithTheirFileAndForRobots) {
  const ScratchFolder scratch;
  const std::string file =
      scratch.file("bad.toml", "[[effect]]\nid = \"a\"\nexpression = \"c*(q\"\n");
  const ProgramResult bad = runFisherHill(
      {"discover", "models/elbow8.osim", "emg_data/hidden_a/train_1.sto", "--effect", file});
  EXPECT_EQ(bad.status, 2);
  EXPECT_THAT(bad.err, HasSubstr(file));
  EXPECT_EQ(runFisherHill({"check", file}).status, 1);
  const ProgramResult robot =
      runFisherHill({"discover", "--system", "double-pendulum", example, "--effect", example});
  EXPECT_EQ(robot.status, 2);
  EXPECT_THAT(robot.err, HasSubstr("--effect cannot be combined with --system"));
}

}  // namespace
