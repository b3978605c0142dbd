// Designs with any list of observed channels and torqued coordinates.
#include <gtest/gtest.h>

#include "bio/analysis/sensitivity_study.h"
#include "bio/design/design_setup.h"
#include "bio/tables/trial_table.h"
#include "support/numbers.h"
#include "support/shipped_elbow.h"
#include "support/throws_saying.h"

namespace bio {
namespace {

using support::degree;
using Kind = Observable::Kind;

/// The first seconds of a shipped trial of elbow8, with other roles of its coordinates.
struct Roles {
  Model model = readOsim(fixtures::ShippedElbow::root() + "/models/elbow8.osim");
  SystemOptions options;
  TrialOptions reading;
  MusculoskeletalSystem system;
  Trial trial;
  ParameterCatalogue catalogue;
  SimulationOptions simulation;

  Roles(const std::vector<std::string>& free, const std::vector<std::string>& prescribed)
      : options{{free, {}}, {}, {}, false, prescribed},
        reading{.prescribed = prescribed},
        system(model, options),
        trial(
            readTrial(fixtures::ShippedElbow::root() + "/emg_data/curl_slow.sto", model, reading)),
        catalogue(model, system, {beginningOf(trial, model, system, {}).point.q, {}}) {
    simulation.duration = trial.duration();
  }
  ExperimentDesign design(std::vector<ChannelCandidate> observed, const GivenLimits& given,
                          const std::vector<std::string>& excite) const {
    DesignQuestion question;
    question.observed = std::move(observed);
    question.parameters = catalogue.select({"BRA.max_isometric_force", "hand.mass"});
    const Eigen::VectorXd q = catalogue.nominal().start.q;
    return {system,
            catalogue,
            catalogue.nominal(),
            trial,
            simulation,
            question,
            withCoordinates({}, system, given),
            muscleGroups(system, q, excite),
            0.5};
  }
  /// The information that `sensitivity` finds in the trial as it would be written.
  Eigen::MatrixXd told(const ExperimentDesign& design, const DesignedExperiment& e) const {
    const Trial again = trialFrom(plannedTable(system, e.trial), "design", model, reading);
    const StartPoint start{beginningOf(again, model, system, {}).point.q, {}};
    const StudiedTrial studied = studiedTrial(again, model, system, start, simulation);
    return localSensitivity({studied}, {options, "", 1, design.question().observed,
                                        design.question().parameters})
        .information.fisher;
  }
};

void expectAlike(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  ASSERT_EQ(a.rows(), b.rows());
  for (Eigen::Index i = 0; i < a.rows(); ++i) {
    for (Eigen::Index k = 0; k < a.cols(); ++k) {
      EXPECT_NEAR(a(i, k), b(i, k), 1e-9 * std::sqrt(b(i, i) * b(k, k))) << i << k;
    }
  }
}

DesignSearchSettings quickSearch() {
  DesignSearchSettings settings;
  settings.candidates = 8;
  settings.generations = 1;
  settings.iterations = 1;
  return settings;
}

// A dynamometer moves the elbow; excitations are sought.
TEST(DesignChannels, ObserveTheMomentOfAPrescribedElbow) {
  const Roles roles({"elbow_flexion"}, {"elbow_flexion"});
  const ExperimentDesign design =
      roles.design({{{Kind::moment, "elbow_flexion", 0}, 0.5}}, {}, {"flexors"});
  EXPECT_TRUE(design.inputs().torques().empty());
  const DesignResult result = design.search(quickSearch());
  ASSERT_TRUE(result.improved);
  EXPECT_LT(result.after.bound[0], 0.8 * result.before.bound[0]);
  EXPECT_TRUE(result.after.ranges.empty());
  expectAlike(result.after.information, roles.told(design, result.after));
  // the motion is that of the trial
  EXPECT_LT((result.after.motion.q - result.before.motion.q).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(DesignChannels, PushTwoCoordinatesAndObserveWhatSensitivityDoes) {
  const Roles roles({"elbow_flexion", "shoulder_elv"}, {});
  const std::vector<ChannelCandidate> observed = {{ofCoordinate("shoulder_elv"), 1 * degree},
                                                  {{Kind::fibreLength, "BRA", 0}, 0.001},
                                                  {{Kind::speed, "elbow_flexion", 0}, 5 * degree},
                                                  {{Kind::tendonForce, "TRIlong", 0}, 10}};
  const ExperimentDesign design =
      roles.design(observed, {{}, {{"", 2}}, {{"", 20}}}, {"elbow_flexion.extensors"});
  ASSERT_EQ(design.inputs().torques().size(), 2u);
  EXPECT_EQ(design.inputs().profiles().inputs().size(), 3u);
  const DesignedExperiment before = design.before();
  expectAlike(before.information, roles.told(design, before));
  // every channel adds, each with its own noise
  Eigen::Matrix2d sum = Eigen::Matrix2d::Zero();
  const Eigen::Index n = before.measuredTimes.size();
  for (std::size_t o = 0; o < observed.size(); ++o) {
    const Eigen::MatrixXd own = before.gamma.middleRows(static_cast<Eigen::Index>(o) * n, n);
    sum += own.transpose() * own / std::pow(observed[o].sd, 2);
  }
  expectAlike(before.information, sum);
  EXPECT_NEAR(design.boundOverTime(before)[n - 1] / before.bound[0], 1, 1e-9);

  const DesignedExperiment e =
      design.at(design.inputs().profiles().project(design.inputs().random(1, 1)));
  expectAlike(e.information, roles.told(design, e));
  for (const char* name : {"elbow_flexion", "shoulder_elv"}) {
    EXPECT_GT(design.inputs().largestTorque(e.trial, name), 0);
    EXPECT_LE(design.inputs().largestTorque(e.trial, name), 2);
  }
  EXPECT_NE(design.inputs().torqueOf(e.trial, "elbow_flexion"),
            design.inputs().torqueOf(e.trial, "shoulder_elv"));
  // what is written begins where the experiment does and has every channel
  EXPECT_EQ(plannedTable(roles.system, e.trial).columns.size(), 1 + 8 + 2 + 2 + 3);
}

// Through noise, scales and the criterion: dφ/dI at the information of several channels.
TEST(DesignChannels, TheCriterionFollowsItsGradient) {
  const Roles roles({"elbow_flexion"}, {"elbow_flexion"});
  const ExperimentDesign design = roles.design(
      {{{Kind::moment, "elbow_flexion", 0}, 0.5}, {{Kind::fibreLength, "BRA", 0}, 0.001}}, {},
      {"flexors"});
  const Eigen::VectorXd x = design.inputs().own();
  const auto informationAt = [&](double step) -> Eigen::MatrixXd {
    Eigen::VectorXd there = x;
    there[1] += step;
    const Eigen::MatrixXd I = design.at(there).information;
    return design.scale().asDiagonal() * I * design.scale().asDiagonal();
  };
  const double step = 1e-4;
  const Eigen::MatrixXd plus = informationAt(step), minus = informationAt(-step);
  const double slope =
      design.cost(informationAt(0), 1e-9).dvalue_dI.cwiseProduct((plus - minus) / (2 * step)).sum();
  const double difference =
      (design.cost(plus, 1e-9).value - design.cost(minus, 1e-9).value) / (2 * step);
  EXPECT_GT(std::abs(slope), 0.01);
  EXPECT_NEAR(slope / difference, 1, 1e-5);
}

TEST(DesignChannels, SaysWhatCannotBeMeant) {
  const Roles held({"elbow_flexion"}, {"elbow_flexion"});
  const std::vector<ChannelCandidate> moment = {{{Kind::moment, "elbow_flexion", 0}, 0.5}};
  support::throwsSaying([&] { (void)held.design(moment, {}, {}); }, "no input to design");
  support::throwsSaying(
      [&] {
        (void)held.design(moment, {{}, {{"elbow_flexion", 2}}}, {});
      },
      "torque of 'elbow_flexion': must be a coordinate that is free to move");
  support::throwsSaying([&] { (void)held.design({}, {}, {"BRA"}); }, "nothing is observed");
  const Roles free({"elbow_flexion"}, {});
  support::throwsSaying([&] { (void)free.design(moment, {}, {}); },
                        "its coordinate must be prescribed or locked");
}

}  // namespace
}  // namespace bio
