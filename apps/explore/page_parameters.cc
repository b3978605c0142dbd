#include "explore/page_parameters.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "bio/analysis/sensitivity_study.h"
#include "bio/model/units.h"
#include "output/json_text.h"

namespace app {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t mostByDefault = 12;
/// More are not ranked by what they do to the motion: that would take long.
constexpr std::size_t mostRanked = 400;

/// A model of the page, with the trials as it reads them.
struct StudiedModel {
  const bio::MusculoskeletalSystem& system;
  std::vector<bio::StudiedTrial> trials;
};

StudiedModel studied(const ExploredModel& model, const bio::MusculoskeletalSystem& system,
                     const ParameterQuestion& question) {
  StudiedModel studied{system, {}};
  for (const TrialInput& input : question.inputs) {
    studied.trials.push_back(bio::studiedTrial(input.trial, model.model, system,
                                               {input.start.q, input.start.qDot, {}},
                                               input.recorded.simulation));
  }
  return studied;
}

/// The coordinates that the first trial measures, or the first free one, with their noise.
std::vector<bio::ChannelCandidate> observedIn(const ParameterQuestion& question,
                                              const StudiedModel& shown) {
  std::vector<bio::ChannelCandidate> observed;
  for (const bio::Coordinate& one : shown.system.skeleton().coordinates()) {
    const bio::Observable what = bio::ofCoordinate(one.name);
    const bool isMeasured = question.inputs.front().trial.measurementOf(what) != nullptr;
    if (isMeasured && !shown.system.isPrescribed(shown.system.skeleton().indexOf(one.name)))
      observed.push_back({what, question.noise / bio::positionUnit(one.isRotation).factor});
  }
  return observed;
}

bio::SensitivityQuestion sensitivityQuestion(const ParameterQuestion& question,
                                             const StudiedModel& shown,
                                             std::vector<std::size_t> selection) {
  const bio::Coordinate& first = shown.system.skeleton().coordinates().front();
  bio::SensitivityQuestion asked;
  asked.system = question.options;
  asked.coordinate = first.name;
  asked.noise = question.noise / bio::positionUnit(first.isRotation).factor;
  asked.observed = observedIn(question, shown);
  asked.selection = std::move(selection);
  return asked;
}

/// Those that move the motion most per standard deviation of their priors.
std::vector<std::string> mostInfluential(const ParameterQuestion& question,
                                         const StudiedModel& shown) {
  const bio::ParameterCatalogue& catalogue = shown.trials.front().catalogue;
  std::vector<std::size_t> all;
  for (std::size_t i = 0; i < catalogue.parameters().size(); ++i) {
    const bio::ModelParameter& one = catalogue.parameters()[i];
    if (!one.isGroup && !one.name.starts_with("initial.")) all.push_back(i);
  }
  std::vector<std::string> names;
  if (all.size() > mostRanked ||
      !bio::isVariational(shown.trials.front().recorded.simulation.integrator)) {
    for (const std::size_t i : all) {
      if (names.size() < mostByDefault &&
          catalogue.parameters()[i].name.ends_with(".max_isometric_force"))
        names.push_back(catalogue.parameters()[i].name);
    }
    for (std::size_t k = 0; k < all.size() && names.size() < mostByDefault / 2; ++k)
      names.push_back(catalogue.parameters()[all[k]].name);
    return names;
  }
  const bio::LocalSensitivity local =
      bio::localSensitivity(shown.trials, sensitivityQuestion(question, shown, all));
  std::vector<std::size_t> order(all.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  const Eigen::VectorXd& influence = local.information.normalisedSensitivity;
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return influence[static_cast<Eigen::Index>(a)] > influence[static_cast<Eigen::Index>(b)];
  });
  order.resize(std::min(order.size(), mostByDefault));
  for (const std::size_t i : order) names.push_back(catalogue.parameters()[all[i]].name);
  return names;
}

/// The effect's own numbers, then those that a fit shifted most.
std::vector<std::string> ofVerdict(const EarlierVerdict& verdict,
                                   const bio::ParameterCatalogue& shown,
                                   const bio::ParameterCatalogue& given) {
  std::vector<std::string> names;
  for (const bio::ModelParameter& one : shown.parameters()) {
    // a damper is a spring without stiffness: what is 0 was not estimated
    if (!one.isGroup && one.value != 0 && !given.has(one.name)) names.push_back(one.name);
  }
  std::vector<EarlierVerdict::Fitted> fitted = verdict.fitted;
  std::stable_sort(fitted.begin(), fitted.end(),
                   [](const auto& a, const auto& b) { return a.shift > b.shift; });
  for (const EarlierVerdict::Fitted& one : fitted) {
    const bool isNew = std::find(names.begin(), names.end(), one.name) == names.end();
    if (names.size() < mostByDefault && isNew && shown.has(one.name) &&
        !one.name.starts_with("initial."))
      names.push_back(one.name);
  }
  return names;
}

