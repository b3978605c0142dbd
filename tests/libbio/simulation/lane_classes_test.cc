// Muscles of every class in lanes: their laws beside the scalar ones, and whole simulations.

#include <gtest/gtest.h>

#include <functional>

#include "bio/model/convert_muscles.h"
#include "bio/simulation/simulate_batch.h"
#include "info/probability/random_stream.h"
#include "simulation/simd/lane_muscle.h"
#include "support/shipped_elbow.h"

namespace bio {
namespace {

using fixtures::forSeconds;
using fixtures::ShippedElbow;

using Change = std::function<void(Model&)>;

template <class Parameters, class F>
void forAll(Model& model, const F& change) {
  for (Muscle& muscle : model.muscles) {
    if (!muscle.hill) continue;
    if (auto* p = std::get_if<Parameters>(&*muscle.hill)) change(*p);
  }
}

using Thelen = muscles::Thelen2003Parameters<double>;
using Millard = muscles::Millard2012Parameters<double>;
using DeGroote = muscles::DeGrooteFregly2016Parameters<double>;

void makeRigid(Model& model) {
  for (Muscle& muscle : model.muscles) {
    std::visit([](auto& p) { p.ignoreTendonCompliance = true; }, *muscle.hill);
  }
}

/// The elbow with muscles of a class, or of all of them by turns.
Model elbowOf(const std::string& className) {
  Model model = readOsim(ShippedElbow::root() + "/models/elbow8.osim");
  if (className != "mixed") {
    if (className != "Schutte1993") convertMuscles(model, className);
    return model;
  }
  const std::array<Model, 5> kinds{elbowOf("Thelen2003"), elbowOf("Millard2012"),
                                   elbowOf("DeGrooteFregly2016"), elbowOf("RigidTendon"), model};
  for (std::size_t i = 0; i < model.muscles.size(); ++i) {
    model.muscles[i] = kinds[i % kinds.size()].muscles[i];
  }
  return model;
}

struct Kind {
  std::string name;
  Model model;
};

std::vector<Kind> kinds() {
  std::vector<Kind> all;
  for (const char* name : {"Schutte1993", "Thelen2003", "Millard2012", "DeGrooteFregly2016",
                           "RigidTendon", "RigidTendonMuscle", "mixed"}) {
    all.push_back({name, elbowOf(name)});
  }
  const auto add = [&](const std::string& name, const char* of, const Change& change) {
    all.push_back({name, elbowOf(of)});
    change(all.back().model);
  };
  add("undamped Millard", "Millard2012",
      [](Model& model) { forAll<Millard>(model, [](Millard& p) { p.fibreDamping = 0; }); });
  add("pennate Thelen", "Thelen2003",
      [](Model& model) { forAll<Thelen>(model, [](Thelen& p) { p.pennation = 0.3; }); });
  add("damped De Groote", "DeGrooteFregly2016",
      [](Model& model) { forAll<DeGroote>(model, [](DeGroote& p) { p.fibreDamping = 0.1; }); });
  add("rigid De Groote", "DeGrooteFregly2016", makeRigid);
  return all;
}

/// Every second draw has another activation; all differ in numbers and curves.
template <class Parameters>
void vary(Parameters& p, const std::function<double()>& factor, bool odd) {
  p.maxIsometricForce *= factor();
  p.optimalFibreLength *= factor();
  p.tendonSlackLength *= factor();
  const auto scale = [&](SplineFunction& curve) {
    const double by = factor();
    for (double& y : curve.y) y *= by;
  };
  if constexpr (requires { p.activationTime; }) p.activationTime *= odd ? 1.3 : 1;
  if constexpr (requires { p.activeForceLength; }) {
    scale(p.activeForceLength);
    scale(p.tendonForceLength);
  }
  if constexpr (requires { p.curves; }) {
    scale(p.curves.activeForceLength);
    scale(p.curves.forceVelocity);
  }
  if constexpr (requires { p.tendonUnitStrain; }) p.tendonUnitStrain *= factor();
  if constexpr (requires { p.passiveUnitStrain; }) p.passiveUnitStrain *= factor();
  if constexpr (requires { p.maxActiveLength; }) p.maxActiveLength *= factor();
  if constexpr (requires { p.maxEccentricForce; }) p.maxEccentricForce *= factor();
  if constexpr (requires { p.velocityShape; }) p.velocityShape *= factor();
}

/// Simulations of a trial that differ in the muscles' numbers, and what they point to.
struct DrawnOf {
  DrawnOf(const Model& model, double spread, int count, double seconds)
      : options(forSeconds(seconds)),
        own(model, ShippedElbow::options()),
        excitation(
            excitationOf(readTrial(ShippedElbow::root() + "/emg_data/curl_slow.sto", model), own)) {
    info::RandomStream random(5, 0);
    const auto factor = [&] { return std::exp(spread * random.normal()); };
    for (int i = 0; i < count; ++i) {
      Model drawn = model;
      for (Muscle& muscle : drawn.muscles) {
        if (muscle.schutte) vary(*muscle.schutte, factor, i % 2 != 0);
        if (muscle.hill) std::visit([&](auto& p) { vary(p, factor, i % 2 != 0); }, *muscle.hill);
      }
      auto& system = arms.emplace_back(
          std::make_unique<MusculoskeletalSystem>(drawn, ShippedElbow::options()));
      starts.push_back(std::make_unique<SystemState>(
          initialState(*system, Eigen::VectorXd::Constant(1, 0.5), excitation, 0)));
      jobs.push_back({system.get(), &excitation, starts.back().get()});
    }
  }

