#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>

#include "support/run_program.h"
#include "support/scratch_folder.h"

namespace {

using support::contentOf;
using support::ProgramResult;
using support::runFisherHill;
using support::ScratchFolder;
using testing::HasSubstr;

const std::string treeRoot = FISHERHILL_SOURCE_DIR;

// The shipped elbow with springs that hold the shoulder, the forearm and the wrist.
std::string heldElbow() {
  std::string text = contentOf(treeRoot + "/models/elbow8.osim");
  std::ostringstream springs;
  const auto hold = [&](const char* name, double stiffness, double rest, double viscosity) {
    springs << "<SpringGeneralizedForce name=\"hold_" << name << "\"><coordinate>" << name
            << "</coordinate><stiffness>" << stiffness << "</stiffness><rest_length>" << rest
            << "</rest_length><viscosity>" << viscosity
            << "</viscosity></SpringGeneralizedForce>\n";
  };
  hold("elv_angle", 40, 0.5, 2);
  hold("shoulder_elv", 40, 0.9, 2);
  hold("shoulder_rot", 20, -0.4, 1);
  hold("pro_sup", 3, 0.2, 0.1);
  hold("deviation", 3, 0.1, 0.05);
  hold("flexion", 3, -0.1, 0.05);
  const std::size_t objects = text.find("<objects>", text.find("<ForceSet"));
  text.insert(objects + std::string("<objects>").size(), springs.str());
  return text;
}

TEST(ManyCoordinates, AreReplayedByTwoIntegratorsAlike) {
  const ScratchFolder scratch;
  const std::string model = (scratch / "held.osim").string();
  std::ofstream(model) << heldElbow();
  std::vector<std::string> ends;
  const std::vector<std::string> names{"elbow_flexion", "shoulder_elv", "elv_angle", "shoulder_rot",
                                       "pro_sup",       "deviation",    "flexion"};
  std::vector<std::vector<double>> last;
  for (const std::string integrator : {"vi", "cvode"}) {
    std::vector<std::string> words{"replay",
                                   model,
                                   treeRoot + "/emg_data/curl_slow.sto",
                                   "--out",
                                   (scratch / integrator).string(),
                                   "--integrator",
                                   integrator,
                                   "--ignore-extra"};
    for (const std::string& name : names) {
      words.push_back("--coordinate");
      words.push_back(name);
    }
    const ProgramResult result = runFisherHill(words);
    ASSERT_EQ(result.status, 0) << result.err;
    const std::string states = contentOf(scratch / integrator / "states.sto");
    for (const std::string& name : names) EXPECT_THAT(states, HasSubstr("/" + name + "/value"));
    std::istringstream cells(states.substr(states.rfind('\n', states.size() - 2) + 1));
    last.emplace_back();
    for (double value = 0; cells >> value;) last.back().push_back(value);
  }
  ASSERT_EQ(last[0].size(), last[1].size());
  for (std::size_t i = 1; i < 1 + 2 * names.size(); i += 2) {
    EXPECT_NEAR(last[0][i], last[1][i], 0.01) << i;
  }
}

}  // namespace
