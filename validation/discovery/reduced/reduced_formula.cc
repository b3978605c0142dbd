#include "reduced/reduced_formula.h"

#include <cmath>
#include <cstdio>

namespace reduced {

std::optional<StateTerm> StateTerm::parse(const std::string& expression) {
  StateTerm term;
  const char* text = expression.c_str();
  int end = 0;
  // the whole text, or nothing
  const auto all = [&](int found, int wanted) {
    const bool whole = found == wanted && end > 0 && text[end] == '\0';
    end = 0;
    return whole;
  };
  const auto is = [&](Kind kind) {
    term.kind_ = kind;
    return term;
  };
  if (expression == "1") return is(Kind::power);
  if (expression == "q") return term.power_ = 1, is(Kind::power);
  if (expression == "q*qdot") return is(Kind::product);
  if (expression == "sin(q)") return is(Kind::sine);
  if (expression == "cos(q)") return is(Kind::cosine);
  if (expression == "qdot^3") return is(Kind::cubic);
  if (expression == "qdot") return is(Kind::viscous);
  if (expression == "qdot*abs(qdot)") return is(Kind::quadratic);
  if (all(std::sscanf(text, "q^%d%n", &term.power_, &end), 1)) return is(Kind::power);
  if (all(std::sscanf(text, "((q%lf)/%lf)^%d%n", &term.shift_, &term.b_, &term.power_, &end), 3))
    return is(Kind::power);
  term.shift_ = 0;
  if (all(std::sscanf(text, "qdot/%lf%n", &term.b_, &end), 1)) return is(Kind::viscous);
  if (all(std::sscanf(text, "qdot*abs(qdot)/%lf%n", &term.b_, &end), 1)) return is(Kind::quadratic);
  if (all(std::sscanf(text, "tanh(qdot/%lf)%n", &term.b_, &end), 1)) return is(Kind::dry);
  return {};
}

StateTerm::Value StateTerm::at(double q, double w) const {
  switch (kind_) {
    case Kind::power: {
      const double z = (q + shift_) / b_, below = power_ == 0 ? 0 : std::pow(z, power_ - 1);
      return {power_ == 0 ? 1 : below * z, power_ * below / b_, 0};
    }
    case Kind::viscous:
      return {w / b_, 0, 1 / b_};
    case Kind::quadratic:
      return {w * std::abs(w) / b_, 0, 2 * std::abs(w) / b_};
    case Kind::cubic:
      return {w * w * w, 0, 3 * w * w};
    case Kind::dry: {
      const double grip = std::tanh(w / b_);
      return {grip, 0, (1 - grip * grip) / b_};
    }
    case Kind::product:
      return {q * w, w, q};
    case Kind::sine:
      return {std::sin(q), std::cos(q), 0};
    case Kind::cosine:
      return {std::cos(q), -std::sin(q), 0};
  }
  return {};
}

}  // namespace reduced
