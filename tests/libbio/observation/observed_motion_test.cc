#include "bio/observation/observed_motion.h"

#include <gtest/gtest.h>

#include <cmath>

#include "bio/analysis/replay.h"
#include "bio/observation/channel_information.h"
#include "bio/observation/trial_predictor.h"
#include "bio/opensim/osim_file.h"
#include "libbio/simulation/arm_of_seven.h"
#include "support/throws_saying.h"

namespace bio {
namespace {

using fixtures::ArmOfSeven;
using Kind = Observable::Kind;

/// Elbow and forearm free while the shoulder turns; a marker on the hand.
struct Observed {
  explicit Observed(std::vector<std::string> free)
      : model(withMarker()), c(0.4, std::move(free), false, model), options(c.options) {
    times = Eigen::VectorXd::LinSpaced(14, 0.004, 0.29);
    simulation.duration = 0.3;
    simulation.newtonTolerance = 1e-12;
  }
  static Model withMarker() {
    Model model = ArmOfSeven::heldModel();
    model.markers.push_back({"knuckle", "hand", {0.01, -0.05, 0.02}});
    return model;
  }
  void prescribe(int coordinate) {
    options.prescribed = {options.skeleton.freeCoordinates[static_cast<std::size_t>(coordinate)]};
    std::vector<double> at, values;
    for (int k = 0; k <= 40; ++k) {
      at.push_back(0.01 * k);
      values.push_back(0.8 + 0.2 * std::sin(5 * at.back()));
    }
    simulation.prescribed.add(coordinate, at, values);
  }

