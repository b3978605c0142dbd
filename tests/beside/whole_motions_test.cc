// OpenSim's motions of 4.5 s from its own tables, with the models that OpenSim had. The first 1.5 s
// of them, and of one with De Groote's class, whose curve has a pole that CVODE meets at 2.2 s, are
// in tests/libbio/reference/opensim.
#include "libbio/simulation/opensim_motion.h"

namespace bio {
namespace {

TEST(WholeMotions, CvodeMovesAsOpenSimDoes) {
  const std::filesystem::path beside = std::string(FISHERHILL_SOURCE_DIR) + "/../shared";
  const std::filesystem::path reference = beside / "reference", tables = reference / "opensim";
  std::vector<fixtures::OpenSimMotion> motions;
  for (const std::string trial : {"101", "116"}) {
    motions.push_back({"Schutte " + trial, reference / "elbow8_reference.osim",
                       reference / ("excitations_" + trial + ".sto"),
                       reference / ("forward_" + trial + ".csv"), "elbow_flexion_rad",
                       ".fiber_length_m", ".tendon_force_N"});
  }
  const auto add = [&](const std::string& table, const std::string& model,
                       const std::string& trial) {
    motions.push_back({table + " " + trial, beside / ("data/models/opensim/" + model + ".osim"),
                       tables / ("excitations_elbow8_" + trial + ".sto"),
                       tables / ("forward_elbow8_" + table + "_" + trial + ".csv"),
                       "elbow_flexion_value", "_fiber_length", "_tendon_force"});
  };
  add("Thelen", "elbow8_Thelen", "201");
  add("Millard", "elbow8_Millard", "201");
  for (const fixtures::OpenSimMotion& motion : motions) {
    const auto exact = fixtures::differenceFrom(motion, Integrator::cvode, 0.01);
    EXPECT_LT(exact.angle_deg, 0.05) << motion.name;
    EXPECT_LT(fixtures::differenceFrom(motion, Integrator::variational, 0.01).angle_deg, 0.15)
        << motion.name;
    if (!motion.name.starts_with("Schutte")) continue;
    // of the others a row next to a jump of BRA's path may lie on its other side: tens of newtons
    EXPECT_LT(exact.fibre_m, 5e-5) << motion.name;
    EXPECT_LT(exact.force_N, 1.0) << motion.name;
  }
}

}  // namespace
}  // namespace bio
