#include "score/repaired_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "support/scratch_folder.h"
#include "validation/labels_and_verdicts.h"

namespace hidden {
namespace {

TEST(RepairedTable, HasALineForEverySetWithWhatTheRepairedModelIsSaidToLack) {
  const support::ScratchFolder folder;
  const auto write = [&](const std::string& name, const Json& json) {
    const auto file = folder.path() / name;
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file) << json.dump();
  };
  Json truth = truthOf("visc", 0.3);
  truth["amplitude"] = 0.3;
  truth["unit"] = "N m s";
  write("labels/x.json", labelOf("single", Json::array({truth})));
  Json verdict = verdictOf("named", Json::array({effectOf("visc", "structure", 0.99, 0.29, 0.02)}),
                           Json::array({"visc"}));
  verdict["gap"] = {{"held_out", {{"gap_closed", 0.985}, {"gap_closed_from_nominal", nullptr}}}};
  verdict["wall_s"] = 12;
  write("verdicts/x/verdict.json", verdict);
  const auto table = [&] {
    return repairedTable(folder.path() / "labels", folder.path() / "verdicts",
                         folder.path() / "repaired");
  };
  EXPECT_THAT(table(),
              testing::EndsWith("\n| x | visc 0.3 N m s | named; visc 0.29 ± 0.02 N m s | -0.50 | "
                                "98.5 % | no gap | no verdict | 12 |\n"));
  write("repaired/x/verdict.json", verdictOf("none", Json::array()));
  EXPECT_THAT(table(), testing::HasSubstr("| none | 12 |"));
}

}  // namespace
}  // namespace hidden
