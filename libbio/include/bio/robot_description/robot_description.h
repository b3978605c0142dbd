#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "bio/model/model.h"

namespace tinyxml2 {
class XMLDocument;
}

/// Descriptions of robots as models: URDF (root element <robot>) and MuJoCo's MJCF (<mujoco>).
namespace bio {

enum class ModelFormat { none, openSim, urdf, mjcf };

/// What a file is by its root element, whatever its suffix; `none` for everything else.
/// @throws FileError if the file cannot be read
ModelFormat modelFormat(const std::filesystem::path& file);
ModelFormat modelFormat(const tinyxml2::XMLDocument& document);

/// A parsed URDF or MJCF as a model, with warnings (what would act and is not simulated) and
/// remarks: links or bodies, joints, masses and inertias, damping, dry friction −c·tanh(q̇/0.05),
/// springs, motors and gravity. Coordinates have the joints' names, zeros
/// and signs, bodies the links' names. Tables of what is read: docs/files.md.
///
/// @param file where the document is from, for messages and for what an MJCF includes
/// @throws FileError if the document breaks a rule of its format, or holds what a model cannot say
Model readRobotDescription(const tinyxml2::XMLDocument& document,
                           const std::filesystem::path& file);

/// What a description became, for people: one line each.
/// @param model as readOsim gives it
std::vector<std::string> translationOf(const Model& model, ModelFormat format);

}  // namespace bio
