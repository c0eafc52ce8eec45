#pragma once
#include "kaustik/transport/direct_light.h"
#include "kaustik/transport/light_path.h"
#include "kaustik/transport/scatterer.h"
#include "kaustik/vcm/light_pass.h"

namespace kaustik {

/// A light path under way: its vertices so far as multiple importance sampling sees them.
struct LightPathUnderWay {
  std::vector<PathVertex> vertices;  ///< from the light's point on
  LightPathStart start;
  Facing last;               ///< of the last vertex; zero at a point without a surface
  float pdf_next_event = 0;  ///< see PathHalves; known from the second vertex on
  bool kept = false;         ///< some vertex may be merged or connected
  /// The last vertex as what is learned there; without a normal where nothing is.
  LightScattering scattering;
};

/// The light's point, where the path begins.
void begin_light_path(const LightPathStart& start, LightPathUnderWay& path);

/// What follows the last vertex, `distance` away in the direction opposite to `wo`: it asks for
/// light with `query`. What is known of the vertices before only now is set there.
PathVertex next_light_vertex(const VcmLightInputs& in, const LightQuery& query,
                             const Facing& facing, const PathState& state, const Vec3f& wo,
                             float distance, LightPathUnderWay& path);
PathVertex next_light_vertex(const VcmLightInputs& in, const LightMediumVertex& at,
                             LightPathUnderWay& path);

/// How the last vertex is seen by the camera.
struct SeenByCamera {
  const CameraConnection& connection;
  const SurfaceVertex* vertex;  ///< null: it is in a medium
  float facing;                 ///< Facing::factor() of the vertex to the camera
  float pdf_reverse;  ///< density with which a path from the camera would be scattered there to the
                      ///< vertex before
  float glossy_share;  ///< BsdfValues::glossy_share() of these two directions
};
PathHalves splat_halves(const VcmLightInputs& in, const LightPathUnderWay& path,
                        const SeenByCamera& seen);

}  // namespace kaustik
