#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace hidden {

using Json = nlohmann::ordered_json;

/// What one verdict is worth beside the truth. Declared equivalents count as the truth.
struct Outcome {
  std::string name;   ///< of the data set
  std::string suite;  ///< of its label
  /// "null", "single", "parameter", …: what the suite hides, or of far and violated the label says
  std::string hides;
  std::string violation;  ///< its id; empty but in suite violated
  std::vector<std::string> truth;
  double size = 1, emgNoise = 0;
  bool hasVerdict = false;  ///< false: none was given, which counts as wrong everywhere
  std::string verdict;      ///< the word
  std::vector<std::string> named, inClass;
  bool claims = false;          ///< says that something is missing or wrong
  bool namesStructure = false;  ///< its first name is no parameter and no equivalent of the truth
  bool firstIsRight = false;    ///< its first name is a truth; "unknown" names nothing
  bool classHasTruth = false;   ///< a truth is among names and class
  bool allNamed = false;        ///< every truth is among the names
  bool detectable = true;       ///< not too small to be seen by what the verdict says
  /// Amplitude over the least that would have shown, five deviations: of what was named by its own
  /// deviation, of the rest by `undetectable_below`; of the least visible truth
  std::optional<double> visibility;
  bool confident = false;      ///< first name's probability ≥ 0.95
  bool asClass = false;        ///< a truth is named in one class with a declared equivalent
  bool uniquelyRight = false;  ///< "named", and the truth itself is the only name, without a rival
  /// of the first name, where it is a claim of "named", "ambiguous" or "parameter"
  std::optional<double> probability;
  bool firstIsTrue = false;  ///< the first name is the truth itself, no equivalent
  /// "named" or "parameter", none of its names has a rival, and it has a probability
  bool unqualified = false;
  std::optional<double> z;  ///< (estimate − truth)/sd of the first right name's amplitude
  std::optional<double> gapClosed, overFloor, expectedOverFloor, seconds;

  bool confidentlyWrong() const { return confident && claims && !classHasTruth; }
};

/// @param verdict  null if there is none; @throws nlohmann::json::exception for a broken label or
///   a verdict without its word
Outcome judge(const std::string& name, const Json& label, const Json& verdict);

/// Reads every NAME.json of a folder of labels and NAME/verdict.json (or NAME.json) of a folder of
/// verdicts. Run times come from `processor_s` of the
/// verdict, else from `wall_s`, else from that of summary.json beside it.
/// @throws std::runtime_error naming the file that cannot be read, or if there is no label
std::vector<Outcome> readOutcomes(const std::filesystem::path& labels,
                                  const std::filesystem::path& verdicts);

}  // namespace hidden
