#include "bio/model/convert_muscles.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <stdexcept>
#include <string_view>

#include "bio/muscle/curves/curves.h"
#include "bio/muscle/muscle_parameters.h"

namespace bio {
namespace {

using muscles::AnyParameters;
using muscles::MuscleClasses;

constexpr std::string_view schutteClass = "Schutte1993Muscle_Deprecated";

/// Names of one number in several classes.
using SameNumber = std::array<std::string_view, 3>;
constexpr std::array<SameNumber, 2> sameNumbers{{
    {"FmaxTendonStrain", "TendonForceLengthCurve/strain_at_one_norm_force",
     "tendon_strain_at_one_norm_force"},
    {"FmaxMuscleStrain", "FiberForceLengthCurve/strain_at_one_norm_force",
     "passive_fiber_strain_at_one_norm_force"},
}};

/// The number of that name or of one that means the same; null if the class has none.
template <class Parameters>
double* numberNamed(Parameters& p, std::string_view name) {
  const auto place = [&](std::string_view given) { return muscles::placeOf<Parameters>(given); };
  std::size_t i = place(name);
  for (const SameNumber& names : sameNumbers) {
    bool isOne = false;
    for (const std::string_view one : names) isOne = isOne || one == name;
    for (const std::string_view same : names) {
      if (isOne && i == Parameters::count) i = place(same);
    }
  }
  return i == Parameters::count ? nullptr : &Parameters::at(p, i);
}
double* numberNamed(AnyParameters& any, std::string_view name) {
  return std::visit([&](auto& p) { return numberNamed(p, name); }, any);
}

/// Where a curve of Schutte's class first reaches F0.
std::optional<double> whereUnit(const SplineFunction& curve) {
  const FunctionEvaluator f(Function{1, curve});
  double low = curve.x.front(), high = low;
  constexpr int cells = 1000;
  const double width = (curve.x.back() - curve.x.front()) / cells;
  for (int i = 1; i <= cells; ++i) {
    high = curve.x.front() + i * width;
    if (f.evaluate(high).value >= 1) break;
    low = high;
  }
  if (!(f.evaluate(high).value >= 1)) return {};
  for (int i = 0; i < 60; ++i) {
    const double middle = (low + high) / 2;
    (f.evaluate(middle).value >= 1 ? high : low) = middle;
  }
  return high;
}

/// A number under a name that at least one class has.
using Numbers = std::map<std::string_view, double>;

class Converter {
 public:
  explicit Converter(std::string_view target, bool isRigid) : target_(target), isRigid_(isRigid) {}

  void convert(Muscle& muscle) {
    muscles::MuscleSwitches switches;
    const Numbers numbers =
        muscle.schutte ? ofSchutte(*muscle.schutte, switches) : ofHill(*muscle.hill, switches);
    muscle.schutte.reset();
    muscle.hill.reset();
    muscle.className = target_;
    if (target_ == schutteClass) {
      muscle.schutte = asSchutte(numbers, switches);
    } else {
      muscle.hill = asHill(numbers, switches);
      try {
        std::visit([](const auto& p) { p.requireRules(); }, *muscle.hill);
      } catch (const std::invalid_argument& broken) {
        throw std::invalid_argument(
            fmt::format("muscle '{}' as a {}: {}", muscle.name, target_, broken.what()));
      }
    }
  }

  std::vector<std::string> lost() const {
    std::vector<std::string> lines;
    for (const auto& [what, count] : lost_) {
      lines.push_back(count == 1 ? what : fmt::format("{} of {} muscles", what, count));
    }
    return lines;
  }

 private:
  void lose(const std::string& what) { ++lost_[what]; }

  Numbers ofSchutte(const SchutteParameters& p, muscles::MuscleSwitches& switches) {
    switches.minControl = p.minControl;
    switches.maxControl = p.maxControl;
    Numbers numbers{{"max_isometric_force", p.maxIsometricForce},
                    {"optimal_fiber_length", p.optimalFibreLength},
                    {"tendon_slack_length", p.tendonSlackLength},
                    {"pennation_angle_at_optimal", p.pennation},
                    {"max_contraction_velocity", 1 / p.timeScale},
                    {"activation_time_constant", p.timeScale / (p.activation1 + p.activation2)},
                    {"deactivation_time_constant", p.timeScale / p.activation2},
                    {"fiber_damping", p.damping}};
    if (const auto strain = whereUnit(p.tendonForceLength)) numbers["FmaxTendonStrain"] = *strain;
    if (p.passiveForceLength) {
      if (const auto length = whereUnit(*p.passiveForceLength)) {
        numbers["FmaxMuscleStrain"] = *length - 1;
      }
    } else {
      numbers["FmaxMuscleStrain"] = 0.5;  // exp(8(l − 1))/e⁴
    }
    lose("the curves of Schutte1993Muscle_Deprecated");
    return numbers;
  }

