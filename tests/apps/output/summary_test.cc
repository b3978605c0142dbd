#include "output/summary.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

#include "output/json_text.h"
#include "output/sha256.h"
#include "support/scratch_folder.h"

namespace app {
namespace {

using support::ScratchFolder;

TEST(Sha256, AgreesWithThePublishedTestVectors) {
  // FIPS 180-4 examples: the empty message, "abc", and a million times "a".
  const ScratchFolder scratch;
  EXPECT_EQ(sha256OfFile(scratch.file("empty", "")),
            "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256OfFile(scratch.file("abc", "abc")),
            "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256OfFile(scratch.file("million", std::string(1000000, 'a'))),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST(Sha256, RefusesWhatIsNoFile) {
  const ScratchFolder scratch;
  EXPECT_THROW(sha256OfFile(scratch / "missing"), std::runtime_error);
  EXPECT_THROW(sha256OfFile(scratch.path()), std::runtime_error);
  EXPECT_THROW(sha256OfFile("/dev/zero"), std::runtime_error);
}

TEST(Summary, ShowsBytesThatAreNotUtf8AsReplacementCharacters) {
  Summary summary({});
  summary.set("muscle", "TRI\xFFlong");
  const auto json = nlohmann::json::parse(jsonText(summary.toJson()));
  EXPECT_EQ(json["muscle"], "TRI\uFFFDlong");
}

TEST(Summary, WritesWhatHasNoValueAsNull) {
  Summary summary({});
  summary.set("rms_error_deg", std::numeric_limits<double>::quiet_NaN());
  summary.set("bounds", {{"low", 1.5}, {"high", std::numeric_limits<double>::infinity()}});
  const auto json = nlohmann::json::parse(summary.toJson().dump());
  EXPECT_TRUE(json["rms_error_deg"].is_null());
  EXPECT_TRUE(json["bounds"]["high"].is_null());
  EXPECT_EQ(json["bounds"]["low"], 1.5);
}

TEST(Summary, NamesTheCommandLineSoThatItCanBeTypedAgain) {
  CommandContext context;
  context.subcommand = "check";
  context.commandLine = {"/somewhere/fisherhill", "check", "my model.osim", "it's", "--out=x", ""};
  const auto json = Summary(context).toJson();
  EXPECT_EQ(json["command_line"], "fisherhill check 'my model.osim' 'it'\\''s' --out=x ''");
  EXPECT_EQ(json["subcommand"], "check");
}

TEST(Summary, CarriesInputsWarningsAndTheSimulation) {
  const ScratchFolder scratch;
  Summary summary({});
  summary.addInput(scratch.file("abc", "abc"));
  summary.setSimulation("vi", 0.01, 4.5, 0.002);
  summary.warn("two\nlines");
  const auto json = summary.toJson();
  EXPECT_EQ(json["inputs"][0]["path"], (scratch / "abc").string());
  EXPECT_THAT(json["inputs"][0]["sha256"].get<std::string>(), testing::StartsWith("ba7816bf"));
  EXPECT_EQ(json["integrator"], "vi");
  EXPECT_EQ(json["step_s"], 0.01);
  EXPECT_EQ(json["duration_s"], 4.5);
  EXPECT_EQ(json["wall_s"], 0.002);
  EXPECT_EQ(json["warnings"][0], "two; lines");
  EXPECT_THROW(summary.addInput(scratch / "missing"), std::runtime_error);
}

}  // namespace
}  // namespace app
