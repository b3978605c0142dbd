#pragma once

// Where parameters enter the equations of a step; not public.

#include <vector>

#include "bio/parameters/parameters.h"
#include "bio/path/path_gradient.h"

namespace bio::stepping {

/// column += factor·(derivative in an elementary quantity)
struct QuantityEffect {
  std::size_t quantity;  ///< which one, of its kind
  Eigen::Index column;
  double factor = 1;
};

/// The columns of wanted parameters sorted by what they touch.
class ParameterEffects {
 public:
  ParameterEffects(const MusculoskeletalSystem& system, const ParameterCatalogue::Setting& setting,
                   const std::vector<ParameterDirection>& wanted);

  struct OfMuscle {
    std::vector<QuantityEffect> fibre;       ///< quantity: a place in PerMuscleNumber
    std::vector<QuantityEffect> activation;  ///< quantity: a place in ActivationDynamics::names
    std::vector<QuantityEffect> points;      ///< quantity: 3·point + axis
    std::vector<QuantityEffect> wraps;       ///< quantity: wrap_rows::count·wrap + row
    bool hasGeometry() const { return !points.empty() || !wraps.empty(); }
  };
  struct OfSegment {
    std::size_t segment;
    Segment change;  ///< derivative of its mass, first and second moments
    Eigen::Index column;
  };
  struct OfLimitForce {
    CoordinateLimitForce law;
    int coordinate;
    QuantityEffect effect;
  };
  struct OfSpringForce {
    SpringGeneralizedForce law;
    int coordinate;
    QuantityEffect effect;
  };
  struct OfExpression {
    CoordinateExpression law;
    int coordinate;
    QuantityEffect effect;  ///< quantity: constant
  };
  /// A force on bodies or an actuator, with the numbers wanted of it.
  struct OfForce {
    ForceNumberTarget::Kind kind;
    std::size_t place;  ///< springs and bushings: in the model's list; others: in the system's
    std::vector<QuantityEffect> numbers;  ///< quantity: ForceNumberTarget::number
  };
  struct OfStart {
    int coordinate;
    bool isSpeed;
    Eigen::Index column;
    double weight;
  };
  /// ∂u/∂θ at the rows of the trial.
  struct OfEmg {
    EmgTarget target;
    Eigen::Index column;
    double weight;
  };

  std::vector<OfMuscle> muscles;
  std::vector<OfSegment> segments;
  std::vector<QuantityEffect> gravity;  ///< quantity: axis
  std::vector<OfLimitForce> limitForces;
  std::vector<OfSpringForce> springForces;
  std::vector<OfExpression> expressions;
  std::vector<OfForce> forces;
  std::vector<OfStart> start;
  std::vector<OfEmg> emg;  ///< all but the delay
  std::vector<QuantityEffect> delay;

 private:
  struct Enter;
  void addForce(const MusculoskeletalSystem& system, const Model& model,
                const ForceNumberTarget& target, Eigen::Index column, double weight);
  void addBody(const MusculoskeletalSystem& system, const BodyTarget& target, const Body& body,
               Eigen::Index column, double weight);
};

}  // namespace bio::stepping
