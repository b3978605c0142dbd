#include "study/study_subject.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>

#include "command/command_line.h"
#include "output/json_text.h"
#include "output/text.h"

namespace app {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// A command that could not be carried out.
struct StageFailure {
  std::string message;
};

Json readJson(const fs::path& file) {
  std::ifstream in(file);
  return Json::parse(in);
}

/// Without what would end a cell.
std::string textCell(const std::string& text) {
  std::string cell = oneLine(text);
  std::replace(cell.begin(), cell.end(), ',', ';');
  std::replace(cell.begin(), cell.end(), '"', '\'');
  return cell;
}

class SubjectRun {
 public:
  SubjectRun(const bio::StudyFile& study, const bio::StudySubject& subject, const fs::path& folder,
             const CommandContext& context, const CommandList& commands)
      : study_(study), subject_(subject), folder_(folder), context_(context), commands_(commands) {}

  std::string row() {
    try {
      makeTrials();
      if (!study_.parameters.empty()) calibrate();
      if (study_.discover) discover();
    } catch (const StageFailure& failure) {
      status_ = "failed";
      message_ = failure.message;
    }
    const auto figure = [&](const char* key) {
      return calibration_.contains(key) ? numberCell(calibration_[key]) : std::string();
    };
    const auto verdict = [&](const char* key) {
      return verdict_.is_object() ? textCell(verdict_[key].get<std::string>()) : std::string();
    };
    return fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{}", subject_.name, status_,
                       figure("rmse_train_before_deg"), figure("rmse_train_deg"),
                       figure("rmse_held_out_before_deg"), figure("rmse_held_out_deg"),
                       figure("noise_deg"), identifiable(), verdict("verdict"), effects(),
                       probability(), verdict("sentence"), textCell(message_));
  }

 private:
  /// Runs a command of the program as a part of this one.
  Json run(const std::string& stage, std::vector<std::string> words, const char* result) {
    const fs::path out = folder_ / stage;
    words.insert(words.begin(), "fisherhill");
    for (const std::string& word :
         {std::string("--out"), out.string(), std::string("--force"), std::string("--threads"),
          std::string("1"), std::string("--seed"), std::to_string(context_.seed)}) {
      words.push_back(word);
    }
    try {
      CommandLine line(commands_());
      const CommandLine::Chosen chosen = line.parse(words);
      CommandContext context = *chosen.context;
      context.quiet = true;
      fs::remove(out / result);  // of an earlier run
      const ExitStatus status = chosen.command->run(context);
      if (status == ExitStatus::answerIsNo && !fs::exists(out / result))
        throw StageFailure{stage + ": no result"};
      return readJson(out / result);
    } catch (const std::exception& error) {
      throw StageFailure{stage + ": " + error.what()};
    }
  }

  void makeTrials() {
    train_ = subject_.train;
    heldOut_ = subject_.heldOut;
    for (std::size_t i = 0; i < subject_.recordings.size(); ++i) {
      const bio::StudyRecording& recording = subject_.recordings[i];
      const std::string stage = fmt::format("emg_{}", i + 1);
      run(stage, {"emg", recording.file, "--config", recording.config}, "summary.json");
      (recording.isHeldOut ? heldOut_ : train_)
          .push_back((folder_ / stage / "excitations.sto").string());
    }
  }

  /// MODEL, trials and what both searches share.
  std::vector<std::string> words(const std::string& command) const {
    std::vector<std::string> all = {command, subject_.model};
    all.insert(all.end(), train_.begin(), train_.end());
    const auto add = [&](const char* option, const std::vector<std::string>& values) {
      for (const std::string& value : values) {
        all.emplace_back(option);
        all.push_back(value);
      }
    };
    add("--hold-out", heldOut_);
    add("--coordinate", study_.coordinates);
    add("--lock", study_.locks);
    add("--set", study_.sets);
    add("--set", subject_.sets);
    if (study_.noise_deg) add("--noise-deg", {fmt::format("{:.17g}", *study_.noise_deg)});
    if (study_.step_s) add("--step", {fmt::format("{:.17g}", *study_.step_s)});
    return all;
  }

  void calibrate() {
    std::vector<std::string> all = words("calibrate");
    for (const std::string& name : study_.parameters) {
      all.emplace_back("--parameters");
      all.push_back(name);
    }
    all.emplace_back("--starts");
    all.push_back(std::to_string(study_.starts));
    if (study_.ownStart) all.emplace_back("--own-start");
    if (!study_.priors) all.emplace_back("--no-priors");
    calibration_ = run("calibrate", all, "summary.json");
    if (calibration_.at("status") == "ok") return;
    status_ = calibration_.at("status");
    message_ = calibration_.value("why", "");
  }

  void discover() {
    std::vector<std::string> all = words("discover");
    all.emplace_back("--max-effects");
    all.push_back(std::to_string(study_.maxEffects));
    for (const std::string& id : study_.without) {
      all.emplace_back("--without");
      all.push_back(id);
    }
    verdict_ = run("discover", all, "verdict.json");
  }

  /// "3 of 4"
  std::string identifiable() const {
    if (!calibration_.contains("estimates")) return "";
    std::size_t count = 0, all = 0;
    for (const auto& [name, estimate] : calibration_["estimates"].items()) {
      if (isOfATrial(name)) continue;
      ++all;
      count += estimate.at("identifiable").get<bool>() ? 1 : 0;
    }
    return fmt::format("{} of {}", count, all);
  }

  std::string effects() const {
    if (!verdict_.is_object()) return "";
    std::vector<std::string> ids;
    for (const Json& effect : verdict_["effects"]) ids.push_back(effect.at("id"));
    return fmt::format("{}", fmt::join(ids, "+"));
  }

  std::string probability() const {
    if (!verdict_.is_object() || verdict_["effects"].empty()) return "";
    return numberCell(verdict_["effects"].front().at("probability"));
  }

  const bio::StudyFile& study_;
  const bio::StudySubject& subject_;
  fs::path folder_;
  const CommandContext& context_;
  const CommandList& commands_;
  std::vector<std::string> train_, heldOut_;
  Json calibration_ = Json::object(), verdict_;
  std::string status_ = "ok", message_;
};

}  // namespace

bool isOfATrial(const std::string& parameter) {
  const auto has = [&](const char* part) { return parameter.find(part) != std::string::npos; };
  return parameter.starts_with("initial.") || has(".initial.");
}

const std::vector<std::string>& studyColumns() {
  static const std::vector<std::string> names = {"number",
                                                 "subject",
                                                 "status",
                                                 "rmse_train_before_deg",
                                                 "rmse_train_deg",
                                                 "rmse_held_out_before_deg",
                                                 "rmse_held_out_deg",
                                                 "noise_deg",
                                                 "identifiable",
                                                 "verdict",
                                                 "effects",
                                                 "probability",
                                                 "sentence",
                                                 "message"};
  return names;
}

std::string studySubject(const bio::StudyFile& study, const bio::StudySubject& subject,
                         const fs::path& folder, const CommandContext& context,
                         const CommandList& commands) {
  return SubjectRun(study, subject, folder, context, commands).row();
}

}  // namespace app
