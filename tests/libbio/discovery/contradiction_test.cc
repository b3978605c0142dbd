#include "bio/discovery/contradiction.h"

#include <gmock/gmock.h>

#include <filesystem>
#include <random>
#include <vector>

#include "bio/analysis/inverse_dynamics.h"
#include "bio/analysis/replay.h"
#include "bio/discovery/workflow.h"
#include "bio/opensim/osim_file.h"
#include "support/shipped_elbow.h"

namespace bio::discover {
namespace {

using Eigen::Index;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// Two recordings of the shipped elbow with its angle.
struct Recordings {
  explicit Recordings(bool prescribed = false) {
    if (prescribed) options.prescribed = {"elbow_flexion"};
    for (const char* file : {"train_1.sto", "train_2.sto"}) {
      TrialOptions read;
      read.prescribed = options.prescribed;
      trials.push_back(readTrial(folder / "emg_data/hidden_a" / file, model, read));
    }
  }
  InputAgreement agreement() const {
    return inputAgreement(model, options, "elbow_flexion", trials);
  }

  std::filesystem::path folder = FISHERHILL_SOURCE_DIR;
  Model model = readOsim(folder / "models/elbow8.osim");
  SystemOptions options = fixtures::ShippedElbow::options();
  std::vector<Trial> trials;
};

TEST(InputAgreement, IsLargeWhereExcitationsAndMotionBelongTogether) {
  const InputAgreement agreement = Recordings().agreement();
  EXPECT_GT(agreement.correlation, InputAgreement::tooSmall);
  EXPECT_LE(agreement.correlation, 1);
  EXPECT_THAT(agreement.remedies, IsEmpty());
}

TEST(InputAgreement, DoesNotDependOnACommonFactorOfTheExcitations) {
  Recordings recordings;
  const double before = recordings.agreement().correlation;
  for (Trial& trial : recordings.trials) trial.excitations *= 0.5;
  EXPECT_NEAR(recordings.agreement().correlation, before, 0.1);
}

TEST(InputAgreement, NamesAReversedSign) {
  Recordings recordings;
  for (Trial& trial : recordings.trials) trial.measured.front().values *= -1;
  EXPECT_THAT(recordings.agreement().remedies,
              ElementsAre("the sign of elbow_flexion is reversed"));
}

TEST(InputAgreement, NamesASupplement) {
  Recordings recordings;
  for (Trial& trial : recordings.trials) {
    Eigen::VectorXd& angle = trial.measured.front().values;
    angle = 3.14159265358979 - angle.array();
  }
  EXPECT_THAT(recordings.agreement().remedies, ElementsAre(HasSubstr("180 degrees minus")));
}

TEST(InputAgreement, NamesAWrongUnit) {
  Recordings recordings;
  for (Trial& trial : recordings.trials) trial.measured.front().values /= 57.2957795;
  EXPECT_THAT(recordings.agreement().remedies,
              ElementsAre("elbow_flexion is in radians, not in degrees"));
}

TEST(InputAgreement, NamesAShift) {
  for (const Index rows : {80, -80}) {
    Recordings recordings;
    for (Trial& trial : recordings.trials) {
      // what is measured at row k belongs to row k + rows
      MeasuredChannel& angle = trial.measured.front();
      const Index n = angle.values.size() - 80;
      angle.values = Eigen::VectorXd(rows > 0 ? angle.values.tail(n) : angle.values.head(n));
      angle.times = Eigen::VectorXd(rows > 0 ? angle.times.head(n) : angle.times.tail(n));
    }
    EXPECT_THAT(recordings.agreement().remedies,
                ElementsAre(rows > 0 ? "the excitations are 0.8 s late"
                                     : "the excitations are 0.8 s early"));
  }
}

TEST(InputAgreement, NamesExcitationsOfAnotherTrial) {
  Recordings recordings;
  std::swap(recordings.trials[0].excitations, recordings.trials[1].excitations);
  EXPECT_THAT(
      recordings.agreement().remedies,
      ElementsAre("the motion of train_1.sto belongs to the excitations of train_2.sto, the "
                  "motion of train_2.sto belongs to the excitations of train_1.sto"));
}

/// An arm that hangs upside down: its muscles work against the other sign of gravity.
TEST(InputAgreement, KnowsHowTheLimbWasTurned) {
  Recordings recordings;
  const double before = recordings.agreement().correlation;
  for (Trial& trial : recordings.trials) trial.conditions.armTurn = 3.14159265358979;
  const double turned = recordings.agreement().correlation;
  EXPECT_LT(turned, before - 0.5);
  recordings.model.gravity *= -1;
  EXPECT_NEAR(recordings.agreement().correlation, before, 1e-6);
}

TEST(InputAgreement, StopsWhereItIsToldTo) {
  Recordings recordings;
  for (Trial& trial : recordings.trials) trial.measured.front().values *= -1;
  int asked = 0;
  const InputAgreement agreement =
      inputAgreement(recordings.model, recordings.options, "elbow_flexion", recordings.trials,
                     [&] { return ++asked < 2; });
  EXPECT_THAT(agreement.remedies, IsEmpty());
  EXPECT_EQ(asked, 2);
}

TEST(InputAgreement, SaysNothingOfMusclesThatDoNothing) {
  Recordings recordings;
  for (Trial& trial : recordings.trials) trial.excitations.setZero();
  const InputAgreement agreement = recordings.agreement();
  EXPECT_FALSE(agreement.correlation < InputAgreement::tooSmall);
  EXPECT_THAT(agreement.remedies, IsEmpty());
}

/// What a dynamometer reads while it makes the motion.
Recordings onDynamometer() {
  Recordings recordings(true);
  const MusculoskeletalSystem system(recordings.model, recordings.options);
  for (Trial& trial : recordings.trials) {
    // else the muscles make the motion, and the device has nothing to do
    trial.excitations = (3 * trial.excitations).cwiseMin(1);
    smoothPrescribed(trial, 3);
    const RecordedTrial inputs = recordedTrial(trial, system, {});
    StartPoint start;
    start.q = startCoordinates(trial, system, {});
    start.qDot = Eigen::VectorXd::Zero(1);
    const Trajectory motion =
        simulate(system, inputs.excitation, inputs.startAt(system, start), inputs.simulation);
    const auto n = static_cast<Index>(motion.time.size());
    trial.measured.push_back({{Observable::Kind::moment, "elbow_flexion", 0},
                              Eigen::VectorXd::Map(motion.time.data(), n),
                              -motion.reaction.row(0).transpose()});
  }
  return recordings;
}

TEST(InputAgreement, IsOneOnADynamometer) {
  const InputAgreement agreement = onDynamometer().agreement();
  EXPECT_GT(agreement.correlation, 0.98);
  EXPECT_THAT(agreement.remedies, IsEmpty());
}

TEST(InputAgreement, NamesAReversedMoment) {
  Recordings recordings = onDynamometer();
  for (Trial& trial : recordings.trials) trial.measured.back().values *= -1;
  EXPECT_THAT(recordings.agreement().remedies,
              testing::Contains("the sign of elbow_flexion.moment is reversed"));
}

TEST(InputAgreement, NamesTwoSignsThatAreReversedTogether) {
  Recordings recordings = onDynamometer();
  for (Trial& trial : recordings.trials)
    for (MeasuredChannel* channel : {&trial.prescribed.front(), &trial.measured.back()})
      channel->values *= -1;
  const InputAgreement agreement = recordings.agreement();
  ASSERT_FALSE(agreement.remedies.empty());
  EXPECT_EQ(agreement.remedies.front(),
            "the signs of elbow_flexion and elbow_flexion.moment are reversed");
}

TEST(InputAgreement, IsNotToldWithoutTheMotion) {
  Recordings recordings;
  recordings.trials.front().measured.clear();
  EXPECT_TRUE(std::isnan(recordings.agreement().correlation));
}

/// A curl with one flexor and one extensor, whose channels are exchanged.
struct ExchangedCurl {
  static constexpr const char* flexor = "BRA";
  static constexpr const char* extensor = "TRIlat";

