#include "view/solids.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <vtkNew.h>
#include <vtkXMLPolyDataWriter.h>

#include "support/scratch_folder.h"

namespace {

using namespace bio::view;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

class GeometryFile : public ::testing::Test {
 protected:
  /// A ball as VTK itself writes it.
  void ball(const std::string& name, const Eigen::Vector3d& centre, double radius) const {
    vtkNew<vtkXMLPolyDataWriter> writer;
    writer->SetFileName((scratch / name).c_str());
    writer->SetInputData(sphereMesh(centre, radius));
    ASSERT_EQ(writer->Write(), 1);
  }

  vtkSmartPointer<vtkPolyData> meshOfFiles(const std::vector<std::string>& files) {
    BodyShape body;
    for (const std::string& file : files) body.geometry.push_back({file});
    unusable.clear();
    return meshFromFiles(body, scratch.path(), unusable);
  }

  support::ScratchFolder scratch;
  std::vector<std::string> unusable;
};

TEST_F(GeometryFile, IsDrawnWhereItsPointsAre) {
  ball("bone.vtp", {0.1, -0.2, 0.3}, 0.02);
  const auto mesh = meshOfFiles({"bone.vtp"});
  ASSERT_NE(mesh, nullptr);
  EXPECT_THAT(unusable, IsEmpty());
  double bounds[6];
  mesh->GetBounds(bounds);
  EXPECT_NEAR(bounds[2], -0.22, 1e-3);  // a ball of 32 sides
  EXPECT_NEAR(bounds[3], -0.18, 1e-3);
  EXPECT_NEAR(bounds[4], 0.28, 1e-6);  // its poles lie on z
  EXPECT_NEAR(bounds[5], 0.32, 1e-6);
}

TEST_F(GeometryFile, HasTheScaleThatTheModelGives) {
  ball("bone.vtp", {0.1, 0, 0}, 0.02);
  BodyShape body;
  body.geometry = {{"bone.vtp", {2, 1, 3}}};
  double bounds[6];
  meshFromFiles(body, scratch.path(), unusable)->GetBounds(bounds);
  EXPECT_NEAR((bounds[0] + bounds[1]) / 2, 0.2, 1e-3);
  EXPECT_NEAR(bounds[5], 0.06, 1e-6);
}

TEST_F(GeometryFile, SeveralOfABodyAreJoinedAndFoldersInNamesPassedOver) {
  ball("radius.vtp", {0, 0, 0}, 0.02);
  ball("ulna.vtp", {1, 0, 0}, 0.02);
  const auto mesh = meshOfFiles({"Geometry/radius.vtp", "ulna.vtp"});
  ASSERT_NE(mesh, nullptr);
  double bounds[6];
  mesh->GetBounds(bounds);
  EXPECT_LT(bounds[0], -0.01);
  EXPECT_GT(bounds[1], 1.01);
}

TEST_F(GeometryFile, MissingBrokenOrEmptyOnesAreNamed) {
  ball("good.vtp", {0, 0, 0}, 0.02);
  scratch.file("broken.vtp", "<VTKFile type=\"PolyData\"><PolyData><Piece NumberOfPoints=\"3\"");
  scratch.file("text.vtp", "no geometry\n");
  scratch.file("empty.vtp", "");
  for (const char* bad : {"none.vtp", "broken.vtp", "text.vtp", "empty.vtp"}) {
    EXPECT_EQ(meshOfFiles({"good.vtp", bad}), nullptr) << bad;
    EXPECT_THAT(unusable, ElementsAre(bad));
  }
  EXPECT_EQ(meshOfFiles({}), nullptr);
  EXPECT_THAT(unusable, IsEmpty()) << "a body that names no file lacks none";
}

}  // namespace
