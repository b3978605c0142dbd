#pragma once

#include <Eigen/Dense>
#include <cmath>
#include <concepts>
#include <type_traits>

namespace info {

template <class T, int N>
using Vector = Eigen::Matrix<T, N, 1>;
template <class T, int R, int C>
using Matrix = Eigen::Matrix<T, R, C, (R == 1 && C != 1) ? Eigen::RowMajor : Eigen::ColMajor>;

/// A number a + Σ b_i ε_i with ε_i ε_j = 0: propagates C directional derivatives b through a
/// function,
///     f(a + Σ b_i ε_i) = f(a) + f′(a) Σ b_i ε_i
/// Dual<C, Dual<D>> carries second derivatives. C is fixed, so that nothing is allocated.
///
/// Every operation is evaluated at once. There are no expression templates, so that it compiles
/// faster than Eigen's scalar, and `auto` and nested literals (0.5 * x) are safe. The value is bit
/// for bit that of the same arithmetic in T. Comparisons use only the value. At a kink (|a| at 0)
/// the derivative is one of the two one-sided derivatives; that of √0 is infinite.
template <int C, class T = double>
class Dual {
 public:
  using Scalar = T;
  using DerType = Vector<T, C>;  ///< of the derivatives

  /// Not initialised, like a double.
  Dual() = default;
  /// A constant.
  Dual(double value) : value_(value) { fill(T(0.0)); }
  Dual(const T& value) requires(!std::same_as<T, double>) : value_(value) { fill(T(0.0)); }
  Dual(const T& value, const DerType& derivatives) : value_(value), derivatives_(derivatives) {}
  /// An independent variable: direction `index` of C.
  Dual(const T& value, int /*count*/, int direction) : Dual(value) {
    derivatives_[direction] = T(1.0);
  }

  const T& value() const { return value_; }
  T& value() { return value_; }
  const DerType& derivatives() const { return derivatives_; }
  DerType& derivatives() { return derivatives_; }

  friend Dual operator+(const Dual& x) { return x; }
  friend Dual operator-(const Dual& x) {
    Dual y;
    y.value_ = -x.value_;
    for (int i = 0; i < C; ++i) y.at(i) = -x.at(i);
    return y;
  }
  friend Dual operator+(const Dual& x, const Dual& y) { return Dual(x) += y; }
  friend Dual operator+(const Dual& x, double y) { return Dual(x) += y; }
  friend Dual operator+(double x, const Dual& y) { return Dual(y) += x; }
  friend Dual operator-(const Dual& x, const Dual& y) { return Dual(x) -= y; }
  friend Dual operator-(const Dual& x, double y) { return Dual(x) -= y; }
  friend Dual operator-(double x, const Dual& y) { return -y += x; }
  friend Dual operator*(const Dual& x, const Dual& y) {
    Dual z;
    z.value_ = x.value_ * y.value_;
    for (int i = 0; i < C; ++i) z.at(i) = x.at(i) * y.value_ + x.value_ * y.at(i);
    return z;
  }
  friend Dual operator*(const Dual& x, double y) { return Dual(x) *= y; }
  friend Dual operator*(double x, const Dual& y) { return Dual(y) *= x; }
  friend Dual operator/(const Dual& x, const Dual& y) {
    Dual z;
    const T inverse = 1.0 / y.value_;
    z.value_ = x.value_ / y.value_;
    for (int i = 0; i < C; ++i) z.at(i) = (x.at(i) - z.value_ * y.at(i)) * inverse;
    return z;
  }
  friend Dual operator/(const Dual& x, double y) { return Dual(x) /= y; }
  friend Dual operator/(double x, const Dual& y) {
    const T quotient = x / y.value_;
    return y.through(quotient, -quotient / y.value_);
  }

  Dual& operator+=(const Dual& y) {
    value_ += y.value_;
    for (int i = 0; i < C; ++i) at(i) += y.at(i);
    return *this;
  }
  Dual& operator-=(const Dual& y) {
    value_ -= y.value_;
    for (int i = 0; i < C; ++i) at(i) -= y.at(i);
    return *this;
  }
  Dual& operator*=(const Dual& y) { return *this = *this * y; }
  Dual& operator/=(const Dual& y) { return *this = *this / y; }
  Dual& operator+=(double y) {
    value_ += y;
    return *this;
  }
  Dual& operator-=(double y) {
    value_ -= y;
    return *this;
  }
  Dual& operator*=(double y) {
    value_ *= y;
    for (int i = 0; i < C; ++i) at(i) *= y;
    return *this;
  }
  Dual& operator/=(double y) {
    value_ /= y;
    for (int i = 0; i < C; ++i) at(i) /= y;
    return *this;
  }

