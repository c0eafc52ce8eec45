#pragma once
#include <array>
#include <optional>
#include <vector>

#include "kaustik/photon/lane_draw.h"
#include "kaustik/transport/camera_walk.h"
#include "kaustik/transport/path_weights.h"
#include "kaustik/vcm/lessons/light_path_emission.h"
#include "kaustik/vcm/light_vertices.h"
#include "kaustik/vcm/merging/matt_merging.h"
#include "kaustik/vcm/merging/medium_disks.h"
#include "kaustik/vcm/plan/pixel_plans.h"

namespace kaustik {

class DiskCoverage;
class MergeDisk;

/// What camera paths of a pass share.
struct VcmCameraInputs {
  const Scene& scene;
  const LightPathEmission& emission;
  const PathWeights& weights;
  const LightVertices& light;
  const MattMerging& matt;
  const PixelPlans& pixels;
  float camera_samples;    ///< per pixel
  float connection_scale;  ///< of a connected vertex: vertices over paths and connections
  float merge_radius_sq;   ///< at vertices that the camera does not see
  MediumDisks media = {};
  int maximum_events = 1 << 20;
  const ScatterGuide* scattering = nullptr;  ///< of light paths; null: not guided
  bool visibility = true;                    ///< what is hidden does not merge
};

/// A camera walk's vertices as multiple importance sampling sees them, and what light paths bring
/// to them; as a VolumeLight what merges with the segment that the walk is on in a medium.
class VcmCameraPath final : public LightWeights, public VolumeLight {
 public:
  /// `walk` must not have gone anywhere; `plan` is that of its pixel.
  VcmCameraPath(const VcmCameraInputs& inputs, CameraWalk& walk, const PixelPlan& plan);

  /// The same path so far for a branch of the walk. Until that is done, `other` must not go on;
  /// this takes back what it did to what they share.
  VcmCameraPath(const VcmCameraPath& other, CameraWalk& branch);
  ~VcmCameraPath() { vertices_.resize(vertices_before_); }
  VcmCameraPath(const VcmCameraPath&) = delete;
  VcmCameraPath& operator=(const VcmCameraPath&) = delete;

  /// Takes the walk to its next vertex, and adds what merges with its segments in media. If
  /// nothing is to be scattered there, media take their share alone.
  CameraWalk::Arrival go_on(bool scatters_in_media);
  /// The walk has chosen where to go on.
  void leave();
  /// Adds light of paths that are connected to the vertex, `count` of them.
  void connect(int count);
  /// Adds light of paths whose vertices are near; on surfaces.
  void merge();
  /// A light vertex that merges with the vertex, and what it sends on as if no other way found it.
  struct MergedVertex {
    float beyond;  ///< PathWeights::beyond_merge()
    Spectrum light;
  };
  /// All that are wanted, for who must know more than the sum.
  std::vector<MergedVertex> merged_vertices() const;
  /// Whether the vertex is the first whose lobes are more than delta, for all that is known before
  /// leave().
  bool is_at_first() const { return all_delta_; }
  /// From now on, or no longer, light is weighed as if there were no light paths.
  void leave_out_light_paths(bool leave_out) { no_light_paths_ = leave_out; }
  /// Whether the path has left the first vertex whose event is not delta, and gone no further.
  bool has_left_first() const { return first_ > 0 && first_ == vertices_.size(); }
  /// Whether a path that ends behind the vertex that it has left must look for lamps there.
  bool may_end_at_lamp() const {
    return in_.scene.has_scattering() ||
           (in_.weights.settings().techniques.unidirectional && in_.scene.has_lights_to_meet());
  }
  /// Roulette of paths that have left the first vertex whose event is not delta. Those that it ends
  /// still meet the lamp that comes next, and no path's light from there counts more for it: where
  /// lamps are near, few paths that go on would find them, and count many times as much. False if
  /// there is nothing to go to.
  bool survives_first(float u);

  float sampled(const Scatterer& vertex, const DirectLight& light) const override;
  float met(int light, const SurfaceVertex& vertex) const override;
  float met(int light, const Ray& ray) const override;
  Spectrum radiance(const Ray& ray, float length, const Medium& medium, const Sampler& sampler,
                    uint64_t& rays) const override;

 private:
  /// What merges with the vertex, before it is divided by the area of the disk and the number of
  /// light paths.
  struct MergedLight {
    std::array<Spectrum, component_count> of{};  ///< by component
    Spectrum narrow;  ///< of all that is wanted, within the narrow disk: MattLight::narrow

