#pragma once

namespace kaustik {

/// How long the parts of a pass take, in rays of camera paths with all that is done at their ends:
/// what plans weigh variance against. `cost_tool` measures all but light_sample in scenes that ship
/// and prints its medians beside these.
struct CostModel {
  double merging = 1;  ///< of a vertex: finding what merges, and how far its disk is covered
  double merged_vertex = 0.008;  ///< of each light vertex that is added up there
  /// Of each ray of another sample of a light at the first vertex: an estimate.
  double light_sample = 0.65;
  double light_ray = 1.6;   ///< of a light path, its vertices sorted and learned from
  double gather_ray = 1.5;  ///< to fill a cache, with what is looked up where it ends
};
inline constexpr CostModel cost_model;

}  // namespace kaustik
