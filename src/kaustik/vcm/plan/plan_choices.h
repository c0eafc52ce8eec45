#pragma once

namespace kaustik {

/// What a pilot chooses, place by place.
struct PlanChoices {
  bool survival = true;       ///< how often paths go on; else all do
  bool light_samples = true;  ///< how many lights the vertex samples; else one
};

}  // namespace kaustik
