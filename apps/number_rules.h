#pragma once

#include <CLI/CLI.hpp>

/// What numbers on the command line must be, said in the same words everywhere; NaN and infinity
/// break each of these rules.
namespace app {

CLI::Validator finite();
CLI::Validator positive();
CLI::Validator notNegative();
/// From 0 to 2⁶⁴ − 1.
CLI::Validator wholeNumber();
CLI::Validator between(double low, double high);

}  // namespace app
