#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>
#include <sstream>

#include "support/run_program.h"
#include "support/scratch_folder.h"

namespace {

using support::contentOf;
using support::ProgramResult;
using support::runFisherHill;
using support::ScratchFolder;
using testing::HasSubstr;

const std::string shippedElbow = std::string(FISHERHILL_SOURCE_DIR) + "/models/elbow8.osim";

struct Csv {
  std::vector<std::string> names;
  std::vector<std::vector<std::string>> rows;

  explicit Csv(const std::filesystem::path& file) {
    std::istringstream lines(contentOf(file));
    for (std::string line; std::getline(lines, line);) {
      std::vector<std::string> cells;
      std::istringstream parts(line);
      for (std::string cell; std::getline(parts, cell, ',');) cells.push_back(cell);
      if (names.empty()) {
        names = std::move(cells);
      } else {
        rows.push_back(std::move(cells));
      }
    }
  }
  const std::string& text(std::size_t row, const std::string& name) const {
    const auto at = std::find(names.begin(), names.end(), name);
    if (at == names.end()) throw std::out_of_range("no column " + name);
    return rows.at(row).at(static_cast<std::size_t>(at - names.begin()));
  }
  double at(std::size_t row, const std::string& name) const { return std::stod(text(row, name)); }
};

void writeText(const std::filesystem::path& file, const std::string& text) {
  std::ofstream(file) << text;
}

TEST(PosturesCommand, GivesTheLengthsAndArmsOfASweep) {
  const ScratchFolder scratch;
  const ProgramResult sweep =
      runFisherHill({"moment-arms", shippedElbow, "--from", "-30", "--to", "120", "--points", "31",
                     "--out", (scratch / "sweep").string()});
  ASSERT_EQ(sweep.status, 0) << sweep.err;
  const Csv swept(scratch / "sweep" / "moment_arms.csv");
  std::ostringstream table;
  table.precision(17);
  table << "posture,elbow_flexion,note\n";
  for (std::size_t k = 0; k < swept.rows.size(); ++k) {
    const double angle = swept.at(k, "elbow_flexion_deg") * std::numbers::pi / 180;
    table << k << ',' << angle << ",text\n";
  }
  writeText(scratch / "postures.csv", table.str());
  const ProgramResult postures =
      runFisherHill({"moment-arms", shippedElbow, "--postures", (scratch / "postures.csv").string(),
                     "--out", (scratch / "postures").string()});
  ASSERT_EQ(postures.status, 0) << postures.err;
  EXPECT_THAT(postures.err, HasSubstr("2 columns are no coordinates of the model"));
  const Csv given(scratch / "postures" / "moment_arms.csv");
  ASSERT_EQ(given.rows.size(), swept.rows.size());
  int touched = 0;
  for (std::size_t k = 0; k < given.rows.size(); ++k) {
    for (const std::string muscle : {"TRIlong", "BIClong", "BRA", "BRD"}) {
      EXPECT_NEAR(given.at(k, muscle + ".length_m"), swept.at(k, muscle + ".length_m"), 1e-13);
      EXPECT_NEAR(given.at(k, muscle + ".dlength_d.elbow_flexion"),
                  -swept.at(k, muscle + ".moment_arm_m"), 1e-12);
      const bool isTouched = swept.at(k, muscle + ".wrapped") != 0;
      EXPECT_EQ(given.text(k, muscle + ".wrapped") != "-", isTouched) << muscle << " " << k;
      touched += isTouched ? 1 : 0;
    }
  }
  EXPECT_GT(touched, 20);
}

// Seven coordinates: slopes against differences of the lengths.
TEST(PosturesCommand, TakesAnyNumberOfCoordinates) {
  const ScratchFolder scratch;
  const std::vector<std::string> names{"elbow_flexion", "shoulder_elv", "elv_angle", "shoulder_rot",
                                       "pro_sup",       "deviation",    "flexion"};
  const std::vector<double> middle{0.9, 0.6, 0.4, -0.2, 0.3, 0.05, -0.1};
  const double h = 1e-4;
  std::ostringstream table;
  table.precision(17);
  for (const std::string& name : names) table << (&name == &names.front() ? "" : ",") << name;
  table << '\n';
  const auto add = [&](std::size_t moved, double by) {
    for (std::size_t i = 0; i < middle.size(); ++i) {
      table << (i ? "," : "") << middle[i] + (i == moved ? by : 0);
    }
    table << '\n';
  };
  add(0, 0);
  for (std::size_t i = 0; i < names.size(); ++i) {
    add(i, h);
    add(i, -h);
  }
  writeText(scratch / "postures.csv", table.str());
  const ProgramResult result =
      runFisherHill({"moment-arms", shippedElbow, "--postures", (scratch / "postures.csv").string(),
                     "--out", (scratch / "out").string()});
  ASSERT_EQ(result.status, 0) << result.err;
  const Csv given(scratch / "out" / "moment_arms.csv");
  ASSERT_EQ(given.rows.size(), 15u);
  int moving = 0;
  for (const std::string muscle : {"TRIlong", "TRIlat", "BIClong", "BICshort", "BRA", "BRD"}) {
    for (std::size_t i = 0; i < names.size(); ++i) {
      const double slope = given.at(0, muscle + ".dlength_d." + names[i]);
      const double difference =
          (given.at(1 + 2 * i, muscle + ".length_m") - given.at(2 + 2 * i, muscle + ".length_m")) /
          (2 * h);
      EXPECT_NEAR(slope, difference, 1e-8) << muscle << " " << names[i];
      moving += std::abs(slope) > 1e-4 ? 1 : 0;
    }
  }
  EXPECT_GT(moving, 8);
}

TEST(PosturesCommand, RefusesWhatItCannotRead) {
  const ScratchFolder scratch;
  const auto refused = [&](const std::string& text, const std::string& why,
                           std::vector<std::string> more = {}) {
    writeText(scratch / "bad.csv", text);
    std::vector<std::string> words{"moment-arms", shippedElbow, "--postures",
                                   (scratch / "bad.csv").string()};
    words.insert(words.end(), more.begin(), more.end());
    const ProgramResult result = runFisherHill(words);
    EXPECT_EQ(result.status, 2) << text;
    EXPECT_THAT(result.err, HasSubstr(why)) << text;
  };
  refused("", "no header line");
  refused("angle\n1\n", "no column is named like a coordinate");
  refused("elbow_flexion,elbow_flexion\n1,1\n", "given twice");
  refused("elbow_flexion\n", "no row");
  refused("elbow_flexion\n1,2\n", "2 cells, must be 1");
  refused("elbow_flexion\n1\nflexed\n", "bad.csv:3: elbow_flexion = 'flexed'");
  refused("elbow_flexion\ninf\n", "must be a finite number");
  refused("elbow_flexion\n1\n", "excludes --postures", {"--from", "0"});
}

}  // namespace
