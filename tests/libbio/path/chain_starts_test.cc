#include "bio/path/chain_starts.h"

#include <gtest/gtest.h>

#include "support/allocations.h"
#include "support/random_chains.h"

namespace bio {
namespace {

using Eigen::Vector3d;
using support::RandomChain;
using support::RandomChains;

// The placements of a chain's objects.
ChainPlacements placementsOf(const RandomChain& chain) {
  ChainPlacements X_GC;
  for (std::size_t j = 0; j < chain.objects.size(); ++j) {
    X_GC[j] = {chain.objects[j].R_GS, chain.objects[j].p_GS};
  }
  return X_GC;
}

// The chain with ends and objects moved along some fixed directions, two numbers say how far.
RandomChain moved(RandomChain chain, double s, double t) {
  RandomChains random(7);
  chain.P += s * random.direction();
  chain.Q += t * random.direction();
  for (std::size_t j = 1; j < chain.objects.size(); ++j) {
    ChainObject& o = chain.objects[j];
    o.R_GS = Eigen::AngleAxisd(8 * s + 5 * t, random.direction()).toRotationMatrix() * o.R_GS;
    o.p_GS += t * random.direction();
  }
  return chain;
}

ChainStarts::Known known(const RandomChain& chain, const ChainMemory& from) {
  ChainStarts::Known posture{placementsOf(chain), chain.P, chain.Q, {}, from};
  posture.taut = solveChain(chain.P, chain.Q, chain.objects, posture.memory);
  return posture;
}

// A grid of postures of one chain.
std::vector<ChainStarts::Known> gridOf(const RandomChain& chain, int width, double step) {
  std::vector<ChainStarts::Known> grid;
  for (int i = -width; i <= width; ++i) {
    for (int k = -width; k <= width; ++k) {
      grid.push_back(known(moved(chain, i * step, k * step), {}));
    }
  }
  return grid;
}

double squareApart(const ChainEnds& a, const ChainEnds& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return sum;
}

TEST(ChainStarts, StartsFromThePostureThatIsNearest) {
  for (const int count : {1, 2, 3}) {
    RandomChains random(static_cast<unsigned>(70 + count));
    const RandomChain chain = random.ellipsoids(count);
    const auto grid = gridOf(chain, 6, 1e-3);
    const auto size = static_cast<std::size_t>(count);
    const ChainStarts starts(size, count == 1, grid);
    for (int trial = 0; trial < 100; ++trial) {
      const RandomChain here =
          moved(chain, random.between(-8e-3, 8e-3), random.between(-8e-3, 8e-3));
      const ChainPlacements X_GC = placementsOf(here);
      const ChainEnds ends = chainEnds(size, X_GC, here.P, here.Q);
      double least = 1;
      for (const ChainStarts::Known& each : grid) {
        least = std::min(least, squareApart(ends, chainEnds(size, each.X_GC, each.P, each.Q)));
      }
      const ChainMemory& found = *starts.startFor(here.objects, X_GC, here.P, here.Q).kept;
      const auto isFound = [&](const ChainStarts::Known& each) {
        return each.memory.contacts[0].p_SA == found.contacts[0].p_SA &&
               squareApart(ends, chainEnds(size, each.X_GC, each.P, each.Q)) < least + 1e-9;
      };
      EXPECT_TRUE(std::any_of(grid.begin(), grid.end(), isFound));
    }
  }
}

// Half the way, a quarter of what is left to do; whatever moves.
TEST(ChainStarts, MovesContactsToFirstOrder) {
  int measured = 0;
  for (int trial = 0; trial < 60; ++trial) {
    RandomChains random(static_cast<unsigned>(200 + trial));
    const int count = 1 + trial % 3;
    const RandomChain chain = random.ellipsoids(count);
    const ChainStarts::Known at = known(chain, {});
    if (!at.taut.isShortest || at.taut.numContacts < count) continue;
    const ChainStarts starts(static_cast<std::size_t>(count), count == 1, {at});
    const auto error = [&](double share) {
      const RandomChain here = moved(chain, share, -0.7 * share);
      const ChainMemory exact = known(here, at.memory).memory;
      const ChainMemory start =
          starts.startFor(here.objects, placementsOf(here), here.P, here.Q).moved;
      double sum = 0;
      for (std::size_t j = 0; j < here.objects.size(); ++j) {
        const ContactMemory &a = start.contacts[j], &b = exact.contacts[j];
        sum += (a.p_SA - b.p_SA).squaredNorm() + (a.arc - b.arc) * (a.arc - b.arc);
      }
      return std::sqrt(sum);
    };
    const double whole = error(4e-4), half = error(2e-4);
    if (whole > 2e-4) continue;  // near a fold, where a step is too long
    ++measured;
    EXPECT_LT(half, 0.35 * whole + 1e-8) << trial;
    EXPECT_LT(whole, 2e-4);
  }
  EXPECT_GT(measured, 25);
}

TEST(ChainStarts, AllocatesNothingWhenAsked) {
  RandomChains random(5);
  const RandomChain chain = random.ellipsoids(2);
  const ChainStarts starts(2, false, gridOf(chain, 2, 1e-3));
  const ChainPlacements X_GC = placementsOf(chain);
  const long before = support::allocations();
  const ChainStarts::Start start = starts.startFor(chain.objects, X_GC, chain.P, chain.Q);
  EXPECT_EQ(support::allocations(), before);
  EXPECT_TRUE(start.moved.known);
}

}  // namespace
}  // namespace bio
