#pragma once

#include <Eigen/Dense>
#include <cstdint>
#include <map>
#include <span>
#include <tuple>
#include <vector>

namespace info {

class Recording;

/// A scalar that records the operations done with it, so that a template over its scalar becomes a
/// formula that can be differentiated symbolically and evaluated many times without repeated common
/// subexpressions or multiplications by zero.
///
/// A Symbol has no value: it cannot be compared or converted, and a function that branches on its
/// arguments does not compile with it.
class Symbol {
 public:
  Symbol(double constant = 0.0) : constant_(constant) {}  // NOLINT: numbers are constants

  friend Symbol operator+(const Symbol& a, const Symbol& b);
  friend Symbol operator-(const Symbol& a, const Symbol& b);
  friend Symbol operator*(const Symbol& a, const Symbol& b);
  friend Symbol operator/(const Symbol& a, const Symbol& b);
  friend Symbol operator-(const Symbol& a);
  friend Symbol operator+(const Symbol& a) { return a; }
  Symbol& operator+=(const Symbol& b) { return *this = *this + b; }
  Symbol& operator-=(const Symbol& b) { return *this = *this - b; }
  Symbol& operator*=(const Symbol& b) { return *this = *this * b; }
  Symbol& operator/=(const Symbol& b) { return *this = *this / b; }
  friend Symbol sin(const Symbol& a);
  friend Symbol cos(const Symbol& a);
  friend Symbol tan(const Symbol& a) { return sin(a) / cos(a); }
  friend Symbol exp(const Symbol& a);
  friend Symbol log(const Symbol& a);
  friend Symbol sqrt(const Symbol& a);
  friend Symbol tanh(const Symbol& a);
  friend Symbol atan(const Symbol& a);
  friend Symbol pow(const Symbol& a, double exponent);

  /// True for a constant, such as a derivative that is identically zero.
  bool isConstant() const { return recording_ == nullptr; }
  bool isZero() const { return isConstant() && constant_ == 0.0; }

 private:
  friend class Recording;
  friend class RecordedFunction;
  friend struct SymbolRules;
  Recording* recording_ = nullptr;
  int node_ = -1;
  double constant_;
};

/// The recorded operations; equal operations are stored once.
class Recording {
 public:
  Recording() = default;
  Recording(const Recording&) = delete;  // symbols point here
  Recording& operator=(const Recording&) = delete;

  /// A new argument of the function; arguments are numbered in the order of the calls.
  Symbol argument();
  /// ∂s/∂x for an argument x, by the rules of differentiation.
  Symbol derivative(const Symbol& s, const Symbol& x);

  enum class Operation : std::uint8_t {
    constant,
    argument,
    add,
    subtract,
    multiply,
    divide,
    negate,
    sine,
    cosine,
    exponential,
    logarithm,
    squareRoot,
    hyperbolicTangent,
    arcTangent,
    power
  };
  struct Node {
    Operation operation;
    int a = -1, b = -1;  ///< operands
    double value = 0.0;  ///< constants
  };

 private:
  friend class Symbol;
  friend class RecordedFunction;
  friend struct SymbolRules;
  int nodeOf(const Symbol& s);
  Symbol write(const Node& node);
  Symbol symbolOf(int node);

  std::vector<Node> nodes_;
  int argumentCount_ = 0;
  std::map<std::tuple<Operation, int, int, double>, int> known_;
  std::map<std::pair<int, int>, Symbol> derivatives_;
};

/// A recorded function R^arguments → R^outputs, compiled to a list of operations sorted into runs
/// of one kind. Evaluation allocates nothing after a thread's first call, and is thread-safe.
class RecordedFunction {
 public:
  RecordedFunction() = default;
  /// @param targets index in `results` of each output; in order if empty
  RecordedFunction(Recording& recording, std::span<const Symbol> outputs,
                   std::vector<int> targets = {});

  int operationCount() const;

  /// @param arguments one number for each argument of the recording
  /// @param results receives output i at its target; other entries are unchanged
  void evaluate(const double* arguments, double* results) const;

 private:
  struct Run {
    Recording::Operation operation;
    int first, count;  ///< positions in operands_; results follow each other
  };
  int argumentCount_ = 0;
  std::vector<double> constants_;
  std::vector<Run> runs_;
  std::vector<std::pair<int, int>> operands_;
  std::vector<int> outputs_, targets_;
};

}  // namespace info

namespace Eigen {
template <>
struct NumTraits<info::Symbol> : GenericNumTraits<info::Symbol> {
  using Real = info::Symbol;
  using NonInteger = info::Symbol;
  using Nested = info::Symbol;
  enum {
    IsComplex = 0,
    IsInteger = 0,
    IsSigned = 1,
    RequireInitialization = 1,
    ReadCost = 1,
    AddCost = 3,
    MulCost = 3
  };
};
}  // namespace Eigen
