#include "ensemble/mpi_launch.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string_view>

namespace app {
namespace {

/// This process's rank as Open MPI, or a launcher that speaks PMI, tells it; null: there is none.
const char* rankTold() {
  for (const char* name : {"OMPI_COMM_WORLD_RANK", "PMI_RANK", "PMIX_RANK"}) {
    if (const char* rank = std::getenv(name)) return rank;
  }
  return nullptr;
}

}  // namespace

void becomeRankUnderMpi(int argc, char** argv) {
  const char* rank = rankTold();
  if (!rank || argc < 2) return;
  const std::string_view command = argv[1];
  if (command != "ensemble" && command != "study") return;
  const std::filesystem::path program =
      std::filesystem::read_symlink("/proc/self/exe").parent_path() / "fisherhill-mpi";
  execv(program.c_str(), argv);
  if (std::string_view(rank) == "0") {
    fmt::print(stderr,
               "fisherhill {}: {} cannot be started ({}); it is built if MPI is installed "
               "and FISHERHILL_MPI=ON\n",
               command, program.string(), std::strerror(errno));
  }
  std::_Exit(2);
}

}  // namespace app
