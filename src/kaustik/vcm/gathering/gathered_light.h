#pragma once
#include <atomic>

#include "kaustik/irradiance/hemisphere.h"
#include "kaustik/transport/path_class.h"
#include "kaustik/vcm/gathering/scattered_light.h"

namespace kaustik {

/// What gather rays need to know of a pass.
struct GatherInputs {
  const Scene& scene;
  const LightVertices& light;
  const SidedTree<LightVertexData>& focused;  ///< focused_vertices() of it
  float merge_radius_sq = 0;                  ///< of focused light at the ends of gather rays, m²
  int maximum_events = any_number_of_events;
  float shrinkage = 1;  ///< of the areas of disks since the first pass
};

/// Light that has been scattered diffusely before it arrives at a surface, along a ray: that which
/// the diffuse lobe of what the ray meets sends back. There direct light is sampled, focused light,
/// which only light paths find, merges in a disk, and light that was scattered before is looked up.
/// Where that is not known well enough, and by other lobes, the ray goes on as a path of path
/// tracing does. Lamps that paths meet do not count: direct and focused light are all that they
/// bring. Knows no light that media scatter.
class GatheredLight final : public RadianceSource {
 public:
  /// What `inputs` refer to must outlive this.
  explicit GatheredLight(const GatherInputs& inputs, const std::stop_token& stop = {});

  Incoming incoming(const SurfacePoint& from, const Vec3f& direction,
                    Sampler& sampler) const override {
    Scratch scratch;
    return incoming_through(nullptr, from, direction, sampler, scratch);
  }
  Incoming incoming_through(const Medium* medium, const SurfacePoint& from, const Vec3f& direction,
                            Sampler& sampler, Scratch& scratch) const override;
  /// By the flux of the light vertices around.
  bool importance(const SurfacePoint& at, const Frame& frame, const HemisphereGrid& grid,
                  Scratch& scratch, std::vector<float>& cell_importance) const override;
  /// Traced so far.
  uint64_t rays() const { return rays_.load(std::memory_order_relaxed); }

 private:
  Spectrum direct_light(const SurfaceVertex& vertex, const PathState& state, Sampler& sampler,
                        uint64_t& rays) const;
  /// Of what is not hidden.
  Spectrum focused_light(const SurfaceVertex& vertex, int events, Sampler numbers, uint64_t& rays,
                         Scratch& scratch) const;

  GatherInputs in_;
  ScatteredLight scattered_;               ///< empty: it is not looked up
  mutable std::atomic<uint64_t> rays_{0};  ///< a count alone; changes no result
};

}  // namespace kaustik
