#pragma once

#include <functional>
#include <string>
#include <vector>

#include "bio/design/input_search.h"
#include "bio/model/units.h"
#include "bio/observation/channel_information.h"
#include "output/summary.h"
#include "output/text.h"
#include "report/report.h"

/// The parts that the reports of all searches for experiments show.
namespace app {

/// A search for inputs of an experiment.
struct PlannedInputs {
  const bio::Model& model;
  const bio::DesignInputs& inputs;
  const bio::Trial& before;
  const bio::Trial& after;

  const bio::Coordinate& coordinate(const std::string& name) const;
  /// "deg" or "m"
  bio::ShownUnit unitOf(const std::string& coordinate) const;
  /// "N m" or "N"
  std::string torqueUnit(const std::string& coordinate) const;
};

/// The predicted course of one channel, without series.
/// @param caption  is followed by the limits, where there are any
Figure predictionFigure(const PlannedInputs& planned, const bio::Observable& what,
                        const std::string& caption);
/// Every torque and every excitation that was designed.
void addInputFigures(const PlannedInputs& planned, Report& report);
/// A section of the predictions behind the first, if there are any.
void addFurther(std::size_t count, const std::function<Figure(std::size_t)>& predicted,
                Report& report);
/// A table of limits as a section.
void addLimits(Table table, Report& report);
/// The limits of the torques and excitations.
Table limitTable(const PlannedInputs& planned);
/// Adds a row to it.
void addLimit(Table& table, const std::string& quantity, double designed, double limit,
              const bio::ShownUnit& unit);
/// How the search went.
/// @param sign  of the costs
void addSearch(const bio::DesignSearchRecord& record, double before, double sign,
               const std::string& yLabel, Report& report);

/// The summary of every search: what is observed, and where the free coordinates go.
/// @param motions  of DesignLimits::coordinates
void tellPlan(const PlannedInputs& planned, const std::vector<bio::ChannelCandidate>& observed,
              double period, const std::vector<bio::MotionExtremes>& motions,
              const bio::DesignSearchRecord& record, Summary& summary);

/// "one sample of elbow_flexion (noise 0.5 deg) and … every 0.01 s"
std::string measurementText(const std::vector<bio::ChannelCandidate>& observed, double period,
                            const bio::Model& model);

}  // namespace app
