// Searches whose base model goes astray, because it lacks something.
#include <gtest/gtest.h>

#include <cmath>

#include "info/discovery/discover.h"
#include "info/discovery/likelihood/hypothesis.h"
#include "info/probability/random_stream.h"

namespace {

using namespace info::discover;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kSigma = 0.1, kPlace = 0.2;
constexpr int kSamples = 60, kWaves = 8;

/// Outputs are sums of waves e_j that are orthogonal over a trial, so that everything can be seen
/// on paper. θ is a nuisance, A the effect "right", B and C are two makeshifts:
///     y = θ·(e_1 + γ e_2) + A·[w·(e_1 + e_3) + (1 − w)·e_4] + B·makeshift_1 + C·makeshift_2
/// where w(θ) is 1 about θ_c, and 0 from 0.7·kPlace on: only there does A do what it ought to.
class Astray : public DiscoveryProblem {
 public:
  double gamma = 0, centre = 0;
  double ridge = 0;  ///< where not 0 θ acts by 20 (θ − ridge)² e_1 + θ e_2 instead
  VectorXd makeshift[2] = {VectorXd::Zero(kWaves), VectorXd::Zero(kWaves)};
  VectorXd stranger = VectorXd::Zero(kWaves);  ///< is measured, too

  Astray() {
    quantities_ = {{"theta", "", 0, -5, 5, kPlace},
                   {"right", "", 0, -5, 5, 0.5},
                   {"first", "", 0, -5, 5, 0.5},
                   {"second", "", 0, -5, 5, 0.5}};
    for (std::size_t i = 1; i < 4; ++i) {
      Candidate c;
      c.id = c.name = quantities_[i].name;
      c.sentence = "test";
      c.quantities = {i};
      c.sds = {quantities_[i].sd};
      c.starts = {VectorXd::Constant(1, 0.01)};
      candidates_.push_back(c);
    }
    waves_.resize(kSamples, kWaves);
    for (int k = 0; k < kSamples; ++k) {
      times_.push_back(0.05 * k);
      nodes_.push_back({0.05 * k, 0});
      for (int j = 0; j < kWaves; ++j)
        waves_(k, j) = std::sqrt(2.0) * std::cos(M_PI * (j + 3) * (k + 0.5) / kSamples);
    }
  }
  void draw(std::uint64_t seed, double theta, double right) {
    VectorXd truth = nominalValues(*this);
    truth[0] = theta, truth[1] = right;
    for (int t = 0; t < numTrials(); ++t) {
      info::RandomStream random(seed, static_cast<std::uint64_t>(t));
      measured_[t] = outputs(t, truth, {}) + waves_ * stranger;
      for (double& y : measured_[t]) y += kSigma * random.normal();
    }
  }

  const std::vector<Quantity>& quantities() const override { return quantities_; }
  const std::vector<std::size_t>& nuisances() const override { return nuisances_; }
  const std::vector<Candidate>& candidates() const override { return candidates_; }
  int numTrials() const override { return 2; }
  std::string trialName(int trial) const override { return std::to_string(trial); }
  const std::vector<double>& times(int) const override { return times_; }
  const VectorXd& measured(int trial) const override { return measured_[trial]; }
  const std::vector<Node>& nodes(int) const override { return nodes_; }
  MatrixXd inputs(int) const override { return MatrixXd::Zero(kSamples, 0); }
  std::vector<std::string> inputNames() const override { return {}; }

  VectorXd outputs(int, const VectorXd& values, const VectorXd& latent) const override {
    VectorXd y = waves_ * (base(values[0]) + values[1] * right(values[0]) +
                           values[2] * makeshift[0] + values[3] * makeshift[1]);
    if (latent.size() != 0) y += kForce * latent;
    return y;
  }
  Prediction predict(int trial, const VectorXd& values, const VectorXd& latent,
                     const std::vector<std::size_t>& wanted, bool latentToo) const override {
    Prediction p;
    p.outputs = outputs(trial, values, latent);
    p.speeds = VectorXd::Zero(kSamples);
    MatrixXd slopes(kWaves, 4);
    slopes << baseSlope(values[0]) + values[1] * window(values[0]).slope * (near() - away()),
        right(values[0]), makeshift[0], makeshift[1];
    p.gamma.resize(kSamples, static_cast<Index>(wanted.size()));
    for (std::size_t j = 0; j < wanted.size(); ++j)
      p.gamma.col(static_cast<Index>(j)) = waves_ * slopes.col(static_cast<Index>(wanted[j]));
    if (latentToo) {
      p.scale = MatrixXd::Ones(kSamples, 1);
      p.byNode = p.courseByNode = kForce * MatrixXd::Identity(kSamples, kSamples);
      p.course = {p.outputs, p.speeds};
    }
    return p;
  }

  static VectorXd wave(int j) { return VectorXd::Unit(kWaves, j - 1); }

 private:
  static constexpr double kForce = 0.02;
  struct Window {
    double value, slope;
  };
  Window window(double theta) const {
    const double from = (theta - centre) / kPlace, z = (std::abs(from) - 0.35) / 0.35;
    if (z <= 0) return {1, 0};
    if (z >= 1) return {0, 0};
    return {1 - z * z * (3 - 2 * z), -6 * z * (1 - z) / 0.35 / kPlace * (from < 0 ? -1 : 1)};
  }
  VectorXd base(double theta) const {
    if (ridge == 0) return theta * (wave(1) + gamma * wave(2));
    return 20 * (theta - ridge) * (theta - ridge) * wave(1) + theta * wave(2);
  }
  VectorXd baseSlope(double theta) const {
    if (ridge == 0) return wave(1) + gamma * wave(2);
    return 40 * (theta - ridge) * wave(1) + wave(2);
  }
  VectorXd near() const { return wave(1) + wave(3); }
  VectorXd away() const { return wave(4); }
  VectorXd right(double theta) const {
    const double w = window(theta).value;
    return w * near() + (1 - w) * away();
  }

