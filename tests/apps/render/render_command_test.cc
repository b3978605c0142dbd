#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <thread>

#include "support/run_program.h"
#include "support/scratch_folder.h"

namespace {

namespace fs = std::filesystem;
using support::contentOf;
using support::ProgramResult;
using testing::HasSubstr;

const std::string modelFile = std::string(FISHERHILL_SOURCE_DIR) + "/models/elbow8.osim";

/// Processes that carry a mark in their environment: what the program started and left behind.
int processesMarked(const std::string& mark) {
  int count = 0;
  for (const auto& entry : fs::directory_iterator("/proc")) {
    const std::string name = entry.path().filename();
    if (name.find_first_not_of("0123456789") != name.npos) continue;
    if (contentOf(entry.path() / "environ").find(mark) != std::string::npos) ++count;
  }
  return count;
}

class RenderCommand : public testing::Test {
 protected:
  /// Runs `fisherhill render` without a display; `before` are words in front of it.
  ProgramResult render(std::vector<std::string> arguments, const std::string& path = "",
                       const std::vector<std::string>& before = {}) {
    std::vector<std::string> words = {"env", "-u", "DISPLAY", mark_};
    if (!path.empty()) words.push_back("PATH=" + path);
    words.insert(words.end(), before.begin(), before.end());
    words.insert(words.end(), {FISHERHILL_PROGRAM_FOLDER "/fisherhill", "render", modelFile,
                               states_, "--out", (scratch_ / "out").string(), "--size", "160x120"});
    words.insert(words.end(), arguments.begin(), arguments.end());
    return support::runProgram(words);
  }

  /// A folder for PATH that has a virtual display, and perhaps something called ffmpeg.
  std::string programs(const std::string& ffmpeg = "") {
    fs::create_directory(scratch_ / "bin");
    fs::create_symlink("/usr/bin/Xvfb", scratch_ / "bin/Xvfb");
    if (!ffmpeg.empty()) {
      scratch_.file("bin/ffmpeg", "#!/bin/sh\n" + ffmpeg + "\n");
      fs::permissions(scratch_ / "bin/ffmpeg", fs::perms::owner_all);
    }
    return (scratch_ / "bin").string();
  }

  void expectNothingLeftRunning() {
    for (int tenths = 0; tenths < 200 && processesMarked(mark_) > 0; ++tenths) {
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
    EXPECT_EQ(processesMarked(mark_), 0);
  }

  bool made(const std::string& name) const { return fs::exists(scratch_ / ("out/" + name)); }

  support::ScratchFolder scratch_;
  std::string mark_ = "FISHERHILL_RENDER_TEST=" + scratch_.path().string();
  std::string states_ = scratch_.file(
      "states.csv",
      "time,/jointset/elbow/elbow_flexion/value,/forceset/BIClong/activation\n0,0.5,0.1\n"
      "0.2,1.5,0.9\n");
};

TEST_F(RenderCommand, DrawsAPictureWithoutADisplayAndLeavesNoServer) {
  const ProgramResult result = render({"--show-wraps", "--ghost", states_});
  ASSERT_EQ(result.status, 0) << result.err;
  const std::string png = contentOf(scratch_ / "out/picture.png");
  ASSERT_GT(png.size(), 1000u);
  EXPECT_EQ(png.substr(1, 3), "PNG");
  EXPECT_EQ(static_cast<unsigned char>(png[19]), 160);  // width and height, big-endian
  EXPECT_EQ(static_cast<unsigned char>(png[23]), 120);
  EXPECT_TRUE(made("summary.json"));
  EXPECT_THAT(contentOf(scratch_ / "out/report.html"),
              HasSubstr("<img alt=\"Model\" src=\"data:image/png;base64,iVBORw0KGgo"));
  expectNothingLeftRunning();
}

TEST_F(RenderCommand, TheGhostMayBeAnotherModel) {
  // A humerus that is a hand's breadth shorter, and no other difference.
  std::string text = contentOf(modelFile);
  const std::string joint = "0.0061 -0.2904 -0.0123";
  const std::size_t at = text.find(joint);
  ASSERT_NE(at, text.npos);
  text.replace(at, joint.size(), "0.0061 -0.2104 -0.0123");
  const std::string shorter = scratch_.file("shorter.osim", text);
  ASSERT_EQ(render({}).status, 0);
  const std::string alone = contentOf(scratch_ / "out/picture.png");
  ASSERT_EQ(render({"--force", "--ghost", states_}).status, 0);
  const std::string same = contentOf(scratch_ / "out/picture.png");
  const ProgramResult result = render({"--force", "--ghost", states_, "--ghost-model", shorter});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_NE(contentOf(scratch_ / "out/picture.png"), same);
  EXPECT_NE(contentOf(scratch_ / "out/picture.png"), alone);
  EXPECT_THAT(contentOf(scratch_ / "out/summary.json"), HasSubstr("shorter.osim"));
}

class RenderGeometry : public RenderCommand {
 protected:
  /// The shipped elbow with a geometry file for its humerus.
  std::string modelWithGeometry() {
    std::string text = contentOf(modelFile);
    const std::string nothing = "<attached_geometry/>";
    const std::size_t at = text.find(nothing, text.find("<Body name=\"humerus\">"));
    text.replace(at, nothing.size(),
                 "<attached_geometry><Mesh name=\"bone\"><mesh_file>humerus.vtp</mesh_file></Mesh>"
                 "</attached_geometry>");
    return scratch_.file("named.osim", text);
  }

