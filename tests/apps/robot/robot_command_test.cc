#include <gmock/gmock.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "support/run_program.h"
#include "support/scratch_folder.h"

namespace {

using support::ProgramResult;
using support::runFisherHill;
using testing::AllOf;
using testing::HasSubstr;

TEST(RobotCommand, PrintsThePublishedBoundOfTheDoublePendulum) {
  const ProgramResult result =
      runFisherHill({"robot", "double-pendulum", "--bound-only", "--json"});
  ASSERT_EQ(result.status, 0) << result.err;
  const auto bound = nlohmann::json::parse(result.out)["cramer_rao_bound"];
  EXPECT_NEAR(bound["m1_m1"].get<double>(), 2.71e-4, 0.05 * 2.71e-4);
  EXPECT_NEAR(bound["m1_c"].get<double>(), 1.46e-3, 0.05 * 1.46e-3);
  EXPECT_NEAR(bound["c_c"].get<double>(), 1.05, 0.05 * 1.05);
  EXPECT_THAT(runFisherHill({"robot", "double-pendulum", "--bound-only"}).out,
              AllOf(HasSubstr("cramer_rao_bound.m1_c"), HasSubstr("0.001438")));
}

TEST(RobotCommand, SaysThatTheMassesCannotBeToldApartWithoutDamping) {
  const ProgramResult result = runFisherHill(
      {"robot", "double-pendulum", "--bound-only", "--unknown", "m1,m2", "--undamped"});
  EXPECT_EQ(result.status, 1);
  EXPECT_THAT(
      result.out,
      AllOf(HasSubstr("m1 and m2 are not separately identifiable: only m1/m2 is determined"),
            HasSubstr("m1 +1 %, m2 +1 %")));
  EXPECT_EQ(
      runFisherHill({"robot", "double-pendulum", "--bound-only", "--unknown", "m1,m2"}).status, 0);
}

TEST(RobotCommand, PrintsHowThreeEstimatorsConverge) {
  const ProgramResult result = runFisherHill({"robot", "suspended-mass", "--convergence"});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.out,
              AllOf(HasSubstr("gradient descent has not converged after 1000 iterations"),
                    HasSubstr("iterated least squares"), HasSubstr("Newton-Raphson")));
  const auto json = nlohmann::json::parse(
      runFisherHill({"robot", "suspended-mass", "--convergence", "--json"}).out);
  EXPECT_NEAR(json["lively_Newton_Raphson_final_order"].get<double>(), 2, 0.2);
  EXPECT_LT(json["lively_iterated_least_squares"]["final_ratio"].get<double>(), 0.05);
  EXPECT_FALSE(json["quiet_gradient_descent"]["converged"].get<bool>());
}

TEST(RobotCommand, SimulatesTheSameTrialsOnAnyNumberOfThreads) {
  const support::ScratchFolder scratch;
  const auto run = [&](const std::string& threads, const std::string& seed) {
    return nlohmann::json::parse(
        runFisherHill({"robot", "double-pendulum", "--as-is", "--period", "2", "--trials", "20",
                       "--json", "--threads", threads, "--seed", seed})
            .out)["trials_covariance"];
  };
  const auto alone = run("1", "7");
  EXPECT_EQ(alone, run("2", "7"));
  EXPECT_NE(alone, run("2", "8"));
}

TEST(RobotCommand, WritesAReport) {
  const support::ScratchFolder scratch;
  const std::string out = (scratch / "out").string();
  ASSERT_EQ(runFisherHill({"robot", "suspended-mass", "--convergence", "--out", out}).status, 0);
  EXPECT_THAT(support::contentOf(out + "/report.html"), HasSubstr("Lively motion"));
}

