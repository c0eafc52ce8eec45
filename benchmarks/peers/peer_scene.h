#pragma once
#include <optional>
#include <string>
#include <vector>

#include "kaustik/scene/scene.h"

namespace kaustik::bench {

/// Standard deviation of the Gaussian that pictures beside peers are filtered with, pixels.
inline constexpr double peer_filter_stddev = 0.5;

/// Makes the film's filter that of the peers. Throws Error where the scene has no such film.
void use_peer_filter(Description& description);

/// What is done to light at a surface, as every renderer knows it.
enum class PeerMaterial { diffuse, mirror, glass };

struct PeerBall {
  Vec3f center;
  float radius;
};

struct PeerSurface {
  std::string name;
  PeerMaterial material = PeerMaterial::diffuse;
  /// Diffuse: the one value. Mirror: by the cosine to the normal, from 0 to 1 in equal steps.
  std::vector<Spectrum> reflectance;
  float ior = 1;      ///< of glass
  Spectrum radiance;  ///< W/(sr·m²), zero but on lamps
  TriangleMesh mesh;  ///< balls have normals, and the area of the ball
  std::optional<PeerBall> ball;
  bool is_lamp() const { return !radiance.is_zero(); }
};

/// A scene in terms that other renderers share.
struct PeerScene {
  Vec2i size;
  double horizontal_fov;  ///< radians
  Vec3f position, forward, up;
  std::vector<PeerSurface> surfaces;
};

/// Throws Error(input) for lamps that are no surfaces and for materials other than those.
PeerScene peer_scene_of(const Scene& scene);

}  // namespace kaustik::bench
