#pragma once

#include <CLI/CLI.hpp>

/// Validators for numbers on the command line, with uniform messages; NaN and infinity fail each of
/// them.
namespace app {

CLI::Validator finite();
CLI::Validator positive();
CLI::Validator notNegative();
/// From 0 to 2⁶⁴ − 1.
CLI::Validator wholeNumber();
CLI::Validator between(double low, double high);

}  // namespace app
