#include "info/dynamics/system.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "robots/instances.h"
#include "support/pendulum.h"

namespace {

using namespace info;

/// `Pendulum` with every size known at run time only.
struct RunTimePendulum {
  static constexpr int stateSize = dynamic, inputSize = dynamic, parameterSize = dynamic,
                       outputSize = dynamic;
  template <class T>
  using V = Vector<T, dynamic>;
  Dimensions dimensions() const { return {2, 1, 2, 1}; }
  std::vector<std::string> parameterNames() const { return Pendulum{}.parameterNames(); }
  template <class T>
  V<T> f(const V<T>& x, const V<T>& u, const V<T>& theta) const {
    return Pendulum{}.f(Vector<T, 2>(x), Vector<T, 1>(u), Vector<T, 2>(theta));
  }
  template <class T>
  V<T> g(const V<T>& x, const V<T>& u, const V<T>& theta) const {
    return Pendulum{}.g(Vector<T, 2>(x), Vector<T, 1>(u), Vector<T, 2>(theta));
  }
};

/// The double pendulum with every size known at run time only.
struct RunTimeDoublePendulum {
  static constexpr int coordinateSize = dynamic, kinematicSize = dynamic, forceInputSize = dynamic,
                       parameterSize = dynamic, measurementSize = dynamic;
  template <class T>
  using V = Vector<T, dynamic>;
  using Fixed = CartDoublePendulum<>;
  MechanicalDimensions mechanicalDimensions() const { return {2, 1, 0, 2, 2}; }
  std::vector<std::string> parameterNames() const { return Fixed{}.parameterNames(); }
  template <class T>
  T lagrangian(const V<T>& q, const V<T>& v, const V<T>& r, const V<T>& w,
               const V<T>& theta) const {
    return Fixed{}.lagrangian(Vector<T, 2>(q), Vector<T, 2>(v), Vector<T, 1>(r), Vector<T, 1>(w),
                              Vector<T, 2>(theta));
  }
  template <class T>
  V<T> force(const V<T>& q, const V<T>& v, const V<T>& r, const V<T>& w, const V<T>&,
             const V<T>& theta) const {
    return Fixed{}.force(Vector<T, 2>(q), Vector<T, 2>(v), Vector<T, 1>(r), Vector<T, 1>(w),
                         Vector<T, 0>(), Vector<T, 2>(theta));
  }
  template <class T>
  V<T> measure(const V<T>& q, const V<T>& r, const V<T>& theta) const {
    return Fixed{}.measure(Vector<T, 2>(q), Vector<T, 1>(r), Vector<T, 2>(theta));
  }
};

static_assert(SmoothSystem<RunTimePendulum> && LagrangianSystem<RunTimeDoublePendulum>);

struct NoOutput {
  static constexpr int stateSize = 1, inputSize = 0, parameterSize = 0, outputSize = 0;
  template <class T>
  Vector<T, 1> f(const Vector<T, 1>& x, const Vector<T, 0>&, const Vector<T, 0>&) const {
    return x;
  }
};
struct OnlyDouble {  // not a template: a System, but nothing can differentiate it
  static constexpr int stateSize = 1, inputSize = 1, parameterSize = 1, outputSize = 1;
  using V = Vector<double, 1>;
  std::vector<std::string> parameterNames() const { return {"a"}; }
  V f(const V& x, const V&, const V&) const { return x; }
  V g(const V& x, const V&, const V&) const { return x; }
};
static_assert(!System<NoOutput>);
static_assert(System<OnlyDouble> && !SmoothSystem<OnlyDouble>);

template <class Pendulum>
auto run(std::size_t steps) {
  using Map = Rk4<Pendulum>;
  std::vector<InputOf<Map>> u;
  for (std::size_t k = 0; k <= steps; ++k)
    u.push_back(InputOf<Map>::Constant(1, 0.5 * std::cos(0.2 * double(k))));
  StateOf<Map> x0(2);
  x0 << 0.9, -0.4;
  ParametersOf<Map> theta(2);
  theta << 0.7, 0.12;
  const Map map{{}, 0.02};
  const auto out =
      simulateWithSensitivity(map, x0, StateSensitivityOf<Map>::Zero(2, 2).eval(), u, theta);
  const std::vector<StateOf<Map>> weights(out.x.size(), StateOf<Map>::Constant(2, 0.7));
  return std::pair{out, contractSecondSensitivity(map, out, u, theta, weights)};
}

TEST(System, RunTimeSizesGiveTheNumbersOfFixedSizes) {
  const auto [fixed, fixedSecond] = run<Pendulum>(40);
  const auto [atRunTime, second] = run<RunTimePendulum>(40);
  EXPECT_LT((fixed.x.back() - atRunTime.x.back()).norm(), 1e-14);
  EXPECT_LT((fixed.psi.back() - atRunTime.psi.back()).norm(), 1e-13);
  EXPECT_LT((fixedSecond - second).norm(), 1e-11);
}

TEST(System, RunTimeSizesServeTheImplicitMidpointToo) {
  const ImplicitMidpoint<RunTimePendulum> atRunTime{{}, 0.02};
  const ImplicitMidpoint<Pendulum> fixed{{}, 0.02};
  const Vector<double, dynamic> x = Vector<double, 2>(0.9, -0.4), u = Vector<double, 1>(0.3),
                                theta = Vector<double, 2>(0.7, 0.12);
  const auto a = linearise(atRunTime, x, u, u, theta);
  const auto b = linearise(fixed, Vector<double, 2>(x), Vector<double, 1>(u), Vector<double, 1>(u),
                           Vector<double, 2>(theta));
  EXPECT_LT((a.dx - b.dx).norm() + (a.dtheta - b.dtheta).norm() + (a.du1 - b.du1).norm(), 1e-14);
}

TEST(LagrangianSystem, RunTimeSizesGiveTheNumbersOfFixedSizes) {
  const VariationalIntegrator<RunTimeDoublePendulum> atRunTime({}, 0.02);
  const VariationalIntegrator<CartDoublePendulum<>> fixed({}, 0.02);
  const Vector<double, 4> x{0.6, -0.3, 1e-3, 5e-4}, w{0.3, 1.0, -0.7, 2.0};
  const Vector<double, 1> u0(0.1), u1(0.12);
  const Vector<double, 2> theta{0.085, 0.5};
  const Vector<double, dynamic> xd = x, wd = w, u0d = u0, u1d = u1, thetad = theta;
  const auto a = atRunTime.linearise(xd, u0d, u1d, thetad);
  const auto b = fixed.linearise(x, u0, u1, theta);
  ASSERT_TRUE(a.solution.converged);
  EXPECT_LT((a.solution.x1 - b.solution.x1).norm(), 1e-14);
  EXPECT_LT((a.dx - b.dx).norm(), 1e-10 * b.dx.norm());
  EXPECT_LT((a.dtheta - b.dtheta).norm(), 1e-10 * b.dtheta.norm());
  const auto ha = atRunTime.contractedHessian(xd, u0d, u1d, thetad, wd);
  const auto hb = fixed.contractedHessian(x, u0, u1, theta, w);
  EXPECT_LT((ha - hb).norm(), 1e-10 * hb.norm());
}

TEST(System, NamesTheArgumentOfWrongLength) {
  const Rk4<RunTimePendulum> map{{}, 0.02};
  const Vector<double, dynamic> two = Vector<double, 2>(0.1, 0.2), one = Vector<double, 1>(0.1);
  const auto message = [&](const auto& x, const auto& u, const auto& theta) -> std::string {
    try {
      solve(map, x, u, u, theta);
    } catch (const DimensionError& e) {
      return e.what();
    }
    return "nothing thrown";
  };
  EXPECT_THAT(message(one, one, two), testing::StartsWith("state x"));
  EXPECT_THAT(message(two, two, two), testing::StartsWith("input u"));
  EXPECT_EQ(message(two, one, one), "parameters theta: length is 1, must be 2");
}

TEST(LagrangianSystem, NamesTheArgumentOfWrongLength) {
  const VariationalIntegrator<RunTimeDoublePendulum> integrator({}, 0.02);
  const Vector<double, dynamic> three = Vector<double, 3>::Zero(), one = Vector<double, 1>(0.1),
                                two = Vector<double, 2>::Zero(), none(0);
  using I = std::remove_const_t<decltype(integrator)>;
  EXPECT_THROW(integrator.step(I::Arguments{three, two, none, one, one, two}), DimensionError);
  EXPECT_THROW(integrator.step(I::Arguments{two, three, none, one, one, two}), DimensionError);
  EXPECT_THROW(integrator.step(I::Arguments{two, two, one, one, one, two}), DimensionError);
  EXPECT_THROW(integrator.step(I::Arguments{two, two, none, two, one, two}), DimensionError);
  EXPECT_THROW(integrator.step(I::Arguments{two, two, none, one, two, two}), DimensionError);
  EXPECT_THROW(integrator.step(I::Arguments{two, two, none, one, one, one}), DimensionError);
}

struct Contradicting : RunTimePendulum {
  static constexpr int stateSize = 3;
};

TEST(DimensionsOf, RefusesFixedSizesThatDimensionsContradicts) {
  EXPECT_THROW(dimensionsOf(Contradicting{}), DimensionError);
  EXPECT_EQ(dimensionsOf(RunTimePendulum{}).parameter, 2);
  EXPECT_EQ(dimensionsOf(Pendulum{}).state, 2);
}

}  // namespace
