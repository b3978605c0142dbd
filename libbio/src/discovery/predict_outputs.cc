#include <algorithm>
#include <cmath>
#include <limits>

#include "bio/analysis/replay.h"
#include "bio/discovery/musculoskeletal_problem.h"
#include "bio/sensitivity/coupled_sensitivity.h"
#include "discovery/look_at.h"
#include "sensitivity/sensitivity_run.h"

namespace bio::discover {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// The clock, and starts of other trials, have no column of the simulation.
struct MusculoskeletalProblem::Columns {
  std::vector<ParameterDirection> directions;
  std::vector<Index> place;                        ///< of the wanted among them; −1: none
  std::vector<std::optional<Meaning::Kind>> kind;  ///< of the model's quantities
};

MusculoskeletalProblem::Columns MusculoskeletalProblem::columnsOf(
    const OfTrial& one, const VectorXd& values, const std::vector<std::size_t>& wanted) const {
  const std::size_t own = encompassing_.quantities().size();
  const VectorXd modelValues = values.head(static_cast<Index>(own)) + one.known;
  const int c = encompassing_.freeIndex();
  Columns columns;
  for (const std::size_t quantity : wanted) {
    ParameterDirection direction;
    std::optional<Meaning::Kind> kind;
    if (quantity < own) {
      kind = encompassing_.kindOf(quantity);
      direction = encompassing_.direction(modelValues, quantity);
    }
    if (quantity == one.angle || kind == Meaning::Kind::bias || kind == Meaning::Kind::gain)
      direction = {{InitialTarget{c, false}}};
    if (quantity == one.speed) direction = {{InitialTarget{c, true}}};
    columns.kind.push_back(kind);
    columns.place.push_back(direction.empty() ? -1 : static_cast<Index>(columns.directions.size()));
    if (!direction.empty()) columns.directions.push_back(std::move(direction));
  }
  return columns;
}

MatrixXd MusculoskeletalProblem::latentScale(const OfTrial& one, const MusculoskeletalSystem& arm,
                                             const Trajectory& motion) const {
  Trajectory atNodes;  // the nearest rows
  const auto rows = static_cast<Index>(motion.time.size());
  const auto numNodes = static_cast<Index>(one.nodes.size());
  atNodes.q.resize(motion.q.rows(), numNodes);
  atNodes.qDot.resize(motion.qDot.rows(), numNodes);
  atNodes.fibreLength.resize(motion.fibreLength.rows(), numNodes);
  atNodes.activation.resize(motion.activation.rows(), numNodes);
  for (Index k = 0; k < numNodes; ++k) {
    const double at = one.nodes[static_cast<std::size_t>(k)] - motion.time.front();
    const Index row = std::clamp<Index>(
        static_cast<Index>(std::lround(at / options_.simulation.step)), 0, rows - 1);
    atNodes.q.col(k) = motion.q.col(row);
    atNodes.qDot.col(k) = motion.qDot.col(row);
    atNodes.fibreLength.col(k) = motion.fibreLength.col(row);
    atNodes.activation.col(k) = motion.activation.col(row);
  }
  const MuscleReport muscles = reportMuscles(arm, atNodes, encompassing_.freeIndex());
  MatrixXd scale(numNodes, muscles.momentArm.rows() + 1);
  scale << muscles.momentArm.cwiseProduct(muscles.tendonForce).transpose(),
      VectorXd::Constant(numNodes, options_.latentFloor);
  return scale;
}

/// A trial's simulation and, once asked for, its derivatives.
class MusculoskeletalProblem::Run final : public Simulation {
 public:
  Run(const MusculoskeletalProblem& of, const Nudge* nudge, int trial, const VectorXd& values,
      const VectorXd& latent, const std::vector<std::size_t>& wanted, bool latentToo)
      : of_(of),
        one_(of.of(trial)),
        wanted_(wanted),
        latentToo_(latentToo),
        setting_(of.settingAt(one_, values, wanted)),
        sensor_(of.encompassing_.sensorAt(values)),
        timedNodes_(of.timedDirections(one_, values, wanted)),
        columns_(of.columnsOf(one_, values, wanted)),
        outputs_(VectorXd::Constant(static_cast<Index>(one_.times.size()), nan)),
        speeds_(outputs_) {
    try {
      options_.simulation =
          of.simulationOf(one_, of.withTimedForces(one_, values, latent), sensor_);
      if (nudge) apply(*nudge, setting_.model, options_.simulation.externalForce);
      // forces that change in time follow those at the nodes
      if (latentToo || timedNodes_.size() > 0) {
        options_.externalNodes = {of.encompassing_.freeIndex(), one_.nodes};
      }
      arm_.emplace(of.encompassing_.armOf(setting_));
      excitation_ = of.excitationFor(one_, *arm_);
      run_.emplace(*arm_, setting_, excitation_, options_);
    } catch (const std::exception&) {
      return;  // outside the model's domain
    }
    observe();
  }

