#pragma once
#include <cstdint>
#include <span>
#include <vector>

namespace kaustik {

/// Ways of finding a path.
struct Techniques {
  bool unidirectional = true;  ///< the camera's path meets the light
  bool next_event = true;      ///< its last vertex samples the light
  bool splats = false;         ///< a light path's vertex is connected to the camera
  bool connections = false;    ///< vertices of both paths are connected
  bool merging = false;        ///< a light path's vertex lies within a radius of a camera path's

  /// Whether light is found at all where the camera does not look straight at it.
  bool any() const { return unidirectional || next_event || needs_light_paths(); }
  /// Those of them that need no light paths.
  Techniques of_camera_paths() const {
    return {.unidirectional = unidirectional, .next_event = next_event};
  }
  /// Whether light paths are traced.
  bool needs_light_paths() const { return splats || connections || merging; }
};

/// A vertex of a path as the ways of finding it see it. Densities are per area, per volume in a
/// medium, and per solid angle at what is infinitely far away; given the vertex from which the path
/// comes. At delta events, whose chance is the same in both directions, that chance is left out of
/// both.
struct PathVertex {
  float pdf_camera = 0;   ///< with which paths from the camera find it
  float pdf_light = 0;    ///< with which paths from the lights find it
  float to_previous = 0;  ///< density per solid angle at the vertex to that of its predecessor (on
                          ///< the path that is followed)
  float spread = 1;       ///< see PathWeights; of the camera's path up to and with this vertex
  float mean_free_path = 0;  ///< 1/σ_t of the medium (mean over the lanes), m; 0: on a surface
  float merge_volume = 0;  ///< of merging in the medium, m³: what camera paths that are scattered
                           ///< in 1 m³ around the vertex have along their segments for it
  bool delta = false;      ///< the path is scattered here by a delta event
};

/// A path x₀ (the camera) … xₙ (on a light) in two halves with what meets between xₜ and xₜ₊₁.
struct PathHalves {
  std::span<const PathVertex> camera;  ///< x₁ … xₜ
  std::span<const PathVertex> light;   ///< xₙ … xₜ₊₁
  // What is known only now; it stands for what the vertices hold. (Where there is no such vertex:
  // anything.)
  float pdf_light_last = 0;          ///< of xₜ from xₜ₊₁
  float pdf_light_before_last = 0;   ///< of xₜ₋₁ from xₜ
  float pdf_camera_last = 0;         ///< of xₜ₊₁ from xₜ
  float pdf_camera_before_last = 0;  ///< of xₜ₊₂ from xₜ₊₁
  float pdf_next_event = 0;          ///< of sampling xₙ from xₙ₋₁; 0: never sampled there
  float first_merge_area = 0;        ///< see PathWeights::Settings
  float first_survival = 1;          ///< chance with which camera paths, once behind the first
                                     ///< vertex whose event is not delta, do more than meet a lamp
                                     ///< or the sky, and what merges in a medium on the way
  /// Lights that camera paths sample at that vertex, if it is on a surface. Splats need not know:
  /// their paths have an event after it.
  float first_light_samples = 1;
};

/// Multiple importance sampling over all ways of finding a path: how much the path counts where it
/// is found by one of them, so that the weights of all sum to 1 (power heuristic, Veach 1997).
/// Densities are those of Vertex Connection and Merging (Georgiev et al. 2012; Hachisuka et al.
/// 2012): expected numbers per path, those of n light paths and of merging included.
///
/// Merging at a vertex after the first pays where the camera's paths to it still lie close together
/// (a footprint in densities alone, no threshold of roughness): elsewhere one more event averages
/// over so much that what merging adds is not worth its time. How close is their spread, the
/// product of min(1, density · accepted area) over the vertices (after Grittmann et al. 2021);
/// merging is left out where it is less than `least_spread`.
///
/// In media light paths' vertices merge with the segments of camera paths, scattered there or not
/// (beam radiance estimate, Jarosz, Zwicker and Jensen 2008): a disk that is swept along a segment
/// finds what paths that are scattered on it find in the disk times the mean free path.
///
/// Left out as well: Russian roulette but that of the first vertex, which is on surfaces alone;
/// what media leave of light between the vertices; on paths of less than three segments splats,
/// connections and merging on surfaces, where light sampled or met by chance is better and has no
/// bias.
class PathWeights {
 public:
  struct Settings {
    Techniques techniques;
    float light_paths = 0;  ///< of a pass
    float connections = 0;  ///< expected number of times that a pair of a camera vertex and a
                            ///< vertex of one light path are connected
    /// Area of the disk of merging at vertices that the camera sees, directly or by delta events,
    /// comes with the path, since it is the pixel's; that of all others, m²:
    float merge_area = 0;
    /// At the first vertex in a medium merging counts by this: the samples of a pixel share what
    /// they find.
    float first_medium_share = 1;
    float accepted_area = 0;  ///< of the disk within which paths count as close, m²
    float least_spread = 0.1f;
  };
  PathWeights() = default;
  explicit PathWeights(const Settings& settings) : settings_(settings) {}
  const Settings& settings() const { return settings_; }

