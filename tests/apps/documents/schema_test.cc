#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>
#include <sstream>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validation_results.hpp>
#include <valijson/validator.hpp>

#include "robots/hidden_robots.h"
#include "support/run_program.h"
#include "support/scratch_folder.h"
#include "support/shipped_files.h"

// What every command writes has the form that docs/schemas describes.
namespace {

using nlohmann::json;
using support::contentOf;
using support::model;
using support::ProgramResult;
using support::runFisherHill;
using support::ScratchFolder;
using support::slow;
using testing::HasSubstr;

const std::string sourceTree = FISHERHILL_SOURCE_DIR;

/// A schema of docs/schemas, "summary" or "verdict".
class Schema {
 public:
  explicit Schema(const std::string& name)
      : text_(json::parse(contentOf(sourceTree + "/docs/schemas/" + name + ".schema.json"))) {
    valijson::SchemaParser parser(valijson::SchemaParser::kDraft7);
    parser.populateSchema(Adapter(text_), schema_);
  }

  const json& text() const { return text_; }

  /// What a document breaks; empty: nothing.
  std::string errorsOf(const json& document) const {
    valijson::Validator validator(valijson::Validator::kStrongTypes);
    valijson::ValidationResults results;
    if (validator.validate(schema_, Adapter(document), &results)) return {};
    std::string errors = "not valid\n";
    for (const auto& error : results) {
      for (const std::string& place : error.context) errors += place;
      errors += ": " + error.description + "\n";
    }
    return errors;
  }

