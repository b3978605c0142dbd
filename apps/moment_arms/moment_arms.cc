#include "moment_arms/moment_arms.h"

#include <fmt/format.h>

#include "bio/analysis/replay.h"
#include "bio/path/length_jumps.h"
#include "options/number_rules.h"
#include "options/system_options.h"
#include "options/trial_input.h"
#include "output/angle_unit.h"
#include "output/result.h"
#include "output/text.h"

namespace app {
namespace {

class MomentArms : public Command {
 public:
  About about() const override {
    return {
        "moment-arms", "Compute muscle–tendon lengths and moment arms over a coordinate's range",
        "fisherhill moment-arms models/elbow8.osim --from 0 --to 130 --points 131 --out out/arms"};
  }

  void addOptions(CLI::App& options) override {
    addModelArgument(options, model_);
    options
        .add_option("--from", from_,
                    "first angle [deg] or, for a sliding coordinate, position [mm]; default: start "
                    "of the coordinate's range")
        ->check(finite());
    options
        .add_option("--to", to_,
                    "last angle [deg] or position [mm]; default: end of the coordinate's range")
        ->check(finite());
    options.add_option("--points", points_, "number of values, at least 2")->capture_default_str();
    addModelOptions(options, model_options_);
  }

  ExitStatus run(const CommandContext& context) override {
    OutputFolder folder(context, {"moment_arms.csv"});
    Summary summary(context);
    const bio::Model model = readModel(model_, summary);
    chooseCoordinates(model_options_, model, {});
    const bio::SkeletonOptions options = armOptions(model_options_).skeleton;
    const bio::Skeleton skeleton(model, options);
    for (const std::string& remark : lockRemarks(model, options)) summary.warn(remark);
    const bio::Coordinate& coordinate = skeleton.coordinates().front();
    const double unit = coordinate.isRotation ? degree : 1e-3;
    const double first = from_ ? *from_ : coordinate.rangeMin / unit;
    const double last = to_ ? *to_ : coordinate.rangeMax / unit;
    require(points_ >= 2 && points_ <= 1000000,
            fmt::format("--points {}, must be 2 to 1000000", points_));
    require(std::isfinite(first) && std::isfinite(last) && last > first,
            fmt::format("--from {} --to {}, must rise", numberText(first), numberText(last)));
    const Eigen::VectorXd shown = Eigen::VectorXd::LinSpaced(points_, first, last);
    const bio::PathSample sample =
        bio::samplePaths(model, skeleton, model_options_.wrapAsCylinder, shown * unit);
    for (const std::string& warning : sample.warnings) summary.warn(warning);
    for (const bio::LengthJump& jump : bio::lengthJumps(
             model, skeleton, model_options_.wrapAsCylinder, first * unit, last * unit)) {
      summary.warn(describe(jump));
    }
    require(!sample.muscles.empty(),
            fmt::format("{}: coordinate '{}' changes the length of no muscle", model_,
                        coordinate.name));

    const std::string unitName = coordinate.isRotation ? "deg" : "mm";
    folder.writeFile("moment_arms.csv", [&](const std::filesystem::path& path) {
      bio::writeTable(tableOf(sample, shown, coordinate.name + "_" + unitName), path);
    });
    summary.set("coordinate", coordinate.name);
    summary.set("points", points_);
    summary.set("muscles", sample.muscles);
    summary.set("notes", sample.notes);
    nlohmann::ordered_json ranges = nlohmann::ordered_json::object();
    for (std::size_t i = 0; i < sample.muscles.size(); ++i) {
      const auto column = sample.momentArm.col(static_cast<Eigen::Index>(i));
      ranges[sample.muscles[i]] = {{"moment_arm_min_m", column.minCoeff()},
                                   {"moment_arm_max_m", column.maxCoeff()}};
    }
    summary.set("ranges", ranges);
    deliver(context, summary, reportOn(sample, shown, coordinate, unitName), folder);
    return ExitStatus::done;
  }

 private:
  static void require(bool holds, const std::string& message) {
    if (!holds) throw std::invalid_argument(message);
  }

  static bio::Table tableOf(const bio::PathSample& sample, const Eigen::VectorXd& shown,
                            const std::string& firstColumn) {
    bio::Table table;
    table.columns = {firstColumn};
    table.values.resize(shown.size(), 1 + 4 * sample.length.cols());
    table.values.col(0) = shown;
    for (Eigen::Index i = 0; i < sample.length.cols(); ++i) {
      const std::string& muscle = sample.muscles[static_cast<std::size_t>(i)];
      for (const char* quantity :
           {"length_m", "moment_arm_m", "moment_arm_slope_m_per_rad", "wrapped"}) {
        table.columns.push_back(muscle + "." + quantity);
      }
      table.values.col(1 + 4 * i) = sample.length.col(i);
      table.values.col(2 + 4 * i) = sample.momentArm.col(i);
      table.values.col(3 + 4 * i) = sample.momentArmSlope.col(i);
      table.values.col(4 + 4 * i) = sample.wrapped.col(i).cast<double>();
    }
    return table;
  }

  Report reportOn(const bio::PathSample& sample, const Eigen::VectorXd& shown,
                  const bio::Coordinate& coordinate, const std::string& unitName) const {
    Report report;
    report.title = fmt::format("Moment arms of {} over {}", model_, coordinate.name);
    Figure arms{.title = "Moment arms", .yLabel = "Moment arm [mm]"};
    Figure lengths{.title = "Muscle–tendon lengths", .yLabel = "Length [mm]"};
    arms.xLabel = lengths.xLabel = fmt::format("{} [{}]", coordinate.name, unitName);
    arms.caption =
        fmt::format("Positive: the muscle's force tends to increase {}.", coordinate.name);
    const std::vector<double> x(shown.begin(), shown.end());
    for (std::size_t i = 0; i < sample.muscles.size(); ++i) {
      const auto c = static_cast<Eigen::Index>(i);
      const Eigen::VectorXd arm = sample.momentArm.col(c) * 1e3;
      const Eigen::VectorXd length = sample.length.col(c) * 1e3;
      arms.series.push_back({.name = sample.muscles[i], .x = x, .y = {arm.begin(), arm.end()}});
      lengths.series.push_back(
          {.name = sample.muscles[i], .x = x, .y = {length.begin(), length.end()}});
    }
    report.mainFigure = arms;
    report.verdict =
        fmt::format("{} muscles are moved by {}.", sample.muscles.size(), coordinate.name);
    report.details.push_back(lengths);
    for (const std::string& note : sample.notes) report.details.push_back(Paragraph{note});
    return report;
  }

  std::string model_;
  std::optional<double> from_;
  std::optional<double> to_;
  int points_ = 131;
  SimulationOptions model_options_;
};

}  // namespace

std::unique_ptr<Command> momentArmsCommand() {
  return std::make_unique<MomentArms>();
}

}  // namespace app
