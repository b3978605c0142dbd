#include <fcntl.h>
#include <mpi.h>
#include <unistd.h>

#include <cstdio>

#include "command/run_program.h"
#include "ensemble/ensemble.h"
#include "ensemble/mpi_pool.h"
#include "output/standard_streams.h"
#include "program/all_commands.h"
#include "study/study.h"

namespace {

/// Rank 0 speaks for all while they do the same; a rank at work speaks for itself.
class Silence {
 public:
  Silence() : kept_(dup(STDERR_FILENO)) {
    const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
    dup2(nowhere, STDERR_FILENO);
    dup2(nowhere, STDOUT_FILENO);
    close(nowhere);
  }
  void end() {
    std::fflush(stderr);
    dup2(kept_, STDERR_FILENO);
  }

 private:
  int kept_;
};

/// A crew that lets a follower speak once there is work for it.
class ReportingPool : public app::WorkerPool {
 public:
  ReportingPool(std::unique_ptr<app::WorkerPool> pool, Silence* silence, bool& atWork)
      : pool_(std::move(pool)), silence_(silence), atWork_(&atWork) {}
  bool leads() const override { return pool_->leads(); }
  int ranks() const override { return pool_->ranks(); }
  int defaultThreads(const app::CommandContext& context) const override {
    return pool_->defaultThreads(context);
  }
  bool start() override {
    *atWork_ = pool_->start();
    if (*atWork_ && silence_) silence_->end();
    return *atWork_;
  }
  void work(const app::RowWork& work, int threads) override { pool_->work(work, threads); }

 private:
  std::unique_ptr<app::WorkerPool> pool_;
  Silence* silence_;
  bool* atWork_;
};

}  // namespace

// `mpirun … fisherhill ensemble …`, or study, becomes as many of these.
int main(int argc, char** argv) {
  app::openStandardStreams();
  int provided = 0, rank = 0;
  MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &provided);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  std::unique_ptr<Silence> silence;
  if (rank > 0) silence = std::make_unique<Silence>();
  bool atWork = false;
  std::vector<std::unique_ptr<app::Command>> commands;
  const auto pool = [&] {
    return std::make_unique<ReportingPool>(app::mpiPool(), silence.get(), atWork);
  };
  commands.push_back(app::ensembleCommand(pool));
  commands.push_back(app::studyCommand(pool, app::allCommands));
  const int status = app::runProgram({argv, argv + argc}, std::move(commands));
  // one that fails at work takes the others with it: what is finished is in the file
  if (rank > 0 && atWork && status != 0) MPI_Abort(MPI_COMM_WORLD, status);
  MPI_Finalize();
  return rank == 0 ? status : 0;
}
