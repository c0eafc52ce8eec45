#pragma once
#include "kaustik/vcm/camera_path/connect.h"
#include "kaustik/vcm/camera_path/merge.h"
#include "kaustik/vcm/camera_path/merge_media.h"
#include "kaustik/vcm/camera_path/vertices.h"
#include "kaustik/vcm/camera_path/weights.h"

namespace kaustik {

/// A path from the camera, step by step: the walk that traces it, what multiple importance sampling
/// knows of it, and what light paths bring to it. It asks both; neither knows of the other but for
/// what it is told at a step.
class CameraPath {
 public:
  /// `inputs`, `sampler` and `sink` must outlive this; `plan` is that of the pixel.
  CameraPath(const CameraPathInputs& inputs, const PixelPlan& plan, const Vec2f& raster,
             Sampler& sampler, SampleSink& sink);
  /// A branch of the same path so far, to go on with numbers of its own.
  CameraPath(const CameraPath& stem, Sampler& sampler);
  CameraPath(const CameraPath&) = delete;
  CameraPath& operator=(const CameraPath&) = delete;

  /// Goes to the next vertex, and adds the light that is met and what merges with the segments in
  /// media. If nothing is to be scattered there, media take their share alone. `weights` weigh what
  /// is met; null: the path's own. Before the vertex counts, `split()` is called if the walk waits
  /// there, since light goes straight on in part.
  template <typename Split>
  CameraWalk::Arrival go_on(bool scatters_in_media, LightWeights* weights, const Split& split) {
    const CameraWalk::Arrival arrival = move(scatters_in_media, weights);
    if (arrival == CameraWalk::Arrival::nothing) return arrival;
    if (walk_.straight_chance() > 0) split();
    vertices_.arrive(walk_);
    return arrival;
  }
  CameraWalk::Arrival go_on(bool scatters_in_media, LightWeights* weights = nullptr) {
    return go_on(scatters_in_media, weights, [] {});
  }
  /// Adds light that is sampled from the vertex.
  void add_direct_light(LightWeights* weights = nullptr);
  /// Adds the diffuse indirect light that the cache has, which then nothing else adds.
  void ask_cache();
  /// Adds light of paths that are connected to the vertex.
  void connect() { connect_to_light_paths(in_, vertices_, walk_); }
  /// Adds light of paths whose vertices are near; on surfaces.
  void merge() { SurfaceMerging(in_, vertices_, walk_).merge(); }
  /// SurfaceMerging::merged_vertices()
  std::vector<SurfaceMerging::MergedVertex> merged_vertices() {
    return SurfaceMerging(in_, vertices_, walk_).merged_vertices();
  }
  /// The walk has chosen where to go on.
  void leave() { vertices_.leave(walk_); }
  /// Whether a path that ends behind the vertex that it has left must look for lamps there.
  bool may_end_at_lamp() const;
  /// Roulette of paths that have left the first vertex whose event is not delta. Those that it ends
  /// still meet the lamp that comes next, and no path's light from there counts more for it: where
  /// lamps are near, few paths that go on would find them, and count many times as much. False if
  /// there is nothing to go to.
  bool survives_first(float u);

  CameraWalk& walk() { return walk_; }
  CameraVertices& vertices() { return vertices_; }
  CameraPathWeights& weights() { return weights_; }
  const CameraPathInputs& inputs() const { return in_; }

 private:
  CameraWalk::Arrival move(bool scatters_in_media, LightWeights* weights);

  const CameraPathInputs& in_;
  CameraWalk walk_;
  CameraVertices vertices_;
  CameraPathWeights weights_;
};

/// A camera sample of a pixel with that plan, by all techniques that the weights of `inputs` know,
/// into `sink`.
void trace_camera_path(const CameraPathInputs& inputs, const PixelPlan& plan, const Vec2f& raster,
                       Sampler& sampler, SampleSink& sink);

}  // namespace kaustik