  Model model;
  ArmOfSeven c;
  SystemOptions options;
  SimulationOptions simulation;
  Eigen::VectorXd times;
};

/// Γ of every kind of channel against differences of whole simulations.
void expectDifferences(const Observed& o, const std::vector<Observable>& channels,
                       const std::vector<std::string>& names) {
  const MusculoskeletalSystem system(o.model, o.options);
  const ParameterCatalogue catalogue(o.model, system, {o.c.start.q, {}});
  const auto selection = catalogue.select(names);
  std::vector<ObservedSeries> series;
  for (const Observable& what : channels) series.push_back({what, o.times});
  const TrialPredictor predictor(catalogue, o.options, o.c.excitation, series, selection,
                                 o.simulation);
  const Eigen::VectorXd theta = catalogue.values(selection);
  const auto at = predictor.withSensitivities(theta);
  ASSERT_TRUE(at.outputs.allFinite());
  EXPECT_EQ((at.outputs - predictor.outputs(theta)).cwiseAbs().maxCoeff(), 0);
  for (Eigen::Index j = 0; j < theta.size(); ++j) {
    const double h = 1e-4 * catalogue.parameters()[selection[static_cast<std::size_t>(j)]].sd;
    Eigen::VectorXd up = theta, down = theta;
    up[j] += h;
    down[j] -= h;
    const Eigen::VectorXd difference = (predictor.outputs(up) - predictor.outputs(down)) / (2 * h);
    for (std::size_t s = 0; s < channels.size(); ++s) {
      const auto first = static_cast<Eigen::Index>(s) * o.times.size();
      const Eigen::VectorXd exact = at.gamma.col(j).segment(first, o.times.size());
      const double off = (exact - difference.segment(first, o.times.size())).cwiseAbs().maxCoeff();
      const double noise = 1e-10 / h;  // of outputs of order 1
      EXPECT_LT(off, 3e-5 * exact.cwiseAbs().maxCoeff() + noise)
          << names[static_cast<std::size_t>(j)] << " of " << nameOf(channels[s]);
    }
  }
}

TEST(ObservedMotion, SensitivitiesOfEveryChannelMatchDifferences) {
  Observed o({"elbow_flexion", "pro_sup", "shoulder_elv"});
  o.prescribe(2);
  expectDifferences(
      o,
      {{Kind::coordinate, "elbow_flexion", 0},
       {Kind::speed, "elbow_flexion", 0},
       {Kind::moment, "shoulder_elv", 0},
       {Kind::marker, "hand.knuckle", 0},
       {Kind::marker, "hand.knuckle", 1},
       {Kind::marker, "hand.knuckle", 2},
       {Kind::fibreLength, "BRA", 0},
       {Kind::pennation, "BIClong", 0},
       {Kind::tendonForce, "BRD", 0},
       {Kind::activation, "BIClong", 0}},
      {"BIClong.max_isometric_force", "BRD.tendon_slack_length", "hand.mass", "emg.BIClong.gain"});
}

// The nodes of forces on two free coordinates and on the prescribed one; the first parameter beside
// them has the column that it has without nodes.
TEST(ObservedMotion, NodesOfForcesAreColumnsOfEveryChannel) {
  Observed o({"elbow_flexion", "pro_sup", "shoulder_elv"});
  o.prescribe(2);
  const MusculoskeletalSystem system(o.model, o.options);
  const ParameterCatalogue catalogue(o.model, system, {o.c.start.q, {}});
  const auto setting = catalogue.nominal();
  std::vector<ObservedSeries> series;
  for (const Observable& what : std::vector<Observable>{{Kind::coordinate, "elbow_flexion", 0},
                                                        {Kind::coordinate, "pro_sup", 0},
                                                        {Kind::speed, "pro_sup", 0},
                                                        {Kind::moment, "shoulder_elv", 0},
                                                        {Kind::marker, "hand.knuckle", 1},
                                                        {Kind::fibreLength, "BRA", 0},
                                                        {Kind::tendonForce, "BRD", 0},
                                                        {Kind::activation, "BRA", 0}})
    series.push_back({what, o.times});
  const ObservedMotion observed(system, series);
  SensitivityOptions options{o.simulation, true, true, {{0, 2, 1}, {0, 0.06, 0.13, 0.2, 0.31}}};
  const auto wanted = catalogue.select({"hand.mass"});
  const auto with = observed.linearised(
      simulateWithSensitivities(system, catalogue, setting, wanted, o.c.excitation, options));
  const ExternalNodes nodes = options.externalNodes;
  ASSERT_EQ(with.gamma.cols(), 1 + nodes.count());
  ASSERT_TRUE(with.gamma.allFinite());
  const auto numTimes = static_cast<Eigen::Index>(nodes.times.size());
  for (std::size_t c = 0; c < nodes.coordinates.size(); ++c) {
    for (Eigen::Index k = 0; k < numTimes; ++k) {
      const double h = 1e-3;
      std::vector<Eigen::VectorXd> ends;
      for (const double d : {h, -h}) {
        Eigen::MatrixXd values = Eigen::MatrixXd::Zero(numTimes, 3);
        values(k, nodes.coordinates[c]) = d;
        SimulationOptions pushed = o.simulation;
        pushed.externalForce = ExternalForce(nodes.times, values);
        ends.push_back(observed.values(simulateSetting(system, setting, o.c.excitation, pushed)));
      }
      const Eigen::VectorXd difference = (ends[0] - ends[1]) / (2 * h);
      const Eigen::VectorXd exact = with.gamma.col(1 + static_cast<Eigen::Index>(c) * numTimes + k);
      for (std::size_t i = 0; i < series.size(); ++i) {
        const auto first = static_cast<Eigen::Index>(i) * o.times.size();
        const Eigen::VectorXd part = exact.segment(first, o.times.size());
        EXPECT_LT((part - difference.segment(first, o.times.size())).cwiseAbs().maxCoeff(),
                  2e-5 * part.cwiseAbs().maxCoeff() + 1e-6)
            << nameOf(series[i].what) << " of node " << k << " on " << nodes.coordinates[c];
      }
    }
  }
  options.externalNodes = {};
  const auto without = observed.linearised(
      simulateWithSensitivities(system, catalogue, setting, wanted, o.c.excitation, options));
  EXPECT_LT((without.gamma.col(0) - with.gamma.col(0)).norm(), 1e-13 * with.gamma.col(0).norm());
  // what is pushed reacts at once, and a push of the prescribed coordinate moves nothing
  const auto moments = with.gamma.middleRows(3 * o.times.size(), o.times.size());
  EXPECT_NEAR(moments.middleCols(1 + numTimes, numTimes).row(0).sum(), 1, 1e-9);
  EXPECT_EQ(with.gamma.block(0, 1 + numTimes, 3 * o.times.size(), numTimes).norm(), 0);
}

// sin α = ℓ0 sin α0/ℓ, in every class; BRA has α0 = 0.
TEST(ObservedMotion, PennationFollowsFromTheFibreLength) {
  const Observed o({"elbow_flexion"});
  const std::string root = std::string(FISHERHILL_SOURCE_DIR) + "/models/elbow8";
  for (const char* file : {"", "_Thelen2003", "_Millard2012", "_DeGrooteFregly2016"}) {
    Observed other({"elbow_flexion"});
    other.model = readOsim(root + file + ".osim");
    other.options = {{{"elbow_flexion"}, {}}, {}, {}};
    const MusculoskeletalSystem system(other.model, other.options);
    const Trial trial =
        readTrial(std::string(FISHERHILL_SOURCE_DIR) + "/emg_data/curl_slow.sto", other.model);
    const ExcitationSignal excitation = excitationOf(trial, system);
    const ParameterCatalogue catalogue(other.model, system,
                                       {Eigen::VectorXd::Constant(1, 0.6), {}});
    const bool isSchutte = std::string(file).empty();
    const std::string l0 = "TRIlat.optimal_fiber_length",
                      a0 = isSchutte ? "TRIlat.pennation_angle"
                                     : "TRIlat.pennation_angle_at_optimal";
    const auto selection = catalogue.select({l0, a0, "TRIlat.max_isometric_force", "hand.mass"});
    const TrialPredictor predictor(catalogue, other.options, excitation,
                                   {{{Kind::pennation, "TRIlat", 0}, other.times},
                                    {{Kind::fibreLength, "TRIlat", 0}, other.times}},
                                   selection, other.simulation);
    Eigen::VectorXd theta = catalogue.values(selection);
    theta[1] = 0.3;
    const auto at = predictor.withSensitivities(theta);
    const Eigen::Index n = other.times.size();
    for (Eigen::Index k = 0; k < n; ++k) {
      EXPECT_NEAR(std::sin(at.outputs[k]), theta[0] * std::sin(0.3) / at.outputs[n + k], 1e-12);
    }
    for (Eigen::Index j = 0; j < theta.size(); ++j) {
      const double h = 1e-4 * catalogue.parameters()[selection[static_cast<std::size_t>(j)]].sd;
      Eigen::VectorXd up = theta, down = theta;
      up[j] += h;
      down[j] -= h;
      const Eigen::VectorXd difference =
          (predictor.outputs(up) - predictor.outputs(down)).head(n) / (2 * h);
      const Eigen::VectorXd exact = at.gamma.col(j).head(n);
      EXPECT_LT((exact - difference).cwiseAbs().maxCoeff(),
                3e-5 * exact.cwiseAbs().maxCoeff() + 1e-10 / h)
          << file << " " << j;
    }
  }
  EXPECT_EQ(nameOf({Kind::pennation, "BRA", 0}), "BRA.pennation");
  Observable found;
  EXPECT_TRUE(readObservable("BRA.pennation", o.model, found));
  EXPECT_EQ(unitOf(found, o.model), "rad");
}

TEST(ObservedMotion, AHingeHasTheSameChannels) {
  const Observed o({"elbow_flexion"});
  expectDifferences(o,
                    {{Kind::coordinate, "elbow_flexion", 0},
                     {Kind::speed, "elbow_flexion", 0},
                     {Kind::marker, "hand.knuckle", 1},
                     {Kind::fibreLength, "BRA", 0}},
                    {"BRA.max_isometric_force", "hand.mass"});
}

TEST(ObservedMotion, MarkersAreWhereTheirBodyCarriesThem) {
  const Observed o({"elbow_flexion", "shoulder_elv"});
  const MusculoskeletalSystem system(o.model, o.options);
  const Trajectory motion = simulate(system, o.c.excitation, o.c.start, o.simulation);
  Eigen::VectorXd rows(2);
  rows << motion.time[7], motion.time[30];
  std::vector<Placement<double>> placed(system.skeleton().numSegments());
  const BodyPlacement& place = system.skeleton().placeOf("hand");
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::VectorXd x =
        ObservedMotion(system, {{{Kind::marker, "hand.knuckle", axis}, rows}}).values(motion);
    for (const int k : {0, 1}) {
      const Eigen::VectorXd q = motion.q.col(k == 0 ? 7 : 30);
      system.skeleton().placements(q.data(), placed.data());
      const Placement<double>& X = placed[place.segment];
      const Eigen::Vector3d inSegment =
          place.X_SB.R * Eigen::Vector3d(0.01, -0.05, 0.02) + place.X_SB.p;
      EXPECT_NEAR(x[k], (X.R * inSegment + X.p)[axis], 1e-9);
    }
  }
}

TEST(ObservedMotion, RefusesWhatCannotBeObserved) {
  const Observed o({"elbow_flexion"});
  const MusculoskeletalSystem system(o.model, o.options);
  const auto refused = [&](const Observable& what, const char* words) {
    support::throwsSaying([&] { ObservedMotion(system, {{what, o.times}}); }, words);
  };
  refused({Kind::moment, "elbow_flexion", 0}, "nothing holds it");
  refused({Kind::speed, "pro_sup", 0}, "must be free");
  refused({Kind::marker, "hand.thumb", 0}, "no such marker");
  refused({Kind::fibreLength, "DELT", 0}, "moves this muscle");
}

TEST(ChannelGains, TheChannelThatTellsMostComesFirstAndNoneTakesAway) {
  Observed o({"elbow_flexion"});
  o.prescribe(0);
  const MusculoskeletalSystem system(o.model, o.options);
  const ParameterCatalogue catalogue(o.model, system, {o.c.start.q, {}});
  const auto selection =
      catalogue.select({"BIClong.max_isometric_force", "BRA.max_isometric_force"});
  const SensitivityTrajectory s =
      simulateWithSensitivities(system, catalogue, catalogue.nominal(), selection, o.c.excitation,
                                {o.simulation, true, true});
  const auto gammaOf = [&](const Observable& what) -> Eigen::MatrixXd {
    return ObservedMotion(system, {{what, o.times}}).linearised(s).gamma;
  };
  const ParameterInformation known =
      informationAbout(catalogue, selection, {gammaOf({Kind::moment, "elbow_flexion", 0})}, 0.5);
  const std::vector<ChannelCandidate> candidates = {
      {{Kind::activation, "BRA", 0}, 0.05},  // does not depend on forces
      {{Kind::tendonForce, "BRA", 0}, 1},
      {{Kind::tendonForce, "BIClong", 0}, 100}};
  const std::vector<double> times(o.times.begin(), o.times.end());
  const std::vector<Eigen::MatrixXd> information = informationOf(system, candidates, times, s);
  const std::vector<ChannelGain> gains = channelGains(known, candidates, information);
  ASSERT_EQ(gains.size(), 3u);
  EXPECT_EQ(nameOf(gains[0].channel.what), "BRA.tendon_force");
  EXPECT_EQ(gains[0].parameter, "BRA.max_isometric_force");
  EXPECT_EQ(nameOf(gains[2].channel.what), "BRA.activation");
  EXPECT_NEAR(gains[2].information, 0, 1e-9);
  EXPECT_NEAR(gains[2].after, gains[2].before, 1e-9 * gains[2].before);
  // the bound with it is that of the joint information
  const Eigen::MatrixXd gamma = gammaOf(candidates[1].what);
  Eigen::MatrixXd both = known.fisher + gamma.transpose() * gamma;
  for (Eigen::Index i = 0; i < 2; ++i) {
    both(i, i) += 1 / std::pow(known.parameters[static_cast<std::size_t>(i)].prior->sd, 2);
  }
  EXPECT_NEAR(gains[0].after, std::sqrt(both.inverse()(1, 1)), 1e-9 * gains[0].after);
}

}  // namespace
}  // namespace bio
