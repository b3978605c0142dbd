#include "score/repaired_table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <fstream>

#include "score/discovery_score.h"

namespace hidden {
namespace {

Json readVerdict(const std::filesystem::path& folder) {
  const auto file = folder / "verdict.json";
  if (!std::filesystem::exists(file)) return {};
  std::ifstream stream(file);
  try {
    return Json::parse(stream);
  } catch (const std::exception& e) {
    throw std::runtime_error(fmt::format("{}: {}", file.string(), e.what()));
  }
}

std::string withUnit(const std::string& number, const std::string& unit) {
  return unit.empty() ? number : number + " " + unit;
}

std::string hiddenIn(const Json& label) {
  std::vector<std::string> parts;
  for (const Json& effect : label.at("effects"))
    parts.push_back(
        effect.at("id").get<std::string>() + " " +
        withUnit(fmt::format("{:g}", effect.at("amplitude").get<double>()), effect.at("unit")));
  return parts.empty() ? "nothing" : fmt::format("{}", fmt::join(parts, ", "));
}

// The word, and the amplitude of each effect that is named.
std::string foundIn(const Json& verdict) {
  if (verdict.is_null()) return "no verdict";
  std::string text = verdict.at("verdict");
  for (const Json& effect : verdict.at("effects")) {
    text += fmt::format("; {}", effect.at("id").get<std::string>());
    const Json& parameters = effect.at("parameters");
    if (parameters.empty()) continue;
    const Json& first = *parameters.begin();
    if (first.at("value").is_number() && first.at("sd").is_number())
      text += " " + withUnit(fmt::format("{:.4g} ± {:.2g}", first["value"].get<double>(),
                                         first["sd"].get<double>()),
                             first["unit"]);
  }
  const auto inClass = verdict.value("class", std::vector<std::string>{});
  if (inClass.size() > verdict["effects"].size())
    text += fmt::format(" (class {})", fmt::join(inClass, ", "));
  return text;
}

std::string share(const Json& verdict, const char* key) {
  const Json heldOut = verdict.is_null() ? Json() : verdict.at("gap").at("held_out");
  if (heldOut.is_null() || !heldOut.at(key).is_number()) return "no gap";
  return fmt::format("{:.1f} %", 100 * heldOut[key].get<double>());
}

}  // namespace

std::string repairedTable(const std::filesystem::path& labels,
                          const std::filesystem::path& verdicts,
                          const std::filesystem::path& repaired) {
  std::string text =
      "| set | hidden | found | (estimate − truth)/sd | gap closed, held out | from the nominal "
      "model | on the repaired model | s |\n|---|---|---|---|---|---|---|---|\n";
  for (const Outcome& o : readOutcomes(labels, verdicts)) {
    std::ifstream stream(labels / (o.name + ".json"));
    const Json label = Json::parse(stream), verdict = readVerdict(verdicts / o.name);
    text += fmt::format("| {} | {} | {} | {} | {} | {} | {} | {} |\n", o.name, hiddenIn(label),
                        foundIn(verdict), o.z ? fmt::format("{:.2f}", *o.z) : "–",
                        share(verdict, "gap_closed"), share(verdict, "gap_closed_from_nominal"),
                        foundIn(readVerdict(repaired / o.name)),
                        o.seconds ? fmt::format("{:.0f}", *o.seconds) : "–");
  }
  return text;
}

}  // namespace hidden
