#pragma once

#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include <filesystem>
#include <string>
#include <vector>

#include "view/system_shape.h"

/// Shapes as VTK meshes.
namespace bio::view {

vtkSmartPointer<vtkPolyData> meshOf(const TaperedBone& bone);
vtkSmartPointer<vtkPolyData> sphereMesh(const Eigen::Vector3d& centre, double radius);

/// The surface in its body's frame; null for a torus.
vtkSmartPointer<vtkPolyData> meshOf(const WrapObject& wrap);

/// Tubes along the muscles with point data "activation" (NaN: unknown), one value per muscle.
vtkSmartPointer<vtkPolyData> tubesOf(const std::vector<MuscleShape>& muscles,
                                     const std::vector<double>& activations);

/// Lines 0.1 m apart on a square that lies at a height, and the square itself.
struct GroundMesh {
  vtkSmartPointer<vtkPolyData> plane;
  vtkSmartPointer<vtkPolyData> lines;
};
GroundMesh groundMesh(const Eigen::Vector3d& middle, double height);

/// Bones from the files of a body; null if it names none or one is missing or broken, which is then
/// added to `unusable`.
vtkSmartPointer<vtkPolyData> meshFromFiles(const BodyShape& body,
                                           const std::filesystem::path& folder,
                                           std::vector<std::string>& unusable);

vtkSmartPointer<vtkPolyData> joined(const std::vector<vtkSmartPointer<vtkPolyData>>& meshes);

}  // namespace bio::view