TEST(RobotCommand, OptimisesTheDoublePendulumAndTriesBothMotions) {
  const support::ScratchFolder scratch;
  const std::string out = (scratch / "out").string();
  const ProgramResult result =
      runFisherHill({"robot", "double-pendulum", "--out", out, "--trials", "200"});
  ASSERT_EQ(result.status, 0) << result.err;
  const auto json = nlohmann::json::parse(support::contentOf(out + "/summary.json"));
  EXPECT_GT(json["lambda_min_factor"].get<double>(), 1000);
  const auto motion = support::linesOf(support::contentOf(out + "/motion_optimised.csv"));
  EXPECT_NEAR(json["duration_s"].get<double>(), std::stod(motion.back()), 1e-9);
  EXPECT_NEAR(json["step_s"].get<double>(), std::stod(motion.at(2)) - std::stod(motion.at(1)),
              1e-9);
  EXPECT_GT(json["ms_per_iteration"].get<double>(), 1);  // some 100 on a busy machine
  EXPECT_NEAR(json["wall_s"].get<double>(),
              1e-3 * json["ms_per_iteration"].get<double>() * json["iterations"].get<double>(),
              1e-9);
  EXPECT_LT(json["wall_s"].get<double>(), result.seconds);
  const auto before = json["bound_initial"], after = json["bound_optimised"],
             trials = json["monte_carlo_optimised"];
  EXPECT_NEAR(before[0][0].get<double>() / 2.71e-4, 1, 0.05);
  EXPECT_NEAR(before[1][1].get<double>() / 1.05, 1, 0.05);
  for (int i : {0, 1}) {
    EXPECT_NEAR(trials[i][i].get<double>() / after[i][i].get<double>(), 1, 0.25);
    EXPECT_GT(before[i][i].get<double>() / after[i][i].get<double>(), 800);
  }
  const auto kept = [](const std::string& number) {
    return "<span class=\"number\">" + number + "</span>";
  };
  EXPECT_THAT(support::contentOf(out + "/report.html"),
              HasSubstr(kept("2.32e-7") + ", " + kept("8.83e-7") + ", " + kept("1.01e-3")));
  const auto search = nlohmann::json::parse(support::contentOf(out + "/search.json"));
  EXPECT_EQ(search["costs"].size(), json["iterations"].get<std::size_t>() + 1);
  // the result is a start that needs nothing more
  const auto again = nlohmann::json::parse(
      runFisherHill({"robot", "double-pendulum", "--warm-start", out + "/motion_optimised.csv",
                     "--trials", "2", "--json"})
          .out);
  EXPECT_EQ(again["iterations"], 0);
}

nlohmann::json summaryOf(std::vector<std::string> arguments, int status = 0) {
  arguments.insert(arguments.begin(), "robot");
  arguments.push_back("--json");
  const ProgramResult result = runFisherHill(std::move(arguments));
  EXPECT_EQ(result.status, status) << result.err;
  return nlohmann::json::parse(result.out);
}

TEST(RobotCommand, OptimisesTheDoublePendulumInStepsAndTriesBothMotions) {
  const auto json = summaryOf({"double-pendulum", "--discrete", "--trials", "200"});
  EXPECT_GT(json["lambda_min_factor"].get<double>(), 100);
  EXPECT_GT(json["ms_per_iteration_continuous"].get<double>(), 0);
  for (int i : {0, 1}) {
    EXPECT_NEAR(json["monte_carlo_optimised"][i][i].get<double>() /
                    json["bound_optimised"][i][i].get<double>(),
                1, 0.25);
    EXPECT_LT(json["monte_carlo_optimised"][i][i].get<double>(),
              0.05 * json["monte_carlo_initial"][i][i].get<double>());
  }
}

TEST(RobotCommand, MeasuresLessOftenThanItSteps) {
  const std::vector<std::string> whole = {"double-pendulum", "--discrete", "--trials", "2"};
  auto rare = whole;
  rare.insert(rare.end(), {"--measure-every", "5"});
  const auto all = summaryOf(whole), fifth = summaryOf(rare);
  EXPECT_EQ(fifth["samples_per_s"], 10);
  EXPECT_NEAR(fifth["information_initial"][0][0].get<double>() /
                  all["information_initial"][0][0].get<double>(),
              0.2, 0.02);
  EXPECT_GT(fifth["lambda_min_factor"].get<double>(), 100);
}

