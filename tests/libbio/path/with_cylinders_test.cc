#include "bio/path/with_cylinders.h"

#include <gtest/gtest.h>

#include "libbio/path/arm_paths.h"
#include "support/throws_saying.h"

namespace bio {
namespace {

using namespace fixtures;

// The arm with an ellipsoid whose odd semi-axis is this one.
Model armWithEllipsoid(int axis, const V& orientation, const std::string& quadrant) {
  Model model = system();
  for (WrapObject& wrap : model.wrapObjects) {
    if (wrap.name != "ellipsoid") continue;
    wrap.semiAxes.setConstant(0.016);
    wrap.semiAxes[axis] = 0.05;
    wrap.frame.orientation = orientation;
    wrap.quadrant = quadrant;
  }
  return model;
}

TEST(WithCylinders, PathsAreThoseOfEllipsoidsTakenForCylinders) {
  const ArmPath<1>::Q q(1.8);
  const std::vector<std::string> names = {"ellipsoid"};
  const V ordinary(-0.14, 0.05, 0.15);
  // With a cyclic change of axes, a frame without a turn and one about its new axes stand at
  // β = ±π/2, where two of the angles are one.
  for (const V& orientation : {ordinary, V(0, 0, 0), V(2.1, -0.9, -2.8), V(0.3, 0, 0)}) {
    for (const int axis : {0, 1, 2}) {
      for (const char* quadrant : {"all", "x", "-x", "y", "-y", "z", "-z"}) {
        if (*quadrant != 'a' && std::string(quadrant).back() == "xyz"[axis]) continue;
        const Model model = armWithEllipsoid(axis, orientation, quadrant);
        const Model with = withCylinders(model, names);
        const WrapObject& made = findWrapObject(with, "ellipsoid");
        EXPECT_EQ(made.shape, WrapShape::cylinder);
        EXPECT_EQ(made.radius, 0.016);
        EXPECT_EQ(made.length, 0.1);
        ArmPath<1> asked(model, extensor(names), names), found(with, extensor(names));
        EXPECT_NEAR(found.at(q).length, asked.at(q).length, 2e-16) << axis << quadrant;
        EXPECT_NEAR(found.at(q).dL_dq[0], asked.at(q).dL_dq[0], 2e-16) << axis << quadrant;
        EXPECT_EQ(found.at(q).wrapped, asked.at(q).wrapped);
        if (axis == 2) {  // its axes are the cylinder's: nothing is rounded
          EXPECT_EQ(made.frame, findWrapObject(model, "ellipsoid").frame);
          EXPECT_EQ(made.quadrant, quadrant);
          EXPECT_EQ(found.at(q).length, asked.at(q).length);
        }
      }
    }
  }
}

TEST(WithCylinders, LeavesTheOthersAlone) {
  Model model = system();
  EXPECT_EQ(withCylinders(model, {}), model);
  EXPECT_EQ(withCylinders(model, {"cylinder", "sphere"}), model);
  for (WrapObject& wrap : model.wrapObjects)
    if (wrap.name == "ellipsoid") wrap.semiAxes = {0.02, 0.02, 0.02};
  EXPECT_EQ(withCylinders(model, {"ellipsoid"}), model);  // a sphere
  const Model with = withCylinders(system(), {"ellipsoid"});
  ASSERT_EQ(with.remarks.size(), system().remarks.size() + 1);
  EXPECT_EQ(with.remarks.back(),
            "wrap object 'ellipsoid' is a cylinder in place of its ellipsoid, as asked");
}

TEST(WithCylinders, RefusesWhatIsNone) {
  support::throwsSaying([] { withCylinders(system(), {"odd"}); },
                        "its semi-axes are 0.016, 0.02 and 0.05 m, two must be equal");
  support::throwsSaying([] { withCylinders(system(), {"ball"}); }, "ball");
}

}  // namespace
}  // namespace bio
