#include "study/study.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>

#include "ensemble/missing_rows.h"
#include "info/version.h"
#include "output/resumable_table.h"
#include "output/text.h"
#include "report/result.h"
#include "study/study_playback.h"
#include "study/study_report.h"
#include "study/study_subject.h"

namespace app {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// Rows of the parameters.csv of a calibration, without initial states.
void readEstimates(const std::string& subject, const fs::path& file,
                   std::vector<StudyEstimate>& all) {
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  while (std::getline(in, line)) {
    const std::vector<std::string> cells = cellsOf(line);
    if (cells.size() < 5 || isOfATrial(cells[0])) continue;
    all.push_back(
        {subject, cells[0], cells[1], numberIn(cells[2]), numberIn(cells[3]),
         cells[4].empty() ? std::numeric_limits<double>::quiet_NaN() : numberIn(cells[4])});
  }
}

class StudyCommand : public Command {
 public:
  StudyCommand(std::function<std::unique_ptr<WorkerPool>()> gather, CommandList commands)
      : gather_(std::move(gather)), commands_(std::move(commands)) {}

  About about() const override {
    return {"study", "Carry all subjects of a study from recordings to calibrated models",
            "fisherhill study run emg_data/study/study.toml --out out/study"};
  }

  void addOptions(CLI::App& options) override {
    app_ = &options;
    options.add_option("ACTION", action_, "run: compute what is not there yet")
        ->required()
        ->check(CLI::IsMember({"run"}))
        ->type_name("");
    options.add_option("STUDY", file_, "subjects, models, trials and roles (.toml)")
        ->required()
        ->check(CLI::ExistingFile)
        ->type_name("");
  }

  ExitStatus run(const CommandContext& given) override {
    if (!given.out) throw std::invalid_argument("--out is required: every subject has results");
    const std::unique_ptr<WorkerPool> pool = gather_();
    CommandContext context = given;
    context.quiet = !pool->leads();
    const int threads = app_->get_option("--threads")->count() > 0 ? context.threads
                                                                   : pool->defaultThreads(context);
    if (!pool->leads() && !pool->start()) return ExitStatus::done;
    const bio::StudyFile study = bio::readStudy(file_);
    RowWork work;
    work.rows = [&](std::span<const std::uint64_t> numbers) {  // one at a time
      const bio::StudySubject& subject = study.subjects[numbers.front()];
      return std::vector{
          studySubject(study, subject, folderOf(context, subject), context, commands_)};
    };
    if (!pool->leads()) {
      pool->work(work, threads);
      return ExitStatus::done;
    }
    OutputFolder results(mayGoOn(context), {"study.csv", "estimates.csv"});
    Summary summary(context);
    addInputs(study, summary);
    RowFile file(results.path(unfinishedRows), settings(context, summary), studyColumns(),
                 context.force);
    if (const std::string damage = damageIn(file); !damage.empty()) summary.warn(damage);
    computeMissing(*pool, threads, file, study.subjects.size(), work, context, "subjects");
    return tell(context, study, file, summary, results);
  }

 private:
  static fs::path folderOf(const CommandContext& context, const bio::StudySubject& subject) {
    return *context.out / "subjects" / subject.name;
  }

  void addInputs(const bio::StudyFile& study, Summary& summary) const {
    summary.addInput(file_);
    for (const bio::StudySubject& subject : study.subjects) {
      summary.addInput(subject.model);
      for (const auto* files : {&subject.train, &subject.heldOut})
        for (const std::string& file : *files) summary.addInput(file);
      for (const bio::StudyRecording& recording : subject.recordings) {
        summary.addInput(recording.file);
        summary.addInput(recording.config);
      }
    }
  }

  /// All that the rows depend on.
  static Json settings(const CommandContext& context, const Summary& summary) {
    Json json;
    json["program"] = "fisherhill study";
    json["version"] = info::version();
    json["seed"] = context.seed;
    json["inputs"] = Json::array();
    for (const Summary::InputFile& input : summary.inputs())
      json["inputs"].push_back({input.path, input.sha256});
    return json;
  }

  ExitStatus tell(const CommandContext& context, const bio::StudyFile& study, RowFile& file,
                  Summary& summary, OutputFolder& results) const {
    StudyFindings findings{study, {}, {}};
    for (std::size_t i = 0; i < study.subjects.size(); ++i) {
      findings.rows.push_back(cellsOf(file.row(i)));
      const bio::StudySubject& subject = study.subjects[i];
      const bool isThere = !cellOf(findings.rows.back(), "identifiable").empty();
      if (isThere)
        readEstimates(subject.name, folderOf(context, subject) / "calibrate" / "parameters.csv",
                      findings.estimates);
    }
    results.write("study.csv", [&](std::ostream& out) {
      const auto& columns = studyColumns();
      out << fmt::format("{}\n", fmt::join(columns.begin() + 1, columns.end(), ","));
      for (std::size_t i = 0; i < study.subjects.size(); ++i) out << file.row(i) << '\n';
    });
    results.write("estimates.csv", [&](std::ostream& out) {
      out << "subject,parameter,unit,model,estimate,sd\n";
      for (const StudyEstimate& estimate : findings.estimates) {
        out << fmt::format("{},{},{},{:.10g},{:.10g},{}\n", estimate.subject, estimate.name,
                           estimate.unit, estimate.nominal, estimate.estimate,
                           std::isnan(estimate.sd) ? "" : fmt::format("{:.10g}", estimate.sd));
      }
    });
    const auto statuses = countsOf(findings, "status");
    summary.set("subjects", study.subjects.size());
    summary.set("statuses", statuses);
    if (study.discover) summary.set("verdicts", countsOf(findings, "verdict"));
    for (const auto& row : findings.rows) {
      if (const std::string& message = cellOf(row, "message"); !message.empty())
        summary.warn(cellOf(row, "subject") + ": " + message);
    }
    findings.playback = studyPlayback(
        study, [&](const bio::StudySubject& subject) { return folderOf(context, subject); });
    deliver(context, summary, studyReport(findings), results);
    file.remove();
    return statuses.size() == 1 && statuses.contains("ok") ? ExitStatus::done
                                                           : ExitStatus::answerIsNo;
  }

  std::function<std::unique_ptr<WorkerPool>()> gather_;
  CommandList commands_;
  CLI::App* app_ = nullptr;
  std::string action_, file_;
};

}  // namespace

std::unique_ptr<Command> studyCommand(std::function<std::unique_ptr<WorkerPool>()> gather,
                                      CommandList commands) {
  return std::make_unique<StudyCommand>(std::move(gather), std::move(commands));
}

}  // namespace app
