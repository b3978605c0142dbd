#include "tables/equal_times.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "bio/tables/file_error.h"

namespace bio {
namespace {

constexpr double longGap = 2.5;  // intervals, within which nothing was measured

Eigen::VectorXd intervalsOf(const Eigen::VectorXd& times) {
  return times.tail(times.size() - 1) - times.head(times.size() - 1);
}

double medianOf(Eigen::VectorXd values) {
  const auto middle = values.begin() + values.size() / 2;
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// a rate read off rounded times is known only so well
double rounded(double rate) {
  const double whole = std::round(rate);
  return std::abs(whole / rate - 1) < 1e-4 ? whole : rate;
}

}  // namespace

RowTimes rowTimesOf(const std::string& file, const Eigen::VectorXd& times) {
  const Eigen::Index last = times.size() - 1;
  if (last < 1) {
    throw FileError(fmt::format("{}: has {} rows, a recording needs at least 2", file, last + 1));
  }
  RowTimes out{.times = times, .rate = static_cast<double>(last) / (times[last] - times[0])};
  for (Eigen::Index i = 0; i <= last; ++i) {
    if (i > 0 && !(times[i] > times[i - 1])) {
      throw FileError(fmt::format("{}: time = {} s in row {} after {} s, must rise strictly", file,
                                  times[i], i + 1, times[i - 1]));
    }
    const double off = (times[i] - times[0]) * out.rate - static_cast<double>(i);
    out.equal = out.equal && std::abs(off) <= 0.25;
  }
  if (!out.equal) {
    const double interval = medianOf(intervalsOf(times));
    const double rows = (times[last] - times[0]) / interval;
    if (!(rows <= 4 * static_cast<double>(last) + 100)) {
      throw FileError(fmt::format(
          "{}: {} rows from {} s to {} s at intervals of {:.4g} s (median): most rows are missing, "
          "must be there",
          file, last + 1, times[0], times[last], interval));
    }
    out.rate = 1 / interval;
  }
  out.rate = rounded(out.rate);
  return out;
}

std::string jitterOf(const RowTimes& rows) {
  if (rows.equal) return "";
  const Eigen::VectorXd intervals = intervalsOf(rows.times);
  const double median = medianOf(intervals);
  const double typical = medianOf((intervals.array() - median).abs().matrix());
  Eigen::Index at = 0;
  const double largest = intervals.maxCoeff(&at);
  return fmt::format(
      "The times are not equally spaced: intervals of {:.4g} ± {:.2g} ms (median, median "
      "deviation), "
      "{:.4g} ms at least, and the largest gap is {:.4g} ms, at {:.6g} s; resampled on straight "
      "lines "
      "at {:.6g} Hz.",
      1e3 * median, 1e3 * typical, 1e3 * intervals.minCoeff(), 1e3 * largest, rows.times[at],
      rows.rate);
}

RawColumn atEqualTimes(const Eigen::VectorXd& cells, const RowTimes& rows) {
  if (rows.equal) return compressed(cells, rows.rate, rows.times[0]);
  std::vector<Eigen::Index> measured;
  for (Eigen::Index i = 0; i < cells.size(); ++i) {
    if (!std::isnan(cells[i])) measured.push_back(i);
  }
  RawColumn out;
  if (measured.size() < 2) {
    out.rate = rows.rate;
    if (!measured.empty()) {
      out.startTime = rows.times[measured.front()];
      out.values = cells(measured);
    }
    return out;
  }
  const Eigen::VectorXd times = rows.times(measured), values = cells(measured);
  const Eigen::VectorXd intervals = intervalsOf(times);
  // what fills every row has the rate of the rows
  const bool sparse = static_cast<Eigen::Index>(measured.size()) < cells.size();
  out.rate = sparse ? rounded(1 / medianOf(intervals)) : rows.rate;
  out.startTime = times[0];
  out.largestGap = intervals.maxCoeff();
  const Eigen::Index last = times.size() - 1;
  const double count = std::floor((times[last] - times[0]) * out.rate + 1e-6);
  if (!(count <= 4 * static_cast<double>(rows.times.size()) + 100)) {
    // few and far between: at their mean rate, so that no file asks for more than it holds
    out.rate = static_cast<double>(last) / (times[last] - times[0]);
  }
  const auto samples =
      static_cast<Eigen::Index>(std::floor((times[last] - times[0]) * out.rate + 1e-6)) + 1;
  out.values.resize(samples);
  Eigen::Index k = 0;
  for (Eigen::Index i = 0; i < samples; ++i) {
    const double t = std::min(times[0] + static_cast<double>(i) / out.rate, times[last]);
    while (k + 1 < last && times[k + 1] <= t) ++k;
    const double part = (t - times[k]) / (times[k + 1] - times[k]);
    const bool inGap = intervals[k] * out.rate > longGap && part > 0 && part < 1;
    out.values[i] = inGap ? std::numeric_limits<double>::quiet_NaN()
                          : (1 - part) * values[k] + part * values[k + 1];
  }
  // a gap at the very end leaves nothing measured there
  Eigen::Index end = samples;
  while (end > 0 && std::isnan(out.values[end - 1])) --end;
  out.values.conservativeResize(end);
  return out;
}

}  // namespace bio
