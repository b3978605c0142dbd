#include "bio/emg/emg_config.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <numbers>
#include <sstream>

#include "bio/tables/file_error.h"

namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

// The least that works; line 3 is the electrode's table.
const std::string least =
    "[input]\n\n[[electrode]]\nchannel = \"biceps\"\nmuscles = { BRD = 0.5, BIClong = 1, ANC = "
    "0.25 }\n";

class EmgConfigs : public testing::Test {
 protected:
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::string file(const std::string& name, const std::string& text) {
    std::filesystem::create_directories(folder_);
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return (folder_ / name).string();
  }
  bio::EmgConfigFile read(const std::string& text) {
    return bio::readEmgConfig(file("c.toml", text));
  }
  void fails(const std::string& text, const std::string& message) {
    EXPECT_THAT([&] { read(text); }, ThrowsMessage<bio::FileError>(HasSubstr("c.toml:" + message)));
  }
  void failsOn(const bio::Recording& recording, const std::string& text,
               const std::string& message) {
    const bio::EmgConfigFile config = read(text);
    EXPECT_THAT([&] { bio::emgConfigFor(config, recording); },
                ThrowsMessage<bio::FileError>(HasSubstr("c.toml:" + message)));
  }

 private:
  std::filesystem::path folder_ = std::filesystem::temp_directory_path() /
                                  (std::string("fisherhill_emg_config_") +
                                   testing::UnitTest::GetInstance()->current_test_info()->name());
};

bio::Recording recording(const std::string& unit, const std::string& angleUnit = "deg") {
  const Eigen::VectorXd y = Eigen::VectorXd::LinSpaced(200, 0, 2);
  const std::vector<bio::Channel> channels = {{"biceps", unit, 100, 0, y},
                                              {"angle", angleUnit, 100, 0, y}};
  return {"r.csv", bio::RecordingFormat::table, channels, {}, {}};
}

TEST_F(EmgConfigs, HaveTheDocumentedDefaults) {
  const bio::EmgConfigFile c = read(least);
  EXPECT_EQ(c.layout.format, bio::RecordingFormat::automatic);
  EXPECT_EQ(c.emg.signal, bio::EmgSignal::raw);
  ASSERT_TRUE(c.emg.bandPass);
  EXPECT_EQ(c.emg.bandPass->low, 20);
  EXPECT_EQ(c.emg.bandPass->high, 450);
  EXPECT_EQ(c.emg.bandPass->order, 2);
  EXPECT_TRUE(c.emg.notch.lines.empty());
  EXPECT_EQ(c.emg.notch.width, 2);
  EXPECT_EQ(c.emg.envelope.cutoff, 6);
  EXPECT_EQ(c.emg.delay, 0);
  EXPECT_EQ(c.emg.shape, 0);
  EXPECT_EQ(c.emg.outputRate, 200);
  EXPECT_EQ(c.full[0].percentile, 99);
  EXPECT_FALSE(c.emg.measured);
}

