#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <random>
#include <vector>

#include "bio/opensim/osim_file.h"
#include "bio/simulation/simulate.h"

// Random models and excitations: the variational step converges, is halved, or the simulation says
// that there is no solution; and the energy that nobody put in or took out vanishes as the step
// does, with its square.
//     random_arms MODEL COUNT SEED
namespace {

struct Draw {
  std::mt19937_64& random;
  double unit() { return std::uniform_real_distribution<double>(0, 1)(random); }
  double factor(double most) { return std::pow(most, 2 * unit() - 1); }
};

bio::Model randomModel(bio::Model model, Draw draw) {
  for (bio::Body& body : model.bodies) {
    const double heavier = draw.factor(3);
    body.mass *= heavier;
    for (double& inertia : body.inertia) inertia *= heavier;
    body.massCenter *= draw.factor(1.5);
  }
  for (bio::WrapObject& wrap : model.wrapObjects) wrap.radius *= draw.factor(1.2);
  for (bio::Muscle& muscle : model.muscles) {
    if (!muscle.schutte) continue;
    bio::SchutteParameters& p = *muscle.schutte;
    p.maxIsometricForce *= draw.factor(3);
    p.optimalFibreLength *= draw.factor(1.2);
    p.tendonSlackLength *= draw.factor(1.1);
    p.pennation *= draw.factor(1.5);
    p.timeScale *= draw.factor(3);
    p.damping *= draw.factor(5);
  }
  return model;
}

// Steps, ramps and noise; every muscle its own.
bio::ExcitationSignal randomExcitation(std::size_t muscles, Draw draw) {
  constexpr int rows = 51;
  std::vector<double> times;
  Eigen::MatrixXd values(rows, static_cast<Eigen::Index>(muscles));
  for (int k = 0; k < rows; ++k) times.push_back(0.01 * k);
  for (auto column : values.colwise()) {
    const double from = draw.unit(), to = draw.unit(), noise = 0.3 * draw.unit();
    const auto jump = static_cast<int>(rows * draw.unit());
    for (int k = 0; k < rows; ++k) {
      const double level = k < jump ? from : to;
      column[k] = std::clamp(level + noise * (draw.unit() - 0.5), 0.0, 1.0);
    }
  }
  return {times, values};
}

struct Tally {
  std::map<std::string, long> ends;
  long beyondRange = 0, findings = 0;
  std::vector<double> made, ratios;  ///< energy from nowhere at h, of the work done; at h/2 over h
};

void simulated(const bio::MusculoskeletalSystem& arm, const bio::ExcitationSignal& excitation,
               double start, Tally& tally, std::uint64_t seed) {
  const bio::SystemState state =
      initialState(arm, Eigen::VectorXd::Constant(1, start), excitation, 0);
  bio::SimulationOptions options;
  options.duration = 0.5;
  const bio::Trajectory t = simulate(arm, excitation, state, options);
  if (!t.q.allFinite() || !t.qDot.allFinite() || !t.fibreLength.allFinite()) {
    ++tally.findings;
    fmt::print("seed {}: numbers that are not finite\n", seed);
  }
  if (t.outcome != bio::Outcome::completed) {
    if (t.why.empty()) ++tally.findings;
    ++tally.ends["stopped, and said why"];
    return;
  }
  ++tally.ends[t.halvedSteps > 0 ? "came to the end with halved steps" : "came to the end"];
  // What went through the joint, there and back.
  double work = 0;
  for (Eigen::Index k = 1; k < t.muscleWork.size(); ++k) {
    work += std::abs(t.muscleWork[k] - t.muscleWork[k - 1]) +
            std::abs(t.passiveWork[k] - t.passiveWork[k - 1]);
  }
  const double made = energyError(arm, t);
  tally.made.push_back(made / std::max(work, 0.1));
  if (made < 1e-4) return;
  const auto leftRange = [&](const bio::Trajectory& motion) {
    const bio::Coordinate& joint = arm.skeleton().coordinates().front();
    return motion.q.minCoeff() < joint.rangeMin || motion.q.maxCoeff() > joint.rangeMax;
  };
  options.step /= 4;
  const bio::Trajectory fine = simulate(arm, excitation, state, options);
  if (fine.outcome != bio::Outcome::completed) return;
  const double ratio = energyError(arm, fine) / made;
  if (ratio > 0.5 && (leftRange(t) || leftRange(fine))) {
    ++tally.beyondRange;
    options.step /= 16;
    const bio::Trajectory finest = simulate(arm, excitation, state, options);
    if (finest.outcome == bio::Outcome::completed && energyError(arm, finest) < 0.1 * made) return;
  }
  tally.ratios.push_back(ratio);
  if (ratio > 0.5) {
    ++tally.findings;
    fmt::print(
        "seed {}: {:.3g} J from nowhere at 0.01 s, still {:.3g} J at 0.0025 s ({:.3g} J done)\n",
        seed, made, energyError(arm, fine), work);
  }
}

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return std::nan("");
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    fmt::print(stderr, "random_arms MODEL COUNT SEED\n");
    return 2;
  }
  const bio::Model model = bio::readOsim(argv[1]);
  const long count = argc > 2 ? std::atol(argv[2]) : 10'000;
  const auto first = argc > 3 ? static_cast<std::uint64_t>(std::atoll(argv[3])) : 1;
  bio::SystemOptions options;
  options.skeleton.freeCoordinates = {"elbow_flexion"};
  Tally tally;
  for (long i = 0; i < count; ++i) {
    const std::uint64_t seed = first + static_cast<std::uint64_t>(i);
    std::mt19937_64 random(seed);
    Draw draw{random};
    try {
      const bio::MusculoskeletalSystem system(randomModel(model, draw), options);
      const bio::ExcitationSignal excitation = randomExcitation(system.numMuscles(), draw);
      simulated(system, excitation, 0.2 + 1.8 * draw.unit(), tally, seed);
    } catch (const bio::NoStaticEquilibrium&) {
      ++tally.ends["has no static equilibrium at the start"];
    } catch (const std::invalid_argument& refusal) {
      ++tally.ends["is no arm: " + std::string(refusal.what()).substr(0, 40)];
    } catch (const std::domain_error& refusal) {
      ++tally.findings;
      fmt::print("seed {}: {}\n", seed, refusal.what());
    }
  }
  for (const auto& [end, times] : tally.ends) fmt::print("{:>8}  {}\n", times, end);
  fmt::print(
      "energy from nowhere at 0.01 s, of the work done: median {:.1e}, 99 % below {:.1e}, "
      "largest {:.1e}\n",
      quantile(tally.made, 0.5), quantile(tally.made, 0.99), quantile(tally.made, 1));
  fmt::print(
      "what is left of it at 0.0025 s ({} cases above 1e-4 J): median {:.2g}, 99 % below "
      "{:.2g}, largest {:.2g}\n",
      tally.ratios.size(), quantile(tally.ratios, 0.5), quantile(tally.ratios, 0.99),
      quantile(tally.ratios, 1));
  fmt::print("{} parted beyond the joint's range; at 0.00016 s less than a tenth is left\n",
             tally.beyondRange);
  fmt::print("{} models, {} findings\n", count, tally.findings);
  return tally.findings == 0 ? 0 : 1;
}
