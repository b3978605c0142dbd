#include "bio/muscle/muscle_variant.h"

#include <fmt/format.h>

#include <optional>
#include <stdexcept>
#include <type_traits>

namespace bio::muscles {
namespace {

template <template <class> class... Shapes>
AnyMuscle compiledIn(const ClassList<Shapes...>&, const AnyParameters& parameters) {
  return std::visit(
      [](const auto& p) -> AnyMuscle {
        p.requireRules();
        using P = std::remove_cvref_t<decltype(p)>;
        std::optional<AnyMuscle> muscle;
        const auto make = [&]<class Shape>(std::type_identity<Shape>) {
          if constexpr (std::is_same_v<typename Shape::Parameters, P>) {
            muscle.emplace(HillMuscle<Shape>(p));
          }
        };
        (make(std::type_identity<Shapes<double>>{}), ...);
        return *std::move(muscle);
      },
      parameters);
}

}  // namespace

void refuseClass(std::string_view className) {
  throw std::invalid_argument(fmt::format("muscle class {} is not known", className));
}

AnyMuscle compile(const AnyParameters& parameters) {
  return compiledIn(MuscleClasses{}, parameters);
}

AnyActivation activationOf(const AnyParameters& parameters) {
  return std::visit([](const auto& p) { return p.activation(); }, parameters);
}

}  // namespace bio::muscles
