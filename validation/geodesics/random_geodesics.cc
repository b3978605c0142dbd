// A million random taut strings over ellipsoids, tori and chains of two and
// three ellipsoids, each walked again by the geodesic equations under a plain
// Runge–Kutta rule; by how much it misses the end, and by how much its length
// differs; of every tenth also how far first and second derivatives over a
// random motion of ends and objects are from differences.
//
//   random_geodesics [how many of each kind, 250000 by default]
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "support/integrated_geodesic.h"
#include "support/moved_chains.h"
#include "support/random_chains.h"

namespace {

struct Tally {
  long drawn = 0, walked = 0, straight = 0, notFound = 0, cutAgain = 0, notShortest = 0, tooFar = 0;
  double largestMiss = 0, largestDifference = 0;
  long differentiated = 0, tooSteep = 0;
  double largestSlope = 0,
         largestBend = 0;  ///< deviations: [m/m]; of the second derivatives' size
};

constexpr double slopeBound = 1e-7, bendBound = 1e-5;

// A path that is lost or changes its way within the differences tells nothing.
// Near a fold contacts move up to a hundred times as far as the ends:
// differences over 1e-5 m may be too coarse there and are repeated with shorter
// ones.
void addDerivatives(const support::RandomChain& chain, const bio::ChainMemory& memory,
                    const bio::ChainPath& path, support::RandomChains& random, Tally& tally) {
  const bio::ChainScrews motion = support::randomMotion(random);
  if (!support::isWellInside(path)) return;
  bool isSmooth = true;
  const auto solvedAt = [&](double share) {
    const support::RandomChain shifted = support::moved(chain, motion, share);
    bio::ChainMemory start = memory;
    const bio::ChainPath other = bio::solveChain(shifted.P, shifted.Q, shifted.objects, start);
    isSmooth = isSmooth && other.event == bio::ChainEvent::none && other.passing == path.passing;
    return other;
  };
  const double along = support::along(bio::chainGradient(path), motion);
  const auto change = support::flat(bio::ChainChanges(path).gradientChange(motion));
  double slopeError = 1, bendError = 1;
  for (const double step : {1e-5, 3e-6, 1e-6, 3e-7}) {
    const double slope = support::difference([&](double h) { return solvedAt(h).length; }, step);
    const auto bend = support::difference(
        [&](double h) { return support::flat(bio::chainGradient(solvedAt(h))); }, step);
    if (!isSmooth) return;
    slopeError = std::min(slopeError, std::abs(along - slope));
    bendError = std::min(bendError, (change - bend).norm() / (1 + bend.norm()));
    if (slopeError < slopeBound && bendError < bendBound) break;
  }
  ++tally.differentiated;
  if (!(slopeError < slopeBound) || !(bendError < bendBound)) ++tally.tooSteep;
  tally.largestSlope = std::max(tally.largestSlope, slopeError);
  tally.largestBend = std::max(tally.largestBend, bendError);
}

// A walk of 300 steps may be too coarse: it is then repeated with eight times
// as many.
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
    support::RandomChains motions(static_cast<unsigned>(kind) + 101);
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
        if (tally.drawn % 10 == 0) addDerivatives(chain, memory, path, motions, tally);
      }
    }
    fmt::print(
        "{:10}: {} drawn, {} walked, {} straight, {} cut a torus again, "
        "{} not found, {} not the "
        "shortest among their neighbours; of the length: largest miss "
        "{:.2g}, largest difference "
        "{:.2g}, above 1e-9: {}\n",
        names[kind], tally.drawn, tally.walked, tally.straight, tally.cutAgain, tally.notFound,
        tally.notShortest, tally.largestMiss, tally.largestDifference, tally.tooFar);
    fmt::print(
        "{:10}  derivatives of {}: first within {:.2g}, second within "
        "{:.2g}; worse than "
        "1e-7 or 1e-5: {}\n",
        "", tally.differentiated, tally.largestSlope, tally.largestBend, tally.tooSteep);
    std::fflush(stdout);
    good = good && tally.tooFar == 0 && tally.tooSteep == 0;
  }
  return good ? 0 : 1;
}