  const VectorXd& outputs() const override { return outputs_; }

  Prediction predict() override {
    const auto K = static_cast<Index>(one_.times.size());
    const auto numNodes = static_cast<Index>(latentToo_ ? one_.nodes.size() : 0);
    const VectorXd nowhere = VectorXd::Constant(numNodes, nan);
    Prediction result{outputs_,
                      MatrixXd::Constant(K, static_cast<Index>(wanted_.size()), nan),
                      MatrixXd::Constant(latentToo_ ? K : 0, numNodes, nan),
                      MatrixXd::Constant(numNodes, 1, of_.options_.latentFloor),
                      speeds_,
                      {nowhere, nowhere},
                      MatrixXd::Constant(numNodes, numNodes, nan)};
    if (!run_) return result;
    SensitivityTrajectory s;
    try {
      s = run_->sensitivities(columns_.directions);
      if (latentToo_) result.scale = of_.latentScale(one_, *arm_, s.motion);
    } catch (const std::exception&) {
      result.outputs.setConstant(nan);
      result.speeds.setConstant(nan);
      return result;
    }
    if (latentToo_) setCourse(s, result);
    differentiate(s, result);
    return result;
  }

 private:
  static constexpr double nan = std::numeric_limits<double>::quiet_NaN();

  std::optional<MotionWeights> look(const Trajectory& motion, double t) const {
    return lookAt(motion.time, sensor_.measuredAt(t, one_.trial.times[0]));
  }

  /// What the sensor shows of the motion.
  void observe() {
    const Trajectory& motion = run_->motion();
    const int c = of_.encompassing_.freeIndex();
    course_ = lagged(motion.time, motion.q.row(c), motion.qDot.row(c), sensor_.lag);
    const auto q = course_.value.row(0), qDot = course_.speed.row(0);
    for (Index i = 0; i < outputs_.size(); ++i) {
      const double t = one_.times[static_cast<std::size_t>(i)];
      const auto w = look(motion, t);
      if (!w) continue;
      const double factor = 1 + sensor_.gain;
      outputs_[i] =
          factor * w->value(q, qDot) + sensor_.bias + sensor_.drift * (t - one_.trial.times[0]);
      speeds_[i] = factor * w->slope(q, qDot);
    }
  }

  /// The coordinate itself at the nodes; behind the last row it is as there.
  void setCourse(const SensitivityTrajectory& s, Prediction& result) const {
    const auto c = static_cast<std::size_t>(of_.encompassing_.freeIndex());
    const Trajectory& motion = s.motion;
    const auto q = motion.q.row(static_cast<Index>(c)),
               qDot = motion.qDot.row(static_cast<Index>(c));
    for (Index k = 0; k < static_cast<Index>(one_.nodes.size()); ++k) {
      const double node = one_.nodes[static_cast<std::size_t>(k)];
      const auto w = lookAt(motion.time, std::min(node, motion.time.back()));
      if (!w) continue;
      result.course.q[k] = w->value(q, qDot);
      result.course.qDot[k] = w->slope(q, qDot);
      result.courseByNode.row(k) = w->rows(s.qOfNodes[c], s.qDotOfNodes[c]);
    }
  }

