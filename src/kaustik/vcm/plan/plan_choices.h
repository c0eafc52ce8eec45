#pragma once

namespace kaustik {

/// Whether diffuse indirect light is cached where it is smooth.
enum class CacheUse {
  never,
  choose,  ///< where a pilot says that it pays
  always
};

/// What a pilot chooses, place by place.
struct PlanChoices {
  bool survival = true;       ///< how often paths go on; else all do
  bool light_samples = true;  ///< how many lights the vertex samples; else one
  CacheUse cache = CacheUse::choose;
};

}  // namespace kaustik
