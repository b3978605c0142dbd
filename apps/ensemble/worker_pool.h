#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "output/command_context.h"

namespace app {

/// Rising numbers, kept as ranges.
class RowNumbers {
 public:
  /// @param number greater than all before
  void add(std::uint64_t number);
  std::size_t size() const { return size_; }
  /// At most `count` numbers from the place `first` on.
  std::vector<std::uint64_t> part(std::size_t first, std::size_t count) const;

 private:
  struct Range {
    std::uint64_t first;  ///< number
    std::size_t place;    ///< of it among all
  };
  std::vector<Range> ranges_;
  std::size_t size_ = 0;
};

/// Numbered rows to compute.
struct RowWork {
  RowNumbers numbers;  ///< numbers of the rows; used by the root rank only
  /// Computes the texts of some rows, each a pure function of its number; called from several
  /// threads.
  std::function<std::vector<std::string>(std::span<const std::uint64_t> numbers)> rows;
  /// Number of rows that are best computed at once.
  std::size_t together = 1;
  /// Receives a finished row; called in the root rank only, one call at a time, in any order. An
  /// exception ends the work.
  std::function<void(std::uint64_t number, const std::string& row)> take;
};

/// Computes the rows on several threads and passes each to `take`, which is called from all
/// threads.
/// @throws what `rows` and `take` throw
void inBatches(const RowWork& work, const RowNumbers& numbers, int threads,
               const std::function<void(std::uint64_t number, const std::string& row)>& take);

/// A pool of workers that compute rows: the threads of one process, or of several MPI ranks that
/// send their rows to the root rank. Every rank runs the same command; only the root rank prints
/// and writes files.
class WorkerPool {
 public:
  virtual ~WorkerPool() = default;

  virtual bool leads() const = 0;
  virtual int ranks() const = 0;
  /// Default number of threads of each rank.
  virtual int defaultThreads(const CommandContext& context) const = 0;

  /// The root rank calls this before work(), once all input has been checked; the other ranks wait
  /// for it.
  /// @return false if the root rank gave up, so that there is no work
  virtual bool start() = 0;

  /// Computes every row. In the other ranks it returns when no rows are left.
  /// @throws what `rows` and, in the root rank, `take` throw
  virtual void work(const RowWork& work, int threads) = 0;
};

/// A pool of this process only.
std::unique_ptr<WorkerPool> threadPool();

}  // namespace app
