#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "bio/discovery/add_effects.h"
#include "info/discovery/likelihood/hypothesis.h"
#include "libbio/discovery/effect_cases.h"
#include "support/scratch_folder.h"

// A dynamometer's lever in the moment that it records.

namespace bio::discover {
namespace {

using namespace effect_cases;

SystemOptions turned() {
  SystemOptions options = ShippedElbow::options();
  options.prescribed = {"elbow_flexion"};
  return options;
}

constexpr double mean = 1.2, swing = 0.6, rate = 3;  // q = mean + swing·sin(rate·t)

/// The shipped elbow turned by a dynamometer that reads its moment.
struct Turned {
  explicit Turned(const Model& model = ShippedElbow().model)
      : data(model, turned(), "elbow_flexion", {recorded()}, Case::exact()) {}

  static Trial recorded() {
    Trial trial = cut(ShippedElbow().trial, 1);
    const VectorXd q = mean + swing * (rate * trial.times.array()).sin();
    trial.prescribed = {{ofCoordinate("elbow_flexion"), trial.times, q}};
    const Index n = trial.times.size();
    trial.measured = {{{Observable::Kind::moment, "elbow_flexion", 0},
                       trial.times,
                       VectorXd::LinSpaced(n, 0, 1)}};
    return trial;
  }
  std::size_t find(const std::string& quantity) const { return data.encompassing().find(quantity); }
  VectorXd moment(double weight, double angle, double inertia) const {
    VectorXd values = info::discover::nominalValues(data);
    values[static_cast<Index>(find("lever_weight.torque"))] = weight;
    values[static_cast<Index>(find("lever_weight.angle"))] = angle;
    values[static_cast<Index>(find("lever_inertia.inertia"))] = inertia;
    return data.outputs(0, values, {});
  }
  MusculoskeletalProblem data;
};

TEST(DynamometerEffects, AreOfCoordinatesThatItMoves) {
  const Case isFree(0.3);
  for (const char* id : {"lever_weight", "lever_inertia"}) {
    EXPECT_FALSE(isFree.data.encompassing().knows(id)) << id;
    EXPECT_TRUE(Turned().data.encompassing().knows(id)) << id;
  }
  for (const char* id : {"bias", "gain", "clock", "clock_rate", "lag", "drift"})
    EXPECT_TRUE(Turned().data.encompassing().knows(id)) << id;
}

TEST(DynamometerEffects, AddTheLeversWeightAndInertiaToTheMoment) {
  const Turned c;
  const VectorXd alone = c.moment(0, 0, 0), weighed = c.moment(2, 0.7, 0),
                 inert = c.moment(0, 0, 0.1);
  const auto& times = c.data.times(0);
  const double first = Turned::recorded().times[0];
  ASSERT_TRUE(alone.allFinite());
  for (std::size_t k = 0; k < times.size(); ++k) {
    const double t = times[k], q = mean + swing * std::sin(rate * t);
    const auto i = static_cast<Index>(k);
    // linear between rows 0.01 s apart: 1.2e-4 N·m
    EXPECT_NEAR(weighed[i] - alone[i], 2 * std::cos(q - 0.7), 2e-4);
    if (t < first + 0.1 || t > first + 0.9) continue;  // where the spline ends, q̈ is 0
    const double acceleration = -swing * rate * rate * std::sin(rate * t);
    EXPECT_NEAR(inert[i] - alone[i], -0.1 * acceleration, 1e-3);
  }
}

TEST(DynamometerEffects, AreAbsentAtZeroAndHaveTheirDerivatives) {
  const Turned c;
  const std::size_t w = c.find("lever_weight.torque"), r = c.find("lever_weight.angle"),
                    I = c.find("lever_inertia.inertia");
  const VectorXd nominal = info::discover::nominalValues(c.data);
  EXPECT_EQ(c.moment(0, 0.7, 0), c.data.outputs(0, nominal, {}));
  EXPECT_EQ(c.data.predict(0, nominal, {}, {w, r, I}, false).outputs,
            c.data.outputs(0, nominal, {}));
  for (const bool isThere : {false, true}) {
    VectorXd values = nominal;
    values[static_cast<Index>(w)] = isThere ? 2 : 0;
    values[static_cast<Index>(r)] = 0.7;
    values[static_cast<Index>(I)] = isThere ? 0.05 : 0;
    const auto at = c.data.predict(0, values, {}, {w, I, r}, false);
    const auto of = [&](std::size_t quantity) {
      return [&, quantity](double step) {
        VectorXd moved = values;
        moved[static_cast<Index>(quantity)] += step;
        return c.data.outputs(0, moved, {});
      };
    };
    EXPECT_LT(problem(at.gamma.col(0), of(w), 1), 1e-6);
    EXPECT_LT(problem(at.gamma.col(1), of(I), 0.1), 1e-6);
    if (isThere) {
      EXPECT_LT(problem(at.gamma.col(2), of(r), 1), 1e-6);
    }
  }
}

TEST(DynamometerEffects, OfAFileAddWhatTheyDoHere) {
  const Turned c;
  const support::ScratchFolder folder;
  const Augmented added =
      addEffects(c.data.encompassing(),
                 {{"lever_weight", Eigen::Vector2d(2, -0.7), {}, 0, 0},
                  {"lever_inertia", Eigen::VectorXd::Constant(1, 0.05), {}, 0, 0}},
                 {"a test", {}});
  writeOsim(added.model, folder / "lever.osim");
  const Turned again(readOsim(folder / "lever.osim"));
  EXPECT_TRUE(again.data.encompassing().present().contains("lever_weight"));
  EXPECT_LT((again.data.outputs(0, info::discover::nominalValues(again.data), {}) -
             c.moment(2, -0.7, 0.05))
                .cwiseAbs()
                .maxCoeff(),
            1e-9);
}

}  // namespace
}  // namespace bio::discover
