#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "support/run_program.h"

namespace support {

/// `fisherhill replay` of a model on every trial that a verdict.json or a summary.json lists must
/// give the root mean square error it has there, to 0.01 deg, with the
/// start and the step that the model has.
inline void expectReplaysAgree(const std::string& model, const nlohmann::json& trials,
                               double step) {
  ASSERT_FALSE(trials.empty());
  for (const auto& one : trials) {
    const std::string file = one["replay_file"];
    const ProgramResult replay = runFisherHill({"replay", model, file, "--json"});
    ASSERT_EQ(replay.status, 0) << replay.err;
    const auto told = nlohmann::json::parse(replay.out);
    EXPECT_NEAR(told["rms_error_deg"].get<double>(), one["rmse_after_deg"].get<double>(), 0.01)
        << file;
    EXPECT_EQ(told["start_from"], "model") << file;
    EXPECT_EQ(told["step_s"], step) << file;
  }
}

/// Of the trials of one role, weighted alike: the trials of one set are equally long.
inline double pooled(const nlohmann::json& trials, const std::string& role) {
  double sum = 0, count = 0;
  for (const auto& one : trials) {
    if (one["role"] != role) continue;
    sum += std::pow(one["rmse_after_deg"].get<double>(), 2);
    ++count;
  }
  return std::sqrt(sum / count);
}

}  // namespace support