TEST(RobotCommand, DesignsForTheWorstOfSeveralCandidates) {
  const auto json = summaryOf({"double-pendulum", "--discrete", "--trials", "2", "--robust",
                               "worst", "--candidate", "0.085", "0.05", "--candidate", "0.04",
                               "0.02", "--candidate", "0.25", "0.2"});
  EXPECT_EQ(json["candidates"].size(), 3u);
  const auto worst = json["worst_lambda_min"];
  EXPECT_GT(worst["robust"].get<double>(), 1.1 * worst["nominal"].get<double>());
  EXPECT_GT(worst["nominal"].get<double>(), worst["initial"].get<double>());
  EXPECT_EQ(summaryOf({"double-pendulum", "--discrete", "--trials", "2", "--robust", "average",
                       "--iterations", "2"})["candidates"]
                .size(),
            5u);
}

// Tables 4.4 and 4.7 in kind.
TEST(RobotCommand, EstimatesBetterFromTheOptimisedMotionInTheLaboratory) {
  const support::ScratchFolder scratch;
  for (const std::string robot : {"double-pendulum", "suspended-mass"}) {
    const std::string out = (scratch / robot).string();
    const auto json = summaryOf({robot, "--lab", "--trials", "2", "--out", out});
    const auto lab = json["laboratory"];
    EXPECT_GT(lab["out_of_plane_rad"].get<double>(), 0);
    EXPECT_LT(lab["median_error_optimised"][1].get<double>(),
              0.5 * lab["median_error_initial"][1].get<double>());
    EXPECT_LT(lab["median_error_optimised"][0].get<double>(), 0.05) << lab;
    EXPECT_LT(lab["median_error_optimised"][1].get<double>(), 0.3) << lab;
  }
  EXPECT_THAT(support::contentOf((scratch / "double-pendulum/report.html").string()),
              AllOf(HasSubstr("as in table 4.4"), HasSubstr("0.211")));
  EXPECT_THAT(support::contentOf((scratch / "suspended-mass/report.html").string()),
              AllOf(HasSubstr("as in table 4.7"), HasSubstr("1.11")));
}

TEST(RobotCommand, TakesEachEffectOfTheLaboratoryByItsSize) {
  const auto lab = summaryOf({"suspended-mass", "--trials", "2", "--out-of-plane", "2deg",
                              "--sensor-step", "0.01"})["laboratory"];
  EXPECT_NEAR(lab["out_of_plane_rad"].get<double>(), 0.0349, 1e-4);
  EXPECT_EQ(lab["sensor_step"], 0.01);
  EXPECT_EQ(lab["dry_friction_N_m"], 0);
  const auto more = summaryOf(
      {"suspended-mass", "--trials", "2", "--lab", "--dry-friction", "0.002"})["laboratory"];
  EXPECT_EQ(more["dry_friction_N_m"], 0.002);
  EXPECT_GT(more["control_lag_s"].get<double>(), 0);
}

TEST(RobotCommand, SaysWithFiguresThatASearchMadeNoProgress) {
  const support::ScratchFolder scratch;
  const std::string out = (scratch / "out").string();
  ASSERT_EQ(runFisherHill({"robot", "suspended-mass", "--tolerance", "0", "--out", out}).status, 0);
  const ProgramResult again = runFisherHill({"robot", "suspended-mass", "--tolerance", "0",
                                             "--warm-start", out + "/motion_optimised.csv"});
  EXPECT_EQ(again.status, 1);
  EXPECT_THAT(again.out, AllOf(HasSubstr("No progress: no step along the descent direction"),
                               HasSubstr("the cost stays at 10"), HasSubstr("trial motions")));
}

