#include <fmt/format.h>

#include <cmath>
#include <map>
#include <ostream>

#include "bio/analysis/muscle_states.h"
#include "command/command.h"
#include "output/text.h"
#include "report/result.h"

namespace app {
namespace {

class MuscleStates : public Command {
 public:
  About about() const override {
    return {"muscle-states", "Evaluate muscle laws for given states, class by class",
            "fisherhill muscle-states models/muscle_states.csv --out out/muscle-states"};
  }

  void addOptions(CLI::App& options) override {
    options
        .add_option("FILE", file_,
                    "table (.csv) with class, max_isometric_force, optimal_fiber_length, "
                    "tendon_slack_length, pennation, max_contraction_velocity, activation, "
                    "fiber_length, path_length and path_speed")
        ->required()
        ->check(CLI::ExistingFile)
        ->type_name("");
  }

  ExitStatus run(const CommandContext& context) override {
    OutputFolder folder(context, {"muscle_states.csv"});
    Summary summary(context);
    summary.addInput(file_);
    const std::vector<bio::MuscleState> states = bio::muscleStates(file_);
    folder.write("muscle_states.csv", [&](std::ostream& out) {
      out << "class,fiber_velocity,tendon_force,static_fiber_length,static_tendon_force\n";
      for (const bio::MuscleState& state : states) {
        out << state.className << ',' << cellText(state.fibreVelocity) << ','
            << cellText(state.tendonForce) << ',' << cellText(state.staticFibreLength) << ','
            << cellText(state.staticTendonForce) << '\n';
      }
    });
    nlohmann::ordered_json classes = nlohmann::ordered_json::object();
    std::size_t without = 0;
    for (const bio::MuscleState& state : states) {
      classes[state.className] = classes.value(state.className, 0) + 1;
      if (!std::isfinite(state.staticFibreLength)) ++without;
    }
    summary.set("states", states.size());
    summary.set("states_by_class", classes);
    summary.set("states_without_rest", without);
    Report report;
    report.title = fmt::format("Muscle states of {}", file_);
    report.verdict = fmt::format("{} states of {} muscle {}.", states.size(), classes.size(),
                                 classes.size() == 1 ? "class" : "classes");
    if (without > 0)
      report.verdict += fmt::format(
          " In {} of them no fibre length balances the tendon, so there is no static state.",
          without);
    Table table{"", {"class", "states"}, {}};
    for (const auto& [name, number] : classes.items())
      table.rows.push_back({name, std::to_string(number.get<int>())});
    report.details.push_back(table);
    deliver(context, summary, report, folder);
    return ExitStatus::done;
  }

 private:
  std::string file_;
};

}  // namespace

/// `muscle-states`: what the muscle laws give for rows of class, parameters and state.
std::unique_ptr<Command> muscleStatesCommand() {
  return std::make_unique<MuscleStates>();
}

}  // namespace app
