#include "compare/compare_muscles_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bio/analysis/compare.h"
#include "bio/model/units.h"
#include "bio/simulation/integrator_names.h"
#include "output/text.h"

namespace app {
namespace {

bool reachedEnd(const bio::MuscleClassMotion& motion) {
  return motion.motion.outcome == bio::Outcome::completed;
}

double inDegrees(double angle) {
  return angle * 180 / std::numbers::pi;
}

double shownFactorOf(const bio::Coordinate& coordinate) {
  return bio::positionUnit(coordinate.isRotation).factor;
}

std::string unitSuffix(const bio::Coordinate& coordinate) {
  return "_" + bio::positionUnit(coordinate.isRotation).name;
}

/// The largest difference of the class from the first in any free rotation, and what of the
/// measured coordinate's no change of parameters explains.
std::string rowOf(const bio::MuscleClassMotion& motion, double factor) {
  if (!reachedEnd(motion)) return ",,,,,,,";
  return fmt::format("{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{},{:.6g},{:.6g}",
                     inDegrees(motion.difference.rms), inDegrees(motion.difference.largest),
                     motion.difference.largestAt, motion.measured * factor,
                     motion.unexplained * factor, motion.information.determinedCombinations,
                     motion.motion.wallSeconds * 1e3, motion.energyError);
}

double relativeBound(const bio::MuscleClassMotion& motion, std::size_t i) {
  return motion.information.boundJoint[static_cast<Eigen::Index>(i)] /
         std::abs(motion.information.parameters[i].start);
}

/// The class whose muscles' numbers name the rows: the first that has them.
const std::vector<info::Parameter>& rowNames(const MuscleFindings& f) {
  return f.classes.front().information.parameters;
}

}  // namespace

void writeMuscleClasses(const MuscleFindings& f, std::ostream& out) {
  const std::string unit = unitSuffix(f.coordinate);
  out << "class,status,rms_deg,max_deg,max_at_s,measured_rms" << unit << ",unexplained_rms" << unit
      << ",determined_combinations,wall_ms,energy_error_J\n";
  for (const bio::MuscleClassMotion& motion : f.classes) {
    out << motion.name << ',' << bio::name(motion.motion.outcome) << ','
        << rowOf(motion, shownFactorOf(f.coordinate)) << '\n';
  }
}

void writeMuscleBounds(const MuscleFindings& f, std::ostream& out) {
  out << "parameter";
  for (const bio::MuscleClassMotion& motion : f.classes) out << ',' << motion.name;
  out << '\n';
  for (std::size_t i = 0; i < rowNames(f).size(); ++i) {
    out << rowNames(f)[i].name;
    for (const bio::MuscleClassMotion& motion : f.classes) {
      out << ',' << (reachedEnd(motion) ? fmt::format("{:.6g}", relativeBound(motion, i)) : "");
    }
    out << '\n';
  }
}

void tellMuscles(const MuscleFindings& f, Summary& summary) {
  const std::string unit = unitSuffix(f.coordinate);
  const double factor = shownFactorOf(f.coordinate);
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const bio::MuscleClassMotion& motion : f.classes) {
    nlohmann::ordered_json row{{"class", motion.name},
                               {"status", bio::name(motion.motion.outcome)}};
    if (reachedEnd(motion)) {
      row["rms_deg"] = inDegrees(motion.difference.rms);
      row["max_deg"] = inDegrees(motion.difference.largest);
      row["max_at_s"] = motion.difference.largestAt;
      row["measured_rms" + unit] = motion.measured * factor;
      row["unexplained_rms" + unit] = motion.unexplained * factor;
      row["determined_combinations"] = motion.information.determinedCombinations;
      row["wall_s"] = motion.motion.wallSeconds;
      row["energy_error_J"] = motion.energyError;
    } else {
      row["why"] = motion.motion.why;
    }
    row["lost"] = motion.lost;
    list.push_back(row);
  }
  summary.set("muscle_classes", list);
}

Report musclesReport(const MuscleFindings& f) {
  const double factor = shownFactorOf(f.coordinate);
  const std::string unit = bio::positionUnit(f.coordinate.isRotation).name;
  Report report;
  report.title = fmt::format("Muscle classes of {} on {}", f.modelFile, f.trialFile);
  const bio::MuscleClassMotion* widest = nullptr;
  for (const bio::MuscleClassMotion& motion : f.classes) {
    if (reachedEnd(motion) && (!widest || motion.measured > widest->measured)) widest = &motion;
  }
  report.verdict = fmt::format(
      "The class alone changes {} by up to {:.3g} {} RMS ({}); {:.3g} {} of that no change of the "
      "model's own muscle parameters explains (linearised, with their priors), against {:.3g} {} "
      "of noise in a sample.",
      f.coordinate.name, widest->measured * factor, unit, widest->name,
      widest->unexplained * factor, unit, f.noise * factor, unit);
  Figure figure{
      .title = "Motion by muscle class",
      .xLabel = "Time [s]",
      .yLabel = fmt::format("{} [{}]", f.coordinate.name, unit),
      .caption =
          "The same excitations and the same shared numbers; fibres begin in static equilibrium."};
  Table table{
      "Classes",
      {"class", "status", "RMS [deg]", "largest [deg]", fmt::format("measured RMS [{}]", unit),
       fmt::format("unexplained RMS [{}]", unit), "determined combinations", "time [ms]"},
      {}};
  Table bounds{"What the data tell: standard deviation over value", {"parameter"}, {}};
  for (const bio::MuscleClassMotion& motion : f.classes) {
    bounds.columns.push_back(motion.name);
    figure.series.push_back({.name = motion.name, .x = motion.motion.time, .y = {}});
    const Eigen::VectorXd q = motion.motion.q.row(0) * factor;
    figure.series.back().y = asList(q);
    if (!reachedEnd(motion)) {
      table.rows.push_back({motion.name, motion.motion.why, "", "", "", "", "", ""});
      continue;
    }
    table.rows.push_back({motion.name, "ok", numberText(inDegrees(motion.difference.rms)),
                          numberText(inDegrees(motion.difference.largest)),
                          numberText(motion.measured * factor),
                          numberText(motion.unexplained * factor),
                          std::to_string(motion.information.determinedCombinations),
                          numberText(motion.motion.wallSeconds * 1e3)});
  }
  for (std::size_t i = 0; i < rowNames(f).size(); ++i) {
    std::vector<std::string> row{rowNames(f)[i].name};
    for (const bio::MuscleClassMotion& motion : f.classes) {
      row.push_back(reachedEnd(motion) ? fmt::format("{:.3g}", relativeBound(motion, i)) : "");
    }
    bounds.rows.push_back(std::move(row));
  }
  report.mainFigure = figure;
  table.title.clear();
  report.details = {
      Section{"Classes",
              "How far the motion of each class is from that of the model, and what of it no "
              "change of the model's own muscle parameters explains."},
      table,
      Section{"Identifiability",
              "Whether the same data would tell as much of the muscles of each class: the smaller "
              "the share, the better is a parameter known."},
      bounds};
  const bool anyLost = std::any_of(f.classes.begin(), f.classes.end(),
                                   [](const auto& motion) { return !motion.lost.empty(); });
  if (anyLost)
    report.details.push_back(Section{"Lost", "What of the model's muscles a class has not."});
  for (const bio::MuscleClassMotion& motion : f.classes) {
    for (const std::string& lost : motion.lost) {
      report.details.push_back(Paragraph{fmt::format("As {}: lost is {}", motion.name, lost)});
    }
  }
  return report;
}

}  // namespace app