  friend bool operator==(const Dual& x, const Dual& y) { return x.value_ == y.value_; }
  friend bool operator==(const Dual& x, double y) { return x.value_ == y; }
  friend auto operator<=>(const Dual& x, const Dual& y) { return x.value_ <=> y.value_; }
  friend auto operator<=>(const Dual& x, double y) { return x.value_ <=> y; }

  friend Dual sqrt(const Dual& x) {
    using std::sqrt;
    const T root = sqrt(x.value_);
    return x.through(root, 0.5 / root);
  }
  friend Dual exp(const Dual& x) {
    using std::exp;
    const T power = exp(x.value_);
    return x.through(power, power);
  }
  friend Dual log(const Dual& x) {
    using std::log;
    return x.through(log(x.value_), 1.0 / x.value_);
  }
  friend Dual sin(const Dual& x) {
    using std::cos, std::sin;
    return x.through(sin(x.value_), cos(x.value_));
  }
  friend Dual cos(const Dual& x) {
    using std::cos, std::sin;
    return x.through(cos(x.value_), -sin(x.value_));
  }
  friend Dual tan(const Dual& x) {
    using std::tan;
    const T tangent = tan(x.value_);
    return x.through(tangent, 1.0 + tangent * tangent);
  }
  friend Dual asin(const Dual& x) {
    using std::asin, std::sqrt;
    return x.through(asin(x.value_), 1.0 / sqrt(1.0 - x.value_ * x.value_));
  }
  friend Dual acos(const Dual& x) {
    using std::acos, std::sqrt;
    return x.through(acos(x.value_), -1.0 / sqrt(1.0 - x.value_ * x.value_));
  }
  friend Dual atan(const Dual& x) {
    using std::atan;
    return x.through(atan(x.value_), 1.0 / (1.0 + x.value_ * x.value_));
  }
  friend Dual sinh(const Dual& x) {
    using std::cosh, std::sinh;
    return x.through(sinh(x.value_), cosh(x.value_));
  }
  friend Dual cosh(const Dual& x) {
    using std::cosh, std::sinh;
    return x.through(cosh(x.value_), sinh(x.value_));
  }
  friend Dual tanh(const Dual& x) {
    using std::tanh;
    const T tangent = tanh(x.value_);
    return x.through(tangent, 1.0 - tangent * tangent);
  }
  friend Dual abs(const Dual& x) { return x.value_ < 0.0 ? -x : x; }
  /// x^y for a constant y.
  friend Dual pow(const Dual& x, double y) {
    using std::pow;
    return x.through(pow(x.value_, y), y * pow(x.value_, y - 1));
  }
  /// x^y, x > 0.
  friend Dual pow(const Dual& x, const Dual& y) { return exp(y * log(x)); }
  friend Dual atan2(const Dual& y, const Dual& x) {
    using std::atan2;
    const T square = x.value_ * x.value_ + y.value_ * y.value_;
    Dual z;
    z.value_ = atan2(y.value_, x.value_);
    for (int i = 0; i < C; ++i) z.at(i) = (x.value_ * y.at(i) - y.value_ * x.at(i)) / square;
    return z;
  }
  friend bool isfinite(const Dual& x) {
    using std::isfinite;
    return isfinite(x.value_);
  }
  friend bool isnan(const Dual& x) {
    using std::isnan;
    return isnan(x.value_);
  }

 private:
  const T& at(int i) const { return derivatives_.data()[i]; }
  T& at(int i) { return derivatives_.data()[i]; }
  void fill(const T& x) {
    for (int i = 0; i < C; ++i) at(i) = x;
  }
  /// f(x) from f(a) and f′(a).
  Dual through(const T& image, const T& slope) const {
    Dual y;
    y.value_ = image;
    for (int i = 0; i < C; ++i) y.at(i) = slope * at(i);
    return y;
  }

  T value_;
  DerType derivatives_;
};

/// The value as a double, for any nesting.
inline double plainValue(double x) {
  return x;
}
template <int C, class T>
double plainValue(const Dual<C, T>& x) {
  return plainValue(x.value());
}

}  // namespace info

/// Allows Dual numbers as scalars of Eigen's matrices, also mixed with double.
template <int C, class T>
struct Eigen::NumTraits<info::Dual<C, T>> : Eigen::NumTraits<double> {
  using Real = info::Dual<C, T>;
  using NonInteger = info::Dual<C, T>;
  using Nested = info::Dual<C, T>;
  using Literal = double;
  enum { RequireInitialization = 1, ReadCost = C, AddCost = C, MulCost = 2 * C };
};
template <int C, class T, class Operation>
struct Eigen::ScalarBinaryOpTraits<info::Dual<C, T>, double, Operation> {
  using ReturnType = info::Dual<C, T>;
};
template <int C, class T, class Operation>
struct Eigen::ScalarBinaryOpTraits<double, info::Dual<C, T>, Operation> {
  using ReturnType = info::Dual<C, T>;
};
