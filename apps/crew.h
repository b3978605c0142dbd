#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "command_context.h"

namespace app {

/// Numbered rows to be computed.
struct RowWork {
  std::vector<std::uint64_t> numbers;  ///< which; looked at by the leader alone
  /// The texts of some rows, each a pure function of its number alone; called from several threads.
  std::function<std::vector<std::string>(std::span<const std::uint64_t> numbers)> rows;
  /// As many rows as are best computed at once, if so many are left.
  std::size_t together = 1;
  /// Takes a finished row; called in the leader alone, one call at a time, in any order. Throwing
  /// ends the work.
  std::function<void(std::uint64_t number, const std::string& row)> take;
};

/// Computes these rows on some threads and gives each to `take`, which is called from all of them.
/// @throws what `rows` and `take` throw
void inBatches(const RowWork& work, std::span<const std::uint64_t> numbers, int threads,
               const std::function<void(std::uint64_t number, const std::string& row)>& take);

/// Those who compute rows: the threads of one program, or of many (ranks) that send their rows to
/// the leader. Every program of a crew runs the same command; only the leader speaks and writes.
class Crew {
 public:
  virtual ~Crew() = default;

  virtual bool leads() const = 0;
  virtual int ranks() const = 0;
  /// Threads of each rank where the user does not say.
  virtual int defaultThreads(const CommandContext& context) const = 0;

  /// The leader calls this when everything is in order, before work(); the others wait for it.
  /// @return false if the leader gave up: there will be no work
  virtual bool start() = 0;

  /// Has every row computed. In those who do not lead it returns when nothing is left to do.
  /// @throws what `rows` and, in the leader, `take` throw
  virtual void work(const RowWork& work, int threads) = 0;
};

/// This program alone.
std::unique_ptr<Crew> threadCrew();

}  // namespace app
