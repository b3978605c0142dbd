#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

#include "support/run_program.h"
#include "support/scratch_folder.h"
#include "support/shipped_files.h"

// What reports say of how their numbers were made follows the options.
namespace {

using support::contentOf;
using support::ProgramResult;
using support::runFisherHill;
using support::ScratchFolder;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

/// The section Methods of the report of a command.
std::string methodsOf(std::vector<std::string> words, int status = 0) {
  const ScratchFolder scratch;
  const std::string out = (scratch / "out").string();
  words.insert(words.end(), {"--out", out});
  const ProgramResult result = runFisherHill(words);
  EXPECT_EQ(result.status, status) << result.err;
  const std::string html = contentOf(out + "/report.html");
  const auto begin = html.find("<h2>Methods</h2>");
  if (begin == html.npos) throw std::runtime_error("no methods: " + result.err);
  return html.substr(begin, html.find("<h2>", begin + 4) - begin);
}

/// A few rows of a trial.
std::string fewRows(const ScratchFolder& scratch) {
  const auto lines =
      support::linesOf(contentOf(std::string(FISHERHILL_SOURCE_DIR) + "/" + support::slow));
  std::string text;
  std::size_t rows = 0;
  bool isTable = false;
  for (const std::string& line : lines) {
    if (isTable && ++rows > 60) break;
    if (line.starts_with("time")) isTable = true;
    if (!line.starts_with("nRows")) text += line + "\n";
  }
  return scratch.file("few.sto", text);
}

TEST(MethodsOfCommands, EmgTellsTheFiltersThatWereUsed) {
  const ScratchFolder scratch;
  std::string raw;
  for (int i = 0; i < 600; ++i) {
    raw += std::to_string((i * 37) % 101 - 50) + "\t" + std::to_string((i * 53) % 89 - 44) +
           (i < 300 ? "\t" + std::to_string(i) : "") + "\n";
  }
  const std::string recording = scratch.file("raw.txt", raw);
  const std::string channels =
      "[[channel]]\ncolumn = 1\nname = \"biceps\"\nrate_Hz = 200\nunit = \"mV\"\n"
      "[[channel]]\ncolumn = 2\nname = \"triceps\"\nrate_Hz = 200\nunit = \"mV\"\n"
      "[[channel]]\ncolumn = 3\nname = \"angle\"\nrate_Hz = 100\nunit = \"deg\"\n";
  const std::string one = methodsOf(
      {"emg", recording, "--config",
       scratch.file("one.toml", channels +
                                    "[bandpass]\nlow_Hz = 20\nhigh_Hz = 80\n"
                                    "[[electrode]]\nchannel = \"biceps\"\nmuscles = [\"BRA\"]\n"
                                    "[measured]\nchannel = \"angle\"\n")});
  EXPECT_THAT(
      one,
      AllOf(HasSubstr("The raw EMG of 1 electrode was sampled at 200 Hz"),
            HasSubstr("band-passed from 20 to 80 Hz (order 2), full-wave rectified and low-passed "
                      "at 6 Hz (order 2)."),
            HasSubstr("divided by its own percentile 99 in this recording and clipped"),
            HasSubstr("The excitation is the normalised envelope itself. It was sampled at 200 "
                      "Hz, without a delay."),
            HasSubstr("drives BRA."), HasSubstr("elbow_flexion is channel"),
            HasSubstr("determined only up to a factor"), Not(HasSubstr("notches")),
            Not(HasSubstr("Lloyd"))));
  const std::string other = methodsOf(
      {"emg", recording, "--config",
       scratch.file(
           "other.toml",
           channels + "[bandpass]\nenabled = false\n[notch]\nlines_Hz = [50]\nwidth_Hz = 3\n"
                      "[envelope]\ncutoff_Hz = 4\norder = 3\n"
                      "[excitation]\nshape = -1.5\ndelay_s = 0.04\nrate_Hz = 50\n"
                      "[[electrode]]\nchannel = \"biceps\"\nmuscles = { BRA = 1.0, BRD = 0.5 }\n"
                      "mvc = 60\nunit = \"mV\"\n"
                      "[[electrode]]\nchannel = \"triceps\"\nmuscles = { TRI = 1.0, BRD = 0.25 }\n"
                      "mvc = 60\nunit = \"mV\"\n"
                      "[measured]\nchannel = \"angle\"\n")});
  EXPECT_THAT(
      other,
      AllOf(HasSubstr("It was filtered by notches of 3 Hz width (order 2) at 50 Hz, full-wave "
                      "rectified and low-passed at 4 Hz (order 3)."),
            HasSubstr("divided by the value given for a maximum voluntary contraction"),
            HasSubstr("(exp(A u) − 1)/(exp(A) − 1) with A = -1.5 (Lloyd and Besier, 2003)"),
            HasSubstr("delayed by 40 ms, the electromechanical delay, and sampled at 50 Hz"),
            HasSubstr("BRD (weight 0.5)"), HasSubstr("weighted sum of their excitations"),
            HasSubstr("low-passed at 20 Hz without lag (Butterworth, order 6"),
            HasSubstr("Journal of Biomechanics 36, 2003."), Not(HasSubstr("band-passed")),
            Not(HasSubstr("up to a factor"))));
  const std::string envelopes = methodsOf(
      {"emg", recording, "--config",
       scratch.file("envelopes.toml",
                    "[input]\nsignal = \"envelope\"\n" + channels +
                        "[normalise]\npercentile = 100\n"
                        "[[electrode]]\nchannel = \"biceps\"\nmuscles = [\"BRA\"]\n"
                        "[[electrode]]\nchannel = \"triceps\"\nmuscles = [\"TRI\"]\nmvc = 60\n"
                        "unit = \"mV\"\n"
                        "[[unrecorded]]\nmuscle = \"BRD\"\nconstant = 0.05\n")});
  EXPECT_THAT(
      envelopes,
      AllOf(HasSubstr("Envelopes of the EMG of 2 electrodes, sampled at 200 Hz, were used as they "
                      "were recorded, without any filter."),
            HasSubstr("that of biceps by its own largest value in this recording"),
            HasSubstr("BRD, which has no electrode, is a constant 0.05."),
            Not(HasSubstr("Butterworth"))));
}

TEST(MethodsOfCommands, MomentArmsTellRangeAndPaths) {
  const std::string model = support::model;
  const std::string one =
      methodsOf({"moment-arms", model, "--from", "10", "--to", "100", "--points", "7"});
  EXPECT_THAT(one, AllOf(HasSubstr("moment arms r = −∂ℓ/∂q of 8 muscles were computed at 7 equally "
                                   "spaced values of elbow_flexion from 10 to 100 deg."),
                         HasSubstr("shortest ones round the model"),
                         HasSubstr("exact derivatives of the path")));
  EXPECT_THAT(methodsOf({"moment-arms", model, "--from", "20", "--to", "30", "--points", "5"}),
              HasSubstr("at 5 equally spaced values of elbow_flexion from 20 to 30 deg."));
  const ScratchFolder scratch;
  const std::string postures =
      scratch.file("postures.csv", "elbow_flexion,pro_sup\n0.5,0\n1.0,0.1\n1.2,0.2\n");
  EXPECT_THAT(methodsOf({"moment-arms", model, "--postures", postures}),
              AllOf(HasSubstr("were computed in 3 postures that are given by elbow_flexion and "
                              "pro_sup."),
                    Not(HasSubstr("equally spaced"))));
  const std::string fit = methodsOf({"moment-arms", model, "--fit", "--fit-muscle", "BRA",
                                     "--fit-tolerance", "0.5", "--fit-order", "6"});
  EXPECT_THAT(fit, AllOf(HasSubstr("length of 1 muscle was approximated by a polynomial"),
                         HasSubstr("of the lowest order up to 6 that keeps the largest error "
                                   "within 0.5 mm.")));
}

TEST(MethodsOfCommands, CompareTellsIntegratorsAndSteps) {
  const ScratchFolder scratch;
  const std::string trial = fewRows(scratch);
  const std::string one =
      methodsOf({"compare", support::model, trial, "--integrators", "vi", "--steps", "0.005,0.01"});
  EXPECT_THAT(one, AllOf(HasSubstr("simulated with steps of 0.005 and 0.01 s by vi, a midpoint "
                                   "variational integrator (Wilson, thesis) with the forces shared "
                                   "by both ends of a step."),
                         HasSubstr("with steps of 0.001 s confirms it"),
                         HasSubstr("an error below 1 deg, found by bisection to 2 %"),
                         HasSubstr("Times are medians of at least 5 runs."),
                         Not(HasSubstr("Runge")), Not(HasSubstr("Motions are simulated by"))));
  const std::string other = methodsOf(
      {"compare", support::model, trial, "--integrators", "rk4,cvode", "--steps", "0.0005"});
  EXPECT_THAT(other, AllOf(HasSubstr("simulated with steps of 0.0005 s by rk4, the classical "
                                     "Runge–Kutta method of fourth order; cvode, CVODE of "
                                     "SUNDIALS (Hindmarsh et al., 2005)"),
                           Not(HasSubstr("a midpoint variational"))));
  const std::string muscles = methodsOf(
      {"compare", support::model, trial, "--muscles", "Thelen2003,RigidTendon", "--noise", "2"});
  EXPECT_THAT(muscles,
              AllOf(HasSubstr("as they are in the model and with all of them as Thelen2003 and "
                              "RigidTendon"),
                    HasSubstr("with a noise of 2 deg in a sample of elbow_flexion")));
}

TEST(MethodsOfCommands, EnsembleTellsWhatWasDrawn) {
  const ScratchFolder scratch;
  const std::string trial = fewRows(scratch);
  const std::string one =
      methodsOf({"ensemble", support::model, trial, "--draws", "6", "--parameters",
                 "TRI.radius,BRA.max_isometric_force", "--seed", "3"});
  EXPECT_THAT(one, AllOf(HasSubstr("simulated 6 times, each with 2 parameters drawn at random "
                                   "(seed 3) from independent normal distributions within their "
                                   "bounds."),
                         HasSubstr("at each of 46 times."), Not(HasSubstr("Sobol")),
                         Not(HasSubstr("unless others were given"))));
  const std::string other =
      methodsOf({"ensemble", support::model, trial, "--draws", "8", "--parameters", "TRI.radius",
                 "--sobol", "--distribution", "uniform", "--spread", "0.5", "--band-points", "9",
                 "--prior", "TRI.radius=0.018:0.001"});
  EXPECT_THAT(other,
              AllOf(HasSubstr("simulated 24 times, at 8 base points of a randomised Halton "
                              "sequence for one parameter by Saltelli"),
                    HasSubstr("uniform distributions over ±√3 standard deviations within their "
                              "bounds, with 0.5 times their standard deviations."),
                    HasSubstr("unless others were given"), HasSubstr("at each of 9 times"),
                    HasSubstr("Saltelli et al., 2010"), Not(HasSubstr("normal distribution"))));
}

TEST(MethodsOfCommands, DesignTellsCriterionInputsAndSearch) {
  const ScratchFolder scratch;
  const std::string trial = fewRows(scratch);
  const auto with = [&](std::vector<std::string> more) {
    std::vector<std::string> words = {"design", support::model, trial};
    words.insert(words.end(), more.begin(), more.end());
    const ScratchFolder other;
    // a search as short as this may well find nothing better
    const std::string out = (other / "out").string();
    words.insert(words.end(), {"--out", out});
    const ProgramResult result = runFisherHill(words);
    EXPECT_LE(result.status, 1) << result.err;
    const std::string html = contentOf(out + "/report.html");
    return html.substr(html.find("<h2>Methods</h2>"));
  };
  const std::string one = with({"--parameters", "TRI.radius", "--candidates", "3", "--generations",
                                "1", "--iterations", "0"});
  EXPECT_THAT(
      one,
      AllOf(HasSubstr("a sample every 0.01 s of elbow_flexion (noise 0.5 deg)"),
            HasSubstr("It was designed for TRI.radius, by E-optimality: the least eigenvalue of I "
                      "is largest"),
            HasSubstr("a torque on elbow_flexion (at most 10 N m and 50 N m/s), piecewise linear "
                      "between knots every 0.3 s"),
            HasSubstr("even if the parameters of interest are 0.5 prior standard deviations off"),
            HasSubstr("3 random designs and 1 generation of CMA-ES (Hansen, 2016) from the best "
                      "of them (seed 1)"),
            Not(HasSubstr("along exact gradients")), Not(HasSubstr("Schur"))));
  const std::string other =
      with({"--parameters",  "TRI.radius", "--nuisance",   "BRA.max_isometric_force",
            "--criterion",   "D",          "--torque",     "5",
            "--excite",      "flexors",    "--knots",      "0.2",
            "--rate",        "50",         "--noise",      "1",
            "--surprise",    "0",          "--candidates", "2",
            "--generations", "0",          "--iterations", "1",
            "--seed",        "4"});
  EXPECT_THAT(
      other,
      AllOf(HasSubstr("a sample every 0.02 s of elbow_flexion (noise 1 deg)"),
            HasSubstr("D-optimality: the determinant of I is largest"),
            HasSubstr("with BRA.max_isometric_force unknown as well"), HasSubstr("Schur"),
            HasSubstr("at most 5 N m"), HasSubstr("an excitation of BIClong, BICshort, BRA and "),
            HasSubstr("knots every 0.2 s"),
            HasSubstr("2 random designs and 1 iteration along exact gradients (seed 4)"),
            Not(HasSubstr("CMA-ES")), Not(HasSubstr("standard deviations off"))));
  const std::string separating = with({"--separate", "visc,spring", "--size", "visc=0.3",
                                       "--candidates", "2", "--generations", "0"});
  EXPECT_THAT(separating, AllOf(HasSubstr("to discriminate between viscous joint damping of 0.3"),
                                HasSubstr("Kass and Raftery, 1995"), Not(HasSubstr("optimality"))));
}

TEST(MethodsOfCommands, DesignOnADynamometerTellsWhatWasConsidered) {
  const std::vector<std::string> words = {"design",        support::model, "--dynamometer",
                                          "elbow_flexion", "--parameters", "TRI.radius"};
  std::vector<std::string> held = words, turned = words;
  held.insert(held.end(), {"--kinds", "isometric", "--angles", "40deg,80deg", "--efforts", "50",
                           "--experiments", "1", "--moment-noise", "0.8"});
  turned.insert(turned.end(), {"--kinds", "passive", "--angles", "30deg,90deg", "--speeds", "30deg",
                               "--experiments", "1", "--rate", "50"});
  EXPECT_THAT(methodsOf(held),
              AllOf(HasSubstr("4 experiments on a dynamometer at elbow_flexion were simulated: "
                              "isometric, at 40 and 80 deg and efforts of 50 % MVC, with 100 "
                              "samples per second and independent normal noise of 0.8 N m"),
                    HasSubstr("½ ln det(I + Λ) about TRI.radius,")));
  EXPECT_THAT(methodsOf(turned),
              AllOf(HasSubstr("passive, at 30 and 90 deg, with 50 samples per second"),
                    Not(HasSubstr("MVC, with"))));
}

TEST(MethodsOfCommands, RobotTellsObjectiveAndStart) {
  const std::string one =
      methodsOf({"robot", "double-pendulum", "--iterations", "1", "--trials", "3", "--seed", "2"});
  EXPECT_THAT(one,
              AllOf(HasSubstr("cart with a double pendulum"),
                    HasSubstr("its unknown parameters are m1 and c."),
                    HasSubstr("the cart&#39;s acceleration, minimises 100/λ_min"),
                    HasSubstr("The search begins with the initial motion of the thesis."),
                    HasSubstr("it made 1 iteration"),
                    HasSubstr("3 experiments with independent noise were simulated for the initial "
                              "motion and for the optimised one (seed 2)"),
                    Not(HasSubstr("barrier")), Not(HasSubstr("worst case"))));
  const std::string other =
      methodsOf({"robot", "suspended-mass", "--iterations", "1", "--objective", "a=2", "--limits",
                 "-3", "3", "--input-weight", "7", "--amplitude", "0.06", "--robust", "worst"});
  EXPECT_THAT(
      other,
      AllOf(HasSubstr("a cart with a mass on a string"), HasSubstr("minimises 2 tr I⁻¹"),
            HasSubstr("half of 7 times the squared deviation"),
            HasSubstr("kept between -3 and 3 m/s² by a barrier function (Hauser and Saccon, 2006)"),
            HasSubstr("The worst case over 5 sets of parameter values"),
            HasSubstr("The search begins with a cosine of the size given."),
            HasSubstr("Gradient descent and iterated least squares"), Not(HasSubstr("λ_min"))));
  EXPECT_THAT(methodsOf({"robot", "double-pendulum", "--bound-only"}),
              AllOf(HasSubstr("Cramér–Rao bound"), Not(HasSubstr("were simulated")),
                    Not(HasSubstr("minimises"))));
  EXPECT_THAT(methodsOf({"robot", "double-pendulum", "--as-is", "--trials", "4"}),
              HasSubstr("4 experiments with independent noise were simulated with this motion"));
}

TEST(MethodsOfCommands, ArmThatEstimatesAStringTellsItsRules) {
  const std::vector<std::string> words = {"robot", "baxter",           "--duration",
                                          "1.5",   "--initial-length", "0.42"};
  std::vector<std::string> other = words;
  other.insert(other.end(), {"--estimate-mass", "--window", "1", "--ignore-clipping", "--noise",
                             "0.2", "--disturbance", "0", "--search-time"});
  EXPECT_THAT(
      methodsOf(words),
      AllOf(HasSubstr("a mass of 0.2 kg on a string of 0.368 m, whose force a load cell measures "
                      "with a noise of 0.1 N"),
            HasSubstr("sequential action control (Ansari and Murphey, 2016)"),
            HasSubstr("The length was estimated every 0.5 s by least squares of the force since "
                      "the start; clipped samples count as censored (Tobin, 1958)."),
            HasSubstr("unmeasured acceleration of 0.5 m/s²"), HasSubstr("it acts at once"),
            HasSubstr("in simulated time")));
  EXPECT_THAT(
      methodsOf(other),
      AllOf(HasSubstr("with a noise of 0.2 N"),
            HasSubstr("Length and mass were estimated every 0.5 s by least squares of the force in "
                      "the last 1 s, clipped samples counting as measurements."),
            HasSubstr("may postpone an action"), Not(HasSubstr("Tobin")),
            Not(HasSubstr("disturbed"))));
}

}  // namespace
