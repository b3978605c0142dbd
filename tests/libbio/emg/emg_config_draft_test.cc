#include "bio/emg/emg_config_draft.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "bio/emg/emg_config.h"
#include "bio/emg/emg_recordings.h"
#include "bio/tables/file_error.h"
#include "support/scratch_folder.h"

namespace bio {
namespace {

using support::ScratchFolder;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::string tableOfElectrodes() {
  std::string text = "time,biceps_uV,triceps [mV],elbow_deg,force [N]\n";
  for (int i = 0; i < 400; ++i) {
    text += std::to_string(i) + "e-3," + std::to_string((i * 37) % 101 - 50) + "," +
            std::to_string((i * 31) % 83 - 40) + "," + std::to_string(i / 10) + ",1.5\n";
  }
  return text;
}

std::string contentOfDraft(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::stringstream text;
  text << stream.rdbuf();
  return text.str();
}

TEST(EmgConfigDraft, IsReadAsItIsWhereUnitsTellWhatIsEmg) {
  const ScratchFolder scratch;
  const std::string raw = scratch.file("raw.csv", tableOfElectrodes());
  const EmgConfigDraft draft = draftEmgConfig({raw});
  EXPECT_EQ(draft.channels, 4);
  EXPECT_EQ(draft.electrodes, 2);
  EXPECT_TRUE(draft.complete);
  EXPECT_THAT(draft.text, HasSubstr("\"force"));
  EXPECT_THAT(draft.text, HasSubstr("1000 Hz, 0 to 0.399 s"));
  const EmgConfigFile config = readEmgConfig(scratch.file("c.toml", draft.text));
  ASSERT_EQ(config.emg.electrodes.size(), 2u);
  std::vector<std::string> muscles;
  for (const auto& electrode : config.emg.electrodes) {
    muscles.push_back(electrode.muscles.front().first);
  }
  EXPECT_THAT(muscles, ElementsAre("biceps", "triceps"));
  const JoinedRecordings joined = readRecordings(config, {raw});
  EXPECT_EQ(emgConfigFor(config, joined.recording).electrodes.size(), 2u);
  // the angle and the force are there to be switched on
  std::string with = draft.text;
  const std::size_t at = with.find("# [measured]");
  ASSERT_NE(at, with.npos);
  EXPECT_THAT(with.substr(at), HasSubstr("# channel = \"elbow_deg\""));
}

TEST(EmgConfigDraft, ABandIsBelowHalfTheRate) {
  const ScratchFolder scratch;
  std::string text = "time,biceps_mV\n";
  for (int i = 0; i < 60; ++i) {
    text += std::to_string(i * 5) + "e-3," + std::to_string(i % 7 - 3) + "\n";
  }
  const std::string raw = scratch.file("raw.csv", text);  // 200 Hz
  const std::string draft = draftEmgConfig({raw}).text;
  EXPECT_THAT(draft, HasSubstr("high_Hz = 90 "));
  EXPECT_EQ(readEmgConfig(scratch.file("c.toml", draft)).emg.electrodes.size(), 1u);
}

TEST(EmgConfigDraft, SaysWhatIsMissing) {
  const ScratchFolder scratch;
  const std::string columns = scratch.file("raw.txt", "1\t2\n3\t4\n5\t6\n");
  const EmgConfigDraft draft = draftEmgConfig({columns});
  EXPECT_FALSE(draft.complete);
  EXPECT_EQ(draft.channels, 2);
  EXPECT_THAT(draft.text, HasSubstr("column = 2"));
  EXPECT_THAT(draft.text, HasSubstr("# rate_Hz =             # needed"));
  EXPECT_THAT(draft.text, HasSubstr("# [[electrode]]"));
  const EmgConfigDraft two = draftEmgConfig({scratch.file("a.csv", tableOfElectrodes()), columns});
  EXPECT_FALSE(two.complete);
  EXPECT_THAT(two.text, HasSubstr("[[recording.channel]]"));
  EXPECT_THAT(two.text, HasSubstr("# offset_s = 0          # needed"));
}

TEST(EmgConfigDraft, NamesOfAnyKindAreQuoted) {
  const ScratchFolder scratch;
  std::string text = "time,\"a\\\"\"b_mV\"\n";
  for (int i = 0; i < 60; ++i) text += std::to_string(i) + "e-3," + std::to_string(i % 7) + "\n";
  const std::string raw = scratch.file("raw.csv", text);
  const std::string draft = draftEmgConfig({raw}).text;
  const EmgConfigFile config = readEmgConfig(scratch.file("c.toml", draft));
  const std::string name = readRecording(raw).channels.front().name;
  EXPECT_THAT(name, HasSubstr("a\\\""));
  EXPECT_EQ(config.emg.electrodes.front().channel, name);
}

TEST(EmgConfigDraft, AFileThatIsThereStays) {
  const ScratchFolder scratch;
  const std::string there = scratch.file("c.toml", "mine");
  EXPECT_THROW(writeEmgConfig({"other"}, there), FileError);
  EXPECT_EQ(contentOfDraft(there), "mine");
  std::filesystem::create_symlink(scratch / "nothing", scratch / "link.toml");
  EXPECT_THROW(writeEmgConfig({"other"}, scratch / "link.toml"), FileError);
  writeEmgConfig({"new"}, scratch / "new.toml");
  EXPECT_EQ(contentOfDraft(scratch / "new.toml"), "new");
  EXPECT_THROW(draftEmgConfig({}), std::invalid_argument);
  EXPECT_THROW(draftEmgConfig({(scratch / "none.csv").string()}), FileError);
}

}  // namespace
}  // namespace bio
