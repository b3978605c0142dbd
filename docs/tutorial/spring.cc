#include <fstream>
#include <iostream>

#include "info/info.h"

// A mass of 1 kg on a spring that hardens, ẍ = −k x − h x³ − c ẋ; x is measured.
struct Spring {
  static constexpr int stateSize = 2, inputSize = 0, parameterSize = 3, outputSize = 1;
  std::vector<std::string> parameterNames() const { return {"k", "h", "c"}; }

  template <class T>
  info::Vector<T, 2> f(const info::Vector<T, 2>& x, const info::Vector<T, 0>&,
                       const info::Vector<T, 3>& theta) const {
    info::Vector<T, 2> xDot;
    xDot << x[1], -theta[0] * x[0] - theta[1] * x[0] * x[0] * x[0] - theta[2] * x[1];
    return xDot;
  }

  template <class T>
  info::Vector<T, 1> g(const info::Vector<T, 2>& x, const info::Vector<T, 0>&,
                       const info::Vector<T, 3>&) const {
    return x.template head<1>();
  }
};

int main(int, char** arguments) {
  // The recording: a header, then one line "time,position" for every 0.05 s.
  std::ifstream file(arguments[1]);
  std::string header;
  std::getline(file, header);
  std::vector<double> position;
  char comma;
  for (double time, x; file >> time >> comma >> x;) position.push_back(x);

  // The experiment: let go at rest from 0.5 m, steps of 0.01 s, every fifth one measured.
  using Map = info::Rk4<Spring>;
  const std::size_t steps = 5 * position.size();
  const info::Predictor predictor = info::makePredictor(
      Map{{}, 0.01},
      {{0.5, 0.0}, {steps + 1, info::Vector<double, 0>()}, info::stepsEvery(5, 5, steps)});
  const info::OutputCovariance noise(Eigen::MatrixXd::Constant(1, 1, 0.01 * 0.01));
  const std::vector<info::Parameter> parameters = {
      {.name = "k", .unit = "N/m", .start = 8, .lower = 0},
      {.name = "h", .unit = "N/m³", .start = 15},
      {.name = "c", .unit = "N s/m", .start = 0.5, .lower = 0}};

  // What such a recording tells about the parameters, before it is looked at.
  const Eigen::VectorXd guess = Eigen::Vector3d(8, 15, 0.5);
  const Eigen::MatrixXd information =
      info::fisherInformation(predictor.withSensitivities(guess).gamma, noise);
  const auto report = info::identifiability(information, parameters);
  std::cout.precision(3);
  std::cout << "information\n" << information << '\n';
  std::cout << report.sentences[0] << ", standard deviations " << report.sd.transpose() << '\n';

  // What this recording says they are.
  const Eigen::MatrixXd measured =
      Eigen::VectorXd::Map(position.data(), Eigen::Index(position.size())).transpose();
  const auto estimate =
      info::estimate(info::LeastSquares(predictor, {measured, noise}, parameters));
  std::cout << describe(estimate.why) << " after " << estimate.iterations << " iterations\n";
  for (Eigen::Index i = 0; i < 3; ++i)
    std::cout << label(parameters[std::size_t(i)]) << " = " << estimate.parameters[i]
              << ", 95 % between " << estimate.intervals(i, 0) << " and "
              << estimate.intervals(i, 1) << '\n';
}
