#pragma once
#include <CLI/CLI.hpp>

#include "kaustik/scene/scene.h"

namespace kaustik::app {

/// Adds --texture-memory, which sets `build`'s budget. Both must live until the command has run.
void add_texture_memory(CLI::App& command, BuildOptions& build);

}  // namespace kaustik::app
