#include <fmt/format.h>

#include <Eigen/Dense>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include "bio/analysis/replay.h"
#include "bio/opensim/osim_file.h"
#include "bio/review/model_review.h"
#include "bio/tables/file_error.h"
#include "bio/tables/table_file.h"
#include "mutations.h"
#include "support/scratch_folder.h"
#include "watched_child.h"

// Structured mutants of valid models: each simulates to finite numbers or ends with one line that
// names the element.
//     mutate_models COUNT SEED TRIAL MODEL…
namespace {

using robustness::Mutant;

struct Sources {
  std::string trial;
  std::vector<std::string> models;  ///< their texts
};

Mutant mutantOf(const Sources& sources, std::uint64_t seed) {
  return robustness::mutated(sources.models[seed % sources.models.size()], seed);
}

// A message has one line and names something: an element, muscle, coordinate … in quotes, a line.
std::string refusal(const char* stage, const std::string& what) {
  if (what.empty() || what.find('\n') != what.npos)
    return "finding: message not of one line: " + what;
  const bool names = what.find('\'') != what.npos || what.find(".osim:") != what.npos ||
                     what.find(".sto:") != what.npos;
  return fmt::format("{} {}: {}", names ? "refused by" : "finding: nothing is named by", stage,
                     what);
}

std::string simulated(const bio::Model& model, const std::string& trialFile) {
  bio::SystemOptions options;
  const auto& joints = model.joints;
  for (const bio::Joint& joint : joints) {
    for (const bio::Coordinate& coordinate : joint.coordinates) {
      if (coordinate.name == "elbow_flexion" || coordinate.name == "q")
        options.skeleton.freeCoordinates = {coordinate.name};
    }
  }
  if (options.skeleton.freeCoordinates.empty())
    options.skeleton.freeCoordinates = {"elbow_flexion"};
  const bio::MusculoskeletalSystem system(model, options);
  const bio::Trial trial =
      bio::readTrial(trialFile, model, {.ignoreExtra = true, .baseline = 0.01});
  const bio::ExcitationSignal excitation = excitationOf(trial, system);
  const bio::SystemState start =
      initialState(system, startCoordinates(trial, system, {}), excitation, trial.times[0]);
  bio::SimulationOptions simulation;
  simulation.startTime = trial.times[0];
  simulation.duration = 0.3;
  const bio::Trajectory t = simulate(system, excitation, start, simulation);
  const bool finite = t.q.allFinite() && t.qDot.allFinite() && t.activation.allFinite() &&
                      t.fibreLength.allFinite();
  if (!finite) return "finding: numbers that are not finite";
  if (t.outcome == bio::Outcome::completed) return "simulated";
  if (t.why.empty() || t.why.find('\n') != t.why.npos) return "finding: stops without a reason";
  return "stopped: " + t.why;
}

// The model with one force a little larger, written and read again.
std::string rewritten(const std::string& original, bio::Model model, const std::string& copy) {
  if (model.muscles.empty() || !model.muscles[0].schutte) return "";
  model.muscles[0].schutte->maxIsometricForce *= 1.01;
  try {
    rewriteOsim(original, model, copy);
  } catch (const std::invalid_argument&) {
    return "";
  }
  const bio::Model again = bio::readOsim(copy);
  const double wanted = model.muscles[0].schutte->maxIsometricForce;
  const double found = again.muscles.at(0).schutte->maxIsometricForce;
  return std::abs(found - wanted) <= 1e-12 * wanted ? "" : "finding: written with another force";
}

std::string outcomeOf(const Mutant& mutant, const std::string& trial,
                      const std::filesystem::path& folder) {
  const std::string file = (folder / "mutant.osim").string();
  std::ofstream(file, std::ios::binary) << mutant.text;
  const char* stage = "the reader";
  try {
    const bio::Model model = bio::readOsim(file);
    reviewModel(model);
    stage = "the arm";
    std::string outcome = simulated(model, trial);
    stage = "the writer";
    const std::string written = rewritten(file, model, (folder / "copy.osim").string());
    return written.empty() ? outcome : written;
  } catch (const bio::FileError& e) {
    return refusal(stage, e.what());
  } catch (const std::invalid_argument& e) {
    return refusal(stage, e.what());
  } catch (const bio::NoStaticEquilibrium& e) {
    return refusal("statics", e.what());
  } catch (const std::exception& e) {
    return fmt::format("finding: {}: {}", typeid(e).name(), e.what());
  }
}

// The trial with a column for every muscle of the models.
std::string trialOf(const std::string& file, const std::vector<std::string>& models,
                    const std::string& copy) {
  bio::Table table = bio::readTable(file);
  for (const std::string& model : models) {
    for (const bio::Muscle& muscle : bio::readOsim(model).muscles) {
      if (hasColumn(table, muscle.name)) continue;
      table.columns.push_back(muscle.name);
      table.values.conservativeResize(Eigen::NoChange, table.values.cols() + 1);
      table.values.rightCols(1) = table.values.col(1);
    }
  }
  writeTable(table, copy);
  return copy;
}

std::string contentOf(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  if (!stream) throw std::runtime_error(file + ": cannot be read");
  return text.str();
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 5) {
    fmt::print(stderr, "mutate_models COUNT SEED TRIAL MODEL…\n");
    return 2;
  }
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  const long count = std::atol(argv[1]);
  const auto first = static_cast<std::uint64_t>(std::atoll(argv[2]));
  const std::vector<std::string> models(argv + 4, argv + argc);
  const support::ScratchFolder folder;
  Sources sources{trialOf(argv[3], models, (folder / "trial.sto").string()), {}};
  for (const std::string& model : models) sources.models.push_back(contentOf(model));

  std::map<std::string, long> counts;
  long findings = 0;
  robustness::runWatched(
      count,
      [&](long i) {
        const Mutant mutant = mutantOf(sources, first + static_cast<std::uint64_t>(i));
        return outcomeOf(mutant, sources.trial, folder.path());
      },
      [&](long i, const robustness::WatchedEnd& end) {
        const std::uint64_t seed = first + static_cast<std::uint64_t>(i);
        const bool found = !end.finished || end.answer.starts_with("finding");
        const std::string kind = !end.finished ? "finding: " + end.answer
                                 : found       ? "finding"
                                               : end.answer.substr(0, end.answer.find(':'));
        ++counts[kind];
        if (!found) return;
        ++findings;
        const Mutant mutant = mutantOf(sources, seed);
        fmt::print("seed {}: {}\n  {}\n", seed, end.answer, mutant.story);
        if (const char* keep = std::getenv("KEEP"))
          std::ofstream(fmt::format("{}/{}.osim", keep, seed)) << mutant.text;
      });
  for (const std::string& name : folder.listing()) {
    if (name == "mutant.osim" || name == "copy.osim" || name == "trial.sto") continue;
    ++findings;
    fmt::print("left behind: {}\n", name);
  }
  for (const auto& [kind, times] : counts) fmt::print("{:>7}  {}\n", times, kind);
  fmt::print("{:>7}  mutants, {} findings\n", count, findings);
  return findings == 0 ? 0 : 1;
}