  /// @return the picture
  std::string draw(const std::string& named, const std::string& geometry, std::string& messages) {
    const ProgramResult result =
        support::runProgram({"env", "-u", "DISPLAY", FISHERHILL_PROGRAM_FOLDER "/fisherhill",
                             "render", named, states_, "--out", (scratch_ / "out").string(),
                             "--force", "--size", "160x120", "--geometry", geometry});
    EXPECT_EQ(result.status, 0) << result.err;
    messages = result.err;
    return contentOf(scratch_ / "out/picture.png");
  }
};

TEST_F(RenderGeometry, MissingItIsOneWarningAndATaperedSolid) {
  const std::string named = modelWithGeometry();
  fs::create_directory(scratch_ / "empty");
  fs::create_directory(scratch_ / "bones");
  // A tetrahedron along the humerus.
  scratch_.file("bones/humerus.vtp",
                "<VTKFile type=\"PolyData\" version=\"0.1\" byte_order=\"LittleEndian\"><PolyData>"
                "<Piece NumberOfPoints=\"4\" NumberOfVerts=\"0\" NumberOfLines=\"0\" "
                "NumberOfStrips=\"0\" NumberOfPolys=\"4\"><Points><DataArray type=\"Float32\" "
                "NumberOfComponents=\"3\" format=\"ascii\">0 0 0.05 0.05 0 -0.05 -0.05 0 -0.05 0 "
                "-0.3 0</DataArray></Points><Polys><DataArray type=\"Int32\" "
                "Name=\"connectivity\" format=\"ascii\">0 1 2 0 3 1 1 3 2 2 3 0</DataArray>"
                "<DataArray type=\"Int32\" Name=\"offsets\" format=\"ascii\">3 6 9 12</DataArray>"
                "</Polys></Piece></PolyData></VTKFile>\n");
  std::string messages;
  const std::string tapered = draw(named, (scratch_ / "empty").string(), messages);
  const std::size_t first = messages.find("humerus.vtp");
  EXPECT_NE(first, messages.npos) << messages;
  EXPECT_EQ(messages.find("humerus.vtp", first + 1), messages.npos) << messages;
  const std::string meshed = draw(named, (scratch_ / "bones").string(), messages);
  EXPECT_EQ(messages.find(".vtp"), messages.npos) << messages;
  EXPECT_NE(meshed, tapered);
}

TEST_F(RenderCommand, MakesAFilm) {
  if (!fs::exists("/usr/bin/ffmpeg")) GTEST_SKIP() << "ffmpeg is not installed";
  const ProgramResult result = render({"--film", "--fps", "20"});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(contentOf(scratch_ / "out/film.mp4").substr(4, 4), "ftyp");
  EXPECT_THAT(contentOf(scratch_ / "out/summary.json"), HasSubstr("\"pictures\": 5"));
  EXPECT_FALSE(made("frame_0001.png"));
  expectNothingLeftRunning();
}

TEST_F(RenderCommand, WithoutFfmpegKeepsThePicturesAndSaysHowToMakeTheFilm) {
  const ProgramResult result = render({"--film", "--fps", "10"}, programs());
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.err, HasSubstr("ffmpeg -framerate 10 -i "));
  EXPECT_TRUE(made("frame_0001.png") && made("frame_0003.png"));
  EXPECT_FALSE(made("frame_0004.png") || made("film.mp4"));
}

TEST_F(RenderCommand, AFailingFfmpegIsOneLineAndLeavesNothing) {
  const ProgramResult result = render({"--film"}, programs("echo no codec >&2; exit 1"));
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.err, HasSubstr("no codec"));
  EXPECT_FALSE(fs::exists(scratch_ / "out"));
  expectNothingLeftRunning();
}

