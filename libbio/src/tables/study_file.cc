#include "bio/tables/study_file.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <set>

#include "tables/toml_table.h"

namespace bio {
namespace {

namespace fs = std::filesystem;

bool isPlainName(const std::string& name) {
  return !name.empty() && name.front() != '.' && name.size() <= 100 &&
         std::all_of(name.begin(), name.end(), [](unsigned char c) {
           return std::isalnum(c) || c == '.' || c == '_' || c == '-';
         });
}

/// Reads subjects whose paths are relative to a folder.
class SubjectReader {
 public:
  explicit SubjectReader(fs::path folder) : folder_(std::move(folder)) {}

  StudySubject read(TomlTable& table) {
    StudySubject subject;
    subject.name = table.required("name", table.text("name"));
    if (!isPlainName(subject.name)) {
      table.fail("name", "must be letters, digits, '.', '_' and '-' and not begin with '.'");
    }
    if (!names_.insert(subject.name).second) table.fail("name", "is given twice");
    (void)table.required("model", table.text("model"));
    subject.model = paths(table, "model", {*table.text("model")}).front();
    subject.train = paths(table, "train", table.texts("train"));
    subject.heldOut = paths(table, "hold_out", table.texts("hold_out"));
    subject.sets = table.texts("set");
    bool hasTraining = !subject.train.empty();
    for (TomlTable& one : table.tables("recording")) {
      StudyRecording recording;
      recording.file = paths(one, "file", {one.required("file", one.text("file"))}).front();
      recording.config = paths(one, "config", {one.required("config", one.text("config"))}).front();
      recording.isHeldOut = one.word("role", {"train", "hold_out"}).value_or("train") == "hold_out";
      hasTraining = hasTraining || !recording.isHeldOut;
      one.finish();
      subject.recordings.push_back(std::move(recording));
    }
    if (!hasTraining)
      table.fail("name", "needs a trial to train on: train or [[subject.recording]]");
    table.finish();
    return subject;
  }

 private:
  std::vector<std::string> paths(const TomlTable& table, const char* key,
                                 const std::vector<std::string>& files) const {
    std::vector<std::string> found;
    for (const std::string& file : files) {
      const fs::path path = fs::path(file).is_absolute() ? fs::path(file) : folder_ / file;
      std::error_code none;
      if (!fs::is_regular_file(path, none)) table.fail(key, "'" + path.string() + "' is no file");
      found.push_back(path.lexically_normal().string());
    }
    return found;
  }

  fs::path folder_;
  std::set<std::string> names_;
};

}  // namespace

StudyFile readStudy(const std::string& file) {
  TomlTable table = TomlTable::read(file);
  StudyFile study;
  study.file = file;
  study.title = table.text("title").value_or("");
  study.parameters = table.texts("parameters");
  study.ownStart = table.flag("own_start").value_or(study.ownStart);
  study.priors = table.flag("priors").value_or(study.priors);
  const auto positive = [](double value) { return value > 0; };
  study.noise_deg = table.number("noise_deg", positive, "must be > 0");
  study.step_s = table.number("step_s", positive, "must be > 0");
  study.starts = table.integer("starts").value_or(study.starts);
  if (study.starts < 1 || study.starts > 1000) table.fail("starts", "must be 1 to 1000");
  study.discover = table.flag("discover").value_or(study.discover);
  study.maxEffects = table.integer("max_effects").value_or(study.maxEffects);
  if (study.maxEffects < 1 || study.maxEffects > 3) table.fail("max_effects", "must be 1 to 3");
  study.without = table.texts("without");
  study.coordinates = table.texts("coordinates");
  study.locks = table.texts("lock");
  study.sets = table.texts("set");
  SubjectReader reader(fs::path(file).parent_path());
  std::vector<TomlTable> subjects = table.tables("subject");
  table.finish();
  (void)table.required("subject", subjects.empty() ? std::optional<int>() : std::optional<int>(1));
  for (TomlTable& subject : subjects) study.subjects.push_back(reader.read(subject));
  if (!study.discover) {
    (void)table.required("parameters",
                         study.parameters.empty() ? std::optional<int>() : std::optional<int>(1));
  }
  return study;
}

}  // namespace bio
