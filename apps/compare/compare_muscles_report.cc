#include "compare/compare_muscles_report.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "bio/analysis/compare.h"
#include "bio/simulation/integrator_names.h"
#include "output/text.h"

namespace app {
namespace {

bool reachedEnd(const bio::MuscleClassMotion& one) {
  return one.motion.outcome == bio::Outcome::completed;
}

double shownFactorOf(const bio::Coordinate& coordinate) {
  return coordinate.isRotation ? 180 / std::numbers::pi : 1e3;
}

std::string unitSuffix(const bio::Coordinate& coordinate) {
  return coordinate.isRotation ? "_deg" : "_mm";
}

/// The largest difference of the class from the first in any free rotation, and what of the
/// measured coordinate's no change of parameters explains.
std::string rowOf(const bio::MuscleClassMotion& one, double factor) {
  if (!reachedEnd(one)) return ",,,,,,,";
  return fmt::format(
      "{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{},{:.6g},{:.6g}",
      one.difference.rms * 180 / std::numbers::pi, one.difference.largest * 180 / std::numbers::pi,
      one.difference.largestAt, one.measured * factor, one.unexplained * factor,
      one.information.determinedCombinations, one.motion.wallSeconds * 1e3, one.energyError);
}

double relativeBound(const bio::MuscleClassMotion& one, std::size_t i) {
  return one.information.boundJoint[static_cast<Eigen::Index>(i)] /
         std::abs(one.information.parameters[i].start);
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
  for (const bio::MuscleClassMotion& one : f.classes) {
    out << one.name << ',' << bio::name(one.motion.outcome) << ','
        << rowOf(one, shownFactorOf(f.coordinate)) << '\n';
  }
}

void writeMuscleBounds(const MuscleFindings& f, std::ostream& out) {
  out << "parameter";
  for (const bio::MuscleClassMotion& one : f.classes) out << ',' << one.name;
  out << '\n';
  for (std::size_t i = 0; i < rowNames(f).size(); ++i) {
    out << rowNames(f)[i].name;
    for (const bio::MuscleClassMotion& one : f.classes) {
      out << ',' << (reachedEnd(one) ? fmt::format("{:.6g}", relativeBound(one, i)) : "");
    }
    out << '\n';
  }
}

void tellMuscles(const MuscleFindings& f, Summary& summary) {
  const std::string unit = unitSuffix(f.coordinate);
  const double factor = shownFactorOf(f.coordinate);
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const bio::MuscleClassMotion& one : f.classes) {
    nlohmann::ordered_json row{{"class", one.name}, {"status", bio::name(one.motion.outcome)}};
    if (reachedEnd(one)) {
      row["rms_deg"] = one.difference.rms * 180 / std::numbers::pi;
      row["max_deg"] = one.difference.largest * 180 / std::numbers::pi;
      row["max_at_s"] = one.difference.largestAt;
      row["measured_rms" + unit] = one.measured * factor;
      row["unexplained_rms" + unit] = one.unexplained * factor;
      row["determined_combinations"] = one.information.determinedCombinations;
      row["wall_s"] = one.motion.wallSeconds;
      row["energy_error_J"] = one.energyError;
    } else {
      row["why"] = one.motion.why;
    }
    row["lost"] = one.lost;
    list.push_back(row);
  }
  summary.set("muscle_classes", list);
}

Report musclesReport(const MuscleFindings& f) {
  const double factor = shownFactorOf(f.coordinate);
  const char* unit = f.coordinate.isRotation ? "deg" : "mm";
  Report report;
  report.title = fmt::format("Muscle classes of {} on {}", f.modelFile, f.trialFile);
  const bio::MuscleClassMotion* widest = nullptr;
  for (const bio::MuscleClassMotion& one : f.classes) {
    if (reachedEnd(one) && (!widest || one.measured > widest->measured)) widest = &one;
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
      .caption = "The same excitations and the same shared numbers; fibres begin at rest."};
  Table table{
      "Classes",
      {"class", "status", "RMS [deg]", "largest [deg]", fmt::format("measured RMS [{}]", unit),
       fmt::format("unexplained RMS [{}]", unit), "determined combinations", "time [ms]"},
      {}};
  Table bounds{"What the data tell: standard deviation over value", {"parameter"}, {}};
  for (const bio::MuscleClassMotion& one : f.classes) {
    bounds.columns.push_back(one.name);
    figure.series.push_back({.name = one.name, .x = one.motion.time, .y = {}});
    const Eigen::VectorXd q = one.motion.q.row(0) * factor;
    figure.series.back().y = asList(q);
    if (!reachedEnd(one)) {
      table.rows.push_back({one.name, one.motion.why, "", "", "", "", "", ""});
      continue;
    }
    table.rows.push_back({one.name, "ok", numberText(one.difference.rms * 180 / std::numbers::pi),
                          numberText(one.difference.largest * 180 / std::numbers::pi),
                          numberText(one.measured * factor), numberText(one.unexplained * factor),
                          std::to_string(one.information.determinedCombinations),
                          numberText(one.motion.wallSeconds * 1e3)});
  }
  for (std::size_t i = 0; i < rowNames(f).size(); ++i) {
    std::vector<std::string> row{rowNames(f)[i].name};
    for (const bio::MuscleClassMotion& one : f.classes) {
      row.push_back(reachedEnd(one) ? fmt::format("{:.3g}", relativeBound(one, i)) : "");
    }
    bounds.rows.push_back(std::move(row));
  }
  report.mainFigure = figure;
  report.details = {table, bounds};
  for (const bio::MuscleClassMotion& one : f.classes) {
    for (const std::string& lost : one.lost) {
      report.details.push_back(Paragraph{fmt::format("As {}: lost is {}", one.name, lost)});
    }
  }
  return report;
}

}  // namespace app
