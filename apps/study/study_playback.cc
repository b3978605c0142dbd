#include "study/study_playback.h"

#include <fmt/format.h>

#include <exception>
#include <fstream>
#include <list>
#include <nlohmann/json.hpp>

#include "bio/analysis/replay.h"
#include "bio/opensim/osim_file.h"
#include "options/quantity.h"
#include "options/system_options.h"
#include "options/trial_input.h"
#include "playback/replayed_trials.h"

namespace app {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// The entry of `trials` in the summary of a calibration: the first held-out one, else the first.
Json chosenTrial(const fs::path& summary) {
  std::ifstream in(summary);
  const Json trials = Json::parse(in).at("trials");
  for (const Json& trial : trials)
    if (trial.at("role") == "held_out") return trial;
  return trials.at(0);
}

/// What is replayed of one subject.
struct SubjectTrial {
  bio::Model model;
  bio::Trial trial;
};

}  // namespace

std::optional<Playback> studyPlayback(
    const bio::StudyFile& study,
    const std::function<fs::path(const bio::StudySubject&)>& folderOf) {
  SimulationOptions typed;
  typed.coordinates = study.coordinates;
  for (const std::string& lock : study.locks) typed.locks.push_back(parseAssignment(lock));
  typed.step = study.step_s;
  std::list<SubjectTrial> kept;
  ReplayedTrials replayed({}, simulationOptions(typed, 0, 1));
  for (const bio::StudySubject& subject : study.subjects) {
    try {
      const fs::path folder = folderOf(subject) / "calibrate";
      const Json chosen = chosenTrial(folder / "summary.json");
      const std::string file = chosen.at("replay_file");
      SimulationOptions options = typed;
      SubjectTrial& one = kept.emplace_back();
      one.model = bio::readOsim(folder / "calibrated.osim");
      chooseCoordinates(options, one.model, {file});
      one.trial = readTrialFile(file, one.model, options, {.channels = true});
      ReplayedTrials::Setting setting;
      setting.step =
          bio::stepOf(one.model, simulationOptions(options, 0, 1).integrator, typed.step);
      for (const Json& start : chosen.at("start"))
        setting.starts.push_back(
            {"", "", start.at("coordinate"), start.at("value"), start.at("speed")});
      replayed.useOptions(systemOptions(options));
      replayed.beginTrial(
          fmt::format("{}: {}{}", subject.name, chosen.at("file").get<std::string>(),
                      chosen.at("role") == "held_out" ? " (held out)" : ""),
          one.trial);
      replayed.add("calibrated", one.model, one.trial, setting);
    } catch (const std::exception&) {
      // the subject has no result, and the table says why
    }
  }
  return replayed.playback("A trial of each subject in three dimensions");
}

}  // namespace app
