#include "bio/tables/different_trials.h"

#include <gtest/gtest.h>

#include "support/throws_saying.h"

namespace bio {
namespace {

Trial trialCalled(const std::string& file, const std::string& sha256) {
  Trial trial;
  trial.file = file;
  trial.sha256 = sha256;
  return trial;
}

TEST(DifferentTrials, AreKnownByTheirContent) {
  const Trial a = trialCalled("a", "1"), b = trialCalled("b", "2"), unknown = trialCalled("u", "");
  requireDifferentTrials({a, b}, std::vector<Trial>{trialCalled("a", "3")});
  requireDifferentTrials({unknown, unknown}, std::vector<Trial>{unknown});
  support::throwsSaying(
      [&] {
        requireDifferentTrials({a, b}, std::vector<Trial>{trialCalled("c", "2")});
      },
      "c: is held out and also used for estimation, as b");
  support::throwsSaying(
      [&] {
        requireDifferentTrials({a, b, trialCalled("c", "1")}, std::vector<Trial>{});
      },
      "c: is the same trial as a");
  support::throwsSaying(
      [&] {
        requireDifferentTrials({a}, std::vector<Trial>{b, trialCalled("c", "2")});
      },
      "c: is the same trial as b");
}

}  // namespace
}  // namespace bio
