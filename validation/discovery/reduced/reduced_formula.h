#pragma once

#include <optional>
#include <string>

namespace reduced {

/// A force that follows the state, one of ((q + a)/b)ⁿ, q̇, q̇|q̇|, q̇³, tanh(q̇/b), q·q̇, sin q and
/// cos q, the speeds' ones divided by b: what discovery makes formulas of.
class StateTerm {
 public:
  /// Nothing if it is none of them.
  static std::optional<StateTerm> parse(const std::string& expression);

  struct Value {
    double value, byQ, bySpeed;
  };
  Value at(double q, double w) const;

 private:
  enum class Kind { power, viscous, quadratic, cubic, dry, product, sine, cosine };
  Kind kind_ = Kind::power;
  double shift_ = 0, b_ = 1;
  int power_ = 0;
};

}  // namespace reduced