  Trajectory alone(std::size_t i) const {
    return simulate(*jobs[i].system, *jobs[i].excitation, *jobs[i].start, options);
  }

  SimulationOptions options;
  MusculoskeletalSystem own;
  ExcitationSignal excitation;
  std::vector<std::unique_ptr<MusculoskeletalSystem>> arms;
  std::vector<std::unique_ptr<SystemState>> starts;
  std::vector<LaneJob> jobs;
};

void expectSameMotion(const Trajectory& a, const Trajectory& b) {
  EXPECT_TRUE(a.q == b.q && a.qDot == b.qDot && a.fibreLength == b.fibreLength &&
              a.activation == b.activation && a.muscleWork == b.muscleWork &&
              a.newtonIterations == b.newtonIterations);
}

// simulate() is the second way: it knows nothing of lanes.
TEST(LaneClasses, MoveAsEachAloneWould) {
  for (const Kind& kind : kinds()) {
    SCOPED_TRACE(kind.name);
    DrawnOf drawn(kind.model, 0.02, 6, 4);
    drawn.options.newtonTolerance = 1e-13;
    const auto together = simulateTogether(drawn.jobs, drawn.options);
    double off = 0;
    for (std::size_t i = 0; i < together.size(); ++i) {
      const Trajectory alone = drawn.alone(i);
      const Trajectory& lane = together[i];
      EXPECT_EQ(lane.wallSeconds, 0) << "went by itself";
      ASSERT_EQ(lane.time, alone.time);
      EXPECT_GT(alone.q.maxCoeff() - alone.q.minCoeff(), 0.1);
      off = std::max(off, (lane.q - alone.q).cwiseAbs().maxCoeff());
      EXPECT_LT((lane.fibreLength - alone.fibreLength).cwiseAbs().maxCoeff(), 1e-9);
      EXPECT_LT((lane.activation - alone.activation).cwiseAbs().maxCoeff(), 1e-12);
      EXPECT_LT((lane.muscleWork - alone.muscleWork).cwiseAbs().maxCoeff(), 1e-8);
    }
    EXPECT_LT(off, 1e-9);
  }
}

// With few iterations allowed. A step that barely fails alone may succeed in lanes, whose iterates
// differ by rounding, or the other way round; then motions differ by what halving a step changes.
TEST(LaneClasses, HalveStepsAsEachAloneWould) {
  int halved = 0, otherwise = 0;
  for (const Kind& kind : kinds()) {
    SCOPED_TRACE(kind.name);
    DrawnOf drawn(kind.model, 0.1, 4, 1);
    drawn.options.maxIterations = 2;
    drawn.options.newtonTolerance = 1e-12;
    const auto together = simulateTogether(drawn.jobs, drawn.options);
    for (std::size_t i = 0; i < together.size(); ++i) {
      const Trajectory alone = drawn.alone(i);
      ASSERT_EQ(together[i].time, alone.time);
      EXPECT_EQ(together[i].outcome, alone.outcome);
      const double off = (together[i].q - alone.q).cwiseAbs().maxCoeff();
      EXPECT_LT(off, 3e-4);
      if (off > 1e-9) ++otherwise;
      if (off < 1e-9 && together[i].wallSeconds == 0) {
        EXPECT_EQ(together[i].halvedSteps, alone.halvedSteps);
        halved += static_cast<int>(alone.halvedSteps);
      }
    }
  }
  EXPECT_GT(halved, 20);    // measured: 29
  EXPECT_LE(otherwise, 2);  // measured: 0 of 44
}

TEST(LaneClasses, DependNeitherOnTheGroupNorOnTheProcessor) {
  for (const Kind& kind : kinds()) {
    SCOPED_TRACE(kind.name);
    const DrawnOf drawn(kind.model, 0.05, 9, 1);
    const auto all = simulateTogether(drawn.jobs, drawn.options);
    const auto plain = simulateTogether(drawn.jobs, drawn.options, LaneInstructions::plain);
    const auto avx2 = simulateTogether(drawn.jobs, drawn.options, LaneInstructions::avx2);
    std::vector<LaneJob> turned(drawn.jobs.rbegin(), drawn.jobs.rend());
    const auto other = simulateTogether(turned, drawn.options);
    for (std::size_t i = 0; i < all.size(); ++i) {
      expectSameMotion(all[i], plain[i]);
      expectSameMotion(all[i], avx2[i]);
      expectSameMotion(all[i], other[all.size() - 1 - i]);
      expectSameMotion(all[i], simulateTogether({&drawn.jobs[i], 1}, drawn.options).front());
    }
  }
}

double relative(double a, double b) {
  if (std::isnan(a) && std::isnan(b)) return 0;
  return std::abs(a - b) / std::max(1.0, std::abs(b));
}

/// Of muscles side by side and of states all over their curves: the largest difference to the
/// scalar law.
double offFromScalar(const SimulatedMuscle* const (&of)[lanes::width], double slack) {
  auto numbers = std::make_unique<lanes::LawNumbers<lanes::Here>>();
  lanes::gather(of, *numbers);
  lanes::AnyLaneMuscle law;
  law.set(*numbers);
  info::RandomStream random(3, 0);
  SchuttePieces pieces[lanes::width];
  double off = 0;
  for (int k = 0; k < 4000; ++k) {
    lanes::MuscleState s;
    for (int l = 0; l < lanes::width; ++l) {
      const double optimal = 1 / of[l]->perFibre();
      const double length = optimal * (0.02 + 1.7 * random.uniform());
      s.activation.v[l] = -0.05 + 1.1 * random.uniform();
      s.fibreLength.v[l] = length;
      s.pathLength.v[l] = 0.97 * length + slack * (0.96 + 0.1 * random.uniform());
      s.velocity.v[l] = optimal * 14 * (2 * random.uniform() - 1);
      s.step.v[l] = 0.01;
    }
    lanes::RigidForce force;
    lanes::Rate rate;
    const bool rigid = !of[0]->hasFibreState();
    rigid ? law.force(s, force) : law.rate(s, rate);
    for (int l = 0; l < lanes::width; ++l) {
      if (rigid) {
        const auto r = of[l]->rigidRate(s.activation.v[l], s.pathLength.v[l], s.velocity.v[l]);
        off = std::max({off, relative(force.tendonForce.v[l], r.tendonForce),
                        relative(force.dF_dPathLength.v[l], r.dF_dPathLength),
                        relative(force.dF_dPathSpeed.v[l], r.dF_dPathSpeed)});
        continue;
      }
      const FibreRateDerivatives r =
          of[l]->rateNear(s.activation.v[l], s.fibreLength.v[l], s.pathLength.v[l], s.velocity.v[l],
                          s.step.v[l], pieces[l]);
      off = std::max({off, relative(rate.fibreVelocity.v[l], r.fibreVelocity),
                      relative(rate.tendonForce.v[l], r.tendonForce),
                      relative(rate.dV_dFibreLength.v[l], r.dV_dFibreLength),
                      relative(rate.dV_dMuscleTendonLength.v[l], r.dV_dMuscleTendonLength),
                      relative(rate.dF_dFibreLength.v[l], r.dF_dFibreLength)});
    }
  }
  return off;
}

// Slack and torn tendons, fibres too short and too long, all activations: every branch, in lanes
// that disagree.
TEST(LaneClasses, LawsAreTheScalarOnes) {
  for (const Kind& kind : kinds()) {
    SCOPED_TRACE(kind.name);
    const DrawnOf drawn(kind.model, 0.05, lanes::width, 0.1);
    for (std::size_t i = 0; i < drawn.own.numMuscles(); ++i) {
      const SimulatedMuscle* of[lanes::width];
      for (std::size_t l = 0; l < lanes::width; ++l) of[l] = &drawn.arms[l]->muscles()[i].muscle;
      const Muscle& muscle =
          *std::find_if(kind.model.muscles.begin(), kind.model.muscles.end(),
                        [&](const Muscle& m) { return m.name == drawn.own.muscles()[i].name; });
      const double slack =
          muscle.schutte
              ? muscle.schutte->tendonSlackLength
              : std::visit([](const auto& p) { return p.tendonSlackLength; }, *muscle.hill);
      // measured: 2e-11, Millard's; 0 of Schutte's
      EXPECT_LT(offFromScalar(of, slack), 1e-9) << muscle.name;
    }
  }
}

// Over the range that laws reach, against the standard library.
TEST(LaneNumbers, PowersAndLogarithmsAreThoseOfTheStandardLibrary) {
  double powers = 0, logarithms = 0;
  for (int i = -70000; i < 70000; i += lanes::width) {
    lanes::Real x;
    for (int l = 0; l < lanes::width; ++l) x[l] = 0.01 * (i + l) + 0.003;
    const lanes::Real power = lanes::exponential(x);
    const lanes::Real back = lanes::logarithm(power);
    for (int l = 0; l < lanes::width; ++l) {
      const double expected = std::exp(x[l]);
      powers = std::max(powers, std::abs(power[l] - expected) / expected);
      const double log = std::log(power[l]);
      logarithms = std::max(logarithms, std::abs(back[l] - log) / std::max(1.0, std::abs(log)));
    }
  }
  EXPECT_LT(powers, 4.5e-16);
  EXPECT_LT(logarithms, 4.5e-16);
  const lanes::Real edges = {1e9, -1e9, std::numeric_limits<double>::quiet_NaN(), 0};
  const lanes::Real power = lanes::exponential(edges);
  EXPECT_GT(power[0], 1e300);
  EXPECT_LT(power[1], 1e-300);
  EXPECT_TRUE(std::isnan(power[2]));
  EXPECT_EQ(power[3], 1);
  EXPECT_TRUE(std::isnan(lanes::logarithm(edges)[2]));
}

}  // namespace
}  // namespace bio
