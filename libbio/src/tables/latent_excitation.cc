#include "bio/tables/latent_excitation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

namespace bio {
namespace {

constexpr double leastCourse = 1e-3;
constexpr double mostKnots = 10'000;

void checkDeclaration(const LatentDeclaration& declaration) {
  if (!(declaration.sd > 0 && std::isfinite(declaration.sd))) {
    throw std::invalid_argument(fmt::format("latent excitation of '{}': sd = {}, must be > 0",
                                            declaration.muscle, declaration.sd));
  }
  if (!(declaration.spacing > 0 && std::isfinite(declaration.spacing))) {
    throw std::invalid_argument(
        fmt::format("latent excitation of '{}': knots every {} s, must be > 0", declaration.muscle,
                    declaration.spacing));
  }
}

}  // namespace

LatentExcitation latentExcitation(const LatentDeclaration& declared, double first, double last) {
  checkDeclaration(declared);
  const double pieces = std::max(1.0, std::ceil((last - first) / declared.spacing - 1e-9));
  if (!(last > first && pieces < mostKnots)) {
    throw std::invalid_argument(fmt::format(
        "latent excitation of '{}': knots every {} s from {} s to {} s, must be 2 to {}",
        declared.muscle, declared.spacing, first, last, mostKnots));
  }
  LatentExcitation latent;
  latent.sd = declared.sd;
  const auto n = static_cast<std::size_t>(pieces);
  for (std::size_t k = 0; k <= n; ++k) {
    latent.knots.push_back(first + (last - first) * static_cast<double>(k) / pieces);
  }
  latent.values = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(n) + 1);
  return latent;
}

double hatAt(const std::vector<double>& knots, std::size_t k, double t) {
  const std::size_t last = knots.size() - 1;
  if (k == 0 && t <= knots[0]) return 1;
  if (k == last && t >= knots[last]) return 1;
  if (t <= knots[k]) {
    return k == 0 ? 1 : std::max(0.0, (t - knots[k - 1]) / (knots[k] - knots[k - 1]));
  }
  return k == last ? 1 : std::max(0.0, (knots[k + 1] - t) / (knots[k + 1] - knots[k]));
}

Eigen::RowVectorXd withLatent(const Eigen::VectorXd& times, const Eigen::RowVectorXd& course,
                              const LatentExcitation& latent) {
  const std::vector<double>& knots = latent.knots;
  const bool rise = std::adjacent_find(knots.begin(), knots.end(),
                                       [](double a, double b) { return !(a < b); }) == knots.end();
  if (knots.size() < 2 || !rise ||
      latent.values.size() != static_cast<Eigen::Index>(knots.size()) ||
      !latent.values.allFinite()) {
    throw std::invalid_argument(
        "latent excitation: knots must rise, with one finite value for each of at least two");
  }
  Eigen::RowVectorXd x(course.size());
  for (Eigen::Index r = 0; r < x.size(); ++r) {
    const double cut = std::clamp(course[r], leastCourse, 1 - leastCourse);
    const auto above = static_cast<std::size_t>(
        std::upper_bound(knots.begin(), knots.end(), times[r]) - knots.begin());
    const std::size_t k = std::min(above == 0 ? 0 : above - 1, knots.size() - 1);
    double c = latent.values[static_cast<Eigen::Index>(k)] * hatAt(knots, k, times[r]);
    if (k + 1 < knots.size()) {
      c += latent.values[static_cast<Eigen::Index>(k) + 1] * hatAt(knots, k + 1, times[r]);
    }
    x[r] = 1 / (1 + (1 - cut) / cut * std::exp(-c));
  }
  return x;
}

Eigen::RowVectorXd latentSlope(const Eigen::VectorXd& times, const Eigen::RowVectorXd& x,
                               const LatentExcitation& latent, std::size_t k) {
  Eigen::RowVectorXd slope(x.size());
  for (Eigen::Index r = 0; r < x.size(); ++r) {
    slope[r] = x[r] * (1 - x[r]) * hatAt(latent.knots, k, times[r]);
  }
  return slope;
}

std::string latentHeader(const std::vector<LatentDeclaration>& declared) {
  std::string text;
  for (const LatentDeclaration& declaration : declared) {
    text += fmt::format("{}{} {} {}", text.empty() ? "" : "; ", declaration.muscle, declaration.sd,
                        declaration.spacing);
  }
  return text;
}

std::vector<LatentDeclaration> latentInHeader(const std::string& text) {
  std::vector<LatentDeclaration> declared;
  std::istringstream all(text);
  for (std::string part; std::getline(all, part, ';');) {
    std::istringstream words(part);
    LatentDeclaration declaration;
    std::string rest;
    if (!(words >> declaration.muscle >> declaration.sd >> declaration.spacing) || words >> rest) {
      throw std::invalid_argument(fmt::format(
          "latent_excitation = '{}', must be MUSCLE SD KNOTS_S, several between semicolons", text));
    }
    checkDeclaration(declaration);
    for (const LatentDeclaration& other : declared) {
      if (other.muscle != declaration.muscle) continue;
      throw std::invalid_argument(
          fmt::format("latent_excitation: '{}' is given twice", declaration.muscle));
    }
    declared.push_back(std::move(declaration));
  }
  return declared;
}

}  // namespace bio
