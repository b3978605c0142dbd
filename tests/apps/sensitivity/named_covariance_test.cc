#include "sensitivity/named_covariance.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

#include "support/scratch_folder.h"
#include "support/throws_saying.h"

namespace app {
namespace {

TEST(NamedCovariance, ReadsWhatItWritesAndATableWithoutRowNames) {
  const support::ScratchFolder scratch;
  NamedCovariance covariance{{"TRI.radius", "hand.mass"}, Eigen::MatrixXd(2, 2)};
  covariance.values << 1e-8, 0.1 + 0.2e-5, 0.1 + 0.2e-5, 1.0 / 3 * 1e8;
  std::ostringstream text;
  writeCovariance(covariance, text);
  const NamedCovariance again = readCovariance(scratch.file("c.csv", text.str()));
  EXPECT_EQ(again.names, covariance.names);
  EXPECT_EQ(again.values, covariance.values);
  const NamedCovariance bare = readCovariance(scratch.file("b.csv", "a, b\r\n4,1\r\n\r\n1,9\r\n"));
  EXPECT_THAT(bare.names, testing::ElementsAre("a", "b"));
  EXPECT_DOUBLE_EQ(bare.correlation()(0, 1), 1.0 / 6);
  EXPECT_EQ(bare.correlation()(1, 1), 1);
}

TEST(NamedCovariance, SaysWhereAFileIsWrong) {
  const support::ScratchFolder scratch;
  const auto wrong = [&](const std::string& text, const char* words) {
    const std::string file = scratch.file("c.csv", text);
    support::throwsSaying([&] { readCovariance(file); }, words);
  };
  wrong("", "c.csv: is empty");
  wrong("parameter\n", "line 1: 0 names");
  wrong("a,a\n1,0\n0,1\n", "line 1: a is listed twice");
  wrong("a,\n1,0\n0,1\n", "line 1: a name is empty");
  wrong("a,b\n1,x\n0,1\n", "line 2: column b: 'x' must be a finite number");
  wrong("a,b\n1,inf\n0,1\n", "line 2: column b: 'inf' must be a finite number");
  wrong("a,b\n1,0,0\n0,1\n", "line 2: 3 cells, must be 2 as in the first line");
  wrong("parameter,a,b\na,1,0\nc,0,1\n", "line 3: row of 'c', must be 'b' as in the first line");
  wrong("a,b\n1,0\n", "1 rows for 2 names");
  wrong("a,b\n1,0\n0,1\n0,0\n", "line 4: more rows than the 2 names");
  wrong("a,b\n1,0\n0,0\n", "the variance of b is 0, must be > 0");
  wrong("a,b\n1,0.1\n0.2,1\n", "the covariance of b and a is 0.2 in one place and 0.1");
}

}  // namespace
}  // namespace app
