#include "sensitivity/excitation_sensitivity.h"

#include <algorithm>

#include "info/dynamics/linear_table.h"

namespace bio::stepping {

using Eigen::Index;

std::vector<std::vector<RowsOfColumn>> excitationRows(const MusculoskeletalSystem& system,
                                                      const ParameterEffects& effects,
                                                      const ExcitationSignal& trial,
                                                      const EmgMapping& mapping) {
  std::vector<std::vector<RowsOfColumn>> all(system.numMuscles());
  if (effects.emg.empty()) return all;
  const std::vector<std::string> muscles = muscleNames(system);
  const EmgDerivatives d = emgDerivatives(trial, muscles, mapping);
  for (const auto& effect : effects.emg) {
    const auto index = [&](const std::string& name) {
      return static_cast<Index>(std::find(muscles.begin(), muscles.end(), name) - muscles.begin());
    };
    const EmgTarget& target = effect.target;
    const auto enter = [&](Index muscle, const Eigen::RowVectorXd& rows) {
      all[static_cast<std::size_t>(muscle)].push_back({effect.column, effect.weight * rows});
    };
    const auto enterAll = [&](const Eigen::MatrixXd& rows) {
      for (Index i = 0; i < rows.rows(); ++i) enter(i, rows.row(i));
    };
    if (target.what == EmgTarget::What::nonlinearity) {
      for (Index i = 0; i < d.nonlinearity.rows(); ++i) enter(i, d.tired(i, d.nonlinearity.row(i)));
      continue;
    }
    if (target.what == EmgTarget::What::fatigue) enterAll(d.fatigue);
    if (target.what == EmgTarget::What::fatigueTime) enterAll(d.fatigueTime);
    const Index i = index(target.muscle);
    if (i == d.gain.rows()) continue;
    if (target.what == EmgTarget::What::latent) {
      const LatentExcitation& latent = mapping.latent.at(target.muscle);
      const Eigen::RowVectorXd dx = latentSlope(d.times, d.rows.row(i), latent, target.knot);
      enter(i, d.tired(i, d.signal.row(i).cwiseProduct(dx)));
      for (const EmgMapping::Crosstalk& c : mapping.crosstalk) {
        if (c.from != target.muscle) continue;
        const Index to = index(c.to);
        enter(to, d.tired(to, -c.share * d.signal.row(to).cwiseProduct(dx)));
      }
    }
    if (target.what == EmgTarget::What::gain) enter(i, d.tired(i, d.gain.row(i)));
    if (target.what == EmgTarget::What::offset) enter(i, d.tired(i, -d.signal.row(i)));
    if (target.what == EmgTarget::What::saturation) {
      enter(i, d.tired(i, d.signal.row(i).cwiseProduct(flatTops(d.times, d.rows.row(i)))));
    }
    if (target.what == EmgTarget::What::crosstalk) {
      enter(i, d.tired(i, -d.signal.row(i).cwiseProduct(d.rows.row(index(target.from)))));
    }
  }
  return all;
}

ExcitationSensitivity::ExcitationSensitivity(const MusculoskeletalSystem& system,
                                             const ParameterEffects& effects,
                                             const ExcitationSignal& trial,
                                             const ExcitationSignal& driven,
                                             const EmgMapping& mapping)
    : system_(system),
      effects_(effects),
      driven_(driven),
      emg_(excitationRows(system, effects, trial, mapping)),
      from_(static_cast<Index>(system.numMuscles())),
      to_(from_),
      now_(from_) {
  findColumns();
}

void ExcitationSensitivity::findColumns() {
  for (const auto& muscle : effects_.muscles) {
    for (const QuantityEffect& effect : muscle.activation) columns_.push_back(effect.column);
  }
  for (const QuantityEffect& effect : effects_.delay) columns_.push_back(effect.column);
  for (const auto& effect : effects_.emg) columns_.push_back(effect.column);
  std::sort(columns_.begin(), columns_.end());
  columns_.erase(std::unique(columns_.begin(), columns_.end()), columns_.end());
}

Index ExcitationSensitivity::placeOf(Index column) const {
  if (isSpread_) return column;
  return std::lower_bound(columns_.begin(), columns_.end(), column) - columns_.begin();
}

void ExcitationSensitivity::start(double time, SensitivityMatrix& rows) {
  rows.setZero();
  nextRow_ = 0;
  const info::LinearWeights here = info::linearAt(driven_.times(), time);
  for (std::size_t i = 0; i < emg_.size(); ++i) {
    for (const RowsOfColumn& column : emg_[i]) {
      rows(static_cast<Index>(i), placeOf(column.column)) += here.value(column.rows);
    }
  }
  // later by d: the excitation at the start is that of d earlier; none is known before the first
  // row
  const std::vector<double>& times = driven_.times();
  if (!effects_.delay.empty() && time > times.front() && time < times.back()) {
    std::size_t k = 0;
    while (times[k + 1] <= time) ++k;
    driven_.at(times[k], hint_, from_);
    driven_.at(times[k + 1], hint_, to_);
    for (const QuantityEffect& effect : effects_.delay) {
      rows.col(placeOf(effect.column)) -= effect.factor * (to_ - from_) / (times[k + 1] - times[k]);
    }
  }
  // activation begins as the excitation within the law's limits
  driven_.at(time, hint_, from_);
  for (Index i = 0; i < rows.rows(); ++i) {
    const auto si = static_cast<std::size_t>(i);
    const ActivationDynamics::Start start = system_.muscles()[si].activation.start(from_[i]);
    if (start.byExcitation == 1) continue;
    rows.row(i) *= start.byExcitation;
    for (const QuantityEffect& effect : effects_.muscles[si].activation) {
      rows(i, placeOf(effect.column)) += effect.factor * start.byNumber[effect.quantity];
    }
  }
}

void ExcitationSensitivity::advance(double t0, double t1, const Eigen::RowVectorXd* dt0,
                                    const Eigen::RowVectorXd* dt1,
                                    const Eigen::Ref<const Eigen::VectorXd>& activation,
                                    const SensitivityMatrix& in, SensitivityMatrix& out) {
  const std::vector<double>& rows = driven_.times();
  if (nextRow_ > 0 && nextRow_ <= rows.size() && rows[nextRow_ - 1] > t0) nextRow_ = 0;
  double t = t0;
  bool first = true, beginsOnRow = false;
  now_ = activation;
  driven_.at(t0, hint_, from_);
  while (t < t1) {
    // the integrator's pieces, without those that rounding makes where a row and a step meet
    constexpr double together = 1e-12;  // [s]
    while (nextRow_ < rows.size() && rows[nextRow_] <= t + together) ++nextRow_;
    const bool endsOnRow = nextRow_ < rows.size() && rows[nextRow_] < t1 - together;
    const double stop = endsOnRow ? rows[nextRow_] : t1;
    const double h = stop - t;
    driven_.at(stop, hint_, to_);
    const info::LinearWeights atBegin = info::linearAt(rows, t), atEnd = info::linearAt(rows, stop);
    for (Index i = 0; i < out.rows(); ++i) {
      const auto si = static_cast<std::size_t>(i);
      const auto& effects = effects_.muscles[si];
      const ActivationStep p =
          system_.muscles()[si].activation.stepWithDerivatives(from_[i], to_[i], now_[i], h);
      now_[i] = p.value;
      auto row = out.row(i);
      if (first) {
        row = p.d[2] * in.row(i);
      } else {
        row *= p.d[2];
      }
      // a time that moves takes the excitation along its piece, and the piece's length with it
      const double slope = (to_[i] - from_[i]) / h;
      if (!beginsOnRow && dt0) row += (p.d[0] * slope - p.d[3]) * *dt0;
      if (!endsOnRow && dt1) row += (p.d[1] * slope + p.d[3]) * *dt1;
      // a delay moves the rows of the trial; at a held time the excitation is of earlier
      for (const QuantityEffect& effect : effects_.delay) {
        row[placeOf(effect.column)] += effect.factor * ((beginsOnRow ? -p.d[3] : -p.d[0] * slope) +
                                                        (endsOnRow ? p.d[3] : -p.d[1] * slope));
      }
      for (const RowsOfColumn& column : emg_[si]) {
        row[placeOf(column.column)] +=
            p.d[0] * atBegin.value(column.rows) + p.d[1] * atEnd.value(column.rows);
      }
      for (const QuantityEffect& effect : effects.activation) {
        row[placeOf(effect.column)] += effect.factor * p.d[4 + static_cast<Index>(effect.quantity)];
      }
    }
    from_.swap(to_);
    t = stop;
    first = false;
    beginsOnRow = endsOnRow;
  }
}

}  // namespace bio::stepping
