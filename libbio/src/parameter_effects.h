#pragma once

// Where parameters enter the equations of a step; not public.

#include <vector>

#include "bio/parameters.h"
#include "bio/path_gradient.h"

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
  ParameterEffects(const Arm& arm, const ParameterCatalogue& catalogue,
                   const ParameterCatalogue::Setting& setting,
                   const std::vector<std::size_t>& wanted);

  struct OfMuscle {
    std::vector<QuantityEffect> fibre;       ///< quantity: MuscleQuantity below activation1
    std::vector<QuantityEffect> activation;  ///< quantity: 0 time scale, 1 activation1, 2 …2
    std::vector<QuantityEffect> points;      ///< quantity: 3·point + axis
    std::vector<QuantityEffect> wraps;       ///< quantity: 7·wrap + component
    std::vector<QuantityEffect> gain;        ///< of the EMG; quantity unused
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
  struct OfStart {
    int coordinate;
    bool isSpeed;
    Eigen::Index column;
  };

  std::vector<OfMuscle> muscles;
  std::vector<OfSegment> segments;
  std::vector<OfLimitForce> limitForces;
  std::vector<OfSpringForce> springForces;
  std::vector<OfStart> start;
  std::vector<Eigen::Index> delay, nonlinearity;  ///< columns

 private:
  void addBody(const Arm& arm, const Body& body, int component, Eigen::Index column);
};

}  // namespace bio::stepping
