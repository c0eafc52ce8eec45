#pragma once
// Mixtures of textures as mixtures of bsdfs: what reflects is linear in its colours, and Kaustik
// mixes bsdfs.

#include <memory>
#include <string>

#include "kaustik/loader/deviations.h"
#include "kaustik/loader/pbrt/described.h"

namespace kaustik::pbrt {

/// Two textures or values, the second one to the share of `amount`: a value where all are, else a
/// texture of the type 'mix', which without_mixes() takes away again.
Input mixed(const Input& first, const Input& second, const Input& amount, const Place& place);

/// The bsdf without such textures: blends of bsdfs stand for them. `object` is what has it, for
/// what is told where there are too many.
std::shared_ptr<Object> without_mixes(std::shared_ptr<Object> bsdf, const std::string& object,
                                      Deviations& deviations);

}  // namespace kaustik::pbrt
