#include <algorithm>
#include <cmath>
#include <limits>

#include "bio/analysis/replay.h"
#include "bio/discovery/musculoskeletal_problem.h"
#include "bio/sensitivity/coupled_sensitivity.h"
#include "discovery/look_at.h"
#include "discovery/sensed_motion.h"
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
  /// The sensor that shows the start which a column is that of; −1: none.
  std::vector<int> startSensor;
};

MusculoskeletalProblem::Columns MusculoskeletalProblem::columnsOf(
    const OfTrial& trial, const VectorXd& values, const std::vector<std::size_t>& wanted) const {
  const std::size_t own = encompassing_.quantities().size();
  const VectorXd modelValues = values.head(static_cast<Index>(own)) + trial.conditions;
  Columns columns;
  for (const std::size_t quantity : wanted) {
    ParameterDirection direction;
    std::optional<Meaning::Kind> kind;
    int startSensor = -1;
    if (quantity < own) {
      kind = encompassing_.kindOf(quantity);
      direction = encompassing_.direction(modelValues, quantity);
    }
    for (const Start& start : trial.starts) {
      const int c = encompassing_.coordinates()[start.coordinate].index;
      const bool isShown = kind == Meaning::Kind::bias || kind == Meaning::Kind::gain;
      const bool shows =
          isShown && start.sensor == static_cast<int>(encompassing_.sensorOf(quantity));
      if (quantity == start.angle || shows) {
        direction = {{InitialTarget{c, false}}};
        startSensor = start.sensor;
      }
      if (quantity == start.speed) direction = {{InitialTarget{c, true}}};
    }
    columns.kind.push_back(kind);
    columns.startSensor.push_back(startSensor);
    // a drive's column is that of its external force, whatever the numbers of the model are
    const bool hasColumn = !direction.empty() || kind == Meaning::Kind::drive;
    columns.place.push_back(hasColumn ? static_cast<Index>(columns.directions.size()) : -1);
    if (hasColumn) columns.directions.push_back(std::move(direction));
  }
  return columns;
}

MatrixXd MusculoskeletalProblem::latentScale(const OfTrial& trial,
                                             const MusculoskeletalSystem& system,
                                             const Trajectory& motion) const {
  Trajectory atNodes;  // the nearest rows
  const auto rows = static_cast<Index>(motion.time.size());
  const auto numTimes = static_cast<Index>(trial.nodeTimes.size());
  atNodes.q.resize(motion.q.rows(), numTimes);
  atNodes.qDot.resize(motion.qDot.rows(), numTimes);
  atNodes.fibreLength.resize(motion.fibreLength.rows(), numTimes);
  atNodes.activation.resize(motion.activation.rows(), numTimes);
  for (Index k = 0; k < numTimes; ++k) {
    const double at = trial.nodeTimes[static_cast<std::size_t>(k)] - motion.time.front();
    const Index row = std::clamp<Index>(
        static_cast<Index>(std::lround(at / options_.simulation.step)), 0, rows - 1);
    atNodes.q.col(k) = motion.q.col(row);
    atNodes.qDot.col(k) = motion.qDot.col(row);
    atNodes.fibreLength.col(k) = motion.fibreLength.col(row);
    atNodes.activation.col(k) = motion.activation.col(row);
  }
  const auto axes = static_cast<Index>(axes_.size());
  const auto muscles = static_cast<Index>(system.numMuscles());
  MatrixXd scale = MatrixXd::Zero(axes * numTimes, muscles + axes);
  for (Index a = 0; a < axes; ++a) {
    const int c = encompassing_.coordinates()[static_cast<std::size_t>(a)].index;
    const MuscleReport report = reportMuscles(system, atNodes, c);
    scale.block(a * numTimes, 0, numTimes, muscles) =
        report.momentArm.cwiseProduct(report.tendonForce).transpose();
    scale.block(a * numTimes, muscles + a, numTimes, 1)
        .setConstant(latentFloors_[static_cast<std::size_t>(a)]);
  }
  return scale;
}

