#include "moment_arms/fit_command.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <ostream>
#include <stdexcept>

#include "bio/analysis/fit_paths.h"
#include "bio/opensim/osim_file.h"
#include "moment_arms/moment_arm_methods.h"
#include "options/model_methods.h"
#include "options/number_rules.h"
#include "options/system_options.h"
#include "options/trial_input.h"
#include "output/output_folder.h"
#include "output/text.h"
#include "report/result.h"

namespace app {
namespace {

const bio::MultivariatePolynomial& polynomialOf(const bio::PathFit& fit) {
  return std::get<bio::MultivariatePolynomial>(fit.function.length);
}

nlohmann::ordered_json asJson(const bio::MuscleFit& fit) {
  nlohmann::ordered_json json{{"written", fit.whyNot.empty()}};
  if (!fit.whyNot.empty()) json["why_not"] = fit.whyNot;
  if (!fit.fit) return json;
  json["coordinates"] = fit.fit->function.coordinates;
  json["order"] = polynomialOf(*fit.fit).order;
  json["terms"] = polynomialOf(*fit.fit).coefficients.size();
  json["postures"] = fit.fit->postures;
  json["length_error_m"] = {{"rms", fit.fit->length.rms}, {"largest", fit.fit->length.largest}};
  if (std::isfinite(fit.fit->arm.rms)) {
    json["arm_error_m"] = {{"rms", fit.fit->arm.rms}, {"largest", fit.fit->arm.largest}};
  }
  return json;
}

void writeFits(const std::vector<bio::MuscleFit>& fits, std::ostream& out) {
  out << "muscle,written,coordinates,order,terms,length_rms_mm,length_largest_mm,arm_rms_mm,"
         "arm_largest_mm\n";
  for (const bio::MuscleFit& fit : fits) {
    out << fit.muscle << ',' << (fit.whyNot.empty() ? 1 : 0);
    if (!fit.fit) {
      out << ",,,,,,,\n";
      continue;
    }
    const bio::MultivariatePolynomial& polynomial = polynomialOf(*fit.fit);
    out << ',' << fmt::format("{}", fmt::join(fit.fit->function.coordinates, "|")) << ','
        << polynomial.order << ',' << polynomial.coefficients.size();
    for (const double error :
         {fit.fit->length.rms, fit.fit->length.largest, fit.fit->arm.rms, fit.fit->arm.largest}) {
      out << ',' << cellText(1000 * error);
    }
    out << '\n';
  }
}

Report reportOnFit(const std::string& file, const std::vector<bio::MuscleFit>& fits,
                   const FitRequest& request) {
  Report report;
  report.title = fmt::format("Polynomials in place of the paths of {}", file);
  double largest = 0;
  int written = 0;
  Table table{"",
              {"muscle", "order", "coordinates", "length: RMS, largest error [mm]",
               "moment arm: RMS, largest error [mm]", "written"},
              {}};
  for (const bio::MuscleFit& fit : fits) {
    if (fit.whyNot.empty()) {
      ++written;
      largest = std::max(largest, fit.fit->length.largest);
    }
    const std::string answer = fit.whyNot.empty() ? "yes" : "no: " + fit.whyNot;
    if (!fit.fit) {
      table.rows.push_back({fit.muscle, "–", "–", "–", "–", answer});
      continue;
    }
    const auto pair = [](const bio::FitError& error) {
      return numberText(1000 * error.rms, 3) + ", " + numberText(1000 * error.largest, 3);
    };
    table.rows.push_back({fit.muscle, std::to_string(polynomialOf(*fit.fit).order),
                          fmt::format("{}", fmt::join(fit.fit->function.coordinates, ", ")),
                          pair(fit.fit->length), pair(fit.fit->arm), answer});
  }
  report.verdict = fmt::format("{} of {} paths are written as polynomials", written, fits.size());
  if (written > 0) {
    report.verdict += fmt::format(", with lengths within {} mm", numberText(1000 * largest, 3));
  }
  report.verdict +=
      written == static_cast<int>(fits.size())
          ? "."
          : fmt::format(
                "; the others keep their points: no polynomial of order {} or less is "
                "within {} mm, or there is another reason.",
                request.order, numberText(request.tolerance));
  report.details.push_back(
      Section{"Polynomials",
              "Order and error of the polynomial of each muscle; one that is not written keeps its "
              "points."});
  report.details.push_back(table);
  report.details.push_back(Paragraph{
      "Between the ends of the coordinates' ranges or, with a table, among its postures; "
      "beyond them a polynomial is worth nothing. Locked coordinates stay where they are. "
      "OpenSim reads FunctionBasedPath from version 4.5 on."});
  return report;
}

}  // namespace

void addFitOptions(CLI::App& options, FitRequest& request) {
  request.option =
      options
          .add_option("--fit", request.table,
                      "write a model whose muscles' lengths are polynomials of the coordinates "
                      "(OpenSim's FunctionBasedPath), fitted over the ranges of the free "
                      "coordinates, or to the lengths in TABLE (.csv as --postures writes it, "
                      "OpenSim's lengths, for example)")
          ->expected(0, 1)
          ->type_name("[TABLE]");
  for (const char* other : {"--from", "--to", "--points", "--postures"}) {
    request.option->excludes(other);
  }
  options.add_option("--fit-muscle", request.muscles, "fit this muscle only; may be repeated")
      ->needs(request.option)
      ->type_name("NAME");
  options
      .add_option("--fit-tolerance", request.tolerance,
                  "largest error of a length [mm]; a muscle that exceeds it keeps its points")
      ->check(positive())
      ->needs(request.option)
      ->capture_default_str();
  options.add_option("--fit-order", request.order, "highest order tried, at most 9")
      ->check(between(1, 9))
      ->needs(request.option)
      ->capture_default_str();
}

ExitStatus runFit(const CommandContext& context, Summary& summary, const std::string& file,
                  const bio::Model& model, SimulationOptions& options, const FitRequest& request) {
  OutputFolder folder(context, {"fitted_paths.osim", "fitted_paths.csv"});
  const bio::PathFitOptions fitOptions{request.tolerance / 1000, request.order};
  std::vector<bio::MuscleFit> fits;
  if (request.table.empty()) {
    chooseCoordinates(options, model, {});
    const bio::SkeletonOptions skeleton = systemOptions(options).skeleton;
    for (const std::string& remark : lockRemarks(model, skeleton)) summary.warn(remark);
    fits = bio::fitPaths(model, skeleton, options.wrapAsCylinder, request.muscles, fitOptions);
  } else {
    if (!options.coordinates.empty()) {
      throw std::invalid_argument(
          "--coordinate: with --fit TABLE the table's coordinates are free");
    }
    summary.addInput(request.table);
    const bio::LengthTable table = bio::readLengths(request.table, model);
    options.coordinates = table.postures.coordinates;
    fits = bio::fitPathsToTable(model, systemOptions(options).skeleton, table, request.muscles,
                                fitOptions);
  }
  if (fits.empty()) {
    throw std::invalid_argument(
        fmt::format("{}: no muscle is moved by {}", file, fmt::join(options.coordinates, ", ")));
  }
  const auto written =
      std::count_if(fits.begin(), fits.end(), [](const auto& fit) { return fit.whyNot.empty(); });
  for (const bio::MuscleFit& fit : fits) {
    if (!fit.whyNot.empty()) {
      summary.warn(fmt::format("muscle '{}' keeps its points: {}", fit.muscle, fit.whyNot));
    }
  }
  folder.writeFile("fitted_paths.osim", [&](const std::filesystem::path& path) {
    bio::rewriteOsim(file, bio::withFittedPaths(model, fits), path);
  });
  folder.write("fitted_paths.csv", [&](std::ostream& out) { writeFits(fits, out); });
  summary.set("coordinates", options.coordinates);
  summary.set("tolerance_mm", request.tolerance);
  summary.set("written", written);
  nlohmann::ordered_json all = nlohmann::ordered_json::object();
  std::vector<std::string> muscles;
  for (const bio::MuscleFit& fit : fits) {
    muscles.push_back(fit.muscle);
    all[fit.muscle] = asJson(fit);
  }
  summary.set("muscles", muscles);
  summary.set("notes", nlohmann::ordered_json::array());
  summary.set("fits", all);
  sayPathFits(model, fits, request, summary.methods());
  sayCylinders(options.wrapAsCylinder, summary.methods());
  deliver(context, summary, reportOnFit(file, fits, request), folder);
  return written > 0 ? ExitStatus::done : ExitStatus::answerIsNo;
}

}  // namespace app
