#include "ensemble/mpi_pool.h"

#include <mpi.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstring>
#include <deque>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>

#include "output/interruption.h"

namespace app {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int tagRows = 1;     ///< rows, no question
constexpr int tagRequest = 2;  ///< rows, and: give me more
constexpr int tagChunk = 3;    ///< numbers; none: there is nothing left
constexpr int tagStopped = 4;  ///< rows, the last ones: interrupted
constexpr auto together = std::chrono::milliseconds(50);

/// Finished rows as one message: number, length, text, again and again.
class RowMessage {
 public:
  void add(std::uint64_t number, const std::string& row) {
    const std::uint64_t head[2] = {number, row.size()};
    const auto at = bytes_.size();
    bytes_.resize(at + sizeof head + row.size());
    std::memcpy(bytes_.data() + at, head, sizeof head);
    std::memcpy(bytes_.data() + at + sizeof head, row.data(), row.size());
  }
  void send(int tag) {
    MPI_Send(bytes_.data(), static_cast<int>(bytes_.size()), MPI_BYTE, 0, tag, MPI_COMM_WORLD);
    bytes_.clear();
  }
  template <class Take>
  static void read(const std::vector<char>& bytes, Take take) {
    for (std::size_t at = 0; at < bytes.size();) {
      std::uint64_t head[2];
      std::memcpy(head, bytes.data() + at, sizeof head);
      at += sizeof head;
      take(head[0], std::string(bytes.data() + at, head[1]));
      at += head[1];
    }
  }
  /// Rows of a size that no message should exceed wait for nothing.
  bool isLarge() const { return bytes_.size() > (1u << 20); }

 private:
  std::vector<char> bytes_;
};

RowNumbers rising(const std::vector<std::uint64_t>& numbers) {
  RowNumbers ranges;
  for (const std::uint64_t number : numbers) ranges.add(number);
  return ranges;
}

/// The work as rank 0 knows it: its own threads and the messages of the others meet here.
class Handout {
 public:
  Handout(const RowWork& work, int workers) : work_(&work), workers_(workers) {}

  /// Numbers for one of the workers; none when nothing is left or the work has been stopped.
  std::vector<std::uint64_t> chunk(std::size_t atLeast) {
    const std::lock_guard lock(mutex_);
    const std::size_t left = stopped_ ? 0 : work_->numbers.size() - next_;
    const std::size_t share = left / (4 * static_cast<std::size_t>(workers_));
    const std::size_t batch = work_->together;
    const std::size_t whole = (std::max(share, atLeast) + batch - 1) / batch * batch;
    const std::size_t size = std::min(left, whole);
    const auto first = std::exchange(next_, next_ + size);
    return work_->numbers.part(first, size);
  }
  void stop() {
    const std::lock_guard lock(mutex_);
    stopped_ = true;
  }
  bool isStopped() {
    const std::lock_guard lock(mutex_);
    return stopped_;
  }
  void finished(std::uint64_t number, std::string row) {
    const std::lock_guard lock(mutex_);
    rows_.emplace_back(number, std::move(row));
  }
  std::deque<std::pair<std::uint64_t, std::string>> takeFinished() {
    const std::lock_guard lock(mutex_);
    return std::exchange(rows_, {});
  }

 private:
  const RowWork* work_;
  int workers_;
  std::mutex mutex_;
  std::size_t next_ = 0;
  bool stopped_ = false;
  std::deque<std::pair<std::uint64_t, std::string>> rows_;
};

class MpiPool : public WorkerPool {
 public:
  MpiPool() {
    MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
    MPI_Comm_size(MPI_COMM_WORLD, &size_);
  }
  ~MpiPool() override {
    if (leads() && !started_) tellStart(false);
  }

  bool leads() const override { return rank_ == 0; }
  int ranks() const override { return size_; }
  int defaultThreads(const CommandContext&) const override { return 1; }

  bool start() override { return tellStart(true); }

  void work(const RowWork& work, int threads) override {
    if (leads()) {
      lead(work, threads);
    } else {
      follow(work, threads);
    }
  }

 private:
  bool tellStart(bool wanted) {
    started_ = true;
    int go = wanted ? 1 : 0;
    MPI_Bcast(&go, 1, MPI_INT, 0, MPI_COMM_WORLD);
    return go == 1;
  }

