#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "support/run_program.h"
#include "support/scratch_folder.h"
#include "support/shipped_files.h"

/// What people type wrongly, subcommand by subcommand: a list of mistakes is an instance of
/// EveryMistake.
namespace mistakes {

using support::model;
using support::ScratchFolder;
using support::slow;

struct Mistake {
  std::string name;
  std::vector<std::string> arguments;  ///< $ stands for the scratch folder
  std::string message;                 ///< a part of the one line; $ as above
};

/// The files a mistake can use.
inline void writeFiles(const ScratchFolder& scratch) {
  scratch.file("good.csv", "time,BIClong\n0,0.1\n0.1,0.2\n0.2,0.1\n");
  scratch.file("nan.csv", "time,BIClong\n0,0.1\n0.1,nan\n0.2,0.1\n");
  scratch.file("high.csv", "time,BIClong\n0,0.1\n0.1,1.2\n0.2,0.1\n");
  scratch.file("negative.csv", "time,BIClong\n0,0.1\n0.1,-0.2\n0.2,0.1\n");
  scratch.file("extra.csv", "time,BIClong,GLUTmax\n0,0.1,0\n0.1,0.1,0\n");
  scratch.file("misspelt.csv", "time,BIClogn\n0,0.1\n0.1,0.1\n");
  scratch.file("torque_gap.csv", "time,BRA,elbow_flexion.torque\n0,0.1,1\n0.1,0.1,\n");
  scratch.file("torque_locked.csv", "time,BRA,pro_sup.torque\n0,0.1,1\n0.1,0.1,1\n");
  scratch.file("torque_of_nothing.csv", "time,BRA,knee.torque\n0,0.1,1\n0.1,0.1,1\n");
  scratch.file("force_on_an_angle.csv", "time,BRA,elbow_flexion.force\n0,0.1,1\n0.1,0.1,1\n");
  scratch.file("one_row.csv", "time,BIClong\n0,0.1\n");
  scratch.file("back.csv", "time,BIClong\n0,0.1\n0.2,0.1\n0.1,0.1\n");
  scratch.file("empty.csv", "");
  scratch.file("word.csv", "time,BIClong\n0,0.1\n0.1,much\n");
  scratch.file("text.osim", "no model\n");
  scratch.file("with_effect.osim",
               support::contentOf(std::string(FISHERHILL_SOURCE_DIR "/") + model));
  scratch.file("empty.toml", "");
  scratch.file("motion.csv", "time,elbow_flexion_deg\n0,30\n0.1,40\n");
}

class EveryMistake : public testing::TestWithParam<Mistake> {};

inline std::string nameOf(const testing::TestParamInfo<Mistake>& test) {
  return test.param.name;
}

}  // namespace mistakes
