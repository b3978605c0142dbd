#include "discover/discover_results.h"

#include "calibrate/fitted_table.h"
#include "discover/discover_report.h"
#include "output/interruption.h"
#include "output/json_text.h"
#include "report/result.h"

namespace app {

using info::discover::Stage;

nlohmann::ordered_json writeFindings(const DiscoverFindings& findings, Summary& summary,
                                     OutputFolder& folder) {
  tellFindings(findings, summary);
  const nlohmann::ordered_json json = verdictJson(findings);
  folder.write("verdict.json", [&](std::ostream& out) { out << jsonText(json, 2) << '\n'; });
  if (!findings.fitted.empty())
    folder.write("parameters.csv", [&](std::ostream& out) { writeFitted(findings.fitted, out); });
  return json;
}

ExitStatus deliverFindings(const DiscoverFindings& findings, const WatchedSearch& watch,
                           const CommandContext& context, Summary& summary, OutputFolder& folder) {
  deliver(context, summary, discoverReport(findings), folder);
  if (watch.wasInterrupted()) throw Interrupted{};
  const bool isAnswer = findings.verdict.finding != info::discover::Finding::numerical &&
                        !(watch.ranOutOfTime() && findings.verdict.reached != Stage::finished);
  return isAnswer ? ExitStatus::done : ExitStatus::answerIsNo;
}

}  // namespace app
