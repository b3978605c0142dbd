#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "support/run_program.h"
#include "support/scratch_folder.h"

namespace {

using nlohmann::json;
using support::contentOf;
using support::ProgramResult;
using support::runFisherHill;
using support::ScratchFolder;
using testing::HasSubstr;

const std::string elbowFile = std::string(FISHERHILL_SOURCE_DIR) + "/models/elbow8.osim";

std::string trialOf(const ScratchFolder& scratch, const std::string& name, double torque) {
  std::ostringstream text;
  text << "time,BIClong,BRA,elbow_flexion.torque\n";
  for (int k = 0; k <= 40; ++k) text << 0.01 * k << ",0.06,0.05," << torque << '\n';
  return scratch.file(name, text.str());
}

std::string loadsOf(const ScratchFolder& scratch, const std::string& name,
                    const std::string& properties) {
  return scratch.file(name,
                      "<?xml version=\"1.0\"?>\n<OpenSimDocument Version=\"40000\">\n"
                      "<ExternalLoads name=\"loads\"><objects>\n<ExternalForce name=\"cuff\">" +
                          properties +
                          "</ExternalForce></objects>\n<datafile>cuff.sto</datafile>\n"
                          "</ExternalLoads></OpenSimDocument>\n");
}

std::vector<double> lastRow(const std::string& states) {
  std::istringstream cells(states.substr(states.rfind('\n', states.size() - 2) + 1));
  std::vector<double> row;
  for (double value = 0; cells >> value;) row.push_back(value);
  return row;
}

// The elbow's axis, which the humerus holds, times 0.4 N m.
void writeCuff(const ScratchFolder& scratch, double end) {
  std::ostringstream text;
  text << "cuff\nversion=1\nnRows=2\nnColumns=7\ninDegrees=no\nendheader\n"
          "time\tf_x\tf_y\tf_z\tm_x\tm_y\tm_z\n";
  text.precision(17);
  for (const double t : {0.0, end}) {
    text << t << "\t0\t0\t0\t" << 0.4 * 0.04940001 << '\t' << 0.4 * 0.03660001 << '\t'
         << 0.4 * 0.99810825 << '\n';
  }
  scratch.file("cuff.sto", text.str());
}

const std::string aboutTheElbow =
    "<applied_to_body>ulna</applied_to_body><force_expressed_in_body>humerus"
    "</force_expressed_in_body><torque_identifier>m_</torque_identifier>";

TEST(ExternalLoads, ATorqueAboutTheElbowIsThatOfItsColumn) {
  const ScratchFolder scratch;
  writeCuff(scratch, 0.4);
  const std::string loads = loadsOf(scratch, "loads.xml", aboutTheElbow);
  const auto run = [&](const std::string& name, const std::vector<std::string>& more) {
    std::vector<std::string> words{"replay", elbowFile};
    words.insert(words.end(), more.begin(), more.end());
    words.insert(words.end(), {"--out", (scratch / name).string()});
    const ProgramResult result = runFisherHill(words);
    EXPECT_EQ(result.status, 0) << result.err;
  };
  for (const std::string integrator : {"vi", "cvode"}) {
    run("column" + integrator, {trialOf(scratch, "pushed.csv", 0.4), "--integrator", integrator});
    run("loads" + integrator,
        {trialOf(scratch, "alone.csv", 0), "--external-loads", loads, "--integrator", integrator});
    const auto column = lastRow(contentOf(scratch / ("column" + integrator) / "states.sto"));
    const auto byLoads = lastRow(contentOf(scratch / ("loads" + integrator) / "states.sto"));
    ASSERT_EQ(column.size(), byLoads.size());
    for (std::size_t i = 0; i < column.size(); ++i) EXPECT_NEAR(column[i], byLoads[i], 1e-7) << i;
    const auto workOf = [&](const std::string& name) {
      return json::parse(contentOf(scratch / (name + integrator) / "summary.json"))
          .at("external_work_J")
          .get<double>();
    };
    EXPECT_GT(std::abs(workOf("column")), 0.05);
    EXPECT_NEAR(workOf("column"), workOf("loads"), 1e-7);
  }
}

TEST(ExternalLoads, WhatCannotBeUsedIsRefusedInOneLine) {
  const ScratchFolder scratch;
  writeCuff(scratch, 0.4);
  const std::string trial = trialOf(scratch, "trial.csv", 0);
  const auto refusal = [&](const std::string& properties) {
    const std::string loads = loadsOf(scratch, "wrong.xml", properties);
    const ProgramResult result =
        runFisherHill({"replay", elbowFile, trial, "--external-loads", loads, "--json"});
    EXPECT_EQ(result.status, 2);
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    return result.err;
  };
  EXPECT_THAT(refusal("<applied_to_body>foot</applied_to_body>"),
              HasSubstr("wrong.xml:4: ExternalForce 'cuff': applied_to_body = 'foot', must name"));
  EXPECT_THAT(refusal("<applied_to_body>ulna</applied_to_body>"),
              HasSubstr("neither force_identifier nor torque_identifier"));
  EXPECT_THAT(refusal("<applied_to_body>ulna</applied_to_body>"
                      "<force_identifier>g</force_identifier>"),
              HasSubstr("force_identifier = 'g': 0 columns of"));
  writeCuff(scratch, 0.3);
  EXPECT_THAT(refusal(aboutTheElbow),
              HasSubstr("'cuff': its data are from 0 to 0.3 s, must cover the trial's 0 to 0.4 s"));
}

}  // namespace
