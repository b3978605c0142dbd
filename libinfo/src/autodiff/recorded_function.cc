#include "info/autodiff/recorded_function.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace info {

using Operation = Recording::Operation;

// --- writing operations down

struct SymbolRules {
  static Symbol unary(Operation operation, const Symbol& a) {
    Recording& recording = *a.recording_;
    return recording.write({operation, recording.nodeOf(a)});
  }
  static Symbol binary(Operation operation, const Symbol& a, const Symbol& b) {
    Recording& recording = a.recording_ ? *a.recording_ : *b.recording_;
    int left = recording.nodeOf(a), right = recording.nodeOf(b);
    const bool commutes = operation == Operation::add || operation == Operation::multiply;
    if (commutes && left > right) std::swap(left, right);
    return recording.write({operation, left, right});
  }
  static bool same(const Symbol& a, const Symbol& b) {
    return a.recording_ && a.recording_ == b.recording_ && a.node_ == b.node_;
  }
  static double number(const Symbol& a) { return a.constant_; }
};

using Rules = SymbolRules;

Symbol operator+(const Symbol& a, const Symbol& b) {
  if (a.isConstant() && b.isConstant()) return Rules::number(a) + Rules::number(b);
  if (a.isZero()) return b;
  if (b.isZero()) return a;
  return Rules::binary(Operation::add, a, b);
}

Symbol operator-(const Symbol& a, const Symbol& b) {
  if (a.isConstant() && b.isConstant()) return Rules::number(a) - Rules::number(b);
  if (a.isZero()) return -b;
  if (b.isZero()) return a;
  if (Rules::same(a, b)) return 0.0;
  return Rules::binary(Operation::subtract, a, b);
}

Symbol operator*(const Symbol& a, const Symbol& b) {
  if (a.isConstant() && b.isConstant()) return Rules::number(a) * Rules::number(b);
  if (a.isConstant()) {
    if (a.isZero()) return 0.0;
    if (Rules::number(a) == 1.0) return b;
    if (Rules::number(a) == -1.0) return -b;
  } else if (b.isConstant()) {
    return b * a;
  }
  return Rules::binary(Operation::multiply, a, b);
}

Symbol operator/(const Symbol& a, const Symbol& b) {
  if (b.isConstant()) return a * (1.0 / Rules::number(b));
  if (a.isZero()) return 0.0;
  return Rules::binary(Operation::divide, a, b);
}

Symbol operator-(const Symbol& a) {
  if (a.isConstant()) return -Rules::number(a);
  return Rules::unary(Operation::negate, a);
}

Symbol sin(const Symbol& a) {
  return a.isConstant() ? Symbol(std::sin(Rules::number(a))) : Rules::unary(Operation::sine, a);
}
Symbol cos(const Symbol& a) {
  return a.isConstant() ? Symbol(std::cos(Rules::number(a))) : Rules::unary(Operation::cosine, a);
}
Symbol exp(const Symbol& a) {
  return a.isConstant() ? Symbol(std::exp(Rules::number(a)))
                        : Rules::unary(Operation::exponential, a);
}
Symbol log(const Symbol& a) {
  return a.isConstant() ? Symbol(std::log(Rules::number(a)))
                        : Rules::unary(Operation::logarithm, a);
}
Symbol sqrt(const Symbol& a) {
  return a.isConstant() ? Symbol(std::sqrt(Rules::number(a)))
                        : Rules::unary(Operation::squareRoot, a);
}
Symbol tanh(const Symbol& a) {
  return a.isConstant() ? Symbol(std::tanh(Rules::number(a)))
                        : Rules::unary(Operation::hyperbolicTangent, a);
}
Symbol atan(const Symbol& a) {
  return a.isConstant() ? Symbol(std::atan(Rules::number(a)))
                        : Rules::unary(Operation::arcTangent, a);
}
Symbol pow(const Symbol& a, double exponent) {
  if (a.isConstant()) return std::pow(Rules::number(a), exponent);
  if (exponent == 0.0) return 1.0;
  if (exponent == 1.0) return a;
  if (exponent == 2.0) return a * a;
  return Rules::binary(Operation::power, a, exponent);
}

