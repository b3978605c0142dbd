#pragma once

#include <memory>

#include "crew.h"

namespace app {

/// The ranks of MPI_COMM_WORLD; rank 0 leads. Made and destroyed between MPI_Init and MPI_Finalize,
/// once.
///
/// Rank 0 hands out the rows' numbers in chunks that shrink as less is left (a quarter of an even
/// share), computes with its own threads as the others do, and takes all rows; its main thread does
/// nothing but this. The others send rows as they are finished, those that take milliseconds
/// together for at most a twentieth of a second, and ask for more when nothing is left of a chunk.
/// So when a rank dies what is lost is what it was working on, and a twentieth of a second.
///
/// After Ctrl-C, which mpirun hands to the ranks as SIGTERM, every rank finishes the row it is at
/// and sends what it has; in rank 0 work() then throws Interrupted, in the others it returns.
/// mpirun kills whoever needs more than a second for that.
std::unique_ptr<Crew> mpiCrew();

}  // namespace app
