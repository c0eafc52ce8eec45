#pragma once
#include <optional>
#include <string>

#include "kaustik/loader/load_options.h"

namespace kaustik::gltf {

/// Whether transparent materials are panes or bodies.
enum class Glass {
  automatic,  ///< bodies where the material has a thickness or the mesh is closed
  solid,      ///< always bodies
  thin        ///< always panes
};

/// What the user may define for files of glTF.
struct Options {
  Glass glass = Glass::automatic;   ///< gltf.glass: auto, solid, thin
  double lamp_efficacy = 179;       ///< gltf.lamp_efficacy, lm/W: of lamps in cd and lx
  std::string variant = {};         ///< gltf.variant: of KHR_materials_variants; "": the first
  std::optional<double> time = {};  ///< gltf.time, s: of an animation; none: nothing moves
  std::string animation = {};       ///< gltf.animation: its name; "": the first
};

/// Throws Error(input) for definitions that are none of these.
Options options_of(const LoadOptions& options);

}  // namespace kaustik::gltf
