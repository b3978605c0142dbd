#include "view/solids.h"

#include <vtkAppendPolyData.h>
#include <vtkCellArray.h>
#include <vtkCylinderSource.h>
#include <vtkDoubleArray.h>
#include <vtkMatrix4x4.h>
#include <vtkNew.h>
#include <vtkObject.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyDataNormals.h>
#include <vtkSphereSource.h>
#include <vtkTransform.h>
#include <vtkTransformPolyDataFilter.h>
#include <vtkTubeFilter.h>
#include <vtkXMLPolyDataReader.h>

#include <cmath>
#include <numbers>

namespace bio::view {
namespace {

using Eigen::Vector3d;
using Mesh = vtkSmartPointer<vtkPolyData>;

constexpr int sides = 32;

/// Distance from the axis at a place 0 … 1 along the shaft.
double shaftRadiusAt(const TaperedBone& bone, double s) {
  const double end = s < 0.5 ? bone.fromRadius : bone.toRadius;
  const double fromMiddle = std::abs(2 * s - 1);
  return bone.shaftRadius + (end - bone.shaftRadius) * std::pow(fromMiddle, 3);
}

Mesh moved(const Mesh& mesh, const Placement<double>& X) {
  vtkNew<vtkMatrix4x4> matrix;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) matrix->SetElement(i, j, X.R(i, j));
    matrix->SetElement(i, 3, X.p[i]);
  }
  vtkNew<vtkTransform> transform;
  transform->SetMatrix(matrix);
  vtkNew<vtkTransformPolyDataFilter> filter;
  filter->SetTransform(transform);
  filter->SetInputData(mesh);
  filter->Update();
  return filter->GetOutput();
}

Mesh withNormals(const Mesh& mesh, double featureAngle) {
  vtkNew<vtkPolyDataNormals> normals;
  normals->SetInputData(mesh);
  normals->SetFeatureAngle(featureAngle);
  normals->Update();
  return normals->GetOutput();
}

}  // namespace

Mesh meshOf(const TaperedBone& bone) {
  const Vector3d axis = bone.to - bone.from, z = axis.normalized();
  const Vector3d x = z.unitOrthogonal(), y = z.cross(x);
  // Rings (place along the axis, radius): rounded end, shaft, rounded end.
  std::vector<std::pair<double, double>> rings;
  constexpr int capRings = 6, shaftRings = 24;
  const double length = axis.norm();
  for (int i = 0; i < capRings; ++i) {
    const double angle = (capRings - i) * std::numbers::pi / 2 / capRings;
    rings.push_back({-bone.fromRadius * std::sin(angle), bone.fromRadius * std::cos(angle)});
  }
  for (int i = 0; i <= shaftRings; ++i) {
    const double s = static_cast<double>(i) / shaftRings;
    rings.push_back({s * length, shaftRadiusAt(bone, s)});
  }
  for (int i = 1; i <= capRings; ++i) {
    const double angle = i * std::numbers::pi / 2 / capRings;
    rings.push_back({length + bone.toRadius * std::sin(angle), bone.toRadius * std::cos(angle)});
  }
  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> faces;
  for (const auto& [along, radius] : rings) {
    for (int k = 0; k < sides; ++k) {
      const double angle = 2 * std::numbers::pi * k / sides;
      const Vector3d p =
          bone.from + along * z + radius * (std::cos(angle) * x + std::sin(angle) * y);
      points->InsertNextPoint(p.data());
    }
  }
  for (int r = 0; r + 1 < static_cast<int>(rings.size()); ++r) {
    for (int k = 0; k < sides; ++k) {
      const int next = (k + 1) % sides;
      const vtkIdType face[4] = {r * sides + k, r * sides + next, (r + 1) * sides + next,
                                 (r + 1) * sides + k};
      faces->InsertNextCell(4, face);
    }
  }
  vtkNew<vtkPolyData> mesh;
  mesh->SetPoints(points);
  mesh->SetPolys(faces);
  return withNormals(Mesh(mesh), 180);
}

Mesh sphereMesh(const Vector3d& centre, double radius) {
  vtkNew<vtkSphereSource> sphere;
  sphere->SetCenter(centre.x(), centre.y(), centre.z());
  sphere->SetRadius(radius);
  sphere->SetThetaResolution(sides);
  sphere->SetPhiResolution(sides / 2);
  sphere->Update();
  return sphere->GetOutput();
}

Mesh meshOf(const WrapObject& wrap) {
  Placement<double> X = placementOf(wrap.frame);
  if (wrap.shape == WrapShape::torus) return nullptr;
  if (wrap.shape == WrapShape::cylinder) {
    vtkNew<vtkCylinderSource> cylinder;  // about its y-axis
    cylinder->SetRadius(wrap.radius);
    cylinder->SetHeight(wrap.length);
    cylinder->SetResolution(2 * sides);
    cylinder->SetCapping(false);
    cylinder->Update();
    X.R = X.R * Eigen::AngleAxisd(std::numbers::pi / 2, Vector3d::UnitX()).toRotationMatrix();
    return moved(cylinder->GetOutput(), X);
  }
  if (wrap.shape == WrapShape::sphere) return moved(sphereMesh(Vector3d::Zero(), wrap.radius), X);
  X.R = X.R * wrap.semiAxes.asDiagonal();
  return withNormals(moved(sphereMesh(Vector3d::Zero(), 1), X), 180);
}

