#pragma once
#include <optional>

#include "kaustik/material/bsdf.h"

namespace kaustik {

/// A surface with holes: light meets the nested bsdf by the chance `opacity` and goes straight on
/// otherwise. With a cutoff it is there where the opacity is at least that.
std::shared_ptr<const Bsdf> make_mask(std::shared_ptr<const Bsdf> nested,
                                      std::shared_ptr<const Texture> opacity,
                                      std::optional<float> cutoff = {});

/// The bsdf; for `null`, which has no lobe, one that passes light as a delta event, so that a
/// mixture can choose it.
std::shared_ptr<const Bsdf> with_lobe(std::shared_ptr<const Bsdf> bsdf);

}  // namespace kaustik