  /// `path.camera` holds x₁ … xₙ; no light half. pdf_light_last is that of the light's point,
  /// pdf_light_before_last that of xₙ₋₁ by emission from there.
  float unidirectional(const PathHalves& path) const;
  /// The light half is xₙ.
  float next_event(const PathHalves& path) const;
  /// No camera half.
  float splat(const PathHalves& path) const;
  float connection(const PathHalves& path) const;
  /// Of a light path's vertex at xₜ; the light half begins behind it. pdf_light_last is the density
  /// of the vertex that merges.
  float merge(const PathHalves& path) const;
  /// Squared densities of all that camera paths find by going on from there, relative to that of
  /// merge().
  float beyond_merge(const PathHalves& path) const;

  /// What merge() takes from the light path alone, whatever surface its vertex merges with.
  struct LightTail {
    float pdf_light = 0;    ///< of the vertex that merges …
    float to_previous = 0;  ///< … see PathVertex
    /// Squared densities relative to merging on unit_area(): of connecting it to the one before; of
    /// what paths find by going on from there without merging, for a density of 1 per solid angle
    /// to do so.
    float connection = 0, square = 0;
    float spread_length = 1;  ///< mean free path of the vertex before, m; 1: it is on a surface
    uint32_t merges = 0;      ///< of the LaterMerge …
    uint32_t count = 0;       ///< … those from there on
  };
  /// The same of merging at one vertex beyond.
  struct LaterMerge {
    float square = 0;
    float spread = 1;  ///< at that vertex, relative to the spread at the first one beyond
  };
  /// `path`: as for merge(), with any one vertex as the camera half; pdf_camera_last for a density
  /// of 1 per solid angle. Adds what is merged beyond, from the vertex on.
  LightTail light_tail(const PathHalves& path, std::vector<LaterMerge>& merges) const;
  /// The same as merge(path), from what is known of the light path: of its vertices only the number
  /// is looked at, and neither are pdf_camera_before_last and pdf_next_event. `merges` are those of
  /// the tail.
  float merge(const PathHalves& path, const LightTail& tail,
              std::span<const LaterMerge> merges) const;

  /// What the weight of merging at a matt first vertex takes from the light path alone: squared
  /// densities relative to merging on unit_area(), so that they are of no scale.
  struct MattMerge {
    float connection = 0;  ///< of connecting the camera's vertex to the one before
    float beyond = 0;      ///< of all that paths find by going on from the camera's vertex
  };
  /// `path`: as for merge(), with any one vertex as the camera half and no roulette there;
  /// pdf_camera_last by the surface that the light path met, as if the camera's vertex lay there.
  MattMerge matt_merge(const PathHalves& path) const;
  /// What stands for the rest: 1/(base + connection · on_connection + beyond · on_beyond) is
  /// merge() of a first vertex with a matt surface.
  struct MattVertex {
    float base = 1, on_connection = 0, on_beyond = 0;
  };
  /// `camera`, `merge_area` and `survival` as in PathHalves.
  MattVertex matt_vertex(std::span<const PathVertex> camera, float merge_area,
                         float survival) const;

  /// Whether vertices merge at the last of `camera`.
  bool merges_at(std::span<const PathVertex> camera) const;

  /// PathVertex::spread of `vertex`, found with density `pdf` after one of `spread`. In media paths
  /// spread across their direction.
  float spread_after(float spread, float pdf, const PathVertex& vertex, bool after_delta) const {
    if (after_delta) return spread;
    return spread * accepted(vertex.mean_free_path > 0 ? pdf * vertex.mean_free_path : pdf);
  }

 private:
  /// Settings::merge_area, m²; 1 if there is none.
  float unit_area() const { return settings_.merge_area > 0 ? settings_.merge_area : 1.0f; }
  float accepted(float pdf) const {
    const float chance = pdf * settings_.accepted_area;
    return chance < 1 ? chance : 1.0f;
  }
  class View;
  float weight(const View& path, float own_density) const;
  // Sums of squares of densities times `scale`: of the techniques that meet at x_i or between x_i
  // and x_i+1; of those that meet beyond x_t and before it.
  float squares_at(const View& path, size_t i, float scale, float camera_spread) const;
  float squares_beyond(const View& path, float scale) const;
  float squares_before(const View& path, float scale) const;

  Settings settings_;
};

}  // namespace kaustik
