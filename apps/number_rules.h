#pragma once

#include <CLI/CLI.hpp>

/// What numbers on the command line must be, said in the same words everywhere; NaN and infinity
/// break each of these rules.
namespace app {

CLI::Validator finite();
CLI::Validator positive();
CLI::Validator notNegative();
CLI::Validator between(double low, double high);

}  // namespace app
