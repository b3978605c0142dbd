#include <fmt/format.h>

#include "output/text.h"
#include "sensitivity/sensitivity_report.h"

namespace app {
namespace {

std::string cell(double value) {
  return cellText(value, 9);
}

}  // namespace

void writeSensitivities(const SensitivityFindings& f, std::ostream& out) {
  const bio::ParameterInformation& information = *f.information;
  out << "parameter,unit,value,normalised_sensitivity,bound_alone,bound_joint,identifiable\n";
  for (const std::size_t i : ranking(information.normalisedSensitivity)) {
    const auto k = static_cast<Eigen::Index>(i);
    const info::Parameter& p = information.parameters[i];
    out << fmt::format("{},{},{},{},{},{},{}\n", p.name, p.unit, cell(p.start),
                       cell(information.normalisedSensitivity[k] * f.shownFactor()),
                       cell(information.boundAlone[k]), cell(information.boundJoint[k]),
                       information.identifiable[i] ? "true" : "false");
  }
}

void writeFisher(const SensitivityFindings& f, std::ostream& out) {
  out << "parameter";
  for (const std::string& name : f.parameters) out << ',' << name;
  out << '\n';
  const Eigen::MatrixXd& fisher = f.information->fisher;
  for (Eigen::Index i = 0; i < fisher.rows(); ++i) {
    out << f.parameters[static_cast<std::size_t>(i)];
    for (Eigen::Index j = 0; j < fisher.cols(); ++j) out << ',' << cell(fisher(i, j));
    out << '\n';
  }
}

void writeSweep(const bio::Sweep& sweep, const bio::Coordinate& coordinate, std::ostream& out) {
  const double factor = shownFactor(coordinate);
  out << fmt::format("time,{}_{}", coordinate.name, shownUnit(coordinate));
  for (const bio::SweepRun& run : sweep.runs) {
    out << fmt::format(",{}={:.9g}", sweep.parameter.name, run.value);
  }
  out << '\n';
  for (std::size_t k = 0; k < sweep.nominal.time.size(); ++k) {
    const auto row = static_cast<Eigen::Index>(k);
    out << cell(sweep.nominal.time[k]) << ',' << cell(sweep.nominal.q(0, row) * factor);
    for (const bio::SweepRun& run : sweep.runs) {
      out << ',' << (row < run.motion.q.cols() ? cell(run.motion.q(0, row) * factor) : "");
    }
    out << '\n';
  }
}

void writeProfile(const bio::ProfileFinding& finding, std::ostream& out) {
  out << "value,cost,threshold,converged\n";
  for (const info::ProfilePoint& point : finding.profile.points) {
    out << fmt::format("{},{},{},{}\n", cell(point.value), cell(point.cost),
                       cell(finding.profile.threshold), point.converged ? "true" : "false");
  }
}

void writeGlobal(const SensitivityFindings& f, std::ostream& out) {
  out << "parameter,morris_mean_absolute,morris_deviation,sobol_first,sobol_first_sd,sobol_total,"
         "sobol_total_sd\n";
  for (std::size_t i = 0; i < f.parameters.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    out << f.parameters[i];
    const auto& morris = f.global.morris;
    const auto& sobol = f.global.sobol;
    out << ',' << (morris ? cell(morris->meanAbsolute[k]) : "") << ','
        << (morris ? cell(morris->sd[k]) : "");
    out << ',' << (sobol ? cell(sobol->first[k]) : "") << ','
        << (sobol ? cell(sobol->firstDeviation[k]) : "") << ','
        << (sobol ? cell(sobol->total[k]) : "") << ',' << (sobol ? cell(sobol->totalSd[k]) : "")
        << '\n';
  }
}

void writeTables(const SensitivityFindings& findings, OutputFolder& folder) {
  if (findings.information) {
    folder.write("sensitivity.csv", [&](std::ostream& out) { writeSensitivities(findings, out); });
    folder.write("fisher.csv", [&](std::ostream& out) { writeFisher(findings, out); });
  }
  for (const bio::Sweep& sweep : findings.sweeps) {
    folder.write("sweep.csv",
                 [&](std::ostream& out) { writeSweep(sweep, findings.coordinate, out); });
  }
  if (findings.profile) {
    folder.write("profile.csv", [&](std::ostream& out) { writeProfile(*findings.profile, out); });
  }
  if (findings.global.morris || findings.global.sobol) {
    folder.write("global.csv", [&](std::ostream& out) { writeGlobal(findings, out); });
  }
}

void sayMethods(const SensitivityFindings& f, Methods& methods) {
  constexpr auto inference = Methods::Part::inference;
  if (f.local) {
    methods.say(inference,
                "Sensitivities are exact derivatives of the simulated motion with respect to the "
                "parameters.");
  }
  if (f.information) {
    methods.say(
        inference,
        fmt::format(
            "The Fisher information is that of {} samples with independent normal noise{}; bounds "
            "are Cramér–Rao bounds.",
            f.samples,
            f.observed.empty()
                ? fmt::format(" of {} {}", numberText(f.noise * f.shownFactor(), 3), f.shownUnit())
                : ""));
    methods.say(inference,
                "A parameter counts as identifiable if its bound, combined with the prior, is at "
                "most half the "
                "prior standard deviation.");
    methods.assume(
        "Bounds hold for small changes of the parameters and a model without other errors.");
  }
  if (f.profile)
    methods.say(inference, "The profile likelihood holds one parameter and fits the others anew.");
  if (f.global.morris)
    methods.say(inference, "Elementary effects are those of Morris's screening.");
  if (f.global.sobol)
    methods.say(inference, "Sobol indices are estimated from points of Saltelli's scheme.");
}

}  // namespace app
