#pragma once
#include <optional>
#include <vector>

#include "kaustik/base/parameters.h"

namespace kaustik {

/// A parameter of the photon map integrator with its default, and the one of `preset` = thesis
/// (Schregle 1998, appendix A) where that tells one.
struct PhotonMapParameter {
  Parameter parameter;
  std::optional<Value> in_thesis = std::nullopt;
};

const std::vector<PhotonMapParameter>& photon_map_parameters();

}  // namespace kaustik