// The block in docs/emg.md claims to hold every key with its default.
TEST_F(EmgConfigs, AreDocumentedWithTheirDefaults) {
  std::ifstream stream(std::string(FISHERHILL_SOURCE_DIR) + "/docs/emg.md");
  std::stringstream page;
  page << stream.rdbuf();
  const std::string text = page.str();
  const auto begin = text.find("```toml\n") + 8;
  const bio::EmgConfigFile c = read(text.substr(begin, text.find("```", begin) - begin));
  const bio::EmgConfig standard;
  EXPECT_EQ(c.layout.format, bio::RecordingLayout{}.format);
  EXPECT_EQ(c.emg.signal, standard.signal);
  EXPECT_EQ(c.layout.columns.at(0).scale, 1);
  EXPECT_EQ(c.layout.columns.at(0).offset, bio::ColumnDeclaration{}.offset);
  EXPECT_EQ(c.emg.bandPass->low, standard.bandPass->low);
  EXPECT_EQ(c.emg.bandPass->high, standard.bandPass->high);
  EXPECT_EQ(c.emg.bandPass->order, standard.bandPass->order);
  EXPECT_EQ(c.emg.notch.lines, standard.notch.lines);
  EXPECT_EQ(c.emg.notch.harmonics, standard.notch.harmonics);
  EXPECT_EQ(c.emg.notch.width, standard.notch.width);
  EXPECT_EQ(c.emg.notch.order, standard.notch.order);
  EXPECT_EQ(c.emg.envelope.cutoff, standard.envelope.cutoff);
  EXPECT_EQ(c.emg.envelope.order, standard.envelope.order);
  EXPECT_EQ(c.full.at(0).percentile, bio::OwnPercentile{}.percent);
  EXPECT_EQ(c.emg.shape, standard.shape);
  EXPECT_EQ(c.emg.delay, standard.delay);
  EXPECT_EQ(c.emg.outputRate, standard.outputRate);
  EXPECT_EQ(c.emg.measured->coordinate, bio::MeasuredOptions{}.coordinate);
  EXPECT_EQ(c.emg.measured->sign, bio::MeasuredOptions{}.sign);
  EXPECT_EQ(c.emg.measured->zero, bio::MeasuredOptions{}.zero);
}

TEST_F(EmgConfigs, ShippedAsExamplesAreValid) {
  int valid = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(FISHERHILL_SOURCE_DIR "/emg_data/configs")) {
    if (entry.path().extension() != ".toml") continue;
    EXPECT_FALSE(bio::readEmgConfig(entry.path()).emg.electrodes.empty()) << entry.path();
    ++valid;
  }
  EXPECT_GE(valid, 3);
}

TEST_F(EmgConfigs, KeepTheMusclesInTheOrderOfTheFile) {
  const bio::EmgConfigFile c = read(least);
  EXPECT_THAT(c.emg.electrodes[0].muscles,
              testing::ElementsAre(testing::Pair("BRD", 0.5), testing::Pair("BIClong", 1.0),
                                   testing::Pair("ANC", 0.25)));
}

TEST_F(EmgConfigs, CarryEveryKey) {
  const bio::EmgConfigFile c = read(R"(
[input]
format = "columns"
signal = "raw"
[[channel]]
column = 2
name = "biceps"
rate_Hz = 1000
unit = "mV"
scale = 0.75
offset = -1
[[channel]]
column = "wrist ACC X"
[bandpass]
low_Hz = 30
high_Hz = 400
order = 3
[notch]
lines_Hz = [50, 120.5]
harmonics = 3
width_Hz = 4
order = 1
[envelope]
cutoff_Hz = 3
order = 4
[normalise]
percentile = 95
[excitation]
delay_s = 0.05
shape = -1.5
rate_Hz = 100
start_s = 1
end_s = 2.5
[[electrode]]
channel = "biceps"
muscles = ["BIClong", "BRA"]
mvc = 2
unit = "mV"
[[electrode]]
channel = "triceps"
muscles = ["TRIlong"]
[measured]
channel = "goniometer"
coordinate = "knee"
degrees_per_unit = 0.045
sign = -1
zero = -1675
clip_below = -4000
clip_above = 4000
lowpass_Hz = 6
)");
  EXPECT_EQ(c.layout.format, bio::RecordingFormat::columns);
  const bio::ColumnDeclaration& column = c.layout.columns.at(0);
  EXPECT_EQ(column.number, 2);
  EXPECT_EQ(column.name, "biceps");
  EXPECT_EQ(column.rate, 1000);
  EXPECT_EQ(column.unit, "mV");
  EXPECT_EQ(column.scale, 0.75);
  EXPECT_EQ(column.offset, -1);
  EXPECT_EQ(c.layout.columns.at(1).header, "wrist ACC X");
  EXPECT_EQ(c.layout.columns.at(1).number, 0);
  EXPECT_EQ(c.emg.bandPass->low, 30);
  EXPECT_EQ(c.emg.bandPass->high, 400);
  EXPECT_EQ(c.emg.bandPass->order, 3);
  EXPECT_THAT(c.emg.notch.lines, testing::ElementsAre(50, 120.5));
  EXPECT_EQ(c.emg.notch.harmonics, 3);
  EXPECT_EQ(c.emg.notch.width, 4);
  EXPECT_EQ(c.emg.notch.order, 1);
  EXPECT_EQ(c.emg.envelope.cutoff, 3);
  EXPECT_EQ(c.emg.envelope.order, 4);
  EXPECT_EQ(c.emg.delay, 0.05);
  EXPECT_EQ(c.emg.shape, -1.5);
  EXPECT_EQ(c.emg.outputRate, 100);
  EXPECT_EQ(c.emg.start, 1);
  EXPECT_EQ(c.emg.end, 2.5);
  EXPECT_EQ(c.emg.electrodes.at(0).muscles.at(1).second, 1);
  EXPECT_EQ(c.full.at(0).mvc, 2);
  EXPECT_EQ(c.full.at(0).unit, "mV");
  EXPECT_EQ(c.full.at(1).percentile, 95);
  const bio::MeasuredOptions& m = c.emg.measured.value();
  EXPECT_EQ(m.channel, "goniometer");
  EXPECT_EQ(m.coordinate, "knee");
  EXPECT_EQ(c.degreesPerUnit, 0.045);
  EXPECT_EQ(m.sign, -1);
  EXPECT_EQ(m.zero, -1675);
  EXPECT_EQ(m.clipBelow, -4000);
  EXPECT_EQ(m.clipAbove, 4000);
  EXPECT_EQ(m.lowPass, 6);
}

