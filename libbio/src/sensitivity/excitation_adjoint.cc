#include "sensitivity/excitation_adjoint.h"

#include <algorithm>

namespace bio::stepping {

using Eigen::Index;

ExcitationAdjoint::ExcitationAdjoint(const MusculoskeletalSystem& system,
                                     const ExcitationSignal& driven)
    : system_(system), driven_(driven), now_(static_cast<Index>(system.numMuscles())) {
  excitation_.setZero(now_.size(), static_cast<Index>(driven.times().size()));
  numbers_.setZero(3, now_.size());
}

ExcitationAdjoint::Place ExcitationAdjoint::placeOf(double t) {
  const std::vector<double>& times = driven_.times();
  if (!(t > times.front())) return {0, 0};
  if (t >= times.back()) return {times.size() - 1, 0};
  // back in time, it is most often the row of the last call or the one before
  for (std::size_t k = std::min(near_, times.size() - 2) + 1; k-- > 0 && k + 2 > near_;) {
    if (times[k] <= t && t < times[k + 1]) {
      near_ = k;
      return {k, (t - times[k]) / (times[k + 1] - times[k])};
    }
  }
  const auto k =
      static_cast<std::size_t>(std::upper_bound(times.begin(), times.end(), t) - times.begin() - 1);
  near_ = k;
  return {k, (t - times[k]) / (times[k + 1] - times[k])};
}

void ExcitationAdjoint::evaluate(double t, const Place& place, Eigen::VectorXd& u) const {
  std::size_t hint = place.row;
  driven_.at(t, hint, u);
}

void ExcitationAdjoint::step(Piece& piece) {
  for (std::size_t i = 0; i < piece.steps.size(); ++i) {
    const auto si = static_cast<Index>(i);
    piece.steps[i] = system_.muscles()[i].activation.stepWithDerivatives(
        piece.u0[si], piece.u1[si], now_[si], piece.end - piece.begin);
    now_[si] = piece.steps[i].value;
  }
}

ExcitationAdjoint::InTimes ExcitationAdjoint::pullBack(
    double t0, double t1, const Eigen::Ref<const Eigen::VectorXd>& activation,
    Eigen::VectorXd& lambda, bool gathers) {
  // forward along the pieces between rows of the trial, as the integrator cut them
  constexpr double together = 1e-12;  // [s]
  const std::vector<double>& rows = driven_.times();
  now_ = activation;
  std::size_t count = 0;
  std::size_t next = static_cast<std::size_t>(
      std::upper_bound(rows.begin(), rows.end(), t0 + together) - rows.begin());
  for (double t = t0; t < t1; ++count) {
    if (count == pieces_.size()) {
      Piece& added = pieces_.emplace_back();
      added.u0.resize(now_.size());
      added.u1.resize(now_.size());
      added.steps.resize(system_.numMuscles());
    }
    while (next < rows.size() && rows[next] <= t + together) ++next;
    Piece& piece = pieces_[count];
    piece.begin = t;
    piece.beginsOnRow = count > 0;
    piece.endsOnRow = next < rows.size() && rows[next] < t1 - together;
    piece.end = piece.endsOnRow ? rows[next] : t1;
    if (count > 0) {
      piece.from = pieces_[count - 1].to;
      piece.u0 = pieces_[count - 1].u1;
    } else {
      piece.from = placeOf(piece.begin);
      evaluate(piece.begin, piece.from, piece.u0);
    }
    piece.to = placeOf(piece.end);
    evaluate(piece.end, piece.to, piece.u1);
    step(piece);
    t = piece.end;
  }
  // and back
  InTimes times;
  for (std::size_t index = count; index-- > 0;) {
    const Piece& piece = pieces_[index];
    const double h = piece.end - piece.begin;
    for (Index i = 0; i < lambda.size(); ++i) {
      const auto& d = piece.steps[static_cast<std::size_t>(i)].d;
      const double given = lambda[i];
      const double slope = (piece.u1[i] - piece.u0[i]) / h;
      if (!piece.beginsOnRow) times.begin += given * (d[0] * slope - d[3]);
      if (!piece.endsOnRow) times.end += given * (d[1] * slope + d[3]);
      lambda[i] = d[2] * given;
      if (!gathers) continue;
      delay_ += given * ((piece.beginsOnRow ? -d[3] : -d[0] * slope) +
                         (piece.endsOnRow ? d[3] : -d[1] * slope));
      addExcitation(i, piece.from, d[0] * given);
      addExcitation(i, piece.to, d[1] * given);
      numbers_.col(i) += given * d.tail<3>();
    }
  }
  return times;
}

void ExcitationAdjoint::finish(double time, const Eigen::VectorXd& lambda) {
  const std::vector<double>& times = driven_.times();
  const Place here = placeOf(time);
  std::size_t hint = here.row;
  Eigen::VectorXd u(lambda.size()), u0 = u, u1 = u;
  driven_.at(time, hint, u);
  // a delay moves the excitation at the start to that of earlier
  const bool moves = time > times.front() && time < times.back();
  if (moves) {
    driven_.at(times[here.row], hint, u0);
    driven_.at(times[here.row + 1], hint, u1);
  }
  for (Index i = 0; i < lambda.size(); ++i) {
    const auto si = static_cast<std::size_t>(i);
    const ActivationDynamics::Start start = system_.muscles()[si].activation.start(u[i]);
    const double given = start.byExcitation * lambda[i];
    addExcitation(i, here, given);
    if (moves) delay_ -= given * (u1[i] - u0[i]) / (times[here.row + 1] - times[here.row]);
    if (start.byExcitation == 1) continue;
    for (Index k = 0; k < 3; ++k) {
      numbers_(k, i) += lambda[i] * start.byNumber[static_cast<std::size_t>(k)];
    }
  }
}

}  // namespace bio::stepping