  std::vector<Quantity> quantities_;
  std::vector<std::size_t> nuisances_ = {0};
  std::vector<Candidate> candidates_;
  std::vector<double> times_;
  std::vector<Node> nodes_;
  MatrixXd waves_;
  VectorXd measured_[2];
};

Verdict verdictOn(const Astray& data, double latentTolerance = 5,  // 5 move outputs by kSigma
                  WarmStart* draft = nullptr) {
  Options options;
  options.sds = kSigma;
  options.latentScale = 1;
  options.latentTolerance = latentTolerance;
  return run(data, options, draft);
}

void expectTheRightOneAlone(const Astray& data, const Verdict& v, double theta, double right) {
  EXPECT_EQ(v.finding, Finding::named);
  ASSERT_EQ(v.effects.size(), 1U) << v.sentence;
  EXPECT_EQ(data.candidates()[v.effects[0].candidate].id, "right");
  EXPECT_NEAR(v.values[0], theta, 0.05);
  EXPECT_NEAR(v.values[1], right, 0.05);
}

// The base model explains e_1 by θ = kPlace, where A is of no use, and two makeshifts the rest.
// From the nominal θ = 0 one step finds A.
TEST(Search, RacesSingleEffectsFromTheNominalValuesBeforeASecondNameIsGiven) {
  Astray data;
  data.makeshift[0] = Astray::wave(3) + 0.5 * Astray::wave(5);
  data.makeshift[1] = Astray::wave(5);
  data.draw(1, 0, kPlace);
  expectTheRightOneAlone(data, verdictOn(data), 0, kPlace);
}

// As before, but what is left of e_3 is like neither makeshift. Beside a base that explains e_1 by
// θ no effect gains anything, and the latent force takes what noise of the inputs cannot be.
TEST(Search, RacesFromTheNominalValuesBeforeThereIsNoName) {
  Astray data;
  data.makeshift[0] = Astray::wave(6);
  data.makeshift[1] = Astray::wave(7);
  data.draw(3, 0, kPlace);
  expectTheRightOneAlone(data, verdictOn(data, 2), 0, kPlace);
}

// Nothing explains e_8, so that all are raced from the nominal values; not again by a search that
// starts from what this one knows.
TEST(Search, RacesFromTheNominalValuesOnceOnly) {
  Astray data;
  data.makeshift[0] = Astray::wave(6);
  data.makeshift[1] = Astray::wave(7);
  data.stranger = 3 * kPlace * Astray::wave(8);
  data.draw(4, 0, 0);
  WarmStart draft;
  const Verdict first = verdictOn(data, 2, &draft), again = verdictOn(data, 2, &draft);
  EXPECT_EQ(first.finding, Finding::unknown);
  EXPECT_EQ(again.finding, Finding::unknown);
  EXPECT_LT(again.fits, first.fits / 4);
}

// Nothing is missing. θ = 0.35 is beyond a ridge at 0.05, and all that goes down from the nominal 0
// ends at −0.25, where a makeshift is welcome.
TEST(Search, LooksForOtherMinimaOfTheBaseModel) {
  Astray data;
  data.ridge = 0.05;
  data.makeshift[0] = Astray::wave(2);
  data.makeshift[1] = Astray::wave(7);
  data.draw(5, 0.35, 0);
  const Verdict v = verdictOn(data);
  EXPECT_EQ(v.finding, Finding::none) << v.sentence;
  EXPECT_NEAR(v.values[0], 0.35, 0.02);
}

// A does what it ought to about θ = kPlace only, neither where the base model goes (2·kPlace,
// between e_1 and e_2) nor from the nominal 0. The second makeshift explains most; beside it the
// first brings θ to kPlace, and there A is found. Then nothing is left to the makeshifts: A must be
// fitted alone.
TEST(Search, FitsAnEffectAgainWithoutOneThatIsAbsentBesideIt) {
  Astray data;
  data.gamma = 1, data.centre = kPlace;
  data.makeshift[0] = Astray::wave(1);
  data.makeshift[1] = Astray::wave(3);
  data.draw(2, kPlace, 2 * kPlace);
  expectTheRightOneAlone(data, verdictOn(data), kPlace, 2 * kPlace);
}

// e_4 and e_5 are measured; the first makeshift, e_4 + e_5 + 0.7 e_6, explains four fifths of that.
// Beside it neither gains enough, and only both together explain all.
TEST(Search, LooksBesideAnEffectThatAlmostEarnsItsPlaceForAnother) {
  const double size = 0.115;
  Astray data;
  data.centre = 100;  // so that "right" acts by e_4 whatever θ is
  data.makeshift[0] = Astray::wave(4) + Astray::wave(5) + 0.7 * Astray::wave(6);
  data.makeshift[1] = Astray::wave(5);
  data.stranger = size * (Astray::wave(4) + Astray::wave(5));
  data.draw(6, 0, 0);
  const Verdict v = verdictOn(data);
  ASSERT_EQ(v.effects.size(), 2U) << v.sentence;
  EXPECT_EQ(data.candidates()[v.effects[0].candidate].id, "right");
  EXPECT_EQ(data.candidates()[v.effects[1].candidate].id, "second");
  EXPECT_NEAR(v.values[1], size, 0.03);
  EXPECT_NEAR(v.values[3], size, 0.03);
}

}  // namespace
