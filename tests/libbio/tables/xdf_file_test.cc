#include "bio/tables/xdf_file.h"

#include <gmock/gmock.h>

#include <cmath>
#include <functional>
#include <limits>

#include "binary_samples.h"
#include "bio/tables/file_error.h"
#include "support/scratch_folder.h"
#include "support/throws_saying.h"

namespace bio {
namespace {

using support::XdfSample;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr double none = std::numeric_limits<double>::quiet_NaN();

class Xdf : public testing::Test {
 protected:
  XdfFile read(const std::string& bytes) const { return readXdf(folder_.file("a.xdf", bytes)); }
  std::string refusalOf(const std::string& bytes) const {
    return support::refusalIn<FileError>(folder_.path().string(), [&] { read(bytes); });
  }
  support::ScratchFolder folder_;
};

// `count` samples of two int16 channels at `rate`, chunks of 10, only the first of each stamped.
void addEmg(XdfSample& xdf, std::uint32_t id, int count, double start, double rate) {
  for (int first = 0; first < count; first += 10) {
    std::vector<double> stamps;
    std::vector<std::string> values;
    for (int i = first; i < std::min(first + 10, count); ++i) {
      stamps.push_back(i == first ? start + i / rate : none);
      values.push_back(XdfSample::int16({i - 5, -2 * i}));
    }
    xdf.chunk(3, XdfSample::samples(id, stamps, values));
  }
}

XdfSample twoStreams() {
  XdfSample xdf;
  xdf.fileHeader();
  xdf.streamHeader(1, "EMG", 2, 100, "int16",
                   XdfSample::label("BIC", "µV") + XdfSample::label("TRI", "uV"));
  xdf.streamHeader(2, "Goniometer", 1, 50, "float32");
  xdf.streamHeader(3, "Markers", 1, 0, "string");
  addEmg(xdf, 1, 200, 1000, 100);
  xdf.chunk(3, XdfSample::samples(3, {1000.5}, {"\x01\x03yes"}));
  // its clock is 400 s behind and loses 100 µs a second
  for (int i = 0; i < 100; ++i) {
    xdf.chunk(3, XdfSample::samples(2, {600.1 + i / 50.0},
                                    {XdfSample::float32({static_cast<float>(i) / 4})}));
  }
  for (int i = 0; i < 5; ++i) {
    xdf.offset(1, 1000 + i, 0);
    xdf.offset(2, 600 + i, 400 + 1e-4 * i);
  }
  xdf.chunk(6, XdfSample::idOf(1) + "<info/>");
  return xdf;
}

TEST_F(Xdf, BringsStreamsToOneClock) {
  const XdfFile file = read(twoStreams().bytes);
  ASSERT_EQ(file.streams.size(), 2);
  const Channel& triceps = file.streams[0].channels.at(1);
  EXPECT_EQ(triceps.name, "EMG TRI");
  EXPECT_EQ(file.streams[0].channels[0].unit, "uV");
  EXPECT_NEAR(triceps.rate, 100, 1e-6);
  EXPECT_NEAR(triceps.startTime, 0, 1e-6);
  ASSERT_EQ(triceps.values.size(), 200);
  EXPECT_EQ(triceps.values[199], -398);
  const Channel& angle = file.streams[1].channels.at(0);
  EXPECT_EQ(angle.name, "Goniometer");
  EXPECT_NEAR(angle.startTime, 0.1 + 1e-5, 1e-6);
  EXPECT_NEAR(angle.rate, 50 / (1 + 1e-4), 1e-5);
  EXPECT_EQ(angle.values[99], 24.75);
  EXPECT_THAT(file.remarks, ElementsAre("Stream 'Markers' holds texts and was not read."));
}

TEST_F(Xdf, LeapsOfTimeAreGaps) {
  XdfSample xdf;
  xdf.streamHeader(1, "EMG", 2, 100, "int16");
  addEmg(xdf, 1, 800, 10, 100);
  addEmg(xdf, 1, 800, 24, 100);  // 6 s are missing
  const XdfFile file = read(xdf.bytes);
  const Eigen::VectorXd& values = file.streams[0].channels[0].values;
  ASSERT_EQ(values.size(), 800 + 600 + 800);
  EXPECT_EQ(values[799], 794);
  EXPECT_TRUE(std::isnan(values[800]) && std::isnan(values[1399]));
  EXPECT_EQ(values[1400], -5);
  EXPECT_THAT(file.remarks, ElementsAre(HasSubstr("1 times samples are missing, 600 in all")));
}

TEST_F(Xdf, ASingleStrayOffsetIsNoRestart) {
  XdfSample xdf;
  xdf.streamHeader(1, "EMG", 2, 100, "int16");
  for (int i = 0; i <= 400; ++i) xdf.offset(1, 1000 + i, i == 200 ? 103 : 100);
  addEmg(xdf, 1, 800, 1000, 100);
  const XdfFile file = read(xdf.bytes);
  const Channel& emg = file.streams[0].channels[0];
  EXPECT_EQ(emg.values.size(), 800);
  EXPECT_NEAR(emg.rate, 100, 1e-3);
  EXPECT_THAT(file.remarks, ElementsAre(HasSubstr("off a straight line")));
}

// The computer of a stream restarts: its clock begins anew, 3000 s lower, after 2 s without
// samples.
TEST_F(Xdf, AClockThatRestartsIsFollowedByItsOwnOffsets) {
  for (const double restarted : {50.0, 9000.0}) {
    XdfSample xdf;
    xdf.streamHeader(1, "EMG", 2, 100, "int16");
    xdf.streamHeader(2, "Goniometer", 1, 50, "float32");
    const auto offsets = [&](double begin, double by) {
      for (int i = 0; i < 4; ++i) xdf.offset(1, begin + 2 * i, by + 1e-4 * i);
    };
    offsets(3000, 100);
    addEmg(xdf, 1, 800, 3000, 100);
    // 10 s after the first sample on the recorder's clock
    offsets(restarted, 3110 - restarted);
    addEmg(xdf, 1, 800, restarted, 100);
    for (int i = 0; i < 900; ++i) {
      xdf.chunk(3, XdfSample::samples(2, {3100 + i / 50.0}, {XdfSample::float32({1})}));
    }
    const XdfFile file = read(xdf.bytes);
    const Channel& emg = file.streams[0].channels[0];
    ASSERT_EQ(emg.values.size(), 1800) << restarted;
    EXPECT_NEAR(emg.rate, 100, 0.01);
    EXPECT_NEAR(emg.startTime, 0, 1e-3);
    EXPECT_EQ(emg.values[799], 794);
    EXPECT_TRUE(std::isnan(emg.values[800]) && std::isnan(emg.values[999]));
    EXPECT_EQ(emg.values[1000], -5);
    EXPECT_THAT(
        file.remarks,
        testing::Contains(HasSubstr("Stream 'EMG': its clock was set or restarted 1 time;")));
  }
}

TEST_F(Xdf, JitterOfStampsIsEvenedOut) {
  XdfSample xdf;
  xdf.streamHeader(1, "EMG", 1, 100, "float32");
  for (int i = 0; i < 400; ++i) {
    const double jitter = 0.004 * std::sin(1.7 * i * i);
    xdf.chunk(3, XdfSample::samples(1, {5 + i / 98.0 + jitter}, {XdfSample::float32({1})}));
  }
  const XdfFile file = read(xdf.bytes);
  EXPECT_NEAR(file.streams[0].channels[0].rate, 98, 0.02);
  EXPECT_FALSE(file.remarks.empty());  // 2 % off the nominal rate
}

TEST_F(Xdf, ARecordingThatWasCutOffIsReadAsFarAsItGoes) {
  const std::string whole = twoStreams().bytes;
  const std::string cut = whole.substr(0, whole.find("\x03yes") - 30);
  const XdfFile file = read(cut);
  EXPECT_EQ(file.streams.at(0).channels[0].values.size(), 190);
  EXPECT_THAT(file.remarks, testing::Contains(HasSubstr("The recording was cut off: its last")));
}

TEST_F(Xdf, IsARecordingOfItsStreams) {
  const Recording recording = readRecording(folder_.file("a.dat", twoStreams().bytes));
  EXPECT_EQ(recording.format, RecordingFormat::xdf);
  EXPECT_EQ(findChannel(recording, "EMG BIC").values.size(), 200);
}

struct BrokenXdf {
  const char* what;
  std::function<void(XdfSample&)> add;
  const char* message;
};

TEST_F(Xdf, RefusesBrokenFilesInOneLine) {
  const auto header = [](unsigned channels, double rate, const char* format) {
    return [=](XdfSample& xdf) { xdf.streamHeader(7, "S", channels, rate, format); };
  };
  const auto samples = [](std::vector<double> stamps, std::vector<std::string> values) {
    return [=](XdfSample& xdf) { xdf.chunk(3, XdfSample::samples(1, stamps, values)); };
  };
  const auto raw = [](const std::string& bytes) {
    return [=](XdfSample& xdf) { xdf.bytes += bytes; };
  };
  const auto xml = [](const std::string& text) {
    return [=](XdfSample& xdf) { xdf.chunk(2, XdfSample::idOf(9) + text); };
  };
  const std::string two = XdfSample::int16({1, 2});
  const std::vector<BrokenXdf> all = {
      {"no magic", [](XdfSample& xdf) { xdf.bytes[3] = ';'; }, "is no XDF file"},
      {"empty", [](XdfSample& xdf) { xdf.bytes.clear(); }, "is no XDF file"},
      {"bytes of a length", raw("\x03zzzz"), "length in 3 bytes, must be in 1, 4 or 8"},
      {"length cut off", raw(std::string("\x08\x01\x00", 3)), "needs 8 bytes"},
      {"length 1", raw("\x01\x01\x01"), "length 1, must be ≥ 2"},
      {"nothing behind", raw("\x01\x05"), "needs 2 bytes"},
      {"too long", raw(std::string("\x08\xFF\xFF\xFF\xFF\xFF\xFF\xFF\x7F\x02\x00zz", 13)),
       "(cut off?)"},
      {"tag", [](XdfSample& xdf) { xdf.chunk(9, "zz"); }, "tag 9, must be 1 to 6"},
      {"no id", [](XdfSample& xdf) { xdf.chunk(3, "z"); }, "needs 4 bytes"},
      {"unknown stream", [](XdfSample& xdf) { xdf.chunk(3, XdfSample::samples(5, {}, {})); },
       "stream 5, must have a header before"},
      {"second header", [](XdfSample& xdf) { xdf.streamHeader(1, "A", 1, 1, "int8"); },
       "second header of stream 1"},
      {"no XML", xml("<info"), "must be XML"},
      {"no info", xml("<inf/>"), "must hold an element 'info'"},
      {"no count", xml("<info><name>N</name></info>"), "channel_count = '', must be a number"},
      {"no channels", header(0, 100, "int8"), "channel_count = 0, must be a whole number ≥ 1"},
      {"rate",
       xml("<info><channel_count>1</channel_count><nominal_srate>-5</nominal_srate></info>"),
       "nominal_srate = '-5', must be a number ≥ 0"},
      {"format", header(1, 100, "float16"), "channel_format = 'float16', must be float32"},
      {"first stamp", samples({none}, {two}), "first sample has no time stamp"},
      {"stamp", samples({std::numeric_limits<double>::infinity()}, {two}), "must be a finite time"},
      {"bytes of a stamp",
       [](XdfSample& xdf) { xdf.chunk(3, XdfSample::idOf(1) + "\x01\x01\x04zzzzzzzz"); },
       "time stamp in 4 bytes, must be in 0 or 8"},
      {"values", samples({1}, {"z"}), "needs 4 bytes"},
      {"more samples",
       [&](XdfSample& xdf) {
         xdf.chunk(3, XdfSample::samples(1, {1, 2}, {two, two}) + "zz");
       },
       "2 samples end at byte"},
      {"fewer samples",
       [&](XdfSample& xdf) {
         std::string chunk = XdfSample::samples(1, {1, 2}, {two, two});
         chunk[5] = 3;
         xdf.chunk(3, chunk);
       },
       "needs 1 bytes"},
      {"offset", [](XdfSample& xdf) { xdf.chunk(4, XdfSample::idOf(1) + "zzzz"); }, "needs 16"},
      {"offset not finite", [](XdfSample& xdf) { xdf.offset(1, 1, none); }, "must be finite"},
      {"clock",
       [&](XdfSample& xdf) {
         xdf.chunk(3, XdfSample::samples(1, {1, 1.01}, {two, two}));
         xdf.offset(1, 1, 0);
         xdf.offset(1, 2, 0.5);
       },
       "its clock runs off by 0.5 s per second"},
      {"clock set without its stamps",
       [&](XdfSample& xdf) {
         xdf.offset(1, 1, 0);
         xdf.chunk(3, XdfSample::samples(1, {1, 1.01, 1.02}, {two, two, two}));
         xdf.offset(1, 2, 500);
       },
       "stream 'EMG': the offset of its clock leaps by 500 s where its time stamps do not"},
      {"backwards", samples({100, 50}, {two, two}), "must not go back"},
      {"standing", samples({100, 100}, {two, two}), "its time stamps do not rise"},
      {"a long break", samples({1, 1.01, 1e9}, {two, two, two}), "no samples for 1e+09 s"},
  };
  for (const BrokenXdf& each : all) {
    XdfSample xdf;
    xdf.streamHeader(1, "EMG", 2, 100, "int16");
    each.add(xdf);
    EXPECT_THAT(refusalOf(xdf.bytes), HasSubstr(each.message)) << each.what;
  }
}

}  // namespace
}  // namespace bio
