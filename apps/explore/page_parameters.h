#pragma once

#include <Eigen/Dense>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "explore/explored_models.h"
#include "options/trial_input.h"

namespace app {

/// A parameter with a slider.
struct PageParameter {
  std::string name, unit, meaning;
  double lower, upper;           ///< bounds of its value
  std::optional<double> before;  ///< in the model as given, if the page begins elsewhere
  std::vector<std::optional<double>> inModel;  ///< by model of the page; empty: it has none
  double priorSd = 0;
  double sd = 0;  ///< at the joint bound, or of an earlier fit; 0: not known
  int covarianceRow = -1;
  double value() const;  ///< with which the page begins: of the last model that has it
};

/// The sliders of a page, and what its trials say of them.
struct PageParameters {
  std::vector<PageParameter> list;
  Eigen::MatrixXd covariance;  ///< (I + Λ)⁻¹ of those with a row; empty: not known
  std::string note;            ///< what it holds for
  std::pair<std::size_t, std::size_t> alike = {0, 0};  ///< shown first: the most alike
  std::vector<std::string> names() const;
  nlohmann::ordered_json json() const;
  nlohmann::ordered_json covarianceJson() const;
};

struct ParameterQuestion {
  const std::vector<ExploredModel>& models;
  const bio::MusculoskeletalSystem& system;  ///< of the first model
  const std::vector<TrialInput>& inputs;     ///< of the first model
  bio::SystemOptions options;
  std::vector<std::string> names;  ///< as typed; empty: the most influential
  double noise;                    ///< [deg] or [mm]
  const std::optional<EarlierVerdict>& verdict;
};
/// @throws std::invalid_argument for a name that no model has
PageParameters pageParameters(const ParameterQuestion& question);

}  // namespace app