/// A trial's simulation and, once asked for, its derivatives.
class MusculoskeletalProblem::Run final : public Simulation {
 public:
  Run(const MusculoskeletalProblem& problem, const std::vector<Nudge>* nudges, int trial,
      const VectorXd& values, const VectorXd& latent, const std::vector<std::size_t>& wanted,
      bool latentToo)
      : problem_(problem),
        one_(problem.of(trial)),
        wanted_(wanted),
        latentToo_(latentToo),
        setting_(problem.settingAt(one_, values, wanted)),
        timedNodes_(problem.timedDirections(one_, values, wanted)),
        columns_(problem.columnsOf(one_, values, wanted)),
        outputs_(VectorXd::Constant(static_cast<Index>(one_.times.size()), nan)),
        speeds_(outputs_) {
    try {
      options_.simulation =
          problem.simulationOf(one_, values, problem.withTimedForces(one_, values, latent));
      if (nudges) {
        for (const Nudge& nudge : *nudges)
          apply(nudge, setting_.model, options_.simulation.externalForce);
      }
      // forces that change in time follow those at the nodes
      if (latentToo || timedNodes_.size() > 0) {
        options_.externalNodes.times = one_.nodeTimes;
        for (const MovingCoordinate& at : problem.encompassing_.coordinates())
          options_.externalNodes.coordinates.push_back(at.index);
      }
      system_.emplace(problem.encompassing_.systemOf(setting_));
      options_.externalSlopes = problem.driveSlopes(one_, values, wanted, columns_.place, *system_);
      sensors_ = problem.sensedBy(*system_, one_, values);
      for (const SensedMotion& sensor : sensors_) {
        options_.reactions = options_.reactions || sensor.needsReactions();
        options_.muscles = options_.muscles || sensor.needsMuscles();
      }
      excitation_ = problem.excitationFor(one_, *system_);
      run_.emplace(*system_, setting_, excitation_, options_);
    } catch (const std::exception&) {
      return;  // outside the model's domain
    }
    for (std::size_t i = 0; i < sensors_.size(); ++i) {
      const SensedMotion::Shown shown = sensors_[i].shown(run_->motion());
      outputs_(one_.series[i].samples) = shown.values;
      speeds_(one_.series[i].samples) = shown.rates;
    }
  }

  const VectorXd& outputs() const override { return outputs_; }

  Prediction predict() override {
    const auto K = static_cast<Index>(one_.times.size());
    const auto numNodes = static_cast<Index>(latentToo_ ? one_.nodes.size() : 0);
    const VectorXd nowhere = VectorXd::Constant(numNodes, nan);
    const auto axes = static_cast<Index>(problem_.axes_.size());
    Prediction result{outputs_,
                      MatrixXd::Constant(K, static_cast<Index>(wanted_.size()), nan),
                      MatrixXd::Constant(latentToo_ ? K : 0, numNodes, nan),
                      MatrixXd::Constant(numNodes, axes, problem_.options_.latentFloor),
                      speeds_,
                      {nowhere, nowhere},
                      MatrixXd::Constant(numNodes, numNodes, nan)};
    if (!run_) return result;
    SensitivityTrajectory s;
    try {
      s = run_->sensitivities(columns_.directions);
      if (latentToo_) result.scale = problem_.latentScale(one_, *system_, s.motion);
    } catch (const std::exception&) {
      result.outputs.setConstant(nan);
      result.speeds.setConstant(nan);
      return result;
    }
    if (latentToo_) setCourse(s, result);
    for (std::size_t i = 0; i < sensors_.size(); ++i)
      differentiate(sensors_[i], one_.series[i], s, result);
    return result;
  }

 private:
  static constexpr double nan = std::numeric_limits<double>::quiet_NaN();

  /// The coordinates themselves at the nodes; behind the last row they are as there.
  void setCourse(const SensitivityTrajectory& s, Prediction& result) const {
    const Trajectory& motion = s.motion;
    const auto numNodes = static_cast<Index>(one_.nodes.size());
    for (Index k = 0; k < numNodes; ++k) {
      const info::discover::Node& node = one_.nodes[static_cast<std::size_t>(k)];
      const auto c =
          static_cast<std::size_t>(problem_.encompassing_.coordinates()[node.axis].index);
      const auto w = lookAt(motion.time, std::min(node.time, motion.time.back()));
      if (!w) continue;
      const auto q = motion.q.row(static_cast<Index>(c)),
                 qDot = motion.qDot.row(static_cast<Index>(c));
      result.course.q[k] = w->value(q, qDot);
      result.course.qDot[k] = w->slope(q, qDot);
      result.courseByNode.row(k) = w->rows(s.q[c], s.qDot[c]).tail(numNodes);
    }
  }