/// What the trials say of the parameters that the shown model has.
void addInformation(const ParameterQuestion& question, const StudiedModel& shown,
                    PageParameters& page) {
  const bio::ParameterCatalogue& catalogue = shown.trials.front().catalogue;
  if (!bio::isVariational(shown.trials.front().recorded.simulation.integrator)) return;
  std::vector<std::size_t> selection;
  for (PageParameter& one : page.list) {
    if (!catalogue.has(one.name)) continue;
    one.covarianceRow = static_cast<int>(selection.size());
    selection.push_back(catalogue.find(one.name));
  }
  const bio::SensitivityQuestion asked = sensitivityQuestion(question, shown, selection);
  if (selection.empty() || asked.observed.empty()) {
    for (PageParameter& one : page.list) one.covarianceRow = -1;
    return;
  }
  const bio::ParameterInformation information =
      bio::localSensitivity(shown.trials, asked).information;
  page.covariance = information.boundJoint.asDiagonal() * information.correlation *
                    information.boundJoint.asDiagonal();
  for (PageParameter& one : page.list) {
    if (one.covarianceRow >= 0) one.sd = information.boundJoint[one.covarianceRow];
  }
  std::string what;
  for (const bio::ChannelCandidate& channel : asked.observed)
    what += (what.empty() ? "" : ", ") + nameOf(channel.what);
  page.note = fmt::format(
      "For {} measured with noise of {:.3g} deg or mm, if the sliders' parameters are unknown and "
      "all others known.",
      what, question.noise);
  const std::vector<bio::AlikePair> alike = bio::alikePairs(information.fisher, 0);
  page.alike = {0, page.list.size() > 1 ? 1 : 0};
  if (alike.empty()) return;
  for (std::size_t i = 0; i < page.list.size(); ++i) {
    if (page.list[i].covarianceRow == alike.front().first) page.alike.first = i;
    if (page.list[i].covarianceRow == alike.front().second) page.alike.second = i;
  }
}

}  // namespace

double PageParameter::value() const {
  for (auto one = inModel.rbegin(); one != inModel.rend(); ++one)
    if (*one) return **one;
  return lower;
}

std::vector<std::string> PageParameters::names() const {
  std::vector<std::string> all;
  for (const PageParameter& one : list) all.push_back(one.name);
  return all;
}

Json PageParameters::json() const {
  Json all = Json::array();
  for (const PageParameter& one : list) {
    const double value = one.value();
    // four prior deviations to either side, within the bounds
    const double reach =
        std::max(4 * one.priorSd, one.before ? 1.5 * std::abs(*one.before - value) : 0);
    Json json = {{"name", one.name},
                 {"unit", one.unit},
                 {"meaning", one.meaning},
                 {"value", value},
                 {"lower", orNull(one.lower)},
                 {"upper", orNull(one.upper)},
                 {"from", std::max(one.lower, value - reach)},
                 {"to", std::min(one.upper, value + reach)},
                 {"prior", one.before.value_or(value)},
                 {"priorSd", one.priorSd},
                 {"sd", one.sd},
                 {"covarianceRow", one.covarianceRow}};
    if (one.before) json["before"] = *one.before;
    all.push_back(std::move(json));
  }
  return all;
}

Json PageParameters::covarianceJson() const {
  if (covariance.size() == 0) return nullptr;
  Json rows = Json::array();
  for (Eigen::Index i = 0; i < covariance.rows(); ++i) {
    const Eigen::VectorXd row = covariance.row(i);
    rows.push_back(std::vector<double>(row.begin(), row.end()));
  }
  return rows;
}

PageParameters pageParameters(const ParameterQuestion& question) {
  // of each model; they must not move
  std::vector<bio::MusculoskeletalSystem> others;
  others.reserve(question.models.size());
  std::vector<StudiedModel> models{studied(question.models.front(), question.system, question)};
  for (std::size_t i = 1; i < question.models.size(); ++i) {
    others.emplace_back(question.models[i].model, question.options);
    models.push_back(studied(question.models[i], others.back(), question));
  }
  std::vector<bio::ParameterCatalogue> all;
  for (const StudiedModel& model : models) all.push_back(model.trials.front().catalogue);
  const StudiedModel& shown = models.back();
  std::vector<std::string> names;
  if (!question.names.empty()) {
    for (const std::size_t i : all.back().select(question.names))
      names.push_back(all.back().parameters()[i].name);
  } else if (question.verdict) {
    names = ofVerdict(*question.verdict, all.back(), all.front());
  } else {
    names = mostInfluential(question, shown);
  }
  PageParameters page;
  for (const std::string& name : names) {
    const bio::ModelParameter& one = all.back().parameters()[all.back().find(name)];
    PageParameter parameter{
        one.name, one.unit, one.meaning, one.lower, std::min(one.upper, one.limit), {}, {}, one.sd};
    for (const bio::ParameterCatalogue& catalogue : all) {
      parameter.inModel.push_back(
          catalogue.has(name) ? std::optional(catalogue.parameters()[catalogue.find(name)].value)
                              : std::nullopt);
    }
    if (parameter.inModel.front() && *parameter.inModel.front() != parameter.value())
      parameter.before = parameter.inModel.front();
    page.list.push_back(std::move(parameter));
  }
  addInformation(question, shown, page);
  return page;
}

}  // namespace app
