#pragma once
#include <chrono>
#include <optional>

#include "kaustik/loader/load_options.h"
#include "kaustik/render/checkpoint.h"
#include "kaustik/render/session.h"

namespace kaustik::app {

/// A scene as a recipe asks for it, ready to be rendered.
struct RenderJob {
  /// Of the files as they were before the scene was built; none: it was not asked for.
  std::optional<DescriptionDigest> digest;
  std::shared_ptr<const Scene> scene;
  std::unique_ptr<Integrator> integrator;
  ViewFacts view;
};

/// Says how much memory large meshes will take, before they are read.
void tell_of_memory(const Description& description);

/// Reads a scene file, or standard input ("-"). Throws Error.
Description read_scene(const std::string& path, const LoadOptions& options);

/// Takes another integrator than the file's, and tells what the file says that it has no use for.
void use_integrator(Description& description, const std::string& type);

/// The recipe's scene file with its definitions and its integrator, before its settings.
Description load_description(const RenderRecipe& recipe);

/// Applies the recipe's settings and builds the scene; what is odd about it is told. The digest
/// reads every file of the scene once more: only checkpoints are worth it. Throws Error.
RenderJob make_job(Description description, const RenderRecipe& recipe, bool with_digest,
                   const BuildOptions& build = {});

/// How a session is watched and kept.
struct JobOptions {
  bool quiet = false;
  std::string checkpoint;  ///< file; "": none
  double every_s = 30;     ///< between two checkpoints
  /// From when on the session's time counts.
  std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();
};

/// Renders with progress, keeps the checkpoint and writes the pictures; goes on with `begun` if it
/// is there. A checkpoint needs the job's digest. What `record` lacks is filled in: samples per
/// pass, plan, digest, view. Throws Error, of all that could not be written, and EndedEarly.
void run_job(const RenderJob& job, RenderRecord record, SessionSettings settings,
             std::optional<Film> begun, const JobOptions& options);

}  // namespace kaustik::app
