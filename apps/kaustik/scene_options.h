#pragma once
#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace kaustik::app {

// Options of all commands that read a scene.

/// Scenes are written in one format: another suffix would promise another one. Throws Error(input).
void check_scene_name(const std::string& output);

/// The scene file itself, the first argument.
void add_scene(CLI::App& command, std::string& scene);
/// --threads; 0: all.
void add_threads(CLI::App& command, int& threads);
/// -D: "name=value" for parse_definitions().
void add_definitions(CLI::App& command, std::vector<std::string>& definitions);
/// --camera.
void add_camera(CLI::App& command, std::string& camera);
/// --strict.
void add_strict(CLI::App& command, bool& is_strict);
/// --set: "object.parameter=value", and --spectral, which is one of them; `examples` are for
/// people.
void add_settings(CLI::App& command, std::vector<std::string>& settings,
                  const std::string& examples);

/// What messages call the option.
inline constexpr const char* integrator_origin = "command line: --integrator";
/// Kaustik's own, for --integrator.
std::vector<std::string> integrator_names();
/// Those of them that learn from their passes.
const std::vector<std::string>& learning_integrators();

}  // namespace kaustik::app
