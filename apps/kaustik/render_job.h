#pragma once
#include <functional>
#include <optional>
#include <string>

#include "kaustik/loader/scene_format.h"
#include "kaustik/render/job.h"
#include "progress_display.h"
#include "view_options.h"

namespace kaustik::app {

/// Of scenes whose variables -D sets.
LoadOptions load_options(std::vector<std::pair<std::string, std::string>> definitions,
                         bool is_strict);

/// Reads a scene file, or standard input ("-"). Throws Error.
Description read_scene(const std::string& path, const LoadOptions& options);

/// The recipe's scene file with its definitions; the job makes the other changes.
Description load_description(const RenderRecipe& recipe);

/// The integrator that the recipe asks for, else the description's own; none: Kaustik's default.
std::optional<Object> integrator_of(const Description& description, const RenderRecipe& recipe);

/// To the terminal.
Messages terminal_messages();

/// What is told and shown of a command's work.
struct JobDisplay {
  ProgressStyle progress = ProgressStyle::none;
  bool quiet = false;  ///< no notes
  ViewOptions views;
};

/// Prepares the job and calls work(progress), with progress of a share of the work; if a signal
/// cancels it, and what was done so far is of no use (work() throws Error), throws EndedEarly.
void run_to_the_end(Job& job, const JobDisplay& display,
                    const std::function<void(const ProgressFunction&)>& work);

/// Renders with progress, keeps the checkpoint and writes the pictures of the settings' record, on
/// SIGUSR1 also as far as they are. `prepared` is called when the scene is built. Throws Error, of
/// all that could not be written, and EndedEarly.
void run_job(Description description, JobSettings settings, const JobDisplay& display,
             const std::function<void()>& prepared = {});

}  // namespace kaustik::app
