#pragma once

#include <Eigen/Dense>
#include <string>
#include <vector>

#include "info/discovery/likelihood/discovery_problem.h"

/// The two robots of chapter 4 of Wilson's thesis with all effects that may be missing: the
/// catalogues of discovery (info/discover).
namespace info::robot {

/// One measured channel.
struct Channel {
  std::string name;  ///< name of its column, e.g. "link1"
  std::string unit;  ///< "rad" or "N"
};

/// One quantity of a trial's initial state; the rest is 0.
struct StartQuantity {
  std::string name, unit;
  int channel;   ///< channel whose first sample is the nominal value; −1: 0
  double sd;     ///< prior standard deviation, in its unit
  double bound;  ///< bounds: nominal ± this
};

/// A recording: the cart's commanded acceleration and the measurements.
struct Trial {
  std::string name;
  std::vector<double> times;         ///< [s] strictly rising, at least 2
  std::vector<double> acceleration;  ///< commanded [m/s²], linear between times
  Eigen::MatrixXd measured;          ///< times × channels; NaN: not measured
};

/// One measured value.
struct Sample {
  double time = 0;  ///< [s]
  int channel = 0;
};

/// A request for a simulation.
struct Request {
  const Trial& trial;
  const std::vector<Sample>& samples;      ///< in the order of time, within the trial
  const std::vector<double>& nodes;        ///< of the latent acceleration [s], equally spaced
  double step;                             ///< longest time step [s] > 0
  const Eigen::VectorXd& shared;           ///< values of Model::quantities
  const Eigen::VectorXd& start;            ///< values of Model::starts
  const Eigen::VectorXd& latent;           ///< at the nodes [m/s²]; empty: 0
  const std::vector<std::size_t>& wanted;  ///< indices into `shared`, each once
  bool derivatives = false, latentToo = false;
};

/// The result of a simulation; not finite if it fails.
struct Response {
  Eigen::VectorXd outputs;   ///< at the samples, in the channels' units
  Eigen::VectorXd speeds;    ///< their rates
  Eigen::MatrixXd byWanted;  ///< exact derivatives, samples × wanted
  Eigen::MatrixXd byStart, byLatent;
  Eigen::VectorXd angle, rate;    ///< of the first joint at the nodes; with `latentToo`
  Eigen::MatrixXd angleByLatent;  ///< its derivatives, nodes × nodes; with `latentToo`
  Eigen::MatrixXd states;         ///< at the trial's times
};

/// A robot with its catalogue.
///
/// Amplitudes that are physically non-negative are ≥ 0; at 0 the effect is absent, bit for bit.
/// Sources of the priors are given beside each entry in src/robot_double_pendulum.cc and
/// src/robot_suspended_mass.cc.
struct Model {
  std::string name;
  std::vector<Channel> channels;
  std::vector<discover::Quantity> quantities;
  std::vector<std::size_t> nuisances;  ///< of `quantities`
  std::vector<discover::Candidate> candidates;
  std::vector<StartQuantity> starts;
  std::vector<std::string> states;  ///< names of Response::states, with units
  Response (*simulate)(const Request& request) = nullptr;
};

/// Cart with double pendulum (cart_double_pendulum.h), absolute angles α, β of both links measured
/// [rad]; w_1 = α̇, w_2 = β̇ − α̇ are the rates of its joints, τ_i the moments in them.
///
/// | id | effect | amplitude |
/// |---|---|---|
/// | visc_1, visc_2 | τ_i −= b·w_i, in addition to the damping of the model | b ≥ 0 [N·m·s/rad] |
/// | coulomb_1, coulomb_2 | τ_i −= c·tanh(w_i/0.05 rad/s) | c ≥ 0 [N·m] |
/// | stribeck_1, stribeck_2 | τ_i −= c·[1 + e^{−(w_i/v)²}]·tanh(w_i/0.05 rad/s) | c ≥ 0 [N·m] |
/// | drag | −k·|v|·v at the mass centre of each link, v its velocity | k ≥ 0 [N·s²/m²] |
/// | tilt | gravity's moments are those at α + δ, β + δ | δ [rad] |
/// | locked_2 | τ_2 −= k·(β − α + w_2·2 ms): one link fewer as k → ∞ | k ≥ 0 [N·m/rad] |
/// | link_3 | a point mass m on a rod of length ℓ below the end of link 2 | m ≥ 0 [kg] |
/// | lag | T·ȧ_c = a − a_c between command a and actual acceleration a_c | T ≥ 0 [s] |
/// | bias_1, bias_2, gain_1, gain_2 | the reading is (1 + g)·angle + b | b [rad], g |
/// | clock | sensors are delayed by T | T ≥ 0 [s] |
/// | m_1, m_2, com_1, com_2, I_1, I_2, pivots, damping | errors of parameters | |
///
/// The third link hangs L2 − 2·offset below joint 2 and starts in line with link 2; its joint has
/// viscous damping, 0.5/s times mℓ² times its rate.
Model doublePendulum();

/// Cart with a mass on a string (suspended_mass.h), the string's force measured at its top [N].
///
/// | id | effect | amplitude |
/// |---|---|---|
/// | drag | −k·|v|·v on the mass, v its velocity | k ≥ 0 [N·s²/m²] |
/// | elastic | the string is C·(F − mg) longer, inner damping 0.2 N·s/m | C ≥ 0 [m/N] |
/// | visc | moment −b·φ̇ of the pivot | b ≥ 0 [N·m·s/rad] |
/// | coulomb | moment −c·tanh(φ̇/0.05 rad/s) of the pivot | c ≥ 0 [N·m] |
/// | tilt | gravity's components at φ + δ; initial angle from the vertical | δ [rad] |
/// | lag | T·ȧ_c = a − a_c between command a and cart a_c | T ≥ 0 [s] |
/// | saturation | the fraction s of the force beyond K is lost | s ≥ 0; 1: all of it |
/// | bias, gain | the reading is (1 + g)·F + b | b [N], g |
/// | clock | the sensor is delayed by T | T ≥ 0 [s] |
/// | mass, length | errors of parameters; gain and mass differ only with drag | |
/// @param leastForce, greatestForce measured [N]: the range in which saturation may begin
Model suspendedMass(double leastForce, double greatestForce);

}  // namespace info::robot