Symbol Recording::argument() {
  return write({Operation::argument, argumentCount_++});
}

Symbol Recording::write(const Node& node) {
  const auto [place, isNew] =
      known_.try_emplace({node.operation, node.a, node.b, node.value}, int(nodes_.size()));
  if (isNew) nodes_.push_back(node);
  return symbolOf(place->second);
}

int Recording::nodeOf(const Symbol& s) {
  if (!s.isConstant()) return s.node_;
  return write({Operation::constant, -1, -1, s.constant_}).node_;
}

Symbol Recording::symbolOf(int node) {
  Symbol s;
  s.recording_ = this;
  s.node_ = node;
  return s;
}

// --- the rules of differentiation

Symbol Recording::derivative(const Symbol& s, const Symbol& x) {
  if (s.isConstant()) return 0.0;
  const auto found = derivatives_.find({s.node_, x.node_});
  if (found != derivatives_.end()) return found->second;
  const Node node = nodes_[std::size_t(s.node_)];
  const auto operand = [&](int i) -> Symbol {
    const Node& n = nodes_[std::size_t(i)];
    return n.operation == Operation::constant ? Symbol(n.value) : symbolOf(i);
  };
  Symbol result = 0.0;
  if (node.operation == Operation::argument) {
    result = s.node_ == x.node_ ? 1.0 : 0.0;
  } else if (node.operation != Operation::constant) {
    const Symbol a = operand(node.a), da = derivative(a, x);
    const Symbol b = node.b >= 0 ? operand(node.b) : Symbol();
    const Symbol db = node.b >= 0 ? derivative(b, x) : Symbol();
    switch (node.operation) {
      case Operation::add:
        result = da + db;
        break;
      case Operation::subtract:
        result = da - db;
        break;
      case Operation::multiply:
        result = da * b + a * db;
        break;
      case Operation::divide:
        result = da / b - s * (db / b);
        break;
      case Operation::negate:
        result = -da;
        break;
      case Operation::sine:
        result = da.isZero() ? da : cos(a) * da;
        break;
      case Operation::cosine:
        result = da.isZero() ? da : -(sin(a) * da);
        break;
      case Operation::exponential:
        result = s * da;
        break;
      case Operation::logarithm:
        result = da / a;
        break;
      case Operation::squareRoot:
        result = 0.5 * (da / s);
        break;
      case Operation::hyperbolicTangent:
        result = (1.0 - s * s) * da;
        break;
      case Operation::arcTangent:
        result = da / (1.0 + a * a);
        break;
      case Operation::power:
        result = da.isZero() ? da : (b * pow(a, b.constant_ - 1.0)) * da;
        break;
      case Operation::constant:
      case Operation::argument:
        break;
    }
  }
  return derivatives_[{s.node_, x.node_}] = result;
}

// --- sorting the operations into runs