 private:
  using Adapter = valijson::adapters::NlohmannJsonAdapter;
  json text_;
  valijson::Schema schema_;
};

const Schema& summarySchema() {
  static const Schema schema("summary");
  return schema;
}

const Schema& verdictSchema() {
  static const Schema schema("verdict");
  return schema;
}

/// Every key that a document may not lack, at its top: without it, with a value of a wrong type,
/// and with another name it is refused.
void expectEachKeyToBeHeld(const Schema& schema, const json& document,
                           const std::vector<std::string>& keys) {
  for (const std::string& key : keys) {
    ASSERT_TRUE(document.contains(key)) << key;
    json changed = document;
    changed.erase(key);
    EXPECT_NE(schema.errorsOf(changed), "") << "without " << key;
    changed["another_" + key] = document[key];
    EXPECT_NE(schema.errorsOf(changed), "") << key << " renamed";
    changed = document;
    changed[key] = json::array({json::object()});
    EXPECT_NE(schema.errorsOf(changed), "") << key << " of a wrong type";
  }
  json more = document;
  more["no_such_key"] = 1;
  EXPECT_NE(schema.errorsOf(more), "");
}

// --- summary.json

struct Run {
  std::string name;  ///< of the test
  std::vector<std::string> arguments;
};

void PrintTo(const Run& run, std::ostream* out) {
  *out << run.name;
}

class SummarySchema : public testing::TestWithParam<Run> {};

TEST_P(SummarySchema, HoldsWhatIsPrinted) {
  std::vector<std::string> arguments = GetParam().arguments;
  arguments.push_back("--json");
  const ProgramResult result = runFisherHill(arguments);
  ASSERT_LE(result.status, 1) << result.err;
  EXPECT_EQ(summarySchema().errorsOf(json::parse(result.out)), "") << result.out;
}

const std::string raw = "emg_data/curl_slow_raw.csv";
const Run runs[] = {
    {"Calibrate",
     {"calibrate", model, slow, "--hold-out", "emg_data/curl_fast.sto", "--parameters",
      "hand.mass"}},
    {"CalibrateWithAllIntervals",
     {"calibrate", model, slow, "--parameters", "TRI.radius,hand.mass", "--profile", "hand.mass",
      "--bootstrap", "20", "--starts", "2"}},
    {"Check", {"check", model, slow}},
    {"CheckOfWhatIsNoModel", {"check", "README.md"}},
    {"Compare", {"compare", model, slow, "--integrators", "vi", "--steps", "0.01"}},
    {"CompareOfMuscles", {"compare", model, slow, "--muscles", "Thelen2003"}},
    {"Design",
     {"design", model, slow, "--parameters", "TRI.radius", "--candidates", "4", "--generations",
      "1"}},
    {"DesignThatSeparates",
     {"design", model, slow, "--separate", "delay,clock", "--candidates", "4", "--generations",
      "1"}},
    {"Emg", {"emg", raw, "--config", "emg_data/configs/shipped_raw.toml"}},
    {"Ensemble", {"ensemble", model, slow, "--parameters", "TRI.radius", "--draws", "4"}},
    {"EnsembleWithSobolIndices",
     {"ensemble", model, slow, "--parameters", "TRI.radius,hand.mass", "--draws", "4", "--sobol"}},
    {"EnsembleOfChannels",
     {"ensemble", model, slow, "--coordinate", "elbow_flexion", "--coordinate", "shoulder_elv",
      "--observe", "elbow_flexion,BRA.activation", "--sobol", "--parameters", "hand.mass",
      "--draws", "2"}},
    {"EnsembleOfAMoment",
     {"ensemble", model, slow, "--prescribe", "elbow_flexion", "--observe", "elbow_flexion.moment",
      "--draws", "4"}},
    {"MomentArms", {"moment-arms", model, "--points", "21"}},
    {"MomentArmsFitted", {"moment-arms", model, "--fit"}},
    {"MomentArmsInPostures", {"moment-arms", model, "--postures", "models/elbow8_postures.csv"}},
    {"MuscleStates", {"muscle-states", "models/muscle_states.csv"}},
    {"Replay", {"replay", model, slow}},
    {"ReplayThatFails", {"replay", model, slow, "--integrator", "rk4", "--step", "0.02"}},
    {"ReplayOfOneStep", {"replay", model, slow, "--step", "4.5"}},
    {"RobotInformation", {"robot", "double-pendulum", "--bound-only"}},
    {"RobotUndetermined",
     {"robot", "double-pendulum", "--bound-only", "--unknown", "m1,m2", "--undamped"}},
    {"RobotDoublePendulum",
     {"robot", "double-pendulum", "--discrete", "--iterations", "1", "--trials", "4"}},
    {"RobotSuspendedMass", {"robot", "suspended-mass", "--iterations", "1", "--lab"}},
    {"RobotConvergence", {"robot", "suspended-mass", "--convergence"}},
    {"RobotBaxter", {"robot", "baxter", "--duration", "1", "--initial-length", "0.3"}},
    {"RobotBaxterThatRests", {"robot", "baxter", "--tracking-weight", "0"}},
    {"Sensitivity", {"sensitivity", model, slow, "--parameters", "TRI.radius,hand.mass"}},
    {"SensitivityWithASweep",
     {"sensitivity", model, slow, "--parameter", "TRI.radius", "--values", "0.015,0.016"}},
    {"CalibrateWithSet",
     {"calibrate", model, slow, "--parameters", "hand.mass", "--set", "TRI.radius=0.017"}},
    {"CheckWithSet", {"check", model, "--set", "TRI.radius=0.017"}},
    {"DesignWithSet",
     {"design", model, slow, "--parameters", "TRI.radius", "--candidates", "4", "--generations",
      "1", "--set", "TRI.radius=0.017"}},
    {"MomentArmsWithSet", {"moment-arms", model, "--points", "3", "--set", "TRI.radius=0.017"}},
    {"ReplayWithSet", {"replay", model, slow, "--set", "TRIlong.pennation=10deg"}},
};

INSTANTIATE_TEST_SUITE_P(Commands, SummarySchema, testing::ValuesIn(runs),
                         [](const auto& run) { return run.param.name; });

#ifdef FISHERHILL_HAS_VIEW
TEST(SummarySchemaOfRender, HoldsWhatIsWritten) {
  const ScratchFolder scratch;
  const std::string motion = (scratch / "motion").string(), out = (scratch / "out").string();
  ASSERT_EQ(runFisherHill({"replay", model, slow, "--out", motion}).status, 0);
  const ProgramResult result =
      runFisherHill({"render", model, motion + "/states.sto", "--size", "160x120", "--out", out});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(summarySchema().errorsOf(json::parse(contentOf(out + "/summary.json"))), "");
}
#endif

TEST(SummarySchemaOfStudy, HoldsWhatIsWritten) {
  const ScratchFolder scratch;
  const std::string out = (scratch / "out").string();
  const std::string source = FISHERHILL_SOURCE_DIR;
  scratch.file("study.toml", "parameters = [\"hand.mass\"]\n[[subject]]\nname = \"a\"\nmodel = \"" +
                                 source + "/models/elbow8.osim\"\ntrain = \"" + source +
                                 "/emg_data/curl_fast.sto\"\n");
  const ProgramResult result =
      runFisherHill({"study", "run", (scratch / "study.toml").string(), "--out", out});
  ASSERT_LE(result.status, 1) << result.err;
  EXPECT_EQ(summarySchema().errorsOf(json::parse(contentOf(out + "/summary.json"))), "");
}

TEST(SummarySchemas, DescribeEverySubcommand) {
  const json& schemas = summarySchema().text()["definitions"];
  const json& known = schemas["common"]["properties"]["subcommand"]["enum"];
  const std::string help = runFisherHill({"--help"}).out;
  std::istringstream text(help.substr(help.find("Subcommands:")));
  std::string line;
  std::getline(text, line);
  std::size_t subcommands = 0;
  while (std::getline(text, line) && line.starts_with("  ")) {
    if (line.starts_with("   ")) continue;
    const std::string name = line.substr(2, line.find(' ', 2) - 2);
    EXPECT_NE(std::find(known.begin(), known.end(), name), known.end()) << name;
    EXPECT_TRUE(schemas.contains(name)) << name;
    ++subcommands;
  }
  EXPECT_EQ(subcommands, known.size());
}

TEST(SummarySchemas, RefuseWhatLacksAKeyHasOneMoreOrAWrongType) {
  const ProgramResult result = runFisherHill({"replay", model, slow, "--json"});
  const json summary = json::parse(result.out);
  ASSERT_EQ(summarySchema().errorsOf(summary), "");
  expectEachKeyToBeHeld(
      summarySchema(), summary,
      {"program", "version", "subcommand", "command_line", "inputs", "seed", "warnings", "files",
       "integrator", "step_s", "status", "steps", "newton_iterations_per_step", "halved_steps",
       "final_time_s", "energy_error_J"});
  json changed = summary;
  changed["inputs"][0]["sha256"] = "abc";
  EXPECT_NE(summarySchema().errorsOf(changed), "");
  changed = summary;
  changed["rms_error_deg"] = "12";
  EXPECT_NE(summarySchema().errorsOf(changed), "");
  changed = summary;
  changed["subcommand"] = "moment-arms";  // whose figures are others
  EXPECT_NE(summarySchema().errorsOf(changed), "");
}

// --- verdict.json

/// Checks both files of a result, and returns the verdict.
json checkedVerdict(const std::string& folder) {
  const std::string summary = contentOf(folder + "/summary.json");
  const std::string verdict = contentOf(folder + "/verdict.json");
  EXPECT_EQ(summarySchema().errorsOf(json::parse(summary)), "") << summary;
  EXPECT_EQ(verdictSchema().errorsOf(json::parse(verdict)), "") << verdict;
  return json::parse(verdict);
}

TEST(VerdictSchema, HoldsWhatIsFoundInAnArmAndNothingElse) {
  const ScratchFolder scratch;
  const std::string out = (scratch / "out").string();
  const ProgramResult result =
      runFisherHill({"discover", model, "emg_data/hidden_a/train_1.sto", "--max-effects", "1",
                     "--noise-deg", "0.5", "--out", out});
  ASSERT_EQ(result.status, 0) << result.err;
  const json verdict = checkedVerdict(out);
  std::vector<std::string> required = verdictSchema().text()["required"];
  EXPECT_GT(required.size(), 20u);
  expectEachKeyToBeHeld(verdictSchema(), verdict, required);
  for (const char* pointer :
       {"/effects/0", "/gap/train", "/innovations/after", "/trials/0", "/trials/0/start",
        "/fitted_parameters/0", "/samples", "/evidence/0", "/localisation"}) {
    json changed = verdict;
    json& part = changed.at(json::json_pointer(pointer));
    part["no_such_key"] = 1;
    EXPECT_NE(verdictSchema().errorsOf(changed), "") << pointer << " with one key more";
    part.erase("no_such_key");
    ASSERT_EQ(verdictSchema().errorsOf(changed), "");
    part.erase(std::prev(part.end()));
    EXPECT_NE(verdictSchema().errorsOf(changed), "") << pointer << " with one key less";
  }
  json changed = verdict;
  changed["effects"][0]["probability"] = "high";
  EXPECT_NE(verdictSchema().errorsOf(changed), "");
  changed = verdict;
  changed["verdict"] = "perhaps";
  EXPECT_THAT(verdictSchema().errorsOf(changed), HasSubstr("verdict"));
}

// Several outputs, of several units; and a moment alone, of a prescribed motion.
TEST(VerdictSchema, HoldsWhatIsFoundInSeveralOutputsAndInAMoment) {
  const ScratchFolder scratch;
  std::string both = "time,TA,ankle_angle,ankle_angle.speed\n", moment =
                                                                    "time,TA,ankle_angle,"
                                                                    "ankle_angle.moment\n";
  for (int k = 0; k <= 100; ++k) {
    const double t = 0.01 * k, u = 0.1 + 0.1 * std::sin(5 * t), q = -0.3 + 0.1 * std::sin(4 * t);
    const std::string row = fmt::format("{},{},{},", t, u, q);
    both += row + fmt::format("{}\n", 0.4 * std::cos(4 * t));
    moment += row + fmt::format("{}\n", 3 + std::sin(5 * t));
  }
  const std::string ankle = sourceTree + "/models/ankle_ta.osim";
  const std::string out = (scratch / "out").string();
  const auto verdictOf = [&](const std::string& trial, const std::vector<std::string>& more) {
    std::vector<std::string> words = {
        "discover", ankle,    scratch.file("trial.csv", trial), "--max-effects", "1", "--out",
        out,        "--force"};
    words.insert(words.end(), more.begin(), more.end());
    const ProgramResult result = runFisherHill(words);
    EXPECT_LE(result.status, 1) << result.err;
    return checkedVerdict(out);
  };
  json verdict = verdictOf(both, {"--noise", "ankle_angle=1", "--noise", "ankle_angle.speed=0.05"});
  EXPECT_EQ(verdict["outputs"].size(), 2u);
  EXPECT_TRUE(verdict["gap"]["train"].contains("rmse_after_sd"));
  for (const char* pointer : {"/outputs/0", "/gap/train", "/trials/0"}) {
    json changed = verdict;
    changed.at(json::json_pointer(pointer))["no_such_key"] = 1;
    EXPECT_NE(verdictSchema().errorsOf(changed), "") << pointer;
  }
  verdict = verdictOf(moment, {"--prescribe", "ankle_angle", "--noise", "ankle_angle.moment=0.3"});
  EXPECT_TRUE(verdict["gap"]["train"].contains("rmse_after_Nm"));
  EXPECT_EQ(verdict["trials"][0]["starts"].size(), 0u);
}

TEST(VerdictSchema, HoldsWhatIsFoundInARobot) {
  const ScratchFolder scratch;
  hidden::RobotPlan plan;
  plan.system = "suspended-mass";
  plan.seed = 10000;
  plan.effects = {"bias"};
  hidden::RobotDataSet set = hidden::makeRobotDataSet(plan);
  hidden::writeRobotDataSet(set, hidden::robotKind(plan.system), scratch / "set",
                            scratch / "labels");
  const std::string out = (scratch / "out").string();
  const ProgramResult result = runFisherHill(
      {"discover", "--system", plan.system, (scratch / "set/train_1.sto").string(), "--hold-out",
       (scratch / "set/held_out.sto").string(), "--max-effects", "1", "--out", out});
  ASSERT_LE(result.status, 1) << result.err;
  const json verdict = checkedVerdict(out);
  EXPECT_TRUE(verdict["gap"]["held_out"].contains("rmse_after_N"));
  EXPECT_TRUE(verdict["localisation"].contains("inputs"));
}

TEST(SummarySchemaOfIndex, HoldsWhatIsPrinted) {
  const ScratchFolder scratch;
  ASSERT_EQ(runFisherHill({"replay", model, slow, "--out", (scratch / "a").string()}).status, 0);
  const ProgramResult result = runFisherHill({"index", scratch.path().string(), "--json"});
  ASSERT_EQ(result.status, 0) << result.err;
  const json document = json::parse(result.out);
  EXPECT_EQ(summarySchema().errorsOf(document), "");
  expectEachKeyToBeHeld(summarySchema(), document, {"results", "sentence"});
}

}  // namespace
