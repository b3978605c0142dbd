#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "discovery/effects/effects.h"

// Passive tissue of muscles that cross several joints, which makes the passive moment of each
// depend on the others' angles (Riener & Edrich 1999). Prior: as stiff at the joint that it moves
// most as the joint itself (elastic.cc).

namespace bio::discover {

// The length's zero is arbitrary: in the middle of all ranges it is as long as it is at most
// shortened and lengthened in sum. Between OpenSim's paths and this one the moment arms differ as
// far as they change with the angles.
void addBiarticularSprings(EncompassingModel& model) {
  for (const MuscleGroup& group : model.groups()) {
    PathFunction function;
    double most = 0, excursion = 0, zero = 0;
    MultivariatePolynomial length{0, 1, {}};
    for (std::size_t k = 0; k < model.coordinates().size(); ++k) {
      const MovingCoordinate& at = model.coordinates()[k];
      const double arm = group.momentArms[static_cast<Eigen::Index>(k)];
      if (!at.coordinate.isRotation || std::abs(arm) < 1e-3) continue;
      function.coordinates.push_back(at.coordinate.name);
      length.coefficients.insert(length.coefficients.begin(), -arm);  // the last argument first
      most = std::max(most, std::abs(arm));
      excursion += std::abs(arm) * (at.coordinate.rangeMax - at.coordinate.rangeMin);
      zero += arm * at.middle();
    }
    length.dimension = static_cast<int>(function.coordinates.size());
    if (length.dimension < 2 || length.dimension > MultivariatePolynomial::maxDimension) continue;
    length.coefficients.insert(length.coefficients.begin(), excursion + zero);
    function.length = length;
    const std::string id = "biarticular_" + group.name;
    const auto isThere = [&](const ElasticPath& path) { return path.enabled && path.name == id; };
    if (std::any_of(model.base().elasticPaths.begin(), model.base().elasticPaths.end(), isThere)) {
      model.addPresent(id, id);
      continue;
    }
    const std::size_t law = model.addLaw(
        ElasticPath{id, ElasticPathKind::spring, {{}, {}, function}, excursion, 0, 0, 0, {}});
    const auto number = [&](ForceNumberTarget::ElasticPathNumber place) {
      return model.number(ForceNumberTarget{ForceNumberTarget::Kind::elasticPath, law, place}, 0);
    };
    const double size = 1 / (most * most);
    const std::size_t k =
        model.add(amplitude(id + ".stiffness", "N/m", 0, 10 * size, 2 * size),
                  {Meaning::Kind::shift, {{number(ForceNumberTarget::pathScale)}}});
    const std::size_t rest = model.add(
        shape(id + ".rest", "m", excursion, 0.5 * excursion, 1.5 * excursion, 0.3 * excursion),
        {Meaning::Kind::shift, {{number(ForceNumberTarget::pathRestLength)}}});
    model.lawFollows({k, rest});
    model.add(candidate(
        model, id, fmt::format("passive tissue along {}", group.name),
        fmt::format("Passive tissue along {}, which crosses several joints, pulls where it is "
                    "longer than at rest.",
                    group.name),
        info::discover::EffectKind::structure, {k, rest},
        {{0.5 * size, excursion}, {0.5 * size, 0.8 * excursion}, {0.5 * size, 1.2 * excursion}}));
  }
}

}  // namespace bio::discover