  Numbers ofHill(AnyParameters& any, muscles::MuscleSwitches& switches) {
    return std::visit(
        [&]<class Parameters>(Parameters& p) {
          switches = p;
          Numbers numbers;
          if constexpr (requires { p.curves; }) {
            if (const auto length = whereUnit(p.curves.passiveForceLength)) {
              numbers["FmaxMuscleStrain"] = *length - 1;
            }
            lose("the curves of RigidTendonMuscle");
          }
          const Parameters defaults;
          for (std::size_t i = 0; i < Parameters::count; ++i) {
            const double value = Parameters::at(p, i);
            const std::string_view name = Parameters::properties[i].name;
            if (isKnown(name)) {
              numbers[name] = value;
            } else if (p.isGiven(i) && value != Parameters::at(defaults, i)) {
              lose(std::string(name));
            }
          }
          return numbers;
        },
        any);
  }

  /// Whether the target class has it.
  bool isKnown(std::string_view name) const {
    if (target_ == schutteClass) {
      for (const auto& property : muscles::common::properties) {
        if (property.name == name) return true;
      }
      return name == "fiber_damping" || name == "activation_time_constant" ||
             name == "deactivation_time_constant";
    }
    AnyParameters any = MuscleClasses::defaultsOf(target_);
    return numberNamed(any, name) != nullptr;
  }

  AnyParameters asHill(const Numbers& numbers, const muscles::MuscleSwitches& switches) {
    AnyParameters any = MuscleClasses::defaultsOf(target_);
    std::visit([&](auto& p) { static_cast<muscles::MuscleSwitches&>(p) = switches; }, any);
    const bool isThelen = numberNamed(any, "KshapeActive") != nullptr;
    std::visit(
        [&](auto& p) {
          if (isRigid_ || target_ == "RigidTendonMuscle") p.ignoreTendonCompliance = true;
          if (target_ == "RigidTendonMuscle") p.ignoreActivationDynamics = true;
          if (!isThelen) return;
          if (p.ignoreTendonCompliance) lose("ignore_tendon_compliance");
          if (p.ignoreActivationDynamics) lose("ignore_activation_dynamics");
          p.ignoreTendonCompliance = p.ignoreActivationDynamics = false;
        },
        any);
    for (const auto& [name, value] : numbers) {
      if (double* number = numberNamed(any, name)) {
        *number = value;
      } else {
        lose(std::string(name));
      }
    }
    return any;
  }

  SchutteParameters asSchutte(const Numbers& numbers, const muscles::MuscleSwitches& switches) {
    if (switches.ignoreTendonCompliance) lose("ignore_tendon_compliance");
    if (switches.ignoreActivationDynamics) lose("ignore_activation_dynamics");
    SchutteParameters p;
    p.maxIsometricForce = numbers.at("max_isometric_force");
    p.optimalFibreLength = numbers.at("optimal_fiber_length");
    p.tendonSlackLength = numbers.at("tendon_slack_length");
    p.pennation = numbers.at("pennation_angle_at_optimal");
    p.timeScale = 1 / numbers.at("max_contraction_velocity");
    if (const auto time = numbers.find("deactivation_time_constant"); time != numbers.end()) {
      p.activation2 = p.timeScale / time->second;
      p.activation1 =
          std::max(0.0, p.timeScale / numbers.at("activation_time_constant") - p.activation2);
    }
    if (const auto damping = numbers.find("fiber_damping"); damping != numbers.end()) {
      if (damping->second > 0) {
        p.damping = damping->second;
      } else {
        lose("fiber_damping of 0");
      }
    }
    p.minControl = switches.minControl;
    p.maxControl = switches.maxControl;
    p.tendonForceLength = schutteTendonCurve();
    p.activeForceLength = schutteActiveCurve();
    return p;
  }

  std::string target_;
  bool isRigid_;
  std::map<std::string, std::size_t> lost_;  ///< over how many muscles
};

/// OpenSim's whole name.
std::string wholeName(const std::string& className) {
  if (className == "RigidTendon") return wholeName("Millard2012");
  if (className == "Schutte1993" || className == schutteClass) return std::string(schutteClass);
  for (const std::string_view name : MuscleClasses::names) {
    const std::string_view rest = name.substr(std::min(className.size(), name.size()));
    const bool isShort = name.starts_with(className) &&
                         (rest == "Muscle" || rest == "EquilibriumMuscle" || rest.empty());
    if (isShort) return std::string(name);
  }
  throw std::invalid_argument(
      fmt::format("muscle class '{}' is not known, must be one of Thelen2003, Millard2012, "
                  "DeGrooteFregly2016, Schutte1993, RigidTendon, RigidTendonMuscle",
                  className));
}

}  // namespace

MuscleConversion convertMuscles(Model& model, const std::string& className) {
  const std::string whole = wholeName(className);
  const bool isRigid = className == "RigidTendon";
  Converter converter(whole, isRigid);
  MuscleConversion result;
  for (Muscle& muscle : model.muscles) {
    if (!muscle.canBeSimulated()) continue;
    if (muscle.className == whole && !isRigid) continue;
    converter.convert(muscle);
    ++result.converted;
  }
  result.lost = converter.lost();
  return result;
}

}  // namespace bio