  void differentiate(SensitivityTrajectory& s, Prediction& result) const {
    const auto c = static_cast<std::size_t>(of_.encompassing_.freeIndex());
    const bool hasNodes = !s.qOfNodes.empty();
    if (sensor_.lag > 0) {
      const auto behind = [&](SensitivityMatrix& of, SensitivityMatrix& rate) {
        const Lagged late = lagged(s.motion.time, of.transpose(), rate.transpose(), sensor_.lag);
        of = late.value.transpose();
        rate = late.speed.transpose();
      };
      behind(s.q[c], s.qDot[c]);
      if (hasNodes) behind(s.qOfNodes[c], s.qDotOfNodes[c]);
    }
    const double factor = 1 + sensor_.gain;
    for (Index i = 0; i < outputs_.size(); ++i) {
      const auto w = look(s.motion, one_.times[static_cast<std::size_t>(i)]);
      if (!w) continue;
      const Eigen::RowVectorXd along = factor * w->rows(s.q[c], s.qDot[c]);
      Eigen::RowVectorXd ofNodes;
      if (hasNodes) ofNodes = w->rows(s.qOfNodes[c], s.qDotOfNodes[c]);
      addRow(i, *w, along, ofNodes, result);
      if (latentToo_) result.byNode.row(i) = factor * ofNodes;
    }
  }

  /// The derivatives of sample i in the wanted quantities.
  void addRow(Index i, const MotionWeights& w, const Eigen::RowVectorXd& along,
              const Eigen::RowVectorXd& ofNodes, Prediction& result) const {
    const double factor = 1 + sensor_.gain;
    const double since = one_.times[static_cast<std::size_t>(i)] - one_.trial.times[0];
    const double firstAngle = setting_.start.q[of_.encompassing_.freeIndex()];
    const auto q = course_.value.row(0), qDot = course_.speed.row(0);
    const double value = w.value(q, qDot), slope = w.slope(q, qDot);
    for (std::size_t j = 0; j < wanted_.size(); ++j) {
      double& entry = result.gamma(i, static_cast<Index>(j));
      entry = columns_.place[j] >= 0 ? along[columns_.place[j]] : 0;
      // what the sensor shows of the first angle stays where it is
      const auto kind = columns_.kind[j];
      if (wanted_[j] == one_.angle) entry /= factor;
      if (kind == Meaning::Kind::bias) entry = 1 - entry / factor;
      if (kind == Meaning::Kind::gain) entry = value - entry * firstAngle / factor;
      if (kind == Meaning::Kind::clock) entry = -factor * slope;
      if (kind == Meaning::Kind::rate) entry = factor * slope * since;
      if (kind == Meaning::Kind::lag) {
        entry = factor * w.value(course_.inLag.row(0), course_.inLagSpeed.row(0));
      }
      if (kind == Meaning::Kind::drift) entry = since;
      if (kind == Meaning::Kind::timed) {
        entry = factor * ofNodes.dot(timedNodes_.col(static_cast<Index>(j)));
      }
    }
  }

  const MusculoskeletalProblem& of_;
  const OfTrial& one_;
  std::vector<std::size_t> wanted_;
  bool latentToo_;
  ParameterCatalogue::Setting setting_;
  SensorLaw sensor_;
  MatrixXd timedNodes_;
  Columns columns_;
  VectorXd outputs_, speeds_;
  SensitivityOptions options_;
  std::optional<MusculoskeletalSystem> arm_;
  ExcitationSignal excitation_;
  std::optional<stepping::SensitivityRun> run_;  ///< empty: outside the model's domain
  Lagged course_;
};

std::unique_ptr<MusculoskeletalProblem::Simulation> MusculoskeletalProblem::simulatedWith(
    const Nudge* nudge, int trial, const VectorXd& values, const VectorXd& latent,
    const std::vector<std::size_t>& wanted, bool latentToo) const {
  return std::make_unique<Run>(*this, nudge, trial, values, latent, wanted, latentToo);
}

MusculoskeletalProblem::Prediction MusculoskeletalProblem::predictWith(
    const Nudge* nudge, int trial, const VectorXd& values, const VectorXd& latent,
    const std::vector<std::size_t>& wanted, bool latentToo) const {
  return Run(*this, nudge, trial, values, latent, wanted, latentToo).predict();
}

}  // namespace bio::discover