    bool is_zero() const;
    void scale(float factor);
  };
  /// What one light vertex adds to that.
  struct MergedPart {
    Vec3f offset;  ///< from the vertex
    Component component;
    Spectrum light;
  };
  /// What a disk of merging weighs light vertices by: kernels for the disk and for the narrow one
  /// in it.
  struct DiskWeights {
    DiskBounds bounds;
    DiskKernel wide, narrow;
  };
  static std::vector<MergedPart>& empty_parts();
  /// Of a disk around the vertex.
  DiskBounds disk_bounds(float radius) const;
  DiskWeights disk_weights(const MergeDisk& disk, const DiskBounds& bounds) const;
  /// Both leave in their last argument, if there is one, what makes up MergedLight::of.
  MergedLight merged_matt(const MergeDisk& disk, const DiskWeights& weights,
                          std::vector<MattMerging::Factors>* each) const;
  MergedLight merged(const MergeDisk& disk, const DiskWeights& weights, Lobes lobes,
                     std::vector<MergedPart>* each) const;
  /// The same, as far as it is not hidden from the vertex.
  MergedLight reached_matt(const MergeDisk& disk, const DiskWeights& weights,
                           const DiskCoverage& covered) const;
  MergedLight reached(const MergeDisk& disk, const DiskWeights& weights, Lobes lobes,
                      const DiskCoverage& covered) const;
  /// A draw for each component that has light.
  using Draws = std::array<std::optional<LaneDraw>, component_count>;
  Draws draws_of(const MergedLight& light) const;
  /// Leaves what is_reached(part) holds for of those drawn.
  template <typename IsReached>
  static void leave_drawn(const Draws& draws, const IsReached& is_reached, MergedLight& light);
  /// visit(vertex, its flux as far as it counts, how far it lies from the disk's, direction to
  /// where it comes from, bsdf, path) for all that merge; where they are many, for one of
  /// `most_parts` parts of them at most, which is drawn and counts for all.
  template <typename Visit>
  void visit_merging(const MergeDisk& disk, uint32_t most_parts, const Visit& visit) const;
  float merge_radius() const;
  /// Of what follows the last vertex, along the walk's ray.
  PathVertex next_vertex(const Vec3f& position, const Facing& facing) const;
  PathVertex next_in_medium(const Vec3f& position, const Medium& medium) const;
  PathVertex infinitely_far() const;
  void arrive();
  void find_guides();
  bool has_roulette_at_first() const {
    return has_left_first() && !is_in_medium() && plan_.survival < 1;
  }
  /// Density per solid angle with which a light path goes on from its vertex `at`.
  float pdf_of_light(const Scatterer& at, const Vec3f& to) const;
  /// How far from the last vertex segments in media merge, m.
  float merging_length() const;
  /// Weight of merging with `light`, which lies beside `at`, the last vertex.
  float medium_merge_weight(const MergeableMediumVertex& light, float phase,
                            float phase_back) const;
  void connect_to(const ConnectibleVertex& to);
  PathHalves halves() const;
  /// See PathVertex::pdf_light, of the vertex before the last, if light comes to the last one from
  /// `wi`; 0: there is no such vertex.
  float pdf_light_before(const Vec3f& wi) const;
  /// The same where Scatterer::pdf_reverse() of the last vertex is known.
  float pdf_light_before(const Vec3f& wi, float pdf_reverse) const;
  /// Whether light is only sampled and met by chance on paths of this many segments.
  bool path_tracing_alone(size_t length) const;
  /// The last vertex as it asked for light.
  LightQuery weighed_query() const {
    LightQuery query = previous_;
    query.level = vertices_.size() > 1 ? 1 : 0;
    return query;
  }
  bool is_in_medium() const { return vertices_.back().mean_free_path > 0; }
  /// Weight of meeting the light at `on_light`; `to_last` turns a density per solid angle there
  /// into that of the last vertex.
  float met_weight(const PathVertex& on_light, const EmissionDensity& emission, float to_last,
                   float next_event) const;

  const VcmCameraInputs& in_;
  CameraWalk& walk_;
  PixelPlan plan_;
  std::vector<PathVertex>& vertices_;  ///< those of branches come after those of their stem
  size_t vertices_before_;             ///< its size when this was made
  /// Density per solid angle with which light paths go back along the walk.
  struct GuidedBack {
    float unguided = 1;  ///< share of those that the bsdf sends …
    float guided = 0;    ///< … and density of the others
  };
  /// Of light that comes to the last vertex from the back (0) or the front (1).
  std::array<GuidedBack, 2> back_;
  Scatterer here_;         ///< the walk's last vertex, until the walk goes on
  SurfacePoint last_;      ///< of that vertex, without normals in a medium
  Facing last_facing_;     ///< of that vertex
  LightQuery previous_;    ///< of the last vertex
  bool all_delta_ = true;  ///< events so far
  bool no_light_paths_ = false;
  size_t first_ = 0;  ///< number of the first vertex whose event is not delta; 0: none yet
};

}  // namespace kaustik
