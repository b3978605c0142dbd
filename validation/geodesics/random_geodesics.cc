// A million random taut strings over ellipsoids, tori and chains of two and three ellipsoids, each
// walked again by the geodesic equations under a plain Runge–Kutta rule; by how much it misses the
// end, and by how much its length differs.
//
//   random_geodesics [how many of each kind, 250000 by default]
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "support/integrated_geodesic.h"
#include "support/random_chains.h"

namespace {

struct Tally {
  long drawn = 0, walked = 0, straight = 0, notFound = 0, cutAgain = 0, notShortest = 0, tooFar = 0;
  double largestMiss = 0, largestDifference = 0;
};

// A walk of 300 steps may be too coarse: it is then repeated with eight times as many.
void addWalk(const support::RandomChain& chain, const bio::ChainPath& path, Tally& tally) {
  double miss = 0, difference = 0;
  for (const int steps : {300, 2400, 19200}) {
    double walked = 0;
    miss = support::missOf(chain.Q, chain.objects, path, steps, walked) / path.length;
    difference = std::abs(walked - path.length) / path.length;
    if (std::max(miss, difference) < 2e-10) break;
  }
  ++tally.walked;
  if (std::max(miss, difference) > 1e-9) ++tally.tooFar;
  tally.largestMiss = std::max(tally.largestMiss, miss);
  tally.largestDifference = std::max(tally.largestDifference, difference);
}

}  // namespace

int main(int argc, char** argv) {
  const long count = argc > 1 ? std::atol(argv[1]) : 250000;
  const char* names[] = {"ellipsoid", "torus", "chain of 2", "chain of 3"};
  bool good = true;
  for (int kind = 0; kind < 4; ++kind) {
    support::RandomChains random(static_cast<unsigned>(kind) + 1);
    Tally tally;
    for (; tally.drawn < count; ++tally.drawn) {
      const support::RandomChain chain = random.ofKind(kind);
      bio::ChainMemory memory;
      const bio::ChainPath path = solveChain(chain.P, chain.Q, chain.objects, memory);
      if (path.event == bio::ChainEvent::notFound) {
        ++tally.notFound;
      } else if (path.event == bio::ChainEvent::cutsAgain) {
        ++tally.cutAgain;
      } else if (path.numContacts == 0) {
        ++tally.straight;
      } else {
        if (!path.isShortest) ++tally.notShortest;
        addWalk(chain, path, tally);
      }
    }
    fmt::print(
        "{:10}: {} drawn, {} walked, {} straight, {} cut a torus again, {} not found, {} not the "
        "shortest among their neighbours; of the length: largest miss {:.2g}, largest difference "
        "{:.2g}, above 1e-9: {}\n",
        names[kind], tally.drawn, tally.walked, tally.straight, tally.cutAgain, tally.notFound,
        tally.notShortest, tally.largestMiss, tally.largestDifference, tally.tooFar);
    std::fflush(stdout);
    good = good && tally.tooFar == 0;
  }
  return good ? 0 : 1;
}
