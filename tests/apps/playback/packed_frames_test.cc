#include "playback/packed_frames.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <stdexcept>
#include <string>

namespace {

using app::PlayedFrame;
using Eigen::Vector3d;

/// The integers of a stream, read in another way than it was written.
std::vector<int> integersOf(const std::string& text) {
  static const std::string letters =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::vector<int> bytes, integers;
  unsigned held = 0, bits = 0;
  for (const char c : text) {
    if (c == '=') break;
    held = (held << 6) | static_cast<unsigned>(letters.find(c));
    bits += 6;
    if (bits < 8) continue;
    bits -= 8;
    bytes.push_back(static_cast<int>((held >> bits) & 0xff));
  }
  for (std::size_t i = 0; i + 1 < bytes.size(); i += 2) {
    const int value = bytes[i] + 256 * bytes[i + 1];
    integers.push_back(value < 32768 ? value : value - 65536);
  }
  return integers;
}

PlayedFrame randomFrame(std::mt19937& random, double time) {
  const auto in = [&](double size) {
    return std::uniform_real_distribution<double>(-size, size)(random);
  };
  PlayedFrame frame;
  frame.time = time;
  for (int i = 0; i < 3; ++i) {
    bio::Placement<double>& X = frame.bodies.emplace_back();
    X.p = {5 + in(1), in(1), in(1)};
    X.R = Eigen::Quaterniond(in(1), in(1), in(1), in(1)).normalized().toRotationMatrix();
  }
  frame.lines = {{{{5, 0, 0}, {5.3, 0.1, in(1)}, {5, in(1), 0.2}}, 0.0031, 0.4321},
                 {{}, 0.0025, std::numeric_limits<double>::quiet_NaN()}};
  return frame;
}

TEST(PackedFrames, AreReadBackWithinTheirUnit) {
  std::mt19937 random(5);
  const std::vector<PlayedFrame> frames{randomFrame(random, 0.5), randomFrame(random, 1.25)};
  const nlohmann::ordered_json packed = app::packedFrames(frames);
  EXPECT_EQ(packed["times"], (std::vector<double>{0.5, 1.25}));
  EXPECT_EQ(packed["lines"], 2);
  const double unit = packed["unit"];
  EXPECT_LE(unit, 1.0 / 32767 * 1.01);  // everything is within 1 m of the centre
  const std::vector<int> stream = integersOf(packed["data"]);
  std::size_t at = 0;
  const auto point = [&] {
    Vector3d p;
    for (int axis = 0; axis < 3; ++axis)
      p[axis] =
          packed["centre"][static_cast<std::size_t>(axis)].get<double>() + unit * stream.at(at++);
    return p;
  };
  for (const PlayedFrame& frame : frames) {
    for (const bio::Placement<double>& body : frame.bodies) {
      EXPECT_LE((point() - body.p).cwiseAbs().maxCoeff(), 0.51 * unit);
      Eigen::Quaterniond turn;
      for (int k = 0; k < 4; ++k) turn.coeffs()[k] = stream.at(at++) / 32767.0;
      EXPECT_LE((turn.normalized().toRotationMatrix() - body.R).norm(), 2e-4);
    }
    for (const app::PlayedLine& line : frame.lines) {
      ASSERT_EQ(stream.at(at++), static_cast<int>(line.points.size()));
      EXPECT_NEAR(1e-5 * stream.at(at++), line.radius, 0.6e-5);
      const double activation = stream.at(at++) / 1e4;
      if (std::isnan(line.activation)) {
        EXPECT_LT(activation, 0);
      } else {
        EXPECT_NEAR(activation, line.activation, 1e-4);
      }
      for (const Vector3d& p : line.points) EXPECT_LE((point() - p).norm(), unit);
    }
  }
  EXPECT_EQ(at, stream.size());
}

TEST(PackedFrames, SayWhereAPostureIsNotKnown) {
  std::mt19937 random(6);
  std::vector<PlayedFrame> frames{randomFrame(random, 0), randomFrame(random, 1)};
  for (PlayedFrame& frame : frames) frame.lines.clear();
  frames[1].bodies.clear();
  const std::vector<int> stream = integersOf(app::packedFrames(frames)["data"]);
  ASSERT_EQ(stream.size(), 2u * 3 * 7);
  for (std::size_t i = 21; i < 42; ++i) EXPECT_EQ(stream[i], 0);
}

TEST(PackedFrames, RefuseFramesOfDifferentModels) {
  std::mt19937 random(7);
  std::vector<PlayedFrame> frames{randomFrame(random, 0), randomFrame(random, 1)};
  frames[1].bodies.pop_back();
  EXPECT_THROW(app::packedFrames(frames), std::invalid_argument);
  frames[1] = frames[0];
  frames[1].lines.pop_back();
  EXPECT_THROW(app::packedFrames(frames), std::invalid_argument);
}

}  // namespace
