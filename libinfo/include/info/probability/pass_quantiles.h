#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace info {

/// Mean, standard deviation and exact sample quantiles of columns that are too long to be kept,
/// from several passes over their values:
///
///     PassQuantiles columns(2, {0.05, 0.5, 0.95});
///     do {
///       for (…) { columns.add(0, x); columns.add(1, y); }
///     } while (!columns.endPass());
///     columns.quantile(0, 1);  // the median of the first column
///
/// The first pass counts and keeps the first values of every column; where these are all, they are
/// sorted and no other pass follows. Else every pass counts, between two values that enclose an
/// order statistic, how many values fall into each of many bins, and the next pass looks into the
/// bin that holds it, until few enough values are left to be sorted. The bins divide the numbers of
/// double precision, in their order, not their range, so that at most ten passes are needed
/// whatever the values, and three where they are spread.
///
/// Memory: 8 kept() bytes for every column and about 16 MB for the bins, whatever the length.
class PassQuantiles {
 public:
  /// @param shares  probabilities, 0 to 1, in rising order
  PassQuantiles(std::size_t columns, std::vector<double> shares);

  /// The number of values of a column that are kept.
  static constexpr std::size_t kept() { return 4096; }

  /// A value of a column; values that are not finite are ignored. Every pass must give the same
  /// values, in any order.
  void add(std::size_t column, double value);

  /// Ends a pass.
  /// @return whether it was the last one; else the values are needed once more
  /// @throws std::logic_error if the pass had other values than the one before
  bool endPass();

  /// Number of finite values.
  std::uint64_t count(std::size_t column) const { return columns_[column].count; }
  /// NaN without a finite value.
  double mean(std::size_t column) const;
  /// Sample standard deviation; NaN with fewer than two finite values.
  double sd(std::size_t column) const;
  /// Linear between order statistics, as quantileOf(); NaN without a finite value. Valid after
  /// the last pass.
  /// @param share  index of the probability
  double quantile(std::size_t column, std::size_t share) const;

 private:
  /// An order statistic that is looked for: it is one of the numbers from `low` to `high`, which
  /// are counted from the least double on, and found where these are the same.
  struct Search {
    std::uint64_t rank;  ///< among all values, from 0
    std::uint64_t low, high;
    std::uint64_t inside;     ///< number of values there
    std::uint64_t below = 0;  ///< number of values below
    std::vector<std::uint32_t> bins = {};
    std::vector<double> values = {};  ///< where they are few: all of them

    bool isFound() const { return low == high; }
    /// How many numbers a bin has.
    std::uint64_t width() const { return (high - low) / bins.size() + 1; }
    /// Looks into what the pass has counted or kept.
    void narrow();
  };
  struct Column {
    std::uint64_t count = 0;
    double mean = 0, squares = 0;  ///< Σ (x − mean)²
    double least = 0, most = 0;
    std::vector<double> first = {};
    std::vector<Search> searches = {};  ///< in rising order of rank
  };

  void beginSearches(Column& column) const;

  std::vector<double> shares_;
  std::size_t bins_;
  bool isFirst_ = true;
  std::vector<Column> columns_;
};

}  // namespace info
