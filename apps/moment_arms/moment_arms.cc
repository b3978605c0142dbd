#include <fmt/format.h>
#include <fmt/ranges.h>

#include <ostream>

#include "bio/analysis/path_postures.h"
#include "bio/analysis/replay.h"
#include "bio/model/units.h"
#include "command/command.h"
#include "moment_arms/fit_command.h"
#include "moment_arms/moment_arm_methods.h"
#include "moment_arms/path_jumps.h"
#include "options/model_methods.h"
#include "options/number_rules.h"
#include "options/set_parameters.h"
#include "options/system_options.h"
#include "options/trial_input.h"
#include "output/text.h"
#include "report/result.h"

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
    CLI::Option* postures = options.add_option(
        "--postures", postures_,
        "table (.csv) of postures instead of a range: columns named like coordinates [rad] or [m], "
        "which are free; other columns are ignored");
    postures->check(CLI::ExistingFile)->type_name("FILE");
    for (const char* other : {"--from", "--to", "--points"}) postures->excludes(other);
    addFitOptions(options, fit_);
    addModelOptions(options, model_options_);
    postures->excludes("--coordinate");
  }

  ExitStatus run(const CommandContext& context) override {
    Summary summary(context);
    if (fit_.isGiven()) {
      const bio::Model given =
          withSetInWholeModel(readModel(model_, summary), model_options_, summary);
      return runFit(context, summary, model_, given, model_options_, fit_);
    }
    OutputFolder folder(context, {"moment_arms.csv"});
    bio::Model model = readModel(model_, summary);
    if (!postures_.empty()) return runPostures(context, folder, summary, std::move(model));
    chooseCoordinates(model_options_, model, {});
    model = withSetParameters(std::move(model), model_options_, summary);
    const bio::SkeletonOptions options = systemOptions(model_options_).skeleton;
    const bio::Skeleton skeleton(model, options);
    for (const std::string& remark : lockRemarks(model, options)) summary.warn(remark);
    const bio::Coordinate& coordinate = skeleton.coordinates().front();
    const double unit = coordinate.isRotation ? bio::radiansPerDegree : 1e-3;
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
    const std::vector<std::string>& asCylinder = model_options_.wrapAsCylinder;
    const auto jumps = bio::lengthJumps(model, skeleton, asCylinder, first * unit, last * unit);
    for (const bio::LengthJump& jump : jumps) summary.warn(describe(jump));
    const auto differences =
        bio::openSimDifferences(model, skeleton, asCylinder, first * unit, last * unit);
    for (const bio::OpenSimDifference& difference : differences) summary.warn(describe(difference));
    require(!sample.muscles.empty(),
            fmt::format("{}: coordinate '{}' changes the length of no muscle", model_,
                        coordinate.name));

    const std::string unitName = bio::positionUnit(coordinate.isRotation).name;
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
    summary.set("jumps", jumpsAsJson(jumps));
    summary.set("opensim_differences", differencesAsJson(differences));
    sayMomentArms(model, sample, coordinate.name, shown, unitName, summary.methods());
    sayCylinders(asCylinder, summary.methods());
    sayOpenSimDifferences(differences, summary.methods());
    Report report = reportOn(sample, shown, coordinate, unitName);
    if (!jumps.empty() || !differences.empty()) {
      report.details.push_back(Section{"Where paths are special",
                                       "Where a length jumps, or is another one than OpenSim's."});
    }
    if (!jumps.empty()) report.details.push_back(jumpTable(jumps));
    if (!differences.empty()) {
      report.details.push_back(differenceTable(differences));
      report.details.push_back(Paragraph{
          "OpenSim's path by its rule restated, which gives OpenSim 4.6's lengths to 1 µm in most "
          "postures of arm26 and MoBL-ARMS, less well where an ellipsoid is touched together with "
          "another object. Simulations use the taut string."});
    }
    deliver(context, summary, report, folder);
    return ExitStatus::done;
  }

 private:
  ExitStatus runPostures(const CommandContext& context, OutputFolder& folder, Summary& summary,
                         bio::Model model) {
    summary.addInput(postures_);
    const bio::PostureTable postures = bio::readPostures(postures_, model);
    if (!postures.ignored.empty()) {
      summary.warn(
          fmt::format("{}: {} columns are no coordinates of the model and ignored, first "
                      "'{}'",
                      postures_, postures.ignored.size(), postures.ignored.front()));
    }
    model_options_.coordinates = postures.coordinates;
    model = withSetParameters(std::move(model), model_options_, summary);
    const bio::SkeletonOptions options = systemOptions(model_options_).skeleton;
    for (const std::string& remark : lockRemarks(model, options)) summary.warn(remark);
    const bio::PathPostures paths =
        bio::pathsAt(model, postures, options.lockedValues, model_options_.wrapAsCylinder);
    for (const std::string& warning : paths.warnings) summary.warn(warning);
    require(!paths.muscles.empty(), fmt::format("{}: no muscle can be computed", model_));
    folder.write("moment_arms.csv",
                 [&](std::ostream& out) { writePostures(postures, paths, out); });
    summary.set("coordinates", paths.coordinates);
    summary.set("postures", postures.values.rows());
    summary.set("muscles", paths.muscles);
    summary.set("notes", paths.notes);
    const Eigen::Index missing = paths.length.array().isNaN().count();
    summary.set("lengths_without_value", missing);
    sayPostures(model, paths, summary.methods());
    sayCylinders(model_options_.wrapAsCylinder, summary.methods());
    Report report;
    report.title = fmt::format("Muscle–tendon lengths of {} in {}", model_, postures_);
    report.verdict =
        fmt::format("{} muscles in {} postures.", paths.muscles.size(), postures.values.rows());
    if (missing > 0) report.verdict += fmt::format(" {} lengths have no value.", missing);
    Table table{"", {"muscle", "shortest [mm]", "longest [mm]"}, {}};
    for (std::size_t i = 0; i < paths.muscles.size(); ++i) {
      const auto lengths = paths.length.col(static_cast<Eigen::Index>(i)).array();
      table.rows.push_back(
          {paths.muscles[i],
           fmt::format("{:.2f}", 1e3 * lengths.minCoeff<Eigen::PropagateNumbers>()),
           fmt::format("{:.2f}", 1e3 * lengths.maxCoeff<Eigen::PropagateNumbers>())});
    }
    report.details.push_back(
        Section{"Lengths", "Of whole muscle paths, tendons included, over all postures."});
    report.details.push_back(table);
    if (!paths.notes.empty())
      report.details.push_back(Section{"Notes", "What is special about paths of this model."});
    for (const std::string& note : paths.notes) report.details.push_back(Paragraph{note});
    deliver(context, summary, report, folder);
    return ExitStatus::done;
  }

  /// One row per posture; names of touched objects are joined by |, - stands for none.
  static void writePostures(const bio::PostureTable& postures, const bio::PathPostures& paths,
                            std::ostream& out) {
    out << "posture";
    for (const std::string& name : paths.coordinates) out << ',' << name;
    for (const std::string& muscle : paths.muscles) {
      out << ',' << muscle << ".length_m," << muscle << ".wrapped";
      for (const std::string& name : paths.coordinates) {
        out << ',' << muscle << ".dlength_d." << name;
      }
    }
    out << '\n';
    for (Eigen::Index k = 0; k < postures.values.rows(); ++k) {
      out << k;
      for (const double value : postures.values.row(k)) out << ',' << cellText(value);
      for (std::size_t i = 0; i < paths.muscles.size(); ++i) {
        const auto& touched = paths.touched[i][static_cast<std::size_t>(k)];
        out << ',' << cellText(paths.length(k, static_cast<Eigen::Index>(i))) << ','
            << (touched.empty() ? "-" : fmt::format("{}", fmt::join(touched, "|")));
        for (const double slope : paths.slope[i].row(k)) out << ',' << cellText(slope);
      }
      out << '\n';
    }
  }

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
    report.details.push_back(
        Section{"Lengths",
                "Of whole muscle paths, tendons included; a moment arm is minus the slope of this "
                "curve."});
    report.details.push_back(lengths);
    if (!sample.notes.empty())
      report.details.push_back(Section{"Notes", "What is special about paths of this model."});
    for (const std::string& note : sample.notes) report.details.push_back(Paragraph{note});
    return report;
  }

  std::string model_;
  std::optional<double> from_;
  std::optional<double> to_;
  int points_ = 131;
  std::string postures_;
  FitRequest fit_;
  SimulationOptions model_options_;
};

}  // namespace

/// `moment-arms`: lengths, moment arms and their slopes over a coordinate's range.
std::unique_ptr<Command> momentArmsCommand() {
  return std::make_unique<MomentArms>();
}

}  // namespace app
