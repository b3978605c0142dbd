#include "bio/tables/c3d_file.h"

#include <gmock/gmock.h>

#include <cmath>
#include <functional>

#include "binary_samples.h"
#include "bio/tables/file_error.h"
#include "bio/tables/recording.h"
#include "support/scratch_folder.h"
#include "support/throws_saying.h"

namespace bio {
namespace {

using support::C3dSample;
using support::Processor;
using testing::ElementsAre;
using testing::HasSubstr;

class C3d : public testing::Test {
 protected:
  C3dFile read(const C3dSample& sample) const {
    return readC3d(folder_.file("a.c3d", sample.write()));
  }
  // The one line that refuses the bytes, without the folder; empty if they are read.
  std::string refusalOf(const std::string& bytes) const {
    return support::refusalIn<FileError>(folder_.path().string(),
                                         [&] { readC3d(folder_.file("a.c3d", bytes)); });
  }
  support::ScratchFolder folder_;
};

TEST_F(C3d, ReadsIntegersAndFloatsOfEveryProcessor) {
  for (const auto processor : {Processor::intel, Processor::dec, Processor::mips}) {
    for (const bool floats : {false, true}) {
      SCOPED_TRACE(static_cast<int>(processor) * 10 + floats);
      C3dSample sample;
      sample.processor = processor;
      sample.floats = floats;
      const C3dFile file = read(sample);
      EXPECT_THAT(file.markers.names, ElementsAre("HEAD", "ELBOW"));
      EXPECT_EQ(file.markers.rate, 100);
      ASSERT_EQ(file.markers.positions.rows(), 5);
      ASSERT_EQ(file.markers.positions.cols(), 6);
      ASSERT_EQ(file.analog.size(), 2);
      EXPECT_EQ(file.analog[0].name, "BIC");
      EXPECT_EQ(file.analog[1].unit, "V");
      EXPECT_EQ(file.analog[1].rate, 400);
      ASSERT_EQ(file.analog[1].values.size(), 20);
      const double millimetres = floats ? 0.5 : static_cast<double>(0.1F);
      for (unsigned f = 0; f < 5; ++f) {
        EXPECT_DOUBLE_EQ(file.markers.times[f], 0.01 * f);
        for (unsigned k = 0; k < 6; ++k) {
          const double position = file.markers.positions(f, k);
          if (C3dSample::seen(f, k / 3)) {
            EXPECT_DOUBLE_EQ(position,
                             0.001 * millimetres * C3dSample::pointNumber(f, k / 3, k % 3));
          } else {
            EXPECT_TRUE(std::isnan(position));
          }
        }
        for (unsigned s = 0; s < 4; ++s) {
          EXPECT_EQ(file.analog[0].values[4 * f + s],
                    0.5 * 0.25 * (C3dSample::analogNumber(f, s, 0) - 4));
          EXPECT_EQ(file.analog[1].values[4 * f + s],
                    2 * 0.25 * (C3dSample::analogNumber(f, s, 1) + 8));
        }
      }
      EXPECT_TRUE(file.remarks.empty());
    }
  }
}

TEST_F(C3d, FramesKeepTheirTimeInACutTrial) {
  C3dSample sample;
  sample.firstFrame = 51;
  const C3dFile file = read(sample);
  EXPECT_DOUBLE_EQ(file.markers.times[0], 0.5);
  EXPECT_DOUBLE_EQ(file.analog[0].startTime, 0.5);
}

TEST_F(C3d, CountsMoreFramesThanTheHeaderCan) {
  C3dSample sample;
  sample.points = 0;
  sample.channels = 1;
  sample.samplesPerFrame = 1;
  sample.frames = 70000;
  // 10 to 70009 in 16-bit words, the lower first
  C3dSample actual = sample;
  actual.firstFrame = 10;
  actual.more = {C3dSample::wholeOf("TRIAL", "ACTUAL_START_FIELD", {10, 0}),
                 C3dSample::wholeOf("TRIAL", "ACTUAL_END_FIELD", {70009 - 65536, 1})};
  EXPECT_EQ(read(actual).analog[0].values.size(), 70000);
  EXPECT_DOUBLE_EQ(read(actual).analog[0].startTime, 0.09);
  C3dSample counted = sample;
  counted.more = {C3dSample::scalarOf("POINT", "LONG_FRAMES", 4, 70000)};
  EXPECT_EQ(read(counted).analog[0].values.size(), 70000);
}

TEST_F(C3d, NamesGoOnInFurtherParameters) {
  C3dSample sample;
  sample.points = 300;
  sample.frames = 1;
  sample.without = {"POINT:LABELS"};
  std::vector<std::string> first, second;
  for (int i = 0; i < 300; ++i) (i < 255 ? first : second).push_back("P" + std::to_string(i));
  sample.more = {C3dSample::textOf("POINT", "LABELS", first, 4),
                 C3dSample::textOf("POINT", "LABELS2", second, 4)};
  const C3dFile file = read(sample);
  EXPECT_EQ(file.markers.names.at(254), "P254");
  EXPECT_EQ(file.markers.names.at(299), "P299");
  EXPECT_EQ(positionsOf(file.markers, "P299").cols(), 3);
  support::throwsSaying([&] { positionsOf(file.markers, "P300"); },
                        "no marker 'P300'; the file has");
}

TEST_F(C3d, AnalogValuesCanBeWithoutSign) {
  C3dSample sample;
  sample.without = {"ANALOG:OFFSET"};
  sample.more = {C3dSample::wholeOf("ANALOG", "OFFSET", {32768 - 65536, 0}),
                 C3dSample::textOf("ANALOG", "FORMAT", {"UNSIGNED"})};
  // −77 in 16 bits is 65459
  EXPECT_EQ(read(sample).analog[0].values[0], 0.125 * (65459 - 32768));
}

TEST_F(C3d, LeavesOutWhatIsNoPosition) {
  C3dSample sample;
  sample.more = {C3dSample::textOf("POINT", "ANGLES", {"ELBOW"})};
  const C3dFile file = read(sample);
  EXPECT_THAT(file.markers.names, ElementsAre("HEAD"));
  EXPECT_EQ(file.markers.positions.cols(), 3);
  EXPECT_THAT(file.markers.remarks, ElementsAre(HasSubstr("1 points are angles")));
}

TEST_F(C3d, UnitsAreMetres) {
  for (const auto& [unit, metres] : {std::pair{"m", 1.0}, {"cm", 0.01}, {"MM", 0.001}}) {
    C3dSample sample;
    sample.floats = true;
    sample.without = {"POINT:UNITS"};
    sample.more = {C3dSample::textOf("POINT", "UNITS", {unit}, 4)};
    EXPECT_DOUBLE_EQ(read(sample).markers.positions(0, 0), -75 * metres);
  }
  C3dSample silent;
  silent.without = {"POINT:UNITS"};
  EXPECT_THAT(read(silent).markers.remarks, ElementsAre(HasSubstr("taken for millimetres")));
}

TEST_F(C3d, IsARecordingOfItsAnalogChannelsAndPoints) {
  const std::string file = folder_.file("a.c3d", C3dSample{}.write());
  const Recording recording = readRecording(file);
  EXPECT_EQ(recording.format, RecordingFormat::c3d);
  EXPECT_EQ(findChannel(recording, "TRI").rate, 400);
  EXPECT_EQ(findChannel(recording, "TRI").unit, "V");
  // whatever the file is called
  EXPECT_EQ(readRecording(folder_.file("a.bin", C3dSample{}.write())).channels.size(), 2 + 2 * 3);
  const Channel& elbow = findChannel(recording, "ELBOW.y");
  EXPECT_EQ(elbow.unit, "m");
  EXPECT_EQ(elbow.rate, 100);
  ASSERT_EQ(elbow.values.size(), 5);
  EXPECT_TRUE(std::isnan(elbow.values[2]));  // not seen
  EXPECT_NEAR(elbow.values[4], 1e-4 * C3dSample::pointNumber(4, 1, 1), 1e-9);
  EXPECT_EQ(readMarkers(folder_ / "a.bin").names.size(), 2);
  C3dSample markers;
  markers.channels = 0;
  markers.samplesPerFrame = 0;
  markers.without = {"ANALOG:OFFSET"};
  EXPECT_EQ(readRecording(folder_.file("c.c3d", markers.write())).channels.size(), 6);
  markers.points = 0;
  markers.without.insert(markers.without.end(), {"POINT:LABELS"});
  EXPECT_THAT([&] { readRecording(folder_.file("d.c3d", markers.write())); },
              testing::ThrowsMessage<FileError>(HasSubstr("d.c3d: has neither points nor analog")));
  // channels of one name are told apart by their numbers
  C3dSample twice;
  twice.without = {"ANALOG:LABELS"};
  twice.more = {C3dSample::textOf("ANALOG", "LABELS", {"EMG", "EMG"})};
  const std::string named = folder_.file("b.c3d", twice.write());
  EXPECT_EQ(readRecording(named).channels[0].name, "EMG");
  RecordingLayout layout;
  layout.columns = {
      {.number = 2, .header = "", .name = "second", .unit = "", .rate = {}, .scale = {}}};
  EXPECT_EQ(readRecording(named, layout).channels[1].name, "second");
}

// As programs of several makers write them.
TEST_F(C3d, ReadsWhatItCanWhereTheParameterSectionIsOdd) {
  C3dSample sample;
  sample.without = {"POINT:DATA_START", "POINT:UNITS"};
  sample.more = {C3dSample::scalarOf("POINT", "DATA_START", 2, 0),
                 C3dSample::textOf("POINT", "UNITS", {"mete"}, 4)};
  EXPECT_DOUBLE_EQ(read(sample).markers.positions(0, 0), static_cast<double>(0.1F) * -150);
  const std::string good = C3dSample{}.write();
  // a parameter of no group: the header tells the same
  std::string bytes = good;
  bytes.at(bytes.find("USED") - 1) = 9;
  EXPECT_EQ(refusalOf(bytes), "");
  // the last entry points out of the section, whose length is known
  bytes = good;
  bytes.at(514) = 1;
  const std::size_t last = bytes.find("OFFSET") + 6;
  bytes.at(last + 1) = 0x40;
  EXPECT_EQ(refusalOf(bytes), "");
  // channels instead of values per frame
  sample.channels = 3;
  sample.without = {"ANALOG:LABELS"};
  sample.more = {};
  bytes = sample.write();
  bytes.at(4) = 3;
  EXPECT_EQ(readC3d(folder_.file("m.c3d", bytes)).analog.size(), 3);
}

struct Broken {
  const char* what;
  std::function<std::string(std::string)> broken;
  const char* message;
};

std::function<std::string(std::string)> byteAt(std::size_t at, int value) {
  return [=](std::string bytes) {
    bytes.at(at) = static_cast<char>(value);
    return bytes;
  };
}

// A byte of a parameter, counted from behind its name, pointer, type and count of dimensions.
std::function<std::string(std::string)> valueOf(const std::string& name, int at, int value) {
  return [=](std::string bytes) {
    const std::size_t behind = bytes.find(name, 512) + name.size() + 4;
    bytes.at(static_cast<std::size_t>(static_cast<int>(behind) + at)) = static_cast<char>(value);
    return bytes;
  };
}

std::function<std::string(std::string)> cutTo(std::size_t size) {
  return [=](const std::string& bytes) { return bytes.substr(0, size); };
}

TEST_F(C3d, RefusesBrokenFilesInOneLine) {
  const std::string good = C3dSample{}.write();
  const std::vector<Broken> all = {
      {"empty", cutTo(0), "is no C3D file"},
      {"a text", [](auto) { return "time,BIC\n0,1\n"; }, "is no C3D file"},
      {"no key", byteAt(1, 0x51), "is no C3D file"},
      {"processor", byteAt(515, 83), "is no C3D file"},
      {"parameters elsewhere", byteAt(0, 200), "is no C3D file"},
      {"parameters in block 0", byteAt(0, 0), "is no C3D file"},
      {"header cut off", cutTo(300), "is no C3D file"},
      {"parameters cut off", cutTo(700), "(cut off?)"},
      {"data cut off", [](std::string b) { return b.substr(0, b.size() - 1); },
       "promises 5 frames, its data section holds 4 (cut off?)"},
      {"no data", [](std::string b) { return b.substr(0, 1024); }, "its data section holds 0"},
      {"points", byteAt(2, 7), "POINT:USED = 2, but the header says 7, must be equal"},
      {"analog values", byteAt(4, 9), "header: 9 analog values per frame in 4 samples"},
      {"analog channels", byteAt(4, 16), "ANALOG:USED = 2, but the header says 4"},
      {"no samples", byteAt(18, 0), "header: 8 analog values per frame in 0 samples"},
      {"last frame", byteAt(8, 200), "promises 200 frames, its data section holds 5"},
      {"frames backwards", byteAt(6, 9), "header: frames 9 to 5, must be at least one frame"},
      {"data start", byteAt(16, 9), "its data section holds 0 (cut off?)"},
      {"scale's sign", byteAt(15, 0xBD), "must have the same sign"},
      {"scale 0",
       [](std::string b) {
         return valueOf("SCALE", 3, 0)(
             valueOf("SCALE", 2, 0)(valueOf("SCALE", 1, 0)(valueOf("SCALE", 0, 0)(b))));
       },
       "POINT:SCALE = 0, must be finite and not 0"},
      {"rate below 0", valueOf("RATE", 3, 0xC2), "POINT:RATE = -100 Hz, must be > 0"},
      {"rate not finite",
       [](std::string b) { return valueOf("RATE", 3, 0x7F)(valueOf("RATE", 2, 0x80)(b)); },
       "POINT:RATE = "},
      {"type of a value", valueOf("USED", -2, 3), "parameter 'USED': type 3, must be -1"},
      {"dimensions", valueOf("USED", -1, 8), "parameter 'USED': 8 dimensions, must be ≤ 7"},
      {"a long value", valueOf("LABELS", 1, 255), "parameter 'LABELS' needs 2040 bytes"},
      {"pointer", valueOf("USED", -4, 1), "parameter 'USED': next entry at byte"},
      {"pointer beyond", valueOf("USED", -3, 120), "must be behind byte"},
      {"text for a number", valueOf("USED", -2, 0xFF), "POINT:USED: is a text, must be a number"},
      {"number for a text", valueOf("LABELS", -2, 1), "POINT:LABELS: is a number, must be a text"},
  };
  for (const Broken& each : all) {
    EXPECT_THAT(refusalOf(each.broken(good)), HasSubstr(each.message)) << each.what;
  }
}

TEST_F(C3d, RefusesEveryBeginningOfAFile) {
  const std::string good = C3dSample{}.write();
  EXPECT_EQ(refusalOf(good), "");
  for (std::size_t size = 0; size < good.size(); size += size < 1500 ? 7 : 1) {
    EXPECT_NE(refusalOf(good.substr(0, size)), "") << size;
  }
}

}  // namespace
}  // namespace bio
