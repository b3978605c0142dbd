#include "info/information/identifiability.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "info/information/symmetric_eigen.h"

namespace info {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kNegligible = 1e-4;  // of a sparse vector's largest entry

// Rows that span the same space, with as many zeros as Gauss–Jordan elimination gives.
MatrixXd reducedRows(MatrixXd rows) {
  for (Index i = 0; i < rows.rows(); ++i) {
    Index r, c;
    rows.bottomRows(rows.rows() - i).cwiseAbs().maxCoeff(&r, &c);
    rows.row(i).swap(rows.row(i + r));
    rows.row(i) /= rows(i, c);
    for (Index j = 0; j < rows.rows(); ++j)
      if (j != i) rows.row(j) -= rows(j, c) * rows.row(i).eval();
  }
  for (Index i = 0; i < rows.rows(); ++i) {
    rows.row(i) /= rows.row(i).cwiseAbs().maxCoeff();
    rows.row(i) = (rows.row(i).array().abs() < kNegligible).select(0.0, rows.row(i));
  }
  return rows;
}

// The smallest multiple whose entries are whole numbers up to 6, if there is one; first entry > 0.
VectorXd simplest(VectorXd v) {
  Index first = 0;
  while (v[first] == 0) ++first;
  double least = std::numeric_limits<double>::infinity();
  for (double entry : v)
    if (entry != 0) least = std::min(least, std::abs(entry));
  v /= std::copysign(least, v[first]);
  for (int times = 1; times <= 6; ++times) {
    const VectorXd whole = (times * v).array().round();
    if ((times * v - whole).cwiseAbs().maxCoeff() < 1e-3 * times &&
        whole.cwiseAbs().maxCoeff() <= 12)
      return whole;
  }
  return v;
}

std::string exponent(double e) {
  if (e == 1) return "";
  if (e != std::round(e)) return fmt::format("^{:.3g}", e);
  static const char* digits[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string text;
  for (char digit : fmt::format("{:.0f}", e)) text += digits[digit - '0'];
  return text;
}

std::string product(const VectorXd& exponents, const std::vector<Parameter>& parameters) {
  std::string above, below;
  int factorsBelow = 0;
  for (Index i = 0; i < exponents.size(); ++i) {
    if (exponents[i] == 0) continue;
    std::string& side = exponents[i] > 0 ? above : below;
    factorsBelow += exponents[i] < 0;
    side += (side.empty() ? "" : "·") + parameters[static_cast<std::size_t>(i)].name +
            exponent(std::abs(exponents[i]));
  }
  if (above.empty()) above = "1";
  if (below.empty()) return above;
  return above + (factorsBelow > 1 ? "/(" + below + ")" : "/" + below);
}

std::string sum(const VectorXd& coefficients, const std::vector<Parameter>& parameters) {
  std::string text;
  for (Index i = 0; i < coefficients.size(); ++i) {
    const double c = coefficients[i];
    if (c == 0) continue;
    text += text.empty() ? (c < 0 ? "−" : "") : (c < 0 ? " − " : " + ");
    if (std::abs(c) != 1) text += fmt::format("{:.4g}·", std::abs(c));
    text += parameters[static_cast<std::size_t>(i)].name;
  }
  return text;
}

std::string join(const std::vector<std::string>& items) {
  std::string text;
  for (std::size_t i = 0; i < items.size(); ++i)
    text += (i == 0 ? "" : i + 1 == items.size() ? " and " : ", ") + items[i];
  return text;
}

VectorXd scales(const std::vector<Parameter>& parameters, ParameterScale scale) {
  VectorXd s(static_cast<Index>(parameters.size()));
  for (Index i = 0; i < s.size(); ++i) {
    const Parameter& parameter = parameters[static_cast<std::size_t>(i)];
    if (scale == ParameterScale::logarithmic) {
      if (!(std::abs(parameter.start) > 0))
        throw std::invalid_argument(
            fmt::format("parameter {}: start {} must not be 0 on the logarithmic scale",
                        label(parameter), parameter.start));
      s[i] = std::abs(parameter.start);
    } else {
      s[i] = parameter.prior ? parameter.prior->sd
                             : (parameter.start != 0 ? std::abs(parameter.start) : 1.0);
    }
  }
  return s;
}

// "m1 +1 %, m2 −1 %", or "a +0.01 kg, b −0.005 kg": a small move along a direction.
std::string moves(const VectorXd& scaled, const VectorXd& s,
                  const std::vector<Parameter>& parameters, ParameterScale scale) {
  std::string text;
  for (Index i = 0; i < scaled.size(); ++i) {
    if (scaled[i] == 0) continue;
    const Parameter& parameter = parameters[static_cast<std::size_t>(i)];
    // a fraction of |start| is a fraction of start only up to its sign
    const double percent = scaled[i] * (parameter.start < 0 ? -1 : 1);
    const bool isLog = scale == ParameterScale::logarithmic;
    const double amount = isLog ? percent : 0.01 * scaled[i] * s[i];
    text += fmt::format("{}{} {}{:.3g}{}", text.empty() ? "" : ", ", parameter.name,
                        amount < 0 ? "−" : "+", std::abs(amount),
                        isLog ? " %" : (parameter.unit.empty() ? "" : " " + parameter.unit));
  }
  return text;
}

// Cramér–Rao standard deviations and correlations within the determined subspace.
void setAccuracy(IdentifiabilityReport& report, const VectorXd& s) {
  const Index p = s.size();
  const MatrixXd priorSds = report.eigenvectors.rightCols(report.rank);
  const MatrixXd covariance =
      s.asDiagonal() *
      (priorSds * report.eigenvalues.tail(report.rank).cwiseInverse().asDiagonal() *
       priorSds.transpose()) *
      s.asDiagonal();
  report.sd = covariance.diagonal().cwiseSqrt();
  report.correlation.resize(p, p);
  for (Index i = 0; i < p; ++i)
    for (Index j = 0; j < p; ++j)
      report.correlation(i, j) = i == j ? 1.0 : covariance(i, j) / (report.sd[i] * report.sd[j]);
}

// The null directions in words; no accuracy where one reaches.
void setUndetermined(IdentifiabilityReport& report, const MatrixXd& null, const VectorXd& s,
                     const std::vector<Parameter>& parameters, ParameterScale scale) {
  for (Index r = 0; r < null.rows(); ++r) {
    UndeterminedDirection direction;
    direction.direction = null.row(r).transpose().cwiseProduct(s);
    direction.words = moves(null.row(r).transpose(), s, parameters, scale);
    for (Index i = 0; i < s.size(); ++i) {
      if (null(r, i) == 0) continue;
      direction.parameters.push_back(parameters[static_cast<std::size_t>(i)].name);
      report.sd[i] = std::numeric_limits<double>::infinity();
      for (Index j = 0; j < s.size(); ++j)
        if (i != j)
          report.correlation(i, j) = report.correlation(j, i) =
              std::numeric_limits<double>::quiet_NaN();
    }
    report.undetermined.push_back(std::move(direction));
  }
}

// Null directions (rows) that share parameters (members).
struct ConfoundedGroup {
  std::vector<Index> rows, members;
};

std::vector<ConfoundedGroup> confoundedGroups(const MatrixXd& null) {
  std::vector<ConfoundedGroup> groups;
  std::vector<bool> done(static_cast<std::size_t>(null.rows()), false);
  for (Index seed = 0; seed < null.rows(); ++seed) {
    if (done[static_cast<std::size_t>(seed)]) continue;
    std::vector<Index> rows{seed};
    done[static_cast<std::size_t>(seed)] = true;
    for (std::size_t n = 0; n < rows.size(); ++n)
      for (Index r = 0; r < null.rows(); ++r)
        if (!done[static_cast<std::size_t>(r)] &&
            (null.row(r).array() * null.row(rows[n]).array() != 0).any()) {
          done[static_cast<std::size_t>(r)] = true;
          rows.push_back(r);
        }
    std::vector<Index> members;
    for (Index i = 0; i < null.cols(); ++i)
      if ((null(rows, i).array() != 0).any()) members.push_back(i);
    groups.push_back({std::move(rows), std::move(members)});
  }
  return groups;
}

// The orthogonal complement of the group's directions: exponents, or coefficients in θ's units.
std::vector<std::string> determinedCombinations(const ConfoundedGroup& group, const MatrixXd& null,
                                                const VectorXd& s,
                                                const std::vector<Parameter>& parameters,
                                                ParameterScale scale) {
  const auto& [rows, members] = group;
  const MatrixXd part = null(rows, members);
  const Eigen::JacobiSVD<MatrixXd> svd(part, Eigen::ComputeFullV);
  const Index rest = static_cast<Index>(members.size() - rows.size());
  const MatrixXd combinations = reducedRows(svd.matrixV().rightCols(rest).transpose());
  std::vector<std::string> determined;
  for (Index c = 0; c < rest; ++c) {
    VectorXd full = VectorXd::Zero(s.size());
    for (std::size_t m = 0; m < members.size(); ++m) {
      const Index i = members[m];
      const double entry = combinations(c, static_cast<Index>(m));
      const double sign = parameters[static_cast<std::size_t>(i)].start < 0 ? -1 : 1;
      full[i] = scale == ParameterScale::logarithmic ? sign * entry : entry / s[i];
    }
    full = simplest(full);
    determined.push_back(scale == ParameterScale::logarithmic ? product(full, parameters)
                                                              : sum(full, parameters));
  }
  return determined;
}

// What is determined of a group, and what is not.
void addSentences(const ConfoundedGroup& group, IdentifiabilityReport& report, const MatrixXd& null,
                  const VectorXd& s, const std::vector<Parameter>& parameters,
                  ParameterScale scale) {
  std::vector<std::string> names, changes;
  for (Index i : group.members) names.push_back(parameters[static_cast<std::size_t>(i)].name);
  for (Index r : group.rows)
    changes.push_back(report.undetermined[static_cast<std::size_t>(r)].words);
  if (group.members.size() == group.rows.size()) {
    for (const std::string& name : names)
      report.sentences.push_back(name + " has no effect on what is measured");
    return;
  }
  const auto determined = determinedCombinations(group, null, s, parameters, scale);
  report.determined.insert(report.determined.end(), determined.begin(), determined.end());
  report.sentences.push_back(fmt::format(
      "{} are not separately identifiable: only {} {} determined ({} together change no output)",
      join(names), join(determined), determined.size() == 1 ? "is" : "are", changes.front()));
  for (std::size_t n = 1; n < changes.size(); ++n)
    report.sentences.back() += fmt::format("; nor do {}", changes[n]);
}

}  // namespace

IdentifiabilityReport identifiability(const MatrixXd& information,
                                      const std::vector<Parameter>& parameters,
                                      ParameterScale scale, double tolerance) {
  const Index p = static_cast<Index>(parameters.size());
  if (p == 0 || information.rows() != p || information.cols() != p)
    throw std::invalid_argument(
        fmt::format("identifiability: information is {} × {}, must be square with {} parameters",
                    information.rows(), information.cols(), p));
  if (!information.allFinite())
    throw std::domain_error("identifiability: every entry of the information must be finite");
  requireSymmetric(information, "identifiability",
                   [&](Index i) { return parameters[static_cast<std::size_t>(i)].name; });

  IdentifiabilityReport report;
  const VectorXd s = scales(parameters, scale);
  const auto eigen = symmetricEigen(s.asDiagonal() * information * s.asDiagonal());
  report.eigenvalues = eigen.values;
  report.eigenvectors = eigen.vectors;
  const double largest = report.eigenvalues[p - 1];
  const Index nullity =
      largest > 0 ? (report.eigenvalues.array() <= tolerance * largest).count() : p;
  report.rank = p - nullity;

  setAccuracy(report, s);
  if (nullity == 0) {
    report.sentences.emplace_back("all parameters are identifiable");
    return report;
  }
  const MatrixXd null = reducedRows(report.eigenvectors.leftCols(nullity).transpose());
  setUndetermined(report, null, s, parameters, scale);
  for (const ConfoundedGroup& group : confoundedGroups(null))
    addSentences(group, report, null, s, parameters, scale);
  return report;
}

}  // namespace info
