#pragma once

namespace app {

/// Where mpirun started `fisherhill ensemble`, this program becomes `fisherhill-mpi` beside it,
/// with the same words, and does not return; everything else goes on as it is. If that program was
/// not built, rank 0 says so in one line and all ranks end with status 2: each would do all the
/// work.
///
/// A program of its own, so that no other command has to load MPI.
void becomeRankUnderMpi(int argc, char** argv);

}  // namespace app
