#include <gmock/gmock.h>
#include <tinyxml2.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <numbers>
#include <optional>
#include <set>

#include "bio/muscle/curves/curves.h"
#include "bio/opensim/osim_file.h"
#include "bio/tables/table_file.h"
#include "support/reference.h"
#include "support/scratch_folder.h"

// The shipped elbow models say what the sources say, and give the lengths that OpenSim gives.
namespace bio {
namespace {

using Eigen::Isometry3d;
using testing::ElementsAre;
using testing::IsEmpty;

const std::filesystem::path root = FISHERHILL_SOURCE_DIR;

Model elbow8() {
  return readOsim(root / "models/elbow8.osim");
}

Isometry3d placed(const FramePlacement& frame) {
  return Eigen::Translation3d(frame.translation) *
         Eigen::AngleAxisd(frame.orientation.x(), Eigen::Vector3d::UnitX()) *
         Eigen::AngleAxisd(frame.orientation.y(), Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(frame.orientation.z(), Eigen::Vector3d::UnitZ());
}

// Pose of every body with the elbow at q and all else at its default.
std::map<std::string, Isometry3d> poses(const Model& model, double q) {
  std::map<std::string, Isometry3d> pose = {{"ground", Isometry3d::Identity()}};
  for (const Joint& joint : model.joints) {
    Isometry3d motion = Isometry3d::Identity();
    for (std::size_t i = 0; i < 3; ++i) {
      const TransformAxis& axis = joint.axes[i];
      if (axis.coordinate.empty()) continue;
      const double x = axis.coordinate == "elbow_flexion"
                           ? q
                           : findCoordinate(model, axis.coordinate).defaultValue;
      const double angle = FunctionEvaluator(axis.function).value(x);
      motion = motion * Eigen::AngleAxisd(angle, axis.axis.normalized());
    }
    pose[joint.childBody] = pose.at(joint.parentBody) * placed(joint.parentFrame) * motion *
                            placed(joint.childFrame).inverse();
  }
  return pose;
}

// Length of the path as a chain of straight lines.
double straightLength(const Model& model, const Muscle& muscle, double q) {
  const auto pose = poses(model, q);
  double length = 0;
  std::optional<Eigen::Vector3d> last;
  for (const PathPoint& point : muscle.path.points) {
    if (point.condition && (q < point.condition->lower || q > point.condition->upper)) continue;
    Eigen::Vector3d p = point.location;
    if (point.motion) {
      for (int i = 0; i < 3; ++i) {
        p(i) = FunctionEvaluator(point.motion->location[static_cast<std::size_t>(i)]).value(0.0);
      }
    }
    p = pose.at(point.body) * p;
    if (last) length += (p - *last).norm();
    last = p;
  }
  return length;
}

TEST(Elbow8, FilesAreWhatTheirGeneratorWrites) {
  const support::ScratchFolder folder;
  const std::string command =
      std::string(FISHERHILL_MAKE_ELBOW8) + " '" + folder.path().string() + "'";
  ASSERT_EQ(std::system(command.c_str()), 0);
  for (const char* name : {"elbow8.osim", "elbow8_passive.osim"}) {
    EXPECT_EQ(support::contentOf(folder / name), support::contentOf(root / "models" / name))
        << name;
  }
}

// Every "parent/child" of tags below the element.
void collectTags(const tinyxml2::XMLElement& element, std::set<std::string>& tags) {
  for (auto child = element.FirstChildElement(); child; child = child->NextSiblingElement()) {
    tags.insert(std::string(element.Name()) + "/" + child->Name());
    collectTags(*child, tags);
  }
}

std::set<std::string> tagsOf(const std::filesystem::path& file) {
  tinyxml2::XMLDocument document;
  EXPECT_EQ(document.LoadFile(file.c_str()), tinyxml2::XML_SUCCESS) << file;
  std::set<std::string> tags;
  collectTags(*document.RootElement(), tags);
  return tags;
}

// OpenSim is not at hand in a test; but a list tells which elements its own files hold where.
TEST(Elbow8, HoldsOnlyElementsThatOpenSimWritesInTheSamePlaces) {
  std::set<std::string> known;
  std::ifstream list(fixtures::reference("opensim/elements.txt"));
  for (std::string line; std::getline(list, line);) known.insert(line);
  EXPECT_GT(known.size(), 100u);
  for (const char* name : {"models/elbow8.osim", "models/elbow8_passive.osim"}) {
    for (const std::string& tag : tagsOf(root / name)) {
      EXPECT_TRUE(known.contains(tag)) << tag << " in " << name;
    }
  }
}

TEST(Elbow8, HasTheWholeArmWithOneFreeCoordinate) {
  const Model model = elbow8();
  EXPECT_EQ(model.bodies.size(), 12u);
  EXPECT_EQ(model.joints.size(), 12u);
  std::vector<std::string> freeOnes;
  for (const Joint& joint : model.joints) {
    for (const Coordinate& c : joint.coordinates) {
      EXPECT_EQ(c.defaultValue, 0);
      if (!c.locked) freeOnes.push_back(c.name);
    }
  }
  EXPECT_THAT(freeOnes, ElementsAre("elbow_flexion"));
  EXPECT_THAT(model.warnings, IsEmpty());
  // the passive curve's doubled knot, as its source has it (docs/decisions/006)
  EXPECT_THAT(model.remarks, testing::AllOf(testing::SizeIs(8),
                                            testing::Each(testing::HasSubstr("is there twice"))));
}

TEST(Elbow8, HasTheParametersOfTheSource) {
  struct Row {
    const char* muscle;
    double force, fibre, slack, pennation_deg;
  };
  const Row rows[] = {{"TRIlong", 771.8, 0.134, 0.143, 12},  {"TRIlat", 717.5, 0.1138, 0.098, 9},
                      {"TRImed", 717.5, 0.1138, 0.0908, 9},  {"ANC", 283.2, 0.027, 0.018, 0},
                      {"BIClong", 525.1, 0.1157, 0.2723, 0}, {"BICshort", 316.8, 0.1321, 0.1923, 0},
                      {"BRA", 1177.37, 0.0858, 0.0535, 0},   {"BRD", 276, 0.1726, 0.133, 0}};
  const Model model = elbow8();
  EXPECT_EQ(model.muscles.size(), std::size(rows));
  for (const Row& row : rows) {
    const Muscle& muscle = findMuscle(model, row.muscle);
    ASSERT_TRUE(muscle.schutte) << row.muscle;
    EXPECT_EQ(muscle.schutte->maxIsometricForce, row.force);
    EXPECT_EQ(muscle.schutte->optimalFibreLength, row.fibre);
    EXPECT_EQ(muscle.schutte->tendonSlackLength, row.slack);
    EXPECT_NEAR(muscle.schutte->pennation * 180 / std::numbers::pi, row.pennation_deg, 1e-6);
    EXPECT_EQ(muscle.schutte->damping, 0.017);
    EXPECT_EQ(muscle.schutte->timeScale, 0.1);
  }
  EXPECT_EQ(findWrapObject(model, "TRI").radius, 0.016);
  EXPECT_EQ(findWrapObject(model, "BIC_BRD").radius, 0.015);
  EXPECT_EQ(findBody(model, "hand").mass, 0.5819);
  EXPECT_EQ(findBody(model, "ulna").inertia[5], 0.00109169);
}

// Lengths of the brachialis computed elsewhere from the source's numbers; they agree to 7e-7 m.
TEST(Elbow8, BrachialisHasTheLengthsOfTheSource) {
  const Model model = elbow8();
  const Muscle& brachialis = findMuscle(model, "BRA");
  EXPECT_NEAR(straightLength(model, brachialis, 0), 0.1459324, 1e-6);
  EXPECT_NEAR(straightLength(model, brachialis, std::numbers::pi / 2), 0.1223674, 1e-6);
  EXPECT_NEAR(straightLength(model, brachialis, 2.26892803), 0.1059756, 1e-6);
}

TEST(Elbow8, StraightPathsAreAsLongAsInOpenSim) {
  const Table reference =
      readTable(fixtures::reference("opensim/elbow8_paths.csv"), TableKind::any);
  const Model model = elbow8();
  int compared = 0;
  for (Eigen::Index row = 0; row < reference.values.rows(); ++row) {
    const auto cell = [&](const std::string& column) {
      return reference.values(row, columnIndex(reference, column));
    };
    const double q = cell("elbow_flexion_deg") * std::numbers::pi / 180;
    for (const Muscle& muscle : model.muscles) {
      if (cell(muscle.name + ".wrapped") != 0) continue;
      if (q < 0 || cell("elbow_flexion_deg") > 108) continue;
      // The reference fixes the travelling point of the biceps at values rounded to 1e-7 m.
      const bool travels = muscle.name.starts_with("BIC");
      EXPECT_NEAR(straightLength(model, muscle, q), cell(muscle.name + ".length_m"),
                  travels ? 1e-7 : 2e-12)
          << muscle.name << " at " << cell("elbow_flexion_deg") << " deg";
      ++compared;
    }
  }
  EXPECT_GT(compared, 300);
}

TEST(Elbow8, ThePassiveVariantDiffersOnlyInItsLimitForces) {
  Model passive = readOsim(root / "models/elbow8_passive.osim");
  ASSERT_EQ(passive.limitForces.size(), 2u);
  const CoordinateLimitForce& ligaments = passive.limitForces[0];
  const double degree = std::numbers::pi / 180;
  EXPECT_NEAR(ligaments.upperLimit, 85 * degree, 1e-15);
  EXPECT_NEAR(ligaments.lowerStiffness * degree, 100, 1e-12);
  EXPECT_NEAR(passive.limitForces[1].damping, 0.09998, 1e-5);  // N m s/rad
  passive.limitForces.clear();
  passive.name = "elbow8";
  EXPECT_EQ(passive, elbow8());
}

}  // namespace
}  // namespace bio
