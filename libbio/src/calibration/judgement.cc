#include "calibration/judgement.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "info/estimation/monte_carlo.h"
#include "info/information/symmetric_eigen.h"

namespace bio {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

/// The inverse of a matrix of information; where it is singular, as large as rounding allows.
MatrixXd scaledInverse(const MatrixXd& information, const VectorXd& scale) {
  const auto eigen = info::symmetricEigen(scale.asDiagonal() * information * scale.asDiagonal());
  const double floor =
      std::max(1e-14 * eigen.values.maxCoeff(), std::numeric_limits<double>::min());
  const MatrixXd inverse = eigen.vectors *
                           eigen.values.cwiseMax(floor).cwiseInverse().asDiagonal() *
                           eigen.vectors.transpose();
  return scale.asDiagonal() * inverse * scale.asDiagonal();
}

class Judge {
 public:
  Judge(const AskedParameters& asked, const TrialSet& training, const VectorXd& estimate,
        double confidence)
      : asked_(asked), training_(training), estimate_(estimate), confidence_(confidence) {}

  Judgement of(const MatrixXd& data) const {
    const Index count = estimate_.size();
    Judgement result{{}, MatrixXd::Identity(count, count), MatrixXd::Zero(count, count)};
    std::vector<Index> free;
    for (Index i = 0; i < count; ++i) {
      if (!isAtBound(i)) free.push_back(i);
    }
    std::vector<info::Determinacy> told;
    VectorXd sd;
    if (!free.empty()) {
      MatrixXd own = data(free, free), all = own;
      std::vector<info::Parameter> parameters;
      for (std::size_t k = 0; k < free.size(); ++k) {
        const info::Parameter& one = parameters.emplace_back(parameter(free[k]));
        if (!one.prior) continue;
        const double weight = 1 / (one.prior->sd * one.prior->sd);
        const auto i = static_cast<Index>(k);
        all(i, i) += weight;
        if (isOfTrial(free[k])) own(i, i) += weight;  // what is known of a start was measured
      }
      const VectorXd priorSds = asked_.priorSds(free);
      const auto& channels = training_.channels();
      const bool areAngles = channels.size() == 1 && channels.front().areAngles;
      told = info::determinacy(own, parameters, priorSds,
                               areAngles ? "the measured angles" : "the measurements");
      const MatrixXd covariance = scaledInverse(all, priorSds);
      sd = covariance.diagonal().cwiseSqrt();
      result.covariance(free, free) = covariance;
      result.correlation(free, free) = covariance.array() / (sd * sd.transpose()).array();
    }
    for (Index i = 0; i < count; ++i) {
      const auto place = std::find(free.begin(), free.end(), i);
      const auto k = static_cast<std::size_t>(place - free.begin());
      result.parameters.push_back(
          place == free.end() ? atBound(i) : described(i, told[k], sd[static_cast<Index>(k)]));
    }
    return result;
  }

 private:
  const info::Parameter& parameter(Index i) const {
    return asked_.parameters[static_cast<std::size_t>(i)];
  }
  bool isOfTrial(Index i) const { return i >= static_cast<Index>(training_.numCommon()); }
  bool isAtBound(Index i) const {
    return estimate_[i] <= parameter(i).lower || estimate_[i] >= parameter(i).upper;
  }

  CalibratedParameter blank(Index i) const {
    CalibratedParameter one{};
    one.asked = parameter(i);
    one.target = training_.targets()[static_cast<std::size_t>(i)];
    one.model = training_.parameters()[static_cast<std::size_t>(i)].start;
    one.priorSd = asked_.priorSds[i];
    one.ofTrial = isOfTrial(i);
    one.value = estimate_[i];
    one.sd = one.lower = one.upper = unknown;
    one.bootstrapSd = one.bootstrapLower = one.bootstrapUpper = unknown;
    return one;
  }

  CalibratedParameter atBound(Index i) const {
    CalibratedParameter parameter = blank(i);
    parameter.atBound = true;
    parameter.determinacy = {unknown, unknown, false, ""};
    const bool low = parameter.value <= parameter.asked.lower;
    const std::string unit = parameter.asked.unit.empty() ? "" : " " + parameter.asked.unit;
    parameter.why = fmt::format(
        "{} is at its {} bound ({:.4g}{}): the data favour {} values, so no confidence interval is "
        "reported",
        parameter.asked.name, low ? "lower" : "upper", parameter.value, unit,
        low ? "smaller" : "larger");
    return parameter;
  }

  CalibratedParameter described(Index i, const info::Determinacy& told, double sd) const {
    CalibratedParameter parameter = blank(i);
    parameter.determinacy = told;
    parameter.identifiable = told.identifiable;
    parameter.why = told.why;
    if (!parameter.identifiable) return parameter;
    const double z = info::normalQuantile(confidence_);
    parameter.sd = sd;
    parameter.lower = std::max(parameter.asked.lower, parameter.value - z * sd);
    parameter.upper = std::min(parameter.asked.upper, parameter.value + z * sd);
    return parameter;
  }

  const AskedParameters& asked_;
  const TrialSet& training_;
  const VectorXd& estimate_;
  double confidence_;
};

}  // namespace

Judgement judged(const AskedParameters& asked, const TrialSet& training, const VectorXd& estimate,
                 const MatrixXd& data, double confidence) {
  return Judge(asked, training, estimate, confidence).of(data);
}

}  // namespace bio