TEST_F(EmgConfigs, NameFileLineKeyAndRuleOfWhatIsWrong) {
  EXPECT_THAT([] { bio::readEmgConfig("/no/c.toml"); },
              ThrowsMessage<bio::FileError>(HasSubstr("/no/c.toml: there is no such file")));
  fails("[input\n", "1: no valid TOML");
  fails("[input]\nformat = \"csv\"\n",
        "2: [input] format = \"csv\", must be one of automatic, columns");
  fails("[input]\nformt = \"table\"\n", "2: [input] unknown key 'formt', there are format, signal");
  fails("[inptu]\n" + least, "1: unknown key 'inptu'");
  fails("input = 3\n", "1: input = 3, must be a table");
  fails("[channel]\n", "1: channel = ");
  fails("[[channel]]\nname = \"x\"\n", "1: [[channel]] needs a key 'column'");
  fails("[[channel]]\ncolumn = 0\n", "2: [[channel]] column = 0, columns are counted from 1");
  fails("[[channel]]\ncolumn = 1.5\n", "2: [[channel]] column = 1.5, must be a whole number");
  fails("[[channel]]\ncolumn = 1\nrate_Hz = -5\n", "3: [[channel]] rate_Hz = -5, must be > 0");
  fails("[[channel]]\ncolumn = 1\nscale = 0\n", "3: [[channel]] scale = 0, must not be 0");
  fails("[[channel]]\ncolumn = 1\nunit = 3\n", "3: [[channel]] unit = 3, must be a text");
  fails("[bandpass]\nlow_Hz = \"20\"\n", "2: [bandpass] low_Hz = \"20\", must be a number");
  fails("[bandpass]\nlow_Hz = nan\n", "2: [bandpass] low_Hz = nan, must be > 0");
  fails("[bandpass]\nlow_Hz = 500\n", "2: [bandpass] low_Hz = 500, must be below high_Hz = 450");
  fails("[bandpass]\nhigh_Hz = 10\n", "2: [bandpass] high_Hz = 10, must be above low_Hz = 20");
  fails("[bandpass]\norder = 11\n", "2: [bandpass] order = 11, must be 1 to 10");
  fails("[bandpass]\nenabled = 1\n", "2: [bandpass] enabled = 1, must be true or false");
  fails("[notch]\nlines_Hz = 50\n", "2: [notch] lines_Hz = 50, must be a list of numbers");
  fails("[notch]\nlines_Hz = [0]\n", "2: [notch] lines_Hz = [0], 0 Hz must be > width_Hz/2");
  fails("[notch]\nharmonics = 0\n", "2: [notch] harmonics = 0, must be");
  fails("[envelope]\ncutoff_Hz = 0\n", "2: [envelope] cutoff_Hz = 0, must be > 0");
  fails("[normalise]\npercentile = 101\n", "2: [normalise] percentile = 101");
  EXPECT_THAT([&] { read("[input]\n"); },
              ThrowsMessage<bio::FileError>(HasSubstr("at least one [[electrode]]")));
  fails("[[electrode]]\nmuscles = [\"BRA\"]\n", "1: [[electrode]] needs a key 'channel'");
  fails("[[electrode]]\nchannel = \"e\"\n", "1: [[electrode]] needs a key 'muscles'");
  fails("[[electrode]]\nchannel = \"e\"\nmuscles = []\n",
        "3: [[electrode]] muscles = [], must name");
  fails("[[electrode]]\nchannel = \"e\"\nmuscles = { BRA = 2 }\n", "3: [[electrode]] muscles = ");
  fails("[[electrode]]\nchannel = \"e\"\nmuscles = { BRA = \"1\" }\n",
        "3: [[electrode]] muscles = ");
  fails(least + "mvc = 2\n", "6: [[electrode]] mvc = 2, needs its unit");
  fails(least + "unit = \"mV\"\n", "6: [[electrode]] unit = \"mV\", is the unit of mvc");
  fails(least + "mvc = 2\nunit = \"mV\"\npercentile = 9\n",
        "6: [[electrode]] mvc = 2, only one of");
  fails(least + "mvc = -2\nunit = \"mV\"\n", "6: [[electrode]] mvc = -2, must be > 0");
  fails(least + "[excitation]\ndelay_s = 30\n",
        "7: [excitation] delay_s = 30, must lie within 0 and 0.5 s");
  fails(least + "[excitation]\nshape = 2\n", "7: [excitation] shape = 2, must lie within -3 and 0");
  fails(least + "[excitation]\nrate_Hz = 12\n",
        "7: [excitation] rate_Hz = 12, must be more than twice");
  fails(least + "[excitation]\nrate_Hz = 71e946\n",
        "7: [excitation] rate_Hz = 1.7976931348623157e+308, is too large a number");
  fails("[notch]\nlines_Hz = [50, -1e400]\n",
        "2: [notch] lines_Hz = [50,-1.7976931348623157e+308], holds too large a number");
  fails(least + "[excitation]\nstart_s = 2\nend_s = 1\n",
        "8: [excitation] end_s = 1, must be after");
  fails(least + "[measured]\nsign = 1\n", "6: [measured] needs a key 'channel'");
  fails(least + "[measured]\nchannel = \"a\"\nsign = 2\n",
        "8: [measured] sign = 2, must be 1 or -1");
  fails(least + "[measured]\nchannel = \"a\"\ndegrees_per_unit = -1\n",
        "8: [measured] degrees_per_unit");
  fails(least + "[measured]\nchannel = \"a\"\nclip_below = 2\nclip_above = 1\n",
        "9: [measured] clip_above");
  fails("[input]\nsignal = \"envelope\"\n[notch]\nlines_Hz = [50]\n", "3: notch = ");
}

