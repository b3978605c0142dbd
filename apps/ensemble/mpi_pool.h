#pragma once

#include <memory>

#include "ensemble/worker_pool.h"

namespace app {

/// The ranks of MPI_COMM_WORLD; rank 0 is the root. Must be constructed and destroyed once, between
/// MPI_Init and MPI_Finalize.
///
/// Rank 0 hands out row numbers in chunks that shrink as fewer are left (a quarter of an even
/// share), computes rows with its own threads like the other ranks, and collects all rows in its
/// main thread. The other ranks send rows as they are finished, short ones collected over at most
/// 0.05 s, and ask for more when their chunk is finished. If a rank dies, only the rows it was
/// computing and those of the last 0.05 s are lost.
///
/// After Ctrl-C, which mpirun passes on as SIGTERM, every rank finishes its current row and sends
/// its rows. In rank 0 work() then throws Interrupted, in the others it returns. mpirun kills a
/// rank that needs more than a second for this.
std::unique_ptr<WorkerPool> mpiPool();

}  // namespace app
