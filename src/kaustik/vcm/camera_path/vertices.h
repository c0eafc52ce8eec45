#pragma once
#include <array>
#include <vector>

#include "kaustik/transport/camera_walk.h"
#include "kaustik/vcm/camera_path/inputs.h"

namespace kaustik {

/// The vertices of a camera path as multiple importance sampling sees them: what it has met, and
/// with which densities paths from both ends would. It looks at the walk, which knows nothing of
/// it.
class CameraVertices {
 public:
  /// `plan` is that of the path's pixel; `u_lens` tells where on the lens it begins.
  CameraVertices(const CameraPathInputs& inputs, const PixelPlan& plan, const LensNumbers& u_lens);
  /// The same path so far, for a branch of the walk.
  CameraVertices(const CameraVertices& stem, const CameraWalk& branch);

  /// The walk has come to its next vertex.
  void arrive(const CameraWalk& walk);
  /// The walk has chosen where to go on.
  void leave(const CameraWalk& walk);

  const PixelPlan& plan() const { return plan_; }
  /// The last vertex, until the walk goes on.
  const Scatterer& here() const { return here_; }
  const std::vector<PathVertex>& list() const { return vertices_; }
  bool empty() const { return vertices_.empty(); }
  /// Points and densities of the last vertex.
  const SurfacePoint& last_point() const { return last_; }  ///< without normals in a medium
  const Facing& last_facing() const { return last_facing_; }
  bool is_in_medium() const { return vertices_.back().mean_free_path > 0; }
  /// Density per solid angle of the way on from there, as it was sampled, and its direction.
  float pdf_of_way() const { return pdf_; }
  const Vec3f& direction() const { return direction_; }

  /// Whether the vertex is the first whose lobes are more than delta, for all that is known before
  /// leave().
  bool is_at_first() const { return all_delta_; }
  /// Whether the path has left the first vertex whose event is not delta, and gone no further.
  bool has_left_first() const { return first_ > 0 && first_ == vertices_.size(); }
  /// Whether it is on its way from there, and not all paths go that way.
  bool has_roulette_at_first() const {
    return has_left_first() && !is_in_medium() && survival() < 1;
  }
  /// The chance with which they do, in the direction that it has taken.
  float survival() const { return plan_.survival_toward(glossy_share_); }
  /// BsdfValues::glossy_share() of that direction.
  float glossy_share() const { return glossy_share_; }
  /// Lights that are sampled at the vertex.
  int light_samples() const;
  /// The same of the vertex that the path has left.
  int light_samples_before() const {
    return has_left_first() && !is_in_medium() ? plan_.light_samples : 1;
  }
  /// Of the disk of merging there, m.
  float merge_radius() const;

  // What follows the last vertex along the way on.
  PathVertex next(const Vec3f& position, const Facing& facing) const;
  PathVertex next_in_medium(const Vec3f& position, const Medium& medium) const;
  PathVertex next_infinitely_far() const;

  /// The camera's half of a path that ends here. If this is the first vertex whose event is not
  /// delta, PathHalves::first_survival is counted_survival_toward() the next one.
  PathHalves halves() const;
  float counted_survival_toward(const BsdfValues& values) const {
    return plan_.counted_survival(is_at_first() ? values.glossy_share() : glossy_share_);
  }
  /// The same with one vertex more, calling `weigh(halves)`.
  template <typename Weigh>
  float with(const PathVertex& next, const Weigh& weigh) {
    vertices_.push_back(next);
    const float weight = weigh(halves());
    vertices_.pop_back();
    return weight;
  }
  /// See PathVertex::pdf_light, of the vertex before the last, if light comes to the last one from
  /// `wi`; 0: there is no such vertex.
  float pdf_light_before(const Vec3f& wi) const;
  /// The same where Scatterer::pdf_reverse() of the last vertex is known.
  float pdf_light_before(const Vec3f& wi, float pdf_reverse) const;
  /// The last vertex as it asked for light.
  LightQuery weighed_query() const;

 private:
  void find_guides();

  const CameraPathInputs& in_;
  PixelPlan plan_;
  LensNumbers u_lens_;
  std::vector<PathVertex> vertices_;
  /// Density per solid angle with which light paths go back along the walk.
  struct GuidedBack {
    float unguided = 1;  ///< fraction of those that the bsdf sends …
    float guided = 0;    ///< … and density of the others
  };
  /// Of light that comes to the last vertex from the back (0) or the front (1).
  std::array<GuidedBack, 2> back_;
  Scatterer here_;
  SurfacePoint last_;
  Facing last_facing_;
  LightQuery previous_;  ///< of the last vertex
  float pdf_ = 0;
  Vec3f direction_{0, 0, 0};
  bool all_delta_ = true;   ///< events so far
  float glossy_share_ = 0;  ///< see glossy_share()
  size_t first_ = 0;        ///< number of the first vertex whose event is not delta; 0: none yet
};

}  // namespace kaustik
