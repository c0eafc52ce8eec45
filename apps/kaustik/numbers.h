#pragma once
#include <CLI/CLI.hpp>
#include <limits>

namespace kaustik::app {

// Checks of options, whose messages tell what is no number from what is out of range.

CLI::Validator whole_number(int64_t least, int64_t most);
/// Between the two, which may be infinite and are not allowed themselves.
CLI::Validator number_between(double low, double high);

}  // namespace kaustik::app