  ExchangedCurl() {
    std::erase_if(model.muscles, [](const Muscle& muscle) {
      return muscle.name != flexor && muscle.name != extensor;
    });
    trial = readTrial(fixtures::ShippedElbow::root() + "/emg_data/curl_slow.sto", model,
                      {.ignoreExtra = true});
    const MusculoskeletalSystem system(model, fixtures::ShippedElbow::options());
    SimulationOptions cvode;
    cvode.integrator = Integrator::cvode;
    const TrialReplay replay =
        replayTrial(system, trial, cvode, beginningOf(trial, model, system, {}));
    MeasuredChannel& measured = trial.measured.front();
    const auto n = static_cast<Index>(replay.motion.time.size());
    measured.times = Eigen::VectorXd::Map(replay.motion.time.data(), n);
    measured.values = replay.motion.q.row(0).transpose();
    std::mt19937_64 random(8);
    std::normal_distribution<double> normal(0, 0.005);
    for (double& angle : measured.values) angle += normal(random);
    trial.excitations.col(0).swap(trial.excitations.col(1));
  }

  Model model = fixtures::ShippedElbow().model;
  Trial trial;
};

// Without the exchange the excitations have nothing to do with the motion; with it they have.
TEST(InputAgreement, DoesNotDoubtAnExchangeThatExplainsIt) {
  const ExchangedCurl curl;
  ASSERT_EQ(curl.trial.muscles.size(), 2u);
  DiscoveryRequest request{curl.model,   fixtures::ShippedElbow::options(),
                           "elbow_flexion", {curl.trial}, 0, {}, {}, {}, {}};
  request.search.maxEffects = 1;
  request.search.symbolic = false;
  // what takes time
  request.problem.without = {"limit", "limit_exp", "spring", "timed", "fatigue", "wraps"};
  const DiscoveryResult result = discover(request);
  EXPECT_LT(result.inputs.correlation, InputAgreement::unrelated);
  EXPECT_THAT(result.inputs.remedies, IsEmpty());
  const info::discover::Verdict& verdict = result.found.verdict;
  ASSERT_EQ(verdict.effects.size(), 1u) << verdict.sentence;
  EXPECT_EQ(result.data->candidates()[verdict.effects.front().candidate].id, "swap_TRIlat_BRA");
  EXPECT_FALSE(verdict.vetoed) << verdict.sentence;
  EXPECT_GT(verdict.probability, 0.9) << verdict.sentence;
}

}  // namespace
}  // namespace bio::discover
