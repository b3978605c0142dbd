#include <fcntl.h>
#include <mpi.h>
#include <unistd.h>

#include <cstdio>

#include "ensemble.h"
#include "mpi_crew.h"
#include "run_program.h"
#include "standard_streams.h"

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
class SpeakingCrew : public app::Crew {
 public:
  SpeakingCrew(std::unique_ptr<app::Crew> crew, Silence* silence, bool& atWork)
      : crew_(std::move(crew)), silence_(silence), atWork_(&atWork) {}
  bool leads() const override { return crew_->leads(); }
  int ranks() const override { return crew_->ranks(); }
  int defaultThreads(const app::CommandContext& context) const override {
    return crew_->defaultThreads(context);
  }
  bool start() override {
    *atWork_ = crew_->start();
    if (*atWork_ && silence_) silence_->end();
    return *atWork_;
  }
  void work(const app::RowWork& work, int threads) override { crew_->work(work, threads); }

 private:
  std::unique_ptr<app::Crew> crew_;
  Silence* silence_;
  bool* atWork_;
};

}  // namespace

// `mpirun … fisherhill ensemble …` becomes as many of these.
int main(int argc, char** argv) {
  app::openStandardStreams();
  int provided = 0, rank = 0;
  MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &provided);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  std::unique_ptr<Silence> silence;
  if (rank > 0) silence = std::make_unique<Silence>();
  bool atWork = false;
  std::vector<std::unique_ptr<app::Command>> commands;
  commands.push_back(app::ensembleCommand(
      [&] { return std::make_unique<SpeakingCrew>(app::mpiCrew(), silence.get(), atWork); }));
  const int status = app::runProgram({argv, argv + argc}, std::move(commands));
  // one that fails at work takes the others with it: what is finished is in the file
  if (rank > 0 && atWork && status != 0) MPI_Abort(MPI_COMM_WORLD, status);
  MPI_Finalize();
  return rank == 0 ? status : 0;
}
