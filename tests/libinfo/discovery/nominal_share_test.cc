// A prior that gives the nominal value of a quantity a probability of its own.

#include <gtest/gtest.h>

#include <cmath>

#include "libinfo/discovery/drawn_problem.h"

namespace {

using namespace drawn_problem;

constexpr std::size_t kPush = 0, kBias = 2;  // candidates; the bias is quantity 3

class SharedBias : public LinearDisagreement {
 public:
  SharedBias(LinearDisagreement data, double share)
      : LinearDisagreement(std::move(data)), quantities_(LinearDisagreement::quantities()) {
    quantities_[3].nominalShare = share;
  }
  const std::vector<Quantity>& quantities() const override { return quantities_; }

 private:
  std::vector<Quantity> quantities_;
};

double logEvidence(const DiscoveryProblem& data, const std::vector<std::size_t>& effects) {
  const Likelihood likelihood(data, {0, 1}, nominalValues(data), kTime);
  return likelihood
      .fit(makeHypothesis(data, effects, {0, 1}), {kOutput, kLatent, kTime}, nominalValues(data),
           {}, kExact)
      .logEvidence;
}

// Where everything is linear, the sum of the evidences of both parts of the prior is exact.
TEST(NominalShare, HasTheEvidenceOfBothHypotheses) {
  for (const double bias : {0.0, 0.05, 0.4}) {
    LinearDisagreement data = drawn(2, 60, 0.4);
    for (int t = 0; t < 2; ++t) data.measure(t, data.measured(t).array() + bias);
    const double held = logEvidence(data, {kPush}), freed = logEvidence(data, {kPush, kBias});
    for (const double share : {0.0, 0.1, 0.5}) {
      const double both = std::log(share * std::exp(held - freed) + 1 - share) + freed;
      // 1e-6 measured: the fits end so near the best ones
      EXPECT_NEAR(logEvidence(SharedBias(data, share), {kPush, kBias}), both, 1e-5)
          << bias << ", " << share;
    }
  }
}

TEST(NominalShare, IsAProbabilityBelowOne) {
  for (const double share : {-0.1, 1.0, std::nan("")})
    EXPECT_THROW(makeHypothesis(SharedBias(drawn(1, 10, 0), share), {kBias}, {0}),
                 std::invalid_argument);
}

}  // namespace