TEST(RobotCommand, MakesGradientDescentOnTheSuspendedMassConverge) {
  const auto json = nlohmann::json::parse(runFisherHill({"robot", "suspended-mass", "--json"}).out);
  EXPECT_NEAR(json["condition_initial"].get<double>() / 1.73e8, 1, 0.02);
  EXPECT_LE(json["condition_optimised"].get<double>(), 20);
  EXPECT_GT(json["lambda_max_optimised"].get<double>(), json["lambda_max_initial"].get<double>());
  EXPECT_GT(json["gradient_descent_iterations"]["initial"].get<int>(), 1000);
  EXPECT_LE(json["gradient_descent_iterations"]["optimised"].get<int>(), 130);
  EXPECT_LE(json["iterated_least_squares_iterations"]["optimised"].get<int>(), 6);
}

TEST(RobotCommand, AdvisesWhereTheStartTellsNothingAndPerturbsIt) {
  const ProgramResult still =
      runFisherHill({"robot", "double-pendulum", "--discrete", "--amplitude", "0"});
  EXPECT_EQ(still.status, 2);
  EXPECT_THAT(still.err, AllOf(HasSubstr("has no information"), HasSubstr("--perturb")));
  const ProgramResult perturbed =
      runFisherHill({"robot", "double-pendulum", "--discrete", "--amplitude", "0", "--perturb",
                     "0.01", "--json"});
  ASSERT_EQ(perturbed.status, 0) << perturbed.err;
  EXPECT_GT(nlohmann::json::parse(perturbed.out)["lambda_min_factor"].get<double>(), 10);
}

TEST(RobotCommand, TellsWrongUseInOneLine) {
  const auto fails = [](std::vector<std::string> arguments, const std::string& message) {
    const ProgramResult result = runFisherHill(std::move(arguments));
    EXPECT_EQ(result.status, 2);
    EXPECT_THAT(result.err, HasSubstr(message));
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
  };
  fails({"robot", "crane"}, "crane");
  fails({"robot", "double-pendulum", "--convergence"}, "--convergence requires suspended-mass");
  fails({"robot", "suspended-mass", "--undamped"}, "require double-pendulum");
  fails({"robot", "double-pendulum", "--undamped"}, "--undamped requires --unknown m1,m2");
  fails({"robot", "double-pendulum", "--amplitude", "-1"}, "--amplitude");
  fails({"robot", "double-pendulum", "--trials", "0"}, "--trials");
  fails({"robot", "suspended-mass", "--discrete"}, "--discrete requires double-pendulum");
  fails({"robot", "double-pendulum", "--discrete", "--as-is"}, "concern the optimisation");
  fails({"robot", "double-pendulum", "--warm-start", FISHERHILL_SOURCE_DIR "/README.md"},
        "README.md:");
  const support::ScratchFolder scratch;
  fails({"robot", "double-pendulum", "--warm-start",
         scratch.file("short.csv", "time,input\n0,1\n5\n")},
        "short.csv:3: row has 1 cells, must have 2");
  const auto inSteps = [&](std::vector<std::string> more, const std::string& message) {
    more.insert(more.begin(), {"robot", "double-pendulum", "--discrete", "--trials", "2"});
    fails(std::move(more), message);
  };
  inSteps({"--limits", "0.2", "-0.2"}, "limits of input 0: lower 0.2, upper -0.2");
  inSteps({"--limits", "0.1", "0.2"}, "limits of input 0: 0 at time 0, must be 0.1");
  inSteps({"--input-weight", "-1"}, "input weight R: least eigenvalue is -1");
  inSteps({"--objective", "e=-1"}, "weight of E in the objective: -1");
  inSteps({"--objective", "f=1"}, "criterion must be e, a, d or condition");
  inSteps({"--measure-every", "1000"}, "steps per sample: 1000, must be 1");
  inSteps({"--lab"}, "cannot be combined with --discrete");
  inSteps({"--candidate", "1", "1"}, "--candidate requires --robust");
  inSteps({"--robust", "worst", "--objective", "d=1"}, "worst case: weight of D");
  fails({"robot", "double-pendulum", "--measure-every", "2"}, "requires --discrete");
  fails({"robot", "suspended-mass", "--out-of-plane", "120deg"}, "angle out of the plane");
  fails({"robot", "suspended-mass", "--dry-friction", "-1"}, "dry friction: -1 N m");
}

}  // namespace
