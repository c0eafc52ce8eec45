#pragma once
// Programs of Radiance that write scene descriptions, built in: no command is ever run.

#include <functional>
#include <optional>
#include <string>

#include "kaustik/loader/deviations.h"
#include "kaustik/loader/radiance/command_line.h"

namespace kaustik::radiance {

/// What the programs work with.
struct GeneratorContext {
  Place place;  ///< of the command
  /// The text of a file that a program names. Throws Error(input).
  std::function<std::string(const std::string& file)> read;
  /// The same of a part of the scene; "" where there is none, which is told.
  std::function<std::string(const std::string& file)> read_part;
  /// What the program before it in the line writes; nothing if there is none.
  std::optional<std::string> input;
  Deviations& deviations;
};

/// What the program writes, or nothing where it is not built in. Throws Error(input).
std::optional<std::string> run_generator(const Words& words, const GeneratorContext& context);

/// Those that are built in, with commas between; 'xform' among them.
std::string generator_names();

// The programs.
std::string generate_box(const Words& words, const GeneratorContext& context);
std::string generate_prism(const Words& words, const GeneratorContext& context);
std::string generate_revolution(const Words& words, const GeneratorContext& context);
std::string generate_worm(const Words& words, const GeneratorContext& context);
std::string generate_surface(const Words& words, const GeneratorContext& context);
std::string generate_blinds(const Words& words, const GeneratorContext& context);
/// CIE skies (gensky).
std::string generate_cie_sky(const Words& words, const GeneratorContext& context);
/// Skies by measured light, by the model of Perez (gendaylit).
std::string generate_perez_sky(const Words& words, const GeneratorContext& context);
std::string replace_marks(const Words& words, const GeneratorContext& context);

}  // namespace kaustik::radiance