TEST_F(EmgConfigs, SayWhatMusclesWithoutAnElectrodeGet) {
  const std::string muscle = least + "[[unrecorded]]\nmuscle = \"BRA\"\n";
  const bio::EmgConfigFile c = read(muscle +
                                    "synergy = { biceps = 2 }\nfactor = 0.5\nlatent_sd = 0.7\n"
                                    "[[unrecorded]]\nmuscle = \"SUP\"\nconstant = 0.1\n");
  ASSERT_EQ(c.emg.unrecorded.size(), 2u);
  EXPECT_EQ(c.emg.unrecorded[0].factor, 0.5);
  EXPECT_EQ(c.emg.unrecorded[0].synergy[0].second, 2);
  EXPECT_EQ(c.emg.unrecorded[0].latent, (bio::LatentDeclaration{"BRA", 0.7, 0.25}));
  EXPECT_EQ(c.emg.unrecorded[1].constant, 0.1);
  EXPECT_FALSE(c.emg.unrecorded[1].latent);
  fails(muscle, "7: [[unrecorded]] muscle = \"BRA\", needs one of electrode, synergy and constant");
  fails(muscle + "constant = 0.1\nelectrode = \"biceps\"\n",
        "7: [[unrecorded]] muscle = \"BRA\", needs one of");
  fails(muscle + "electrode = \"x\"\n",
        "8: [[unrecorded]] electrode = \"x\", no [[electrode]] has");
  fails(muscle + "synergy = { biceps = 0 }\n", "8: [[unrecorded]] synergy = ");
  fails(muscle + "constant = 2\n", "8: [[unrecorded]] constant = 2, must be 0 to 1");
  fails(muscle + "constant = 0.1\nfactor = 0.5\n", "9: [[unrecorded]] factor = 0.5, has no effect");
  fails(muscle + "constant = 0.1\nknots_s = 1\n", "9: [[unrecorded]] knots_s = 1, needs latent_sd");
  fails(muscle + "constant = 0.1\nlatent_sd = 0\n", "9: [[unrecorded]] latent_sd = 0, must be > 0");
  fails(least + "[[unrecorded]]\nmuscle = \"BRD\"\nconstant = 0\n",
        "7: [[unrecorded]] muscle = \"BRD\", has the electrode 'biceps'");
  fails(least + "[[unrecorded]]\nmuscle = \"a;b\"\nconstant = 0\n",
        "7: [[unrecorded]] muscle = \"a;b\", must be a name without");
  fails(muscle + "constant = 0\n[[unrecorded]]\nmuscle = \"BRA\"\nconstant = 0\n",
        "10: [[unrecorded]] muscle = \"BRA\", is given twice");
}