RecordedFunction::RecordedFunction(Recording& recording, std::span<const Symbol> outputs,
                                   std::vector<int> targets)
    : argumentCount_(recording.argumentCount_), targets_(std::move(targets)) {
  if (targets_.empty())
    for (std::size_t i = 0; i < outputs.size(); ++i) targets_.push_back(int(i));
  if (targets_.size() != outputs.size())
    throw std::invalid_argument("targets: number is " + std::to_string(targets_.size()) +
                                ", must be one per output, " + std::to_string(outputs.size()));
  std::vector<int> results;
  for (const Symbol& s : outputs) results.push_back(recording.nodeOf(s));
  const auto& nodes = recording.nodes_;

  // Mark what the outputs need; the depth of an operation is one more than that of its operands.
  std::vector<char> needed(nodes.size(), 0);
  for (int r : results) needed[std::size_t(r)] = 1;
  std::vector<int> depth(nodes.size(), 0);
  const auto isLeaf = [&](std::size_t i) {
    return nodes[i].operation == Operation::constant || nodes[i].operation == Operation::argument;
  };
  for (std::size_t i = nodes.size(); i-- > 0;) {
    if (!needed[i] || isLeaf(i)) continue;
    needed[std::size_t(nodes[i].a)] = 1;
    if (nodes[i].b >= 0) needed[std::size_t(nodes[i].b)] = 1;
  }
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (!needed[i] || isLeaf(i)) continue;
    depth[i] = 1 + depth[std::size_t(nodes[i].a)];
    if (nodes[i].b >= 0) depth[i] = std::max(depth[i], 1 + depth[std::size_t(nodes[i].b)]);
    order.push_back(i);
  }
  std::stable_sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) {
    return std::pair{depth[i], nodes[i].operation} < std::pair{depth[j], nodes[j].operation};
  });

  // Places in the work array: arguments, constants, operations.
  std::vector<int> place(nodes.size(), -1);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (nodes[i].operation == Operation::argument) place[i] = nodes[i].a;
    if (nodes[i].operation == Operation::constant && needed[i]) {
      place[i] = argumentCount_ + int(constants_.size());
      constants_.push_back(nodes[i].value);
    }
  }
  int next = argumentCount_ + int(constants_.size());
  for (std::size_t i : order) {
    place[i] = next++;
    if (runs_.empty() || runs_.back().operation != nodes[i].operation ||
        depth[i] != depth[order[operands_.size() - 1]])
      runs_.push_back({nodes[i].operation, int(operands_.size()), 0});
    ++runs_.back().count;
    operands_.emplace_back(place[std::size_t(nodes[i].a)],
                           nodes[i].b >= 0 ? place[std::size_t(nodes[i].b)] : 0);
  }
  for (int r : results) outputs_.push_back(place[std::size_t(r)]);
}

int RecordedFunction::operationCount() const {
  return int(operands_.size());
}

void RecordedFunction::evaluate(const double* arguments, double* results) const {
  thread_local std::vector<double> scratch;
  const std::size_t size = std::size_t(argumentCount_) + constants_.size() + operands_.size();
  if (scratch.size() < size) scratch.resize(size);
  double* const w = scratch.data();
  std::copy_n(arguments, argumentCount_, w);
  std::copy(constants_.begin(), constants_.end(), w + argumentCount_);
  double* out = w + argumentCount_ + constants_.size();
  const std::pair<int, int>* operand = operands_.data();
  const auto each = [&](int count, auto operation) {
    for (int i = 0; i < count; ++i, ++operand)
      *out++ = operation(w[operand->first], w[operand->second]);
  };
  for (const Run& run : runs_) {
    switch (run.operation) {
      case Operation::add:
        each(run.count, [](double a, double b) { return a + b; });
        break;
      case Operation::subtract:
        each(run.count, [](double a, double b) { return a - b; });
        break;
      case Operation::multiply:
        each(run.count, [](double a, double b) { return a * b; });
        break;
      case Operation::divide:
        each(run.count, [](double a, double b) { return a / b; });
        break;
      case Operation::negate:
        each(run.count, [](double a, double) { return -a; });
        break;
      case Operation::sine:
        each(run.count, [](double a, double) { return std::sin(a); });
        break;
      case Operation::cosine:
        each(run.count, [](double a, double) { return std::cos(a); });
        break;
      case Operation::exponential:
        each(run.count, [](double a, double) { return std::exp(a); });
        break;
      case Operation::logarithm:
        each(run.count, [](double a, double) { return std::log(a); });
        break;
      case Operation::squareRoot:
        each(run.count, [](double a, double) { return std::sqrt(a); });
        break;
      case Operation::hyperbolicTangent:
        each(run.count, [](double a, double) { return std::tanh(a); });
        break;
      case Operation::arcTangent:
        each(run.count, [](double a, double) { return std::atan(a); });
        break;
      case Operation::power:
        each(run.count, [](double a, double b) { return std::pow(a, b); });
        break;
      case Operation::constant:
      case Operation::argument:
        break;
    }
  }
  for (std::size_t i = 0; i < outputs_.size(); ++i) results[targets_[i]] = w[outputs_[i]];
}

}  // namespace info
