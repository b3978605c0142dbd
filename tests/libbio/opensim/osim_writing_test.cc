#include "libbio/opensim/osim_rules.h"

// What was fitted, and changes of a model, in its file.
namespace bio {
namespace {

using osim_rules::OsimRules;
using osim_rules::replaced;
using osim_rules::valid;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const std::string digest = std::string(60, 'a') + "0123";

std::string withFitted(const std::string& text) {
  return replaced(valid, "</ForceSet>", "</ForceSet>\n<FisherHill>" + text + "</FisherHill>");
}

std::string startOf(const std::string& sha256, const std::string& coordinate) {
  return "<trial_start><file>curl.sto</file><sha256>" + sha256 + "</sha256><coordinate>" +
         coordinate + "</coordinate><value>0.25</value><speed>-0.5</speed></trial_start>";
}

TEST_F(OsimRules, WhatWasFittedIsReadAndWritten) {
  Model model = read(withFitted("<step_s>0.005</step_s>" + startOf(digest, "q")));
  EXPECT_EQ(model.fitted.step, 0.005);
  ASSERT_EQ(model.fitted.starts.size(), 1u);
  EXPECT_EQ(model.fitted.starts[0], (TrialStart{"curl.sto", digest, "q", 0.25, -0.5}));
  EXPECT_THAT(model.warnings, IsEmpty());
  EXPECT_TRUE(read(valid).fitted.empty());

  // into a document that had none, changed there, and taken away again
  const auto original = folder_.file("original.osim", valid);
  const auto copy = folder_ / "copy.osim";
  const std::string other = std::string(64, 'b');
  model.fitted.starts.push_back({"a & b.sto", other, "q", 1.0 / 3, 0});
  rewriteOsim(original, model, copy);
  EXPECT_EQ(readOsim(copy), model);
  model.fitted.starts.erase(model.fitted.starts.begin());
  model.fitted.step = 0.0025;
  rewriteOsim(copy, model, copy);
  EXPECT_EQ(readOsim(copy), model);
  model.fitted = {};
  rewriteOsim(copy, model, copy);
  EXPECT_EQ(readOsim(copy), read(valid));
}

TEST_F(OsimRules, WhatWasFitted) {
  const auto message = [&](const std::string& text) { return messageOf(withFitted(text)); };
  EXPECT_EQ(message("<step_s>0</step_s>"), "m.osim:37: FisherHill: step_s = 0 s, must be > 0");
  EXPECT_EQ(message("<step>0.01</step>"),
            "m.osim:37: FisherHill: holds 'step', must hold nothing but step_s, trial_start");
  EXPECT_EQ(
      message("<trial_start><speeds>1</speeds></trial_start>"),
      "m.osim:37: trial_start: holds 'speeds', must hold nothing but coordinate, file, sha256, "
      "speed, value");
  EXPECT_EQ(message(startOf("abc", "q")),
            "m.osim:37: trial_start: sha256 = 'abc', must be 64 lower-case hexadecimal digits");
  EXPECT_EQ(message(startOf(digest, "knee")),
            "m.osim:37: trial_start: coordinate = 'knee', must name a coordinate of the model");
  EXPECT_EQ(message(replaced(startOf(digest, "q"), ">0.25<", ">nan<")),
            "m.osim:37: trial_start: value = nan, must be finite");
  EXPECT_EQ(message(replaced(startOf(digest, "q"), "<value>0.25</value>", "")),
            "m.osim:37: trial_start: value is missing, must be given");
  EXPECT_EQ(message(startOf(digest, "q") + startOf(digest, "q")),
            "m.osim:37: trial_start: coordinate 'q' of the trial with this sha256 has two starts, "
            "must have one");
  EXPECT_EQ(messageOf(replaced(withFitted(""), "</FisherHill>", "</FisherHill><FisherHill/>")),
            "m.osim:37: FisherHill: is there twice, must be there once");
}

TEST_F(OsimRules, AModelThatBreaksARuleIsNotWritten) {
  Model model = read(valid);
  model.bodies[1].mass = -1;
  EXPECT_THROW(writeOsim(model, folder_ / "out.osim"), FileError);
  EXPECT_THROW(rewriteOsim(folder_ / "m.osim", model, folder_ / "out.osim"), FileError);
  EXPECT_THAT(folder_.listing(), ElementsAre("m.osim"));
  EXPECT_THROW(writeOsim(read(valid), folder_ / "missing/out.osim"), FileError);
}

TEST_F(OsimRules, AChangeThatTheDocumentCannotExpressIsRefused) {
  const std::string onFrame =
      replaced(valid, "/bodyset/lower</socket_parent_frame><location>",
               "/jointset/elbow/upper_offset</socket_parent_frame><location>");
  Model model = read(onFrame);
  model.muscles[0].path.points[2].location.x() += 0.01;  // the file has it in the offset frame
  EXPECT_THAT([&] { rewriteOsim(folder_ / "m.osim", model, folder_ / "m.osim"); },
              testing::ThrowsMessage<std::invalid_argument>(
                  HasSubstr("the document cannot express the model")));
  EXPECT_EQ(support::contentOf(folder_ / "m.osim"), onFrame);
}

}  // namespace
}  // namespace bio
