#include "discovery/nonparametric/symbolic.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "discovery/judgement/node_states.h"
#include "discovery/likelihood/latent_block.h"
#include "info/probability/random_stream.h"

namespace info::discover {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

constexpr int kRepeats = 100;   // bootstraps
constexpr double kBlock = 0.5;  // [s] length of a bootstrap block
constexpr Index kMostTerms = 3;

// The possible terms of a formula on one axis, as columns of force at the nodes of all axes.
struct Library {
  std::vector<std::string> names, expressions;
  std::vector<MatrixXd> columns;  // per trial: nodes × terms
};

struct StateTerm {
  std::string name, expression;
  std::function<double(double q, double w)> at;
};
std::vector<StateTerm> stateTermsOf(const Axis& axis) {
  const double s = axis.smallSpeed;
  std::vector<StateTerm> terms = {
      {"1", "1", [](double, double) { return 1.0; }},
      {"q", "q", [](double q, double) { return q; }},
      {"q²", "q^2", [](double q, double) { return q * q; }},
      {"q³", "q^3", [](double q, double) { return q * q * q; }},
      {"q̇", "qdot", [](double, double w) { return w; }},
      {"q̇|q̇|", "qdot*abs(qdot)", [](double, double w) { return w * std::abs(w); }},
      {"q̇³", "qdot^3", [](double, double w) { return w * w * w; }},
      {fmt::format("tanh(q̇/{})", s), fmt::format("tanh(qdot/{})", s),
       [s](double, double w) { return std::tanh(w / s); }},
      {"q·q̇", "q*qdot", [](double q, double w) { return q * w; }},
  };
  if (axis.isInRadians()) {
    terms.push_back({"sin q", "sin(q)", [](double q, double) { return std::sin(q); }});
    terms.push_back({"cos q", "cos(q)", [](double q, double) { return std::cos(q); }});
  }
  return terms;
}

// Integrals over time, e.g. of an actuator's moment.
MatrixXd integrals(const MatrixXd& values, const std::vector<double>& times) {
  MatrixXd sums = MatrixXd::Zero(values.rows(), values.cols());
  for (Index i = 1; i < values.rows(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    sums.row(i) =
        sums.row(i - 1) + (times[k] - times[k - 1]) / 2 * (values.row(i) + values.row(i - 1));
  }
  return sums;
}

Library libraryOf(const Likelihood& likelihood, const Fit& fit, const NodeStates& states,
                  std::size_t axis) {
  const DiscoveryProblem& data = likelihood.data();
  Library library;
  const std::vector<StateTerm> ofState = stateTermsOf(data.axes()[axis]);
  for (const StateTerm& term : ofState) {
    library.names.push_back(term.name);
    library.expressions.push_back(term.expression);
  }
  const std::vector<std::string> inputs = data.inputNames();
  const auto numInputs = static_cast<Index>(inputs.size());
  bool haveMoments = true;
  const std::vector<VectorXd> q = states.positions(axis), qDot = states.speeds(axis);
  for (std::size_t t = 0; t < q.size(); ++t) {
    const int trial = likelihood.trials()[t];
    const std::vector<double> nodes = nodeTimes(data, trial);
    const auto n = static_cast<Index>(nodes.size());
    // channels of the latent force: the moment of each input's actuator, and one of constant scale
    // for each axis
    const MatrixXd scale =
        onAxis(data.predict(trial, fit.values, {}, {}, true).scale, axis, states.numAxes);
    haveMoments = haveMoments && scale.cols() == numInputs + static_cast<Index>(states.numAxes);
    const auto own = static_cast<Index>(ofState.size());
    MatrixXd columns(n, own + numInputs * (haveMoments ? 3 : 1));
    for (Index j = 0; j < own; ++j)
      for (Index i = 0; i < n; ++i)
        columns(i, j) = ofState[static_cast<std::size_t>(j)].at(q[t][i], qDot[t][i]);
    columns.middleCols(own, numInputs) = onAxis(states.inputs[t], axis, states.numAxes);
    if (haveMoments) {
      columns.middleCols(own + numInputs, numInputs) = scale.leftCols(numInputs);
      columns.rightCols(numInputs) = integrals(scale.leftCols(numInputs), nodes);
    }
    library.columns.push_back(states.placed(t, axis, columns));
  }
  for (const std::string& input : inputs) library.names.push_back("u_" + input);
  if (haveMoments) {
    for (const std::string& input : inputs) library.names.push_back("M_" + input);
    for (const std::string& input : inputs) library.names.push_back("∫M_" + input);
  }
  library.expressions.resize(library.names.size());  // none: no formula in the state
  return library;
}

// The terms' forces and the innovations after elimination of everything that is free in the fit:
// normal equations of each block of time, the last one being that of the priors.
struct Remains {
  std::vector<MatrixXd> normal;
  std::vector<VectorXd> right;
  std::vector<double> samples;
};

Remains remainsOf(const Likelihood& likelihood, const Fit& fit, const NodeStates& states,
                  const Library& library) {
  std::vector<Index> inside;
  for (Index i = 0; i < fit.xi.size(); ++i)
    if (!fit.atBound[static_cast<std::size_t>(i)]) inside.push_back(i);
  const auto p = static_cast<Index>(inside.size());
  const auto m = static_cast<Index>(library.names.size());
  // whitened rows (Γ, forces, innovations) of all trials, then those of the priors
  MatrixXd rows(likelihood.samples() + p, p + m + 1);
  std::vector<int> blockOf;
  int blocks = 0;
  for (std::size_t t = 0; t < states.linear.size(); ++t) {
    const auto& l = states.linear[t];
    const Index n = l.residuals.size();
    MatrixXd Q(n, p + m + 1);
    Q << l.gamma(Eigen::all, inside), l.force * library.columns[t], l.residuals;
    if (l.latent.cols() > 0) Q.col(p + m) += l.latent * fit.eta[t];
    rows.middleRows(static_cast<Index>(blockOf.size()), n) =
        outputCovariance(l.latent, n).llt().matrixL().solve(Q);
    const auto& times = likelihood.data().times(likelihood.trials()[t]);
    for (const double time : times)
      blockOf.push_back(blocks + static_cast<int>((time - times.front()) / kBlock));
    blocks = blockOf.back() + 1;
  }
  rows.bottomRows(p).setZero();
  rows.bottomLeftCorner(p, p).setIdentity();
  rows.bottomRightCorner(p, 1) = -fit.xi(inside);
  blockOf.insert(blockOf.end(), static_cast<std::size_t>(p), blocks);
  if (p > 0) {
    const Eigen::HouseholderQR<MatrixXd> qr(rows.leftCols(p));
    const MatrixXd basis = qr.householderQ() * MatrixXd::Identity(rows.rows(), p);
    const MatrixXd inner = basis.transpose() * rows.rightCols(m + 1);
    rows.rightCols(m + 1) -= basis * inner;
  }
  Remains remains{std::vector<MatrixXd>(static_cast<std::size_t>(blocks) + 1, MatrixXd::Zero(m, m)),
                  std::vector<VectorXd>(static_cast<std::size_t>(blocks) + 1, VectorXd::Zero(m)),
                  std::vector<double>(static_cast<std::size_t>(blocks) + 1, 0)};
  for (Index i = 0; i < rows.rows(); ++i) {
    const auto b = static_cast<std::size_t>(blockOf[static_cast<std::size_t>(i)]);
    const VectorXd column = rows.row(i).segment(p, m).transpose();
    remains.normal[b].selfadjointView<Eigen::Lower>().rankUpdate(column);
    remains.right[b] += column * rows(i, p + m);
    remains.samples[b] += b < static_cast<std::size_t>(blocks);
  }
  for (MatrixXd& normal : remains.normal)
    normal.triangularView<Eigen::StrictlyUpper>() = normal.transpose();
  return remains;
}

struct Subset {
  std::vector<Index> terms;
  VectorXd coefficients, sds;
  double evidence = 0;  // nats
};

// The best subset by ½ gᵀS⁻¹g − ½ k log n (Schwarz).
Subset bestSubset(const MatrixXd& normal, const VectorXd& right, double samples) {
  Subset best;
  const double price = 0.5 * std::log(samples);
  const auto consider = [&](const std::vector<Index>& terms) {
    const auto k = static_cast<Index>(terms.size());
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMostTerms, kMostTerms> A(k, k);
    Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMostTerms, 1> b(k);
    for (Index i = 0; i < k; ++i) {
      b[i] = right[terms[static_cast<std::size_t>(i)]];
      for (Index j = 0; j < k; ++j)
        A(i, j) = normal(terms[static_cast<std::size_t>(i)], terms[static_cast<std::size_t>(j)]);
      if (!(A(i, i) > 0)) return;
    }
    // collinear terms are not both used
    const auto scale = A.diagonal().cwiseSqrt().cwiseInverse().eval();
    const auto unit = (scale.asDiagonal() * A * scale.asDiagonal()).eval();
    const Eigen::LDLT<std::decay_t<decltype(A)>> factor(unit);
    if (!(factor.vectorD().minCoeff() > 1e-8)) return;
    const auto x = (scale.asDiagonal() * factor.solve(scale.asDiagonal() * b)).eval();
    const double evidence = 0.5 * b.dot(x) - static_cast<double>(k) * price;
    if (evidence <= best.evidence) return;
    const auto inverse = factor.solve(MatrixXd::Identity(k, k)).eval();
    best = {terms, x, (scale.array() * inverse.diagonal().array().cwiseMax(0).sqrt()).matrix(),
            evidence};
  };
  const Index n = normal.rows();
  for (Index i = 0; i < n; ++i) {
    consider({i});
    for (Index j = i + 1; j < n; ++j) {
      consider({i, j});
      for (Index k = j + 1; k < n; ++k) consider({i, j, k});
    }
  }
  return best;
}

// Fraction of the latent force's power on an axis that the formula explains, each node weighted by
// its certainty.
double shareExplained(const Likelihood& likelihood, const Fit& fit, const NodeStates& states,
                      std::size_t axis, const Library& library, const Subset& best) {
  double power = 0, left = 0;
  for (std::size_t t = 0; t < library.columns.size(); ++t) {
    const auto own = [&](const VectorXd& all) {
      return VectorXd(all.segment(states.begin(t, axis), states.count(t)));
    };
    const VectorXd sd = own(likelihood.forceSd(t, fit).cwiseMax(1e-9));
    const VectorXd force = own(likelihood.force(t, fit));
    const VectorXd formula = own(library.columns[t](Eigen::all, best.terms) * best.coefficients);
    power += force.cwiseQuotient(sd).squaredNorm();
    left += (force - formula).cwiseQuotient(sd).squaredNorm();
  }
  return power > 0 ? std::max(0.0, 1 - left / power) : 0;
}

}  // namespace

std::string SymbolicTerm::times(double coefficient, const std::string& name) {
  return name == "1" ? fmt::format("{:.3g}", coefficient)
                     : fmt::format("{:.3g}·{}", coefficient, name);
}

VectorXd linearCoefficients(const Likelihood& likelihood, const Fit& fit, const NodeStates& states,
                            std::size_t axis, const std::vector<StateForce>& forces, double sd) {
  const auto n = static_cast<Index>(forces.size());
  Library library;
  library.names.resize(forces.size());
  const std::vector<VectorXd> q = states.positions(axis), qDot = states.speeds(axis);
  for (std::size_t t = 0; t < q.size(); ++t) {
    MatrixXd columns(q[t].size(), n);
    for (Index j = 0; j < n; ++j)
      for (Index i = 0; i < columns.rows(); ++i)
        columns(i, j) = forces[static_cast<std::size_t>(j)].at(q[t][i], qDot[t][i]);
    library.columns.push_back(states.placed(t, axis, columns));
  }
  MatrixXd normal = MatrixXd::Identity(n, n) / (sd * sd);
  VectorXd right = VectorXd::Zero(n);
  const Remains remains = remainsOf(likelihood, fit, states, library);
  for (const MatrixXd& block : remains.normal) normal += block;
  for (const VectorXd& block : remains.right) right += block;
  return normal.ldlt().solve(right);
}

void findFormula(const Likelihood& likelihood, const Fit& fit, Unknown& unknown) {
  const NodeStates states = statesAtNodes(likelihood, fit);
  const Library library = libraryOf(likelihood, fit, states, unknown.axis);
  const auto n = static_cast<Index>(library.names.size());
  const Remains remains = remainsOf(likelihood, fit, states, library);
  const std::size_t blocks = remains.normal.size() - 1;
  if (static_cast<Index>(blocks) < kMostTerms) return;
  const auto select = [&](const auto& pick) {
    MatrixXd normal = remains.normal.back();
    VectorXd right = remains.right.back();
    double samples = 0;
    for (std::size_t i = 0; i < blocks; ++i) {
      const std::size_t from = pick(i);
      normal += remains.normal[from];
      right += remains.right[from];
      samples += remains.samples[from];
    }
    return bestSubset(normal, right, samples);
  };
  const Subset best = select([](std::size_t i) { return i; });
  RandomStream random(1, 1);
  std::vector<int> chosen(static_cast<std::size_t>(n), 0);
  for (int repeat = 0; repeat < kRepeats; ++repeat) {
    const Subset again = select([&](std::size_t) {
      return std::min(blocks - 1,
                      static_cast<std::size_t>(random.uniform() * static_cast<double>(blocks)));
    });
    for (const Index term : again.terms) ++chosen[static_cast<std::size_t>(term)];
  }
  unknown.evidence = best.evidence;
  unknown.stable = !best.terms.empty();
  if (best.terms.empty()) return;
  unknown.explained = shareExplained(likelihood, fit, states, unknown.axis, library, best);
  for (std::size_t i = 0; i < best.terms.size(); ++i) {
    const auto term = static_cast<std::size_t>(best.terms[i]);
    const auto at = static_cast<Index>(i);
    const double stability = static_cast<double>(chosen[term]) / kRepeats;
    unknown.terms.push_back({library.names[term], library.expressions[term], best.coefficients[at],
                             best.sds[at], stability});
    unknown.stable = unknown.stable && stability >= 0.9;
  }
  const auto certainty = [](const SymbolicTerm& term) {
    return std::abs(term.coefficient) / term.sd;
  };
  std::stable_sort(unknown.terms.begin(), unknown.terms.end(),
                   [&](const auto& a, const auto& b) { return certainty(a) > certainty(b); });
  for (const SymbolicTerm& term : unknown.terms) {
    if (!unknown.formula.empty()) unknown.formula += " + ";
    unknown.formula += SymbolicTerm::times(term.coefficient, term.name);
  }
}

}  // namespace info::discover