  /// The derivatives of the samples of one sensor in the wanted quantities and the nodes.
  void differentiate(const SensedMotion& sensor, const Series& series,
                     const SensitivityTrajectory& s, Prediction& result) const {
    const SensedMotion::Slopes slopes = sensor.slopes(s);
    const VectorXd rates = speeds_(series.samples);
    for (std::size_t j = 0; j < wanted_.size(); ++j)
      result.gamma(series.samples, static_cast<Index>(j)) =
          columnOf(j, sensor, series.sensor, slopes, rates);
    if (latentToo_)
      result.byNode(series.samples, Eigen::all) =
          slopes.gamma.rightCols(options_.externalNodes.count());
  }

  /// In one wanted quantity.
  VectorXd columnOf(std::size_t j, const SensedMotion& sensor, std::size_t own,
                    const SensedMotion::Slopes& slopes, const VectorXd& rates) const {
    using Kind = Meaning::Kind;
    VectorXd column = VectorXd::Zero(sensor.size());
    if (columns_.place[j] >= 0) column = slopes.gamma.col(columns_.place[j]);
    // what a sensor shows of the first angle stays where it is
    const int starts = columns_.startSensor[j];
    const auto kind = columns_.kind[j];
    if (starts >= 0) {
      if (kind == Kind::gain) column *= startAngle(starts);
      column /= 1 + startLaw(starts).gain;
      if (kind == Kind::bias || kind == Kind::gain) column = -column;
    }
    if (kind == Kind::timed) {
      const auto nodes = slopes.gamma.rightCols(options_.externalNodes.count());
      for (Index i = 0; i < column.size(); ++i)
        column[i] = nodes.row(i).dot(timedNodes_.col(static_cast<Index>(j)));
    }
    if (!kind || problem_.encompassing_.sensorOf(wanted_[j]) != own) return column;
    switch (*kind) {
      case Kind::bias:
        return (1 + column.array()).matrix();
      case Kind::gain:
        return slopes.value + column;
      case Kind::clock:
        return -rates;
      case Kind::rate:
        return rates.cwiseProduct(sensor.since());
      case Kind::lag:
        return slopes.inLag;
      case Kind::drift:
        return sensor.since();
      default:
        return column;
    }
  }

  const SensorLaw& startLaw(int sensor) const {
    for (std::size_t i = 0; i < sensors_.size(); ++i)
      if (static_cast<int>(one_.series[i].sensor) == sensor) return sensors_[i].law();
    throw std::logic_error("a start that no sensor shows");
  }
  double startAngle(int sensor) const {
    for (const Start& start : one_.starts)
      if (start.sensor == sensor)
        return setting_.start.q[problem_.encompassing_.coordinates()[start.coordinate].index];
    throw std::logic_error("a start that no sensor shows");
  }

  const MusculoskeletalProblem& problem_;
  const OfTrial& one_;
  std::vector<std::size_t> wanted_;
  bool latentToo_;
  ParameterCatalogue::Setting setting_;
  MatrixXd timedNodes_;
  Columns columns_;
  VectorXd outputs_, speeds_;
  SensitivityOptions options_;
  std::optional<MusculoskeletalSystem> system_;
  ExcitationSignal excitation_;
  std::optional<stepping::SensitivityRun> run_;  ///< empty: outside the model's domain
  std::vector<SensedMotion> sensors_;            ///< of the trial's series
};

std::unique_ptr<MusculoskeletalProblem::Simulation> MusculoskeletalProblem::simulatedWith(
    const std::vector<Nudge>* nudges, int trial, const VectorXd& values, const VectorXd& latent,
    const std::vector<std::size_t>& wanted, bool latentToo) const {
  return std::make_unique<Run>(*this, nudges, trial, values, latent, wanted, latentToo);
}

MusculoskeletalProblem::Prediction MusculoskeletalProblem::predictWith(
    const std::vector<Nudge>* nudges, int trial, const VectorXd& values, const VectorXd& latent,
    const std::vector<std::size_t>& wanted, bool latentToo) const {
  return Run(*this, nudges, trial, values, latent, wanted, latentToo).predict();
}

}  // namespace bio::discover
