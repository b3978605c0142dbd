#pragma once

namespace app {

/// If mpirun started `fisherhill ensemble`, replaces this process by `fisherhill-mpi` with the same
/// arguments and does not return; otherwise does nothing. If that program was not built, rank 0
/// reports this in one line and all ranks end with status 2, since each would do all the work.
///
/// It is a separate program so that other commands do not load MPI.
void becomeRankUnderMpi(int argc, char** argv);

}  // namespace app
