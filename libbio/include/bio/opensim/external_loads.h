#pragma once

#include <filesystem>
#include <vector>

#include "bio/model/model.h"

namespace bio {

/// Reads OpenSim's ExternalLoads: the forces of a document, their numbers from its `datafile`
/// (beside the document, or as its path says). Of each ExternalForce: applied_to_body,
/// force_expressed_in_body, point_expressed_in_body, and the columns that begin with
/// force_identifier, point_identifier and torque_identifier, three each in the order of the file.
/// Without a point the force acts at the body's origin. What is not used is said in `warnings`.
/// @throws FileError that names file and line; a body that the model lacks, columns that are not
/// three, a force without data
std::vector<BodyLoad> readExternalLoads(const std::filesystem::path& file, const Model& model,
                                        std::vector<std::string>& warnings);

/// The span of time that all loads with a table cover [s].
/// @throws std::invalid_argument a trial from `begin` to `end` is not within it
void requireLoadsCover(const std::vector<BodyLoad>& loads, double begin, double end);

}  // namespace bio
