#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "support/run_program.h"
#include "support/scratch_folder.h"

namespace {

using support::contentOf;
using support::ProgramResult;
using support::runFisherHill;
using support::ScratchFolder;
using testing::HasSubstr;

const std::string fittedElbow = std::string(FISHERHILL_SOURCE_DIR) + "/models/elbow8.osim";

nlohmann::json summaryIn(const std::filesystem::path& folder) {
  return nlohmann::json::parse(contentOf(folder / "summary.json"));
}

/// A table of one coordinate in steps over a range [rad].
void writeAngles(const std::filesystem::path& file, double from, double to, int count) {
  std::ofstream out(file);
  out.precision(17);
  out << "elbow_flexion\n";
  for (int k = 0; k < count; ++k) out << from + (to - from) * k / (count - 1) << '\n';
}

/// All cells of the columns that end in `.length_m`, by row.
std::vector<std::vector<double>> lengthsIn(const std::filesystem::path& file) {
  std::vector<std::vector<double>> rows;
  std::vector<bool> wanted;
  std::istringstream lines(contentOf(file));
  for (std::string line; std::getline(lines, line);) {
    std::istringstream parts(line);
    std::vector<double> row;
    std::size_t column = 0;
    const bool isHeader = wanted.empty() || rows.empty();
    std::vector<bool> names;
    for (std::string cell; std::getline(parts, cell, ','); ++column) {
      names.push_back(cell.ends_with(".length_m"));
      if (!wanted.empty() && wanted[column]) row.push_back(std::stod(cell));
    }
    if (isHeader && wanted.empty()) {
      wanted = names;
    } else {
      rows.push_back(row);
    }
  }
  return rows;
}

TEST(FitCommand, WritesAModelWithLengthsWithinTheStatedError) {
  const ScratchFolder scratch;
  const ProgramResult result =
      runFisherHill({"moment-arms", fittedElbow, "--fit", "--fit-tolerance", "0.2", "--coordinate",
                     "elbow_flexion", "--out", (scratch / "fit").string()});
  ASSERT_EQ(result.status, 0) << result.err;
  const nlohmann::json summary = summaryIn(scratch / "fit");
  EXPECT_GE(summary["written"].get<int>(), 6);
  const std::string model = (scratch / "fit" / "fitted_paths.osim").string();
  EXPECT_THAT(contentOf(model), HasSubstr("<FunctionBasedPath name=\"path\">"));
  EXPECT_THAT(contentOf(model), HasSubstr("<coordinate_paths>/jointset/elbow/elbow_flexion<"));
  double stated = 0;
  for (const auto& [muscle, fit] : summary["fits"].items()) {
    if (fit["written"].get<bool>()) {
      stated = std::max(stated, fit["length_error_m"]["largest"].get<double>());
    }
  }
  EXPECT_LE(stated, 2e-4);
  writeAngles(scratch / "postures.csv", 0.01, 2.2, 200);
  for (const std::string& of : {fittedElbow, model}) {
    const ProgramResult lengths =
        runFisherHill({"moment-arms", of, "--postures", (scratch / "postures.csv").string(),
                       "--out", (scratch / (of == model ? "fitted" : "exact")).string()});
    ASSERT_EQ(lengths.status, 0) << lengths.err;
  }
  const auto exact = lengthsIn(scratch / "exact" / "moment_arms.csv");
  const auto fitted = lengthsIn(scratch / "fitted" / "moment_arms.csv");
  ASSERT_EQ(exact.size(), 200u);
  ASSERT_EQ(fitted.size(), 200u);
  double largest = 0;
  for (std::size_t k = 0; k < exact.size(); ++k) {
    ASSERT_EQ(fitted[k].size(), 8u);
    for (std::size_t i = 0; i < 8; ++i) {
      largest = std::max(largest, std::abs(exact[k][i] - fitted[k][i]));
    }
  }
  EXPECT_LE(largest, 1.05 * stated);
  EXPECT_GT(largest, 0);
}

TEST(FitCommand, FitsLengthsOfATable) {
  const ScratchFolder scratch;
  writeAngles(scratch / "postures.csv", 0.1, 2.1, 60);
  ASSERT_EQ(
      runFisherHill({"moment-arms", fittedElbow, "--postures", (scratch / "postures.csv").string(),
                     "--out", (scratch / "table").string()})
          .status,
      0);
  const std::string table = (scratch / "table" / "moment_arms.csv").string();
  const ProgramResult result =
      runFisherHill({"moment-arms", fittedElbow, "--fit", table, "--fit-muscle", "BIClong",
                     "--fit-tolerance", "0.3", "--out", (scratch / "fit").string()});
  ASSERT_EQ(result.status, 0) << result.err;
  const nlohmann::json summary = summaryIn(scratch / "fit");
  EXPECT_EQ(summary["fits"].size(), 1u);
  EXPECT_EQ(summary["fits"]["BIClong"]["postures"].get<int>(), 60);
  EXPECT_EQ(summary["inputs"].size(), 2u);
}

TEST(FitCommand, SaysWhatItCannotDo) {
  const ScratchFolder scratch;
  const auto refused = [&](std::vector<std::string> more, const std::string& why, int status = 2) {
    std::vector<std::string> words{"moment-arms", fittedElbow};
    words.insert(words.end(), more.begin(), more.end());
    const ProgramResult result = runFisherHill(words);
    EXPECT_EQ(result.status, status) << why << result.err;
    EXPECT_THAT(result.err, HasSubstr(why));
  };
  refused({"--fit", "--from", "0"}, "excludes --fit");
  refused({"--fit-order", "3"}, "--fit");
  refused({"--fit", "--fit-order", "10"}, "--fit-order");
  refused({"--fit", "--fit-tolerance", "0"}, "--fit-tolerance");
  refused({"--fit", "--fit-muscle", "nobody"}, "nobody");
  refused({"--fit", "--fit-tolerance", "1e-9", "--fit-order", "2", "--coordinate", "elbow_flexion"},
          "keeps its points: off by up to", 1);
  writeAngles(scratch / "angles.csv", 0, 1, 9);
  refused({"--fit", (scratch / "angles.csv").string()}, "no column is named MUSCLE.length_m");
}

}  // namespace