  void lead(const RowWork& work, int threads) {
    Handout handout(work, size_);
    std::exception_ptr failure;
    const auto remember = [&](std::exception_ptr error) {
      if (!failure) failure = error;
      handout.stop();
    };
    std::atomic<bool> ownDone = false;
    std::exception_ptr ownFailure;
    std::jthread own([&] {
      try {
        for (;;) {
          const auto numbers = handout.chunk(static_cast<std::size_t>(threads));
          if (numbers.empty()) break;
          RowWork untilStopped = work;
          untilStopped.rows = [&](std::span<const std::uint64_t> batch) {
            return handout.isStopped() ? std::vector<std::string>(batch.size()) : work.rows(batch);
          };
          inBatches(untilStopped, rising(numbers), threads,
                    [&](std::uint64_t number, const std::string& row) {
                      if (!handout.isStopped()) handout.finished(number, row);
                    });
        }
      } catch (...) {
        ownFailure = std::current_exception();
        handout.stop();
      }
      ownDone = true;
    });

    bool interrupted = false;
    const auto take = [&](std::uint64_t number, const std::string& row) {
      if (failure) return;
      try {
        work.take(number, row);
      } catch (const Interrupted&) {  // this row was taken; those that are finished are still
        interrupted = true;
        handout.stop();
      } catch (...) {
        remember(std::current_exception());
      }
    };
    int atWork = size_ - 1;
    while (atWork > 0 || !ownDone) {
      bool idle = true;
      for (const auto& [number, row] : handout.takeFinished()) {
        take(number, row);
        idle = false;
      }
      if (interruptionRequested()) {
        interrupted = true;
        handout.stop();
      }
      if (atWork > 0 && receive(take, handout, atWork, interrupted)) idle = false;
      if (idle) std::this_thread::sleep_for(std::chrono::microseconds(200));
    }
    own.join();
    for (const auto& [number, row] : handout.takeFinished()) take(number, row);
    if (ownFailure) std::rethrow_exception(ownFailure);
    if (failure) std::rethrow_exception(failure);
    if (interrupted) throw Interrupted{};
  }

  /// Receives one message if there is one, and answers a request. @return whether there was one
  template <class Take>
  static bool receive(const Take& take, Handout& handout, int& atWork, bool& interrupted) {
    int there = 0;
    MPI_Status status;
    MPI_Iprobe(MPI_ANY_SOURCE, MPI_ANY_TAG, MPI_COMM_WORLD, &there, &status);
    if (!there) return false;
    int size = 0;
    MPI_Get_count(&status, MPI_BYTE, &size);
    std::vector<char> bytes(static_cast<std::size_t>(size));
    MPI_Recv(bytes.data(), size, MPI_BYTE, status.MPI_SOURCE, status.MPI_TAG, MPI_COMM_WORLD,
             MPI_STATUS_IGNORE);
    if (status.MPI_TAG == tagRequest) {
      const auto numbers = handout.chunk(1);
      MPI_Send(numbers.data(), static_cast<int>(numbers.size()), MPI_UINT64_T, status.MPI_SOURCE,
               tagChunk, MPI_COMM_WORLD);
      if (numbers.empty()) --atWork;
    }
    if (status.MPI_TAG == tagStopped) {
      --atWork;
      interrupted = true;
      handout.stop();
    }
    RowMessage::read(bytes, take);
    return true;
  }

  void follow(const RowWork& work, int threads) {
    RowMessage message;
    for (;;) {
      message.send(tagRequest);
      MPI_Status status;
      MPI_Probe(0, tagChunk, MPI_COMM_WORLD, &status);
      int count = 0;
      MPI_Get_count(&status, MPI_UINT64_T, &count);
      std::vector<std::uint64_t> numbers(static_cast<std::size_t>(count));
      MPI_Recv(numbers.data(), count, MPI_UINT64_T, 0, tagChunk, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
      if (numbers.empty()) return;
      try {
        compute(work, numbers, threads, message);
      } catch (const Interrupted&) {
      }
      if (!interruptionRequested()) continue;
      message.send(tagStopped);
      return;
    }
  }

  /// Threads only compute; messages are the main thread's affair (MPI_THREAD_FUNNELED).
  static void compute(const RowWork& work, const std::vector<std::uint64_t>& numbers, int threads,
                      RowMessage& message) {
    RowWork untilInterrupted = work;
    untilInterrupted.rows = [&work](std::span<const std::uint64_t> batch) {
      stopIfInterrupted();
      return work.rows(batch);
    };
    Clock::time_point sent = Clock::now();
    const auto sendIfLate = [&] {
      if (Clock::now() - sent < together && !message.isLarge()) return;
      message.send(tagRows);
      sent = Clock::now();
    };
    if (threads == 1) {
      inBatches(untilInterrupted, rising(numbers), 1,
                [&](std::uint64_t number, const std::string& row) {
                  message.add(number, row);
                  sendIfLate();
                });
      return;
    }
    std::mutex mutex;
    std::atomic<bool> done = false;
    std::exception_ptr failure;
    std::jthread own([&] {
      try {
        const auto take = [&](std::uint64_t number, const std::string& row) {
          const std::lock_guard lock(mutex);
          message.add(number, row);
        };
        inBatches(untilInterrupted, rising(numbers), threads, take);
      } catch (...) {
        failure = std::current_exception();
      }
      done = true;
    });
    while (!done) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      const std::lock_guard lock(mutex);
      sendIfLate();
    }
    own.join();
    if (failure) std::rethrow_exception(failure);
  }

  int rank_ = 0, size_ = 1;
  bool started_ = false;
};

}  // namespace

std::unique_ptr<WorkerPool> mpiPool() {
  return std::make_unique<MpiPool>();
}

}  // namespace app
