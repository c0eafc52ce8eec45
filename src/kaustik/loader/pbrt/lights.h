#pragma once
// Lamps of pbrt.

#include <memory>
#include <optional>

#include "kaustik/loader/pbrt/graphics_state.h"
#include "kaustik/loader/pbrt/textures.h"

namespace kaustik::pbrt {

/// What makers of lamps work with.
struct LightTools {
  SceneFiles& files;
  Textures& textures;
  Spectra& spectra;
  Deviations& deviations;
  bool is_old = false;  ///< pbrt-v3 or older
};

/// LightSource: an emitter at the place of the transform; null: it is left out, which is told.
std::shared_ptr<Object> make_light(const LightTools& tools, const std::string& type,
                                   const ParameterList& list, const Owner& owner,
                                   const Transform& to_world);

/// AreaLightSource, on a shape whose area in the world is known or not. Null: it shines not.
std::shared_ptr<Object> make_area_light(const LightTools& tools, const AreaLight& light,
                                        const Owner& owner, std::optional<double> area);

}  // namespace kaustik::pbrt
