#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>

#include "support/run_program.h"
#include "support/scratch_folder.h"

namespace {

using support::contentOf;
using support::ProgramResult;
using support::runFisherHill;
using support::ScratchFolder;
using testing::HasSubstr;

std::vector<std::vector<std::string>> rowsOf(const std::string& text) {
  std::vector<std::vector<std::string>> rows;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::vector<std::string> cells;
    std::istringstream parts(line);
    for (std::string cell; std::getline(parts, cell, ',');) cells.push_back(cell);
    rows.push_back(std::move(cells));
  }
  return rows;
}

// OpenSim 4.6's own columns stand beside the inputs (tests/libbio/reference/README.md).
TEST(MuscleStatesCommand, AgreesWithOpenSimForEveryClass) {
  const ScratchFolder scratch;
  const std::string file =
      std::string(FISHERHILL_SOURCE_DIR) + "/tests/libbio/reference/muscle_states.csv";
  const std::string out = (scratch / "out").string();
  const ProgramResult result = runFisherHill({"muscle-states", file, "--out", out});
  ASSERT_EQ(result.status, 0) << result.err;
  const auto theirs = rowsOf(contentOf(file));
  const auto ours = rowsOf(contentOf(scratch / "out" / "muscle_states.csv"));
  ASSERT_EQ(ours.size(), theirs.size());
  std::map<std::string, int> compared;
  for (std::size_t i = 1; i < ours.size(); ++i) {
    const auto at = [&](std::size_t c) { return std::stod(theirs[i][c]); };
    const double F0 = at(1), l0 = at(2), speed = at(5) * l0;
    const double velocity = at(10);
    ASSERT_EQ(ours[i].size(), 5u);
    EXPECT_EQ(ours[i][0], theirs[i][0]);
    EXPECT_LT(std::abs(std::stod(ours[i][1]) - velocity),
              1e-8 * speed + 1e-11 * std::abs(velocity));
    EXPECT_LT(std::abs(std::stod(ours[i][2]) - at(11)), 1e-9 * F0);
    EXPECT_LT(std::abs(std::stod(ours[i][3]) - at(15)), 1e-7 * l0);
    EXPECT_LT(std::abs(std::stod(ours[i][4]) - at(16)), 1e-7 * F0);
    ++compared[ours[i][0]];
  }
  EXPECT_EQ(compared.size(), 8u);
}

TEST(MuscleStatesCommand, KnowsSchuttesClassAndPropertiesInColumns) {
  const ScratchFolder scratch;
  const std::string header =
      "class,max_isometric_force,optimal_fiber_length,tendon_slack_length,pennation,"
      "max_contraction_velocity,activation,fiber_length,path_length,Flen\n";
  const std::string state = ",800,0.12,0.25,0.1,10,0.5,0.11,0.38,";
  const std::string file =
      scratch.file("s.csv", header + "Schutte1993Muscle_Deprecated" + state + "\nThelen2003Muscle" +
                                state + "\nThelen2003Muscle" + state + "1.8\n");
  const std::string out = (scratch / "out").string();
  const ProgramResult result = runFisherHill({"muscle-states", file, "--out", out});
  ASSERT_EQ(result.status, 0) << result.err;
  const auto rows = rowsOf(contentOf(scratch / "out" / "muscle_states.csv"));
  ASSERT_EQ(rows.size(), 4u);
  EXPECT_GT(std::stod(rows[1][2]), 0);
  EXPECT_GT(std::stod(rows[2][1]), 0);  // it lengthens, where Flen acts
  EXPECT_GT(std::abs(std::stod(rows[2][1]) - std::stod(rows[3][1])), 1);
}

TEST(MuscleStatesCommand, RefusesWhatItCannotUseInOneLine) {
  const ScratchFolder scratch;
  const std::string header =
      "class,max_isometric_force,optimal_fiber_length,tendon_slack_length,pennation,"
      "max_contraction_velocity,activation,fiber_length,path_length";
  const std::string row = ",800,0.12,0.25,0.1,10,0.5,0.11,0.362";
  const auto refused = [&](const std::string& text, const std::string& words) {
    const ProgramResult result =
        runFisherHill({"muscle-states", scratch.file("bad.csv", text), "--json"});
    EXPECT_EQ(result.status, 2) << text;
    EXPECT_THAT(result.err, HasSubstr(words));
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
  };
  refused("", "no header");
  refused(header + "\n", "no row");
  refused("a,b\n1,2\n", "class");
  refused(header + "\nThelen2003Muscle,800\n", ":2: 2 cells, must be 9");
  refused(header + "\nHill1938" + row + "\n", "Hill1938");
  refused(header + "\nThelen2003Muscle_soft" + row + "\n", "_soft");
  refused(header + "\nThelen2003Muscle,-1,0.12,0.25,0.1,10,0.5,0.11,0.362\n",
          "max_isometric_force");
  refused(header + "\nThelen2003Muscle,800,nan,0.25,0.1,10,0.5,0.11,0.362\n",
          "optimal_fiber_length = 'nan'");
  refused(header + "\nThelen2003Muscle,800,0.12,0.25,0.1,10,0.5,,0.362\n", "fiber_length");
  refused(header + ",Colour\nThelen2003Muscle" + row + ",3\n", "Colour");
  refused(header + ",class\nThelen2003Muscle" + row + ",x\n", "twice");
}

}  // namespace
