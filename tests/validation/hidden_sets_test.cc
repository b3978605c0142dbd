#include <gtest/gtest.h>

#include <sstream>

#include "generator/data_set.h"
#include "support/scratch_folder.h"

namespace hidden {
namespace {

const std::string root = FISHERHILL_SOURCE_DIR;

// Numbers below the header of an .sto table.
std::vector<double> cells(const std::string& table) {
  std::istringstream stream(table.substr(table.find("endheader") + 10));
  std::string names;
  std::getline(stream, names);
  std::vector<double> values;
  for (double value; stream >> value;) values.push_back(value);
  return values;
}

// The three sets of emg_data/ are what the generator makes of the plans beside their answers.
TEST(HiddenSets, AreWhatTheirPlansSay) {
  const auto answers =
      nlohmann::ordered_json::parse(support::contentOf(root + "/emg_data/answers/hidden.json"));
  const ElbowNumbers nominal = readElbow(root + "/models/elbow8.osim");
  ASSERT_EQ(answers.size(), 3u);
  for (const auto& [name, label] : answers.items()) {
    DataSetPlan plan;
    plan.seed = label.at("seed");
    plan.suite = label.at("suite");
    plan.size = label.at("size");
    plan.emgNoise = label.at("emg_noise");
    for (const auto& effect : label.at("effects")) plan.effects.push_back(effect.at("id"));
    const DataSet set = makeDataSet(nominal, plan);
    EXPECT_EQ(set.label.at("nuisance_factors").size(), label.at("nuisance_factors").size());
    for (const NamedTrial& trial : set.trials) {
      const std::string file = root + "/emg_data/" + name + "/" + trial.name + ".sto";
      const auto ours = cells(asTable(trial, "")), theirs = cells(support::contentOf(file));
      ASSERT_EQ(ours.size(), theirs.size()) << file;
      ASSERT_EQ(ours.size(), 4510u) << file;
      // one unit of the last digit written; a different compiler may round differently
      for (std::size_t k = 0; k < ours.size(); ++k) {
        EXPECT_NEAR(ours[k], theirs[k], k % 10 == 9 ? 0.0101 : 1.01e-5) << file << " cell " << k;
      }
    }
    EXPECT_EQ(support::contentOf(root + "/emg_data/" + name + "/truth.sha256"),
              sha256(label.dump(2) + "\n") + "\n");
  }
}

}  // namespace
}  // namespace hidden