Mesh tubesOf(const std::vector<MuscleShape>& muscles, const std::vector<double>& activations) {
  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> lines;
  vtkNew<vtkDoubleArray> radii, values;
  radii->SetName("radius");
  values->SetName("activation");
  for (std::size_t i = 0; i < muscles.size(); ++i) {
    std::vector<vtkIdType> line;
    const Vector3d* last = nullptr;
    for (const Vector3d& point : muscles[i].points) {
      // A tube has no direction where two points coincide.
      if (last != nullptr && (point - *last).norm() < 1e-6) continue;
      last = &point;
      line.push_back(points->InsertNextPoint(point.data()));
      radii->InsertNextValue(muscles[i].radius);
      values->InsertNextValue(activations[i]);
    }
    lines->InsertNextCell(static_cast<vtkIdType>(line.size()), line.data());
  }
  vtkNew<vtkPolyData> paths;
  paths->SetPoints(points);
  paths->SetLines(lines);
  paths->GetPointData()->AddArray(values);
  paths->GetPointData()->AddArray(radii);
  paths->GetPointData()->SetActiveScalars("radius");
  vtkNew<vtkTubeFilter> tubes;
  tubes->SetInputData(paths);
  tubes->SetVaryRadiusToVaryRadiusByAbsoluteScalar();
  tubes->SetNumberOfSides(16);
  tubes->CappingOn();
  tubes->Update();
  return tubes->GetOutput();
}

GroundMesh groundMesh(const Vector3d& middle, double height) {
  constexpr int halfCount = 8;
  constexpr double spacing = 0.1;  // [m]
  const double x = std::round(middle.x() / spacing) * spacing;
  const double z = std::round(middle.z() / spacing) * spacing;
  const double half = halfCount * spacing;
  GroundMesh ground{Mesh::New(), Mesh::New()};
  vtkNew<vtkPoints> corners, ends;
  vtkNew<vtkCellArray> face, lines;
  const vtkIdType square[4] = {corners->InsertNextPoint(x - half, height, z - half),
                               corners->InsertNextPoint(x - half, height, z + half),
                               corners->InsertNextPoint(x + half, height, z + half),
                               corners->InsertNextPoint(x + half, height, z - half)};
  face->InsertNextCell(4, square);
  ground.plane->SetPoints(corners);
  ground.plane->SetPolys(face);
  const double above = height + 2e-3;  // [m]: enough for the depth buffer to tell them apart
  for (int i = -halfCount; i <= halfCount; ++i) {
    const double at = i * spacing;
    const vtkIdType along[2] = {ends->InsertNextPoint(x - half, above, z + at),
                                ends->InsertNextPoint(x + half, above, z + at)};
    const vtkIdType across[2] = {ends->InsertNextPoint(x + at, above, z - half),
                                 ends->InsertNextPoint(x + at, above, z + half)};
    lines->InsertNextCell(2, along);
    lines->InsertNextCell(2, across);
  }
  ground.lines->SetPoints(ends);
  ground.lines->SetLines(lines);
  return ground;
}

Mesh meshFromFiles(const BodyShape& body, const std::filesystem::path& folder,
                   std::vector<std::string>& unusable) {
  vtkObject::GlobalWarningDisplayOff();  // a library does not print
  std::vector<Mesh> meshes;
  for (const auto& [name, scale] : body.geometry) {
    const std::filesystem::path file = folder / std::filesystem::path(name).filename();
    vtkNew<vtkXMLPolyDataReader> reader;
    if (std::filesystem::is_regular_file(file) && reader->CanReadFile(file.c_str())) {
      reader->SetFileName(file.c_str());
      reader->Update();
    }
    if (reader->GetOutput()->GetNumberOfPoints() == 0) {
      unusable.push_back(name);
      return nullptr;
    }
    reader->GetOutput()->GetPointData()->SetScalars(nullptr);
    vtkPoints* points = reader->GetOutput()->GetPoints();
    for (vtkIdType k = 0; k < points->GetNumberOfPoints(); ++k) {
      Eigen::Vector3d point;
      points->GetPoint(k, point.data());
      point = point.cwiseProduct(scale);
      points->SetPoint(k, point.data());
    }
    meshes.push_back(withNormals(reader->GetOutput(), 60));
  }
  return meshes.empty() ? nullptr : joined(meshes);
}

Mesh joined(const std::vector<Mesh>& meshes) {
  vtkNew<vtkAppendPolyData> all;
  for (const Mesh& mesh : meshes) all->AddInputData(mesh);
  all->Update();
  return all->GetOutput();
}

}  // namespace bio::view
