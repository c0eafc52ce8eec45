#pragma once
#include "kaustik/loader/scene_format.h"
#include "kaustik/render/job.h"

namespace kaustik::app {

/// Reads a scene file, or standard input ("-"). Throws Error.
Description read_scene(const std::string& path, const LoadOptions& options);

/// The recipe's scene file with its definitions and its integrator, before its settings.
Description load_description(const RenderRecipe& recipe);

/// Takes another integrator than the file's, and tells what the file says that it has no use for.
void use_integrator(Description& description, const std::string& type);

/// To the terminal.
Messages terminal_messages();

/// Renders with progress, keeps the checkpoint and writes the pictures of the settings' record.
/// `prepared` is called when the scene is built. Throws Error, of all that could not be written,
/// and EndedEarly.
void run_job(Description description, JobSettings settings, bool quiet,
             const std::function<void()>& prepared = {});

}  // namespace kaustik::app
