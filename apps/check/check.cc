#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <map>
#include <utility>

#include "bio/analysis/opensim_paths.h"
#include "bio/discovery/user_effect.h"
#include "bio/model/convert_muscles.h"
#include "bio/model/units.h"
#include "bio/opensim/osim_file.h"
#include "bio/path/length_jumps.h"
#include "bio/review/model_review.h"
#include "bio/review/trial_review.h"
#include "bio/robot_description/robot_description.h"
#include "bio/tables/file_error.h"
#include "bio/tables/recorded_file.h"
#include "bio/tables/table_file.h"
#include "bio/tables/trial.h"
#include "check/recording_contents.h"
#include "command/command.h"
#include "options/set_parameters.h"
#include "options/trial_input.h"
#include "output/text.h"
#include "report/result.h"

namespace app {
namespace {

struct ReviewFinding {
  std::string file;
  std::string level;  ///< "error", "warning" or "unusual"
  std::string message;
};

struct Findings {
  std::vector<ReviewFinding> list;

  void add(const std::string& file, const std::string& level, const std::string& message) {
    const bool named = message.starts_with(file + ":");
    list.push_back({file, level, oneLine(named ? message : file + ": " + message)});
  }
  void add(const std::string& file, const bio::Remark& remark) {
    const char* level = remark.weight == bio::Weight::error     ? "error"
                        : remark.weight == bio::Weight::warning ? "warning"
                                                                : "unusual";
    add(file, level, fmt::format("{}: {}", remark.subject, remark.message));
  }
  auto count(std::string_view level) const {
    return std::count_if(list.begin(), list.end(), [&](const auto& f) { return f.level == level; });
  }
};

/// The message without the names in quotes, to see which findings are alike.
std::string patternOf(const ReviewFinding& finding) {
  std::string pattern = finding.level + finding.file;
  bool quoted = false;
  for (const char c : finding.message) {
    if (c == '\'') quoted = !quoted;
    if (!quoted) pattern += c;
  }
  return pattern;
}

/// For people: errors first, then warnings; of many findings that differ in names only, the first.
std::vector<ReviewFinding> shortened(std::vector<ReviewFinding> findings) {
  std::stable_sort(findings.begin(), findings.end(),
                   [](const ReviewFinding& a, const ReviewFinding& b) {
                     const auto rank = [](const ReviewFinding& f) {
                       return f.level == "error" ? 0 : f.level == "warning" ? 1 : 2;
                     };
                     return rank(a) < rank(b);
                   });
  std::map<std::string, int> alike;
  for (const ReviewFinding& finding : findings) ++alike[patternOf(finding)];
  std::vector<ReviewFinding> shown;
  for (ReviewFinding& finding : findings) {
    int& count = alike[patternOf(finding)];
    if (count == 0) continue;
    if (count > 1) finding.message += fmt::format(" (and {} similar findings)", count - 1);
    count = 0;
    shown.push_back(std::move(finding));
  }
  return shown;
}

bool hasExtension(const std::string& file, const char* extension) {
  return std::filesystem::path(file).extension() == extension;
}

/// URDF or MJCF by its root element; `none` for every other file.
bio::ModelFormat robotFormat(const std::string& file) {
  if (bio::isRecordedFile(file)) return bio::ModelFormat::none;
  try {
    const bio::ModelFormat format = bio::modelFormat(file);
    return format == bio::ModelFormat::openSim ? bio::ModelFormat::none : format;
  } catch (const bio::FileError&) {
    return bio::ModelFormat::none;  // whoever reads it says why
  }
}

struct CheckedFile {
  explicit CheckedFile(const std::string& file) : name(file), robot(robotFormat(file)) {}
  std::string name;
  bio::ModelFormat robot;
  bool isModel() const {
    return hasExtension(name, ".osim") || hasExtension(name, ".urdf") ||
           robot != bio::ModelFormat::none;
  }
};

/// Contents of a file, for the report.
using Contents = std::vector<ReportPart>;

/// What a robot description became: lines, for people and for summary.json.
void tellTranslation(const CheckedFile& file, const bio::Model& model, Contents& contents,
                     nlohmann::ordered_json& translations, const CommandContext& context) {
  if (file.robot == bio::ModelFormat::none) return;
  for (const std::string& line : bio::translationOf(model, file.robot)) {
    if (!context.json && !context.quiet) fmt::print("{}: {}\n", file.name, line);
    translations.push_back({{"file", file.name}, {"translated", line}});
    contents.push_back(Paragraph{line + "."});
  }
}

/// A line each; many of one muscle along one coordinate are a line with the largest.
void tellJumps(const std::string& file, const std::vector<bio::LengthJump>& jumps,
               Findings& findings) {
  constexpr std::ptrdiff_t many = 3;
  for (auto begin = jumps.begin(); begin != jumps.end();) {
    const auto end = std::find_if(begin, jumps.end(), [&](const bio::LengthJump& jump) {
      return jump.muscle != begin->muscle || jump.coordinate != begin->coordinate;
    });
    const auto add = [&](const std::string& text) {
      findings.add(file, "unusual", fmt::format("muscle '{}': {}", begin->muscle, text));
    };
    if (end - begin < many) {
      std::for_each(begin, end, [&](const bio::LengthJump& jump) { add(describe(jump)); });
    } else {
      const auto largest = std::max_element(begin, end, [](const auto& a, const auto& b) {
        return std::pair(std::abs(a.size), std::abs(a.arm)) <
               std::pair(std::abs(b.size), std::abs(b.arm));
      });
      const double unit = begin->turns ? bio::degreesPerRadian : 1;
      add(fmt::format(
          "its length or moment arm jumps {} times along {}, at {:.4g} to {:.4g} {}; "
          "most: {}",
          end - begin, begin->coordinate, unit * begin->value, unit * std::prev(end)->value,
          begin->turns ? "deg" : "m", describe(*largest)));
    }
    begin = end;
  }
}

Contents checkModel(const std::string& file, const bio::Model& model, Findings& findings) {
  for (const std::string& warning : model.warnings) findings.add(file, "warning", warning);
  for (const std::string& remark : model.remarks) findings.add(file, "unusual", remark);
  for (const bio::Remark& remark : bio::reviewModel(model)) findings.add(file, remark);
  tellJumps(file, bio::lengthJumps(model), findings);
  for (const bio::OpenSimDifference& difference : bio::openSimDifferences(model)) {
    findings.add(file, "unusual",
                 fmt::format("muscle '{}': {}", difference.muscle, describe(difference)));
  }
  std::size_t coordinates = 0;
  std::vector<std::string> prescribed;
  for (const bio::Joint& joint : model.joints) {
    coordinates += joint.coordinates.size();
    for (const bio::Coordinate& coordinate : joint.coordinates) {
      if (coordinate.isPrescribed()) prescribed.push_back(coordinate.name);
    }
  }
  std::string text = fmt::format(
      "Model “{}”: {} bodies, {} joints with {} coordinates, {} muscles, {} wrap objects.",
      model.name, model.bodies.size(), model.joints.size(), coordinates, model.muscles.size(),
      model.wrapObjects.size());
  if (!prescribed.empty()) {
    text += fmt::format(" Prescribed by functions of time: {}.", fmt::join(prescribed, ", "));
  }
  return {Section{file}, Paragraph{std::move(text)}};
}

/// Reads the trial as one of each model, so that columns are matched with muscles and coordinates.
Contents checkTrial(const std::string& file, const std::vector<bio::Model>& models,
                    Findings& findings) {
  const bio::Table table = bio::readTable(file);
  for (const bio::Model& model : models) {
    const bio::Trial trial = bio::readTrial(file, model, {.experimentalConditions = true});
    for (const std::string& warning : trial.warnings) findings.add(file, "warning", warning);
    for (const bio::Remark& remark : bio::reviewTrial(trial, model)) findings.add(file, remark);
  }
  const Eigen::VectorXd times = bio::timesOf(table);
  Table columns{"Columns", {"column", "smallest", "largest", "not measured"}, {}};
  Figure figure{.title = "All columns", .xLabel = "Time [s]", .yLabel = "Value as in the file"};
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    const auto column = table.values.col(static_cast<Eigen::Index>(i));
    columns.rows.push_back({table.columns[i],
                            numberText(column.minCoeff<Eigen::PropagateNumbers>()),
                            numberText(column.maxCoeff<Eigen::PropagateNumbers>()),
                            std::to_string(column.array().isNaN().count())});
    if (table.columns[i].starts_with("time")) continue;
    // what is measured in every other row only would be a line of gaps
    Series series{.name = table.columns[i]};
    for (Eigen::Index row = 0; row < times.size(); ++row) {
      if (!std::isfinite(column[row])) continue;
      series.x.push_back(times[row]);
      series.y.push_back(column[row]);
    }
    figure.series.push_back(std::move(series));
  }
  const Eigen::Index rows = times.size();
  const double duration = times(rows - 1) - times(0);
  return {Section{file}, Paragraph{fmt::format("{} rows over {} s.", rows, numberText(duration))},
          figure, columns};
}

Contents checkRecording(const std::string& file, Findings& findings, Summary& summary,
                        nlohmann::ordered_json& recordings, const CommandContext& context) {
  RecordingContents contents = recordingContents(file);
  for (const std::string& warning : contents.warnings) findings.add(file, "warning", warning);
  for (const std::string& remark : contents.remarks) findings.add(file, "unusual", remark);
  if (!context.json && !context.quiet) {
    for (const std::string& line : contents.lines) fmt::print("{}: {}\n", file, line);
  }
  recordings.push_back(std::move(contents.summary));
  summary.set("recordings", recordings);
  return std::move(contents.parts);
}

/// Effects of the user's own, as discover --effect reads them.
Contents checkEffects(const std::string& file, const std::vector<bio::Model>& models,
                      Findings& findings) {
  Table table{"Effects", {"id", "coordinate", "force", "parameters"}, {}};
  for (const bio::discover::UserEffect& effect : bio::discover::readUserEffects({file})) {
    for (const bio::Model& model : models)
      if (!effect.coordinate.empty() && bio::coordinateOrNull(model, effect.coordinate) == nullptr)
        findings.add(file, "error",
                     fmt::format("effect '{}': the model “{}” has no coordinate '{}'", effect.id,
                                 model.name, effect.coordinate));
    std::vector<std::string> parameters;
    for (std::size_t i = 0; i < effect.constants.size(); ++i) {
      const info::discover::Quantity& each = effect.quantities[i];
      parameters.push_back(
          fmt::format("{} = {} ± {} {}", effect.constants[i], each.nominal, each.sd, each.unit));
    }
    table.rows.push_back({effect.id, effect.coordinate.empty() ? "each" : effect.coordinate,
                          effect.expression, fmt::format("{}", fmt::join(parameters, ", "))});
  }
  return {Section{file}, std::move(table)};
}

class Check : public Command {
 public:
  About about() const override {
    return {"check", "Check models, trials and recordings, and list errors and unusual values",
            "fisherhill check models/elbow8.osim"};
  }

