#include <cmath>
#include <cstdio>

#include "info/dynamics/integrate.h"
#include "info/dynamics/predictor.h"
#include "info/information/fisher.h"

// ẋ = −θ x, y = x
struct Decay {
  static constexpr int stateSize = 1, inputSize = 0, parameterSize = 1, outputSize = 1;
  std::vector<std::string> parameterNames() const { return {"rate"}; }
  template <class T>
  info::Vector<T, 1> f(const info::Vector<T, 1>& x, const info::Vector<T, 0>&,
                       const info::Vector<T, 1>& theta) const {
    return info::Vector<T, 1>(-theta[0] * x[0]);
  }
  template <class T>
  info::Vector<T, 1> g(const info::Vector<T, 1>& x, const info::Vector<T, 0>&,
                       const info::Vector<T, 1>&) const {
    return x;
  }
};

// The Cramér–Rao bound of the rate from x(1) with noise σ = 0.1: x = e^{−θ}, dx/dθ = −e^{−θ}, so
// the bound is σ²e^{2θ}.
int main() {
  const info::Predictor predictor =
      info::makePredictor(info::Rk4<Decay>{{}, 0.01},
                          {info::Vector<double, 1>(1.0), {101, info::Vector<double, 0>()}, {100}});
  const Eigen::VectorXd rate = Eigen::VectorXd::Constant(1, 2.0);
  const info::OutputCovariance noise(Eigen::MatrixXd::Constant(1, 1, 0.01));
  const double bound = info::cramerRaoBound(
      info::fisherInformation(predictor.withSensitivities(rate).gamma, noise))(0, 0);
  const double expected = 0.01 * std::exp(4.0);
  std::printf("bound %.6f, expected %.6f\n", bound, expected);
  return std::abs(bound / expected - 1) < 1e-6 ? 0 : 1;
}
