#include "robot_options/discover_robot.h"

namespace app {

void addRobotOptions(CLI::App& options, RobotRequest& request) {
  options
      .add_option("--system", request.system,
                  "a robot in place of MODEL: double-pendulum (columns time, input [m/s^2, the "
                  "cart's commanded acceleration], link1_deg and link2_deg [absolute angles from "
                  "hanging down; or _rad]) or suspended-mass (time, input, force_N)")
      ->check(CLI::IsMember({"double-pendulum", "suspended-mass"}))
      ->type_name("NAME");
  options
      .add_option("--with", request.with,
                  "with --system: a with_effect.json whose effects are added to the model")
      ->check(CLI::ExistingFile)
      ->type_name("FILE");
}

}  // namespace app