  void addOptions(CLI::App& options) override {
    options
        .add_option(
            "FILE", files_,
            "models (.osim, URDF or MJCF), trials (.sto, .mot, .csv), which are checked against "
            "the models, recordings (.c3d, .trc, .xdf), and effects of discover --effect (.toml)")
        ->required()
        ->check(CLI::ExistingFile)
        ->type_name("");
    addConvertMusclesOption(options, muscleClass_);
    addSetOption(options, numbers_.set);
  }

  ExitStatus run(const CommandContext& context) override {
    OutputFolder folder(context, {});
    Summary summary(context);
    Report report;
    Findings findings;
    for (const std::string& file : files_) summary.addInput(file);

    // Models first: a trial is checked against all of them.
    std::vector<bio::Model> models;
    std::vector<std::string> modelFiles;
    nlohmann::ordered_json recordings = nlohmann::ordered_json::array(), translations = recordings;
    const std::vector<CheckedFile> all(files_.begin(), files_.end());
    const auto checkAll = [&](bool areModels) {
      for (const CheckedFile& each : all) {
        if (each.isModel() != areModels) continue;
        const std::string& file = each.name;
        try {
          if (areModels) {
            bio::Model model = bio::readOsim(file);
            convert(file, model, findings);
            models.push_back(withSetInWholeModel(std::move(model), numbers_, summary));
            modelFiles.push_back(file);
          }
          Contents contents = areModels ? checkModel(file, models.back(), findings)
                              : hasExtension(file, ".toml") ? checkEffects(file, models, findings)
                              : bio::isRecordedFile(file)
                                  ? checkRecording(file, findings, summary, recordings, context)
                                  : checkTrial(file, models, findings);
          if (areModels) tellTranslation(each, models.back(), contents, translations, context);
          report.details.insert(report.details.end(), contents.begin(), contents.end());
        } catch (const bio::FileError& error) {
          findings.add(file, "error", error.what());
        }
      }
    };
    checkAll(true);
    if (!numbers_.set.empty() && models.empty())
      throw std::invalid_argument("--set: there is no model among the files, must be one");
    checkAll(false);
    std::vector<std::string> limited;
    for (std::size_t i = 0; i < models.size(); ++i) {
      const std::string why = bio::whyNotSimulated(models[i]);
      if (!why.empty()) limited.push_back(fmt::format("{} ({})", modelFiles[i], why));
    }
    summary.set("not_simulated", limited);
    if (!translations.empty()) summary.set("robot_descriptions", translations);
    tell(context, findings, limited, summary, report);
    deliver(context, summary, report, folder);
    return findings.count("error") == 0 ? ExitStatus::done : ExitStatus::answerIsNo;
  }

