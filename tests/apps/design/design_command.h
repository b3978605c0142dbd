#pragma once

#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "support/run_program.h"

/// A short search of `fisherhill design`, and what it says.
namespace designing {

inline nlohmann::json designSummary(const std::string& folder) {
  std::ifstream file(folder + "/summary.json");
  return nlohmann::json::parse(file);
}

inline support::ProgramResult design(const std::string& folder,
                                     std::vector<std::string> more = {}) {
  std::vector<std::string> arguments = {"design",
                                        "models/elbow8.osim",
                                        "emg_data/cocontraction.sto",
                                        "--parameters",
                                        "TRI.radius",
                                        "--candidates",
                                        "8",
                                        "--generations",
                                        "2",
                                        "--iterations",
                                        "0",
                                        "--out",
                                        folder};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return support::runFisherHill(arguments);
}

}  // namespace designing
