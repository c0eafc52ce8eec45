#include "texture_memory.h"

namespace kaustik::app {

void add_texture_memory(CLI::App& command, BuildOptions& build) {
  command
      .add_option_function<int64_t>(
          "--texture-memory",
          [&build](const int64_t& bytes) { build.texture_memory_bytes = bytes; },
          "Memory that the scene's pictures may take, such as 800MB or 4GB [half of the machine's]")
      ->transform(CLI::AsSizeValue(false))
      ->check(CLI::NonNegativeNumber)
      ->type_name("SIZE");
}

}  // namespace kaustik::app