TEST_F(EmgConfigs, TurnPointsIntoMarkersOfTheModel) {
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(200, 0, 2);
  bio::Recording points = recording("mV");
  points.channels.insert(
      points.channels.end(),
      {{"WRI.x", "m", 50, 0, x}, {"WRI.y", "m", 50, 0, x}, {"WRI.z", "m", 50, 0, x}});
  const std::string markers = least + "[markers]\n";
  // laboratory z is up
  const bio::EmgConfig c = bio::emgConfigFor(
      read(markers + "names = { WRI = \"hand.wrist\" }\naxes = \"x z -y\"\norigin_m = [1, 2, 3]\n"
                     "lowpass_Hz = 6\n"),
      points);
  ASSERT_EQ(c.columns.size(), 3u);
  EXPECT_EQ(c.columns[1].channel, "WRI.z");
  EXPECT_EQ(c.columns[1].coordinate, "hand.wrist.y");
  EXPECT_EQ(c.columns[1].zero, 3);
  EXPECT_EQ(c.columns[2].channel, "WRI.y");
  EXPECT_EQ(c.columns[2].sign, -1);
  EXPECT_EQ(c.columns[2].zero, 2);
  EXPECT_EQ(c.columns[0].lowPass, 6);
  // by the model's names
  const std::string model = markers + "model = \"m.osim\"\n";
  const std::vector<std::string> known = {"hand.WRI", "hand.thumb"};
  EXPECT_EQ(bio::emgConfigFor(read(model), points, known).columns[0].coordinate, "hand.WRI.x");
  EXPECT_EQ(bio::emgConfigFor(read(model + "names = { WRI = \"thumb\" }\n"), points, known)
                .columns[0]
                .coordinate,
            "hand.thumb.x");
  EXPECT_THAT(read(model).markers->model, testing::EndsWith("/m.osim"));
  const auto fails2 = [&](const std::string& text, const std::string& message) {
    const bio::EmgConfigFile config = read(text);
    EXPECT_THAT([&] { bio::emgConfigFor(config, points, known); },
                ThrowsMessage<bio::FileError>(HasSubstr("c.toml:6: [markers] " + message)));
  };
  fails2(markers + "names = { ELB = \"hand.x\" }\n", "names: no recording has a point 'ELB'");
  fails2(model + "names = { WRI = \"toe\" }\n",
         "names: the model has no marker 'toe'; it has hand");
  points.channels.resize(2);
  fails2(model, "no point is called as a marker of the model (hand.WRI, hand.thumb): needs names");
  fails(markers, "6: [markers] needs a key 'names'");
  fails(markers + "names = { WRI = \"wrist\" }\n", "7: [markers] names = ");
  fails(markers + "names = [\"a\"]\n", "7: [markers] names = ");
  fails(markers + "names = { A = \"h.w\", B = \"h.w\" }\n",
        "7: [markers] names = …, 'A' and 'B' are both 'h.w'");
  for (const char* axes : {"x y", "x y z x", "x x z", "x y up", "- y z", ""}) {
    fails(model + "axes = \"" + axes + "\"\n",
          "8: [markers] axes = \"" + std::string(axes) + "\", must be three of x, y and z");
  }
  fails(model + "axes = \"x z y\"\n", "8: [markers] axes = \"x z y\", must be a turn");
  fails(model + "origin_m = [1, 2]\n", "8: [markers] origin_m = [1,2], must be three numbers");
}

