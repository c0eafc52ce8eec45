#pragma once
#include <CLI/CLI.hpp>
#include <string>

#include "command_tree.h"

namespace kaustik::app {

// Pages of section 1 for man, in the macros of man(7); the same for the same program.

/// kaustik-render(1) and the like.
std::string man_page(const CommandText& command);
/// kaustik(1): which commands there are.
std::string man_page_of_program(const CLI::App& program);

}  // namespace kaustik::app
