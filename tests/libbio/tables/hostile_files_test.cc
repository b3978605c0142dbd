#include <gmock/gmock.h>
#include <sys/stat.h>

#include <ctime>
#include <filesystem>

#include "bio/emg/emg_config.h"
#include "bio/forces/expression.h"
#include "bio/opensim/osim_file.h"
#include "bio/tables/file_error.h"
#include "bio/tables/recording.h"
#include "support/scratch_folder.h"

// Files that mean harm, or look as if: they are refused with one line, at once, and without taking
// the machine's memory or the stack.
namespace bio {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class HostileFiles : public ::testing::Test {
 protected:
  // The one line that `read` refuses with.
  template <class Refusal = FileError, class Read>
  static std::string refusalOf(Read read) {
    try {
      read();
    } catch (const Refusal& refusal) {
      EXPECT_THAT(refusal.what(), Not(HasSubstr("\n")));
      return refusal.what();
    }
    return "read without complaint";
  }
  std::string configRefusal(const std::string& text) const {
    return refusalOf([&] { readEmgConfig(folder_.file("emg.toml", text)); });
  }
  support::ScratchFolder folder_;
};

std::string times(int count, const std::string& text) {
  std::string all;
  for (int i = 0; i < count; ++i) all += text;
  return all;
}

TEST_F(HostileFiles, LineBreaksInNamesStayOutOfMessages) {
  const std::string model =
      "<OpenSimDocument Version='40000'><Model><BodySet><objects>"
      "<Body name='two&#10;lines'/></objects></BodySet></Model></OpenSimDocument>";
  EXPECT_THAT(refusalOf([&] { readOsim(folder_.file("m.osim", model)); }),
              HasSubstr("Body 'two lines': its name must be without comma, quote, tab or line"));
  EXPECT_THAT(refusalOf<std::invalid_argument>([] { Expression("q +\n unknown", {"q"}); }),
              HasSubstr("unknown name 'unknown'"));
}

TEST_F(HostileFiles, ConfigurationsAreUtf8) {
  for (const char* bytes : {"\x9f\x93", "\xc0\xaf", "\xe2\x82", "\xed\xa0\x80", "\xf4\x90\x80\x80",
                            "\xe0\x80\xaf", "\xf5\x80\x80\x80", "\xc3"}) {
    EXPECT_THAT(
        configRefusal(std::string("[input]\nsignal = '\"m") + bytes + "V\"'\nscale = 0.75\n"),
        HasSubstr("emg.toml:2: not text, must be UTF-8"));
  }
  EXPECT_THAT(configRefusal("[input]\nsignal = 'µ€\xf0\x9d\x9c\x83'\n"), Not(HasSubstr("UTF-8")));
}

TEST_F(HostileFiles, PipesAreNoFiles) {
  const std::string pipe = folder_.path() / "pipe.osim";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_THAT(refusalOf([&] { readOsim(pipe); }),
              HasSubstr("pipe.osim: is a pipe, must be a file"));
}

TEST_F(HostileFiles, AFileOfManyGigabytesIsNotRead) {
  const std::string file = folder_.file("large.osim", "<OpenSimDocument>");
  std::filesystem::resize_file(file, std::uintmax_t{5} << 30);  // a hole: takes no space
  EXPECT_THAT(refusalOf([&] { readOsim(file); }), HasSubstr("has 5 GiB, must be at most 1 GiB"));
}

TEST_F(HostileFiles, AConfigurationOfManyValuesIsRefusedAtOnce) {
  std::string keys, list = "a = [";
  for (int i = 0; i < 300000; ++i) keys += "k" + std::to_string(i) + " = 1\n";
  for (int i = 0; i < 300000; ++i) list += "1, ";
  for (const std::string& text : {keys, list + "1]\n"}) {
    const std::clock_t begin = std::clock();
    EXPECT_THAT(configRefusal(text), HasSubstr("more than 10000 values, must be at most so many"));
    EXPECT_LT(std::clock() - begin, 5 * CLOCKS_PER_SEC);
  }
}

TEST_F(HostileFiles, DevicesAreNoFiles) {
  EXPECT_THAT(refusalOf([] { readOsim("/dev/zero"); }), HasSubstr("/dev/zero: is a device"));
  EXPECT_THAT(refusalOf([] { readRecording("/dev/zero"); }), HasSubstr("is a device"));
  EXPECT_THAT(refusalOf([] { readEmgConfig("/dev/zero"); }), HasSubstr("is a device"));
}

TEST_F(HostileFiles, AConfigurationCannotNestUntilTheStackIsFull) {
  const std::string tooDeep = "emg.toml:2: nested tables or lists, must be at most 100 deep";
  EXPECT_THAT(configRefusal("\na = " + times(100000, "[")), HasSubstr(tooDeep));
  EXPECT_THAT(configRefusal("\na = " + times(100000, "{b = ")), HasSubstr(tooDeep));
  EXPECT_THAT(configRefusal("\na" + times(100000, ".b") + " = 1"), HasSubstr(tooDeep));
  EXPECT_THAT(configRefusal("\n[a" + times(100000, ".b") + "]"), HasSubstr(tooDeep));
  // What is not nested may hold as many brackets and dots as it likes.
  EXPECT_THAT(configRefusal("# " + times(200, "[.") + "\na = [" + times(200, "[0.5], ") +
                            "]\nb = \"\\\"" + times(200, "{.") + "\""),
              HasSubstr("[[electrode]]"));
}

TEST_F(HostileFiles, AConfigurationHasNoTextOfSeveralLines) {
  for (const std::string quotes : {"\'\'\'", "\"\"\""}) {
    EXPECT_THAT(configRefusal("[[electrode]]\nchannel = " + quotes + "\nbiceps\n"),
                HasSubstr("emg.toml:2: a text in three quotes, must be in one line"));
    EXPECT_THAT(configRefusal("a = \"#\" # " + quotes), HasSubstr("[[electrode]]"));
  }
}

TEST_F(HostileFiles, AListWithoutAnItemHasNoKeys) {
  const auto refused = [](const std::string& name) {
    return "emg.toml: '" + name + "' is an empty list, must have no keys of its own";
  };
  EXPECT_THAT(configRefusal("i=[]\n[i.k]\n"), HasSubstr(refused("i")));
  EXPECT_THAT(configRefusal("a.i = [ # none\n\n ]\n[ a . \"i\" . k ]\n"), HasSubstr(refused("i")));
  EXPECT_THAT(configRefusal("i=[]\ni.k = 1\n"), HasSubstr(refused("i")));
  EXPECT_THAT(configRefusal("[t]\nx = { i = [\t] }\n[[t.x.i.k]]\n"), HasSubstr(refused("i")));
  EXPECT_THAT(configRefusal("'i' = []\n[\"\\u0069\".k]\n"), HasSubstr(refused("i")));
  // elsewhere such lists are what they were
  for (const char* text : {"i = []\n[j.k]\n", "i = [\n1]\n[j]\ni = []\n", "a = '[i]'\ni = []\n",
                           "i = []  # [i.k]\n", "a = [\n[1],\n[]]\n[b.c]\n"}) {
    EXPECT_THAT(configRefusal(text), Not(HasSubstr("is an empty list"))) << text;
  }
}

TEST_F(HostileFiles, BinaryNumbersFitIntoWholeOnes) {
  EXPECT_THAT(configRefusal("\na = 0b" + times(63, "1") + "\n"),
              HasSubstr("emg.toml:2: a binary number, must have at most 62 digits"));
  EXPECT_THAT(configRefusal("a = 0b1" + times(61, "_0") + " # 0b" + times(70, "1") + "\n"),
              Not(HasSubstr("binary")));
}

TEST_F(HostileFiles, AMessageShowsATextBesideALongKey) {
  EXPECT_THAT(configRefusal("[[normalise]]\na" + times(90, "b") + " = \"\\f\"\n"),
              HasSubstr("emg.toml:1: normalise = "));
}

TEST_F(HostileFiles, WholeNumbersBeyondAllBoundsAreRefused) {
  EXPECT_THAT(configRefusal("[notch]\nharmonics = -9223372036854775808\n"),
              HasSubstr("must be a whole number"));
}

TEST_F(HostileFiles, AShortRecordingCannotAskForMoreMemoryThanItFills) {
  // 50,000 lines of one column, then one of 20,000: 8 GB, if every column began in the first line.
  RecordingLayout layout;
  layout.columns.resize(1);
  layout.columns[0].number = 1;
  layout.columns[0].rate = 1000;
  const std::string text = times(50000, "1\n") + times(20000, "1 ") + "\n";
  EXPECT_THAT(refusalOf([&] { readRecording(folder_.file("wide.txt", text), layout); }),
              HasSubstr("wide.txt:50001: column 2: '1' after a line that ends before this column"));
  // The same where the first line is wide, too.
  const std::string gap = times(20000, "1 ") + "\n" + text;
  EXPECT_THAT(refusalOf([&] { readRecording(folder_.file("gap.txt", gap), layout); }),
              HasSubstr("gap.txt:50002: column 2: '1' after a line"));
}

TEST_F(HostileFiles, ALongFormulaIsReadAtOnce) {
  const std::clock_t start = std::clock();
  const std::string text = "0" + times(200000, "+1.0");
  const Expression formula(text, {});
  EXPECT_EQ(formula.evaluate<double>(nullptr), 200000);
  EXPECT_LT(std::clock() - start, 2 * CLOCKS_PER_SEC);
}

}  // namespace
}  // namespace bio