TEST_F(EmgConfigs, CompareUnitsWithTheRecording) {
  const std::string mvc = least + "mvc = 1.5\nunit = \"mV\"\n";
  const auto given =
      std::get<bio::MvcValue>(bio::emgConfigFor(read(mvc), recording("mV")).electrodes[0].full);
  EXPECT_EQ(given.value, 1.5);
  EXPECT_THAT(given.source, HasSubstr("c.toml:3"));
  EXPECT_DOUBLE_EQ(
      std::get<bio::MvcValue>(bio::emgConfigFor(read(mvc), recording("uV")).electrodes[0].full)
          .value,
      1500);  // mV in the channel's µV
  failsOn(recording("N"), mvc, "3: mvc = 1.5 mV, but channel 'biceps' is in 'N'");
  const std::string measured = least + "[measured]\nchannel = \"angle\"\n";
  EXPECT_EQ(bio::emgConfigFor(read(measured), recording("mV")).measured->degreesPerUnit, 1);
  EXPECT_DOUBLE_EQ(
      bio::emgConfigFor(read(measured), recording("mV", "rad")).measured->degreesPerUnit,
      180 / std::numbers::pi);
  failsOn(recording("mV", "counts"), measured,
          "6: channel 'angle' is in 'counts', needs degrees_per_unit");
  failsOn(recording("mV"), measured + "degrees_per_unit = 2\n",
          "6: degrees_per_unit = 2, but channel 'angle'");
  failsOn(recording("mV"), least + "[measured]\nchannel = \"knee\"\n",
          "6: r.csv: no channel 'knee'");
  failsOn(recording("mV"), "[[electrode]]\nchannel = \"x\"\nmuscles = [\"BRA\"]\n",
          "1: r.csv: no channel 'x'");
}

TEST_F(EmgConfigs, TakeTheMaximumContractionFromItsOwnFile) {
  std::string text = "time,biceps\n";
  for (int i = 0; i < 100; ++i) {
    text +=
        std::to_string(0.01 * i) + "," + std::to_string(i < 50 ? 0.1 * i : 0.1 * (99 - i)) + "\n";
  }
  file("mvc.csv", text);
  const bio::EmgConfigFile c = read(
      "[input]\nsignal = \"envelope\"\n[[electrode]]\nchannel = \"biceps\"\n"
      "muscles = [\"BRA\"]\nmvc_file = \"mvc.csv\"\n");
  const auto full = std::get<bio::MvcValue>(bio::emgConfigFor(c, recording("")).electrodes[0].full);
  EXPECT_DOUBLE_EQ(full.value, 4.9);
  EXPECT_THAT(full.source, HasSubstr("mvc.csv"));
}

}  // namespace
