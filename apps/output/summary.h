#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "output/command_context.h"
#include "output/methods.h"

namespace app {

/// Summary of a result: summary.json, as docs/schemas/summary.schema.json describes
/// it.
///
/// Values have plain names that end in their unit (`rms_error_deg`); an infinite or undefined value
/// becomes null, since JSON cannot express it.
class Summary {
 public:
  struct InputFile {
    std::string path;
    std::string sha256;
  };

  explicit Summary(const CommandContext& context);

  /// Adds a file that the result depends on. @throws std::runtime_error if it cannot be read
  void addInput(const std::filesystem::path& file);

  /// Adds one value: a number, text, list or object.
  void set(const std::string& name, nlohmann::ordered_json value);

  /// The simulation's own entries: integrator, step_s, duration_s, wall_s.
  void setSimulationFigures(const std::string& integrator, double step, double duration,
                            double wallTime);
  /// What the methods say of it.
  void saySimulation(const std::string& integrator, double step);
  /// Both.
  void setSimulation(const std::string& integrator, double step, double duration, double wallTime);

  /// Prints a warning on standard error and keeps it in the summary.
  void warn(const std::string& sentence);

  /// How the result was made, for the report.
  Methods& methods() { return methods_; }
  const Methods& methods() const { return methods_; }

  /// The command line, quoted for a shell.
  std::string commandLine() const;

  const std::vector<InputFile>& inputs() const { return inputs_; }
  const nlohmann::ordered_json& figures() const { return figures_; }
  const std::vector<std::string>& warnings() const { return warnings_; }

  nlohmann::ordered_json toJson() const;

 private:
  CommandContext context_;
  std::vector<InputFile> inputs_;
  nlohmann::ordered_json figures_ = nlohmann::ordered_json::object();
  std::vector<std::string> warnings_;
  Methods methods_;
};

}  // namespace app
