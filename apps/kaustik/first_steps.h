#pragma once
#include <CLI/CLI.hpp>
#include <string>

namespace kaustik::app {

/// What the program says to who gives it no command: what it is, how to start, its commands, where
/// the manual is. Fits on a small terminal.
std::string first_steps(const CLI::App& program);

}  // namespace kaustik::app
