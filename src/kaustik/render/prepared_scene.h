#pragma once
#include <memory>
#include <optional>

#include "kaustik/render/checkpoint.h"
#include "kaustik/render/messages.h"
#include "kaustik/transport/integrator.h"

namespace kaustik {

/// A scene and what renders it, from a description.
struct PreparedScene {
  std::shared_ptr<const Scene> scene;
  std::unique_ptr<Integrator> integrator;
  ViewFacts view;
  /// Of the files as they were before the scene was built; none: it was not asked for.
  std::optional<DescriptionDigest> digest;
};

/// Makes the changes of a recipe, once: its integrator, then its settings. They change the
/// description's objects. `integrator_origin`: who asks for the recipe's integrator, for messages.
/// Throws Error.
void apply_changes(Description& description, const RenderRecipe& recipe, const Messages& messages,
                   const std::string& integrator_origin = "integrator");

/// Says how much memory large meshes will take, before they are read.
void tell_of_memory(const Description& description, const Messages& messages);

/// Builds the scene, sharing with `previous` (null: none) what is the same; what is odd about it is
/// told. Throws Error.
std::shared_ptr<const Scene> build_scene_and_tell(
    const Description& description, const BuildOptions& build, const Messages& messages,
    const std::shared_ptr<const Scene>& previous = nullptr);

/// The same with the integrator that the description asks for. The digest reads every file of the
/// scene once more: only checkpoints are worth it. Throws Error.
PreparedScene prepare_scene(const Description& description, const BuildOptions& build,
                            bool with_digest, const Messages& messages,
                            const std::shared_ptr<const Scene>& previous = nullptr);

}  // namespace kaustik