TEST_F(RenderCommand, KilledInTheMiddleItLeavesNoServer) {
  // ffmpeg kills the program that feeds it: by then the virtual display runs.
  const ProgramResult result =
      render({"--film"}, programs("kill -KILL $(ps -o ppid= -p $$)") + ":/usr/bin:/bin");
  EXPECT_EQ(result.status, 128 + 9) << result.err;
  expectNothingLeftRunning();
}

TEST_F(RenderCommand, ColoursReachWhatOccursUnlessToldOtherwise) {
  ASSERT_EQ(render({}).status, 0);
  const std::string occurring = contentOf(scratch_ / "out/picture.png");
  ASSERT_EQ(render({"--force", "--activation-max", "0.9"}).status, 0);
  EXPECT_EQ(contentOf(scratch_ / "out/picture.png"), occurring);
  ASSERT_EQ(render({"--force", "--activation-max", "0.5"}).status, 0);
  EXPECT_NE(contentOf(scratch_ / "out/picture.png"), occurring);
  EXPECT_EQ(render({"--force", "--activation-max", "0"}).status, 2);
}

TEST_F(RenderCommand, WithoutAMotionItDrawsOnePosture) {
  const auto drawn = [&](std::vector<std::string> more) {
    std::vector<std::string> words = {"env",
                                      "-u",
                                      "DISPLAY",
                                      FISHERHILL_PROGRAM_FOLDER "/fisherhill",
                                      "render",
                                      modelFile,
                                      "--size",
                                      "160x120",
                                      "--force",
                                      "--out",
                                      (scratch_ / "out").string()};
    words.insert(words.end(), more.begin(), more.end());
    return support::runProgram(words);
  };
  ASSERT_EQ(drawn({}).status, 0);
  const std::string atDefault = contentOf(scratch_ / "out/picture.png");
  const ProgramResult bent = drawn({"--lock", "elbow_flexion=90deg"});
  ASSERT_EQ(bent.status, 0) << bent.err;
  EXPECT_NE(contentOf(scratch_ / "out/picture.png"), atDefault);
  EXPECT_THAT(bent.out, HasSubstr("one posture"));
  EXPECT_THAT(drawn({"--film"}).err, HasSubstr("--film: needs STATES"));
  EXPECT_THAT(drawn({"--time", "1"}).err, HasSubstr("--time: needs STATES"));
  EXPECT_THAT(drawn({"--lock", "elbow_bend=1"}).err, HasSubstr("elbow_bend"));
}

}  // namespace