 private:
  /// Takes the muscles as of another class; what they lose is a warning.
  void convert(const std::string& file, bio::Model& model, Findings& findings) const {
    if (muscleClass_.empty()) return;
    for (const std::string& lost : bio::convertMuscles(model, muscleClass_).lost) {
      findings.add(file, "warning", fmt::format("muscles as {}: lost is {}", muscleClass_, lost));
    }
  }

  void tell(const CommandContext& context, const Findings& findings,
            const std::vector<std::string>& limited, Summary& summary, Report& report) const {
    report.title = fmt::format("Check of {}", fmt::join(files_, ", "));
    const auto errors = findings.count("error");
    report.verdict =
        errors > 0         ? fmt::format("{} cannot be used as it stands.",
                                 errors == 1 ? "One file" : fmt::format("{} files", errors))
                : !limited.empty() ? fmt::format(
                                         "Every file can be read, but these models cannot be simulated: "
                                                 "{}; moment-arms and render work with them.",
                                         fmt::join(limited, ", "))
        : findings.list.empty() ? "No errors and nothing unusual."
                                : "Every file can be used; unusual values are listed.";
    summary.set("errors", errors);
    summary.set("warnings_found", findings.count("warning"));
    summary.set("unusual", findings.count("unusual"));
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const ReviewFinding& finding : findings.list) {
      list.push_back(
          {{"file", finding.file}, {"level", finding.level}, {"message", finding.message}});
    }
    summary.set("findings", list);

    Table table{"Findings", {"kind", "finding"}, {}};
    for (const ReviewFinding& finding : shortened(findings.list)) {
      table.rows.push_back({finding.level, finding.message});
      if (!context.json) fmt::print("{}: {}\n", finding.level, finding.message);
    }
    if (!table.rows.empty()) report.details.insert(report.details.begin(), table);
  }

  std::vector<std::string> files_;
  std::string muscleClass_;    ///< empty: as in the model
  SimulationOptions numbers_;  ///< --set alone, for every model
};

}  // namespace

/// `fisherhill check FILE…`: reads models and trials and lists errors and unusual values. Status 0:
/// no error (warnings are possible); 1: a file has an error; 2: wrong use, or a file that does not
/// exist.
std::unique_ptr<Command> checkCommand() {
  return std::make_unique<Check>();
}

}  // namespace app
