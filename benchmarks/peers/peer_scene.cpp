#include "benchmarks/peers/peer_scene.h"

#include <fmt/format.h>

#include "kaustik/base/error.h"
#include "kaustik/scene/overrides.h"

namespace kaustik::bench {
namespace {

/// Steps of the cosine that the reflectance of mirrors is told in.
constexpr int cosine_steps = 16;
/// Of balls (20 × 4^level triangles): those that are looked at, and lamps, of whose triangles each
/// is a lamp of its own to other renderers.
constexpr int fine_level = 6, lamp_level = 4;

float area_of(const TriangleMesh& mesh) {
  double sum = 0;
  for (const auto& [a, b, c] : mesh.triangles)
    sum += 0.5 * double(length(cross(mesh.positions[b] - mesh.positions[a],
                                     mesh.positions[c] - mesh.positions[a])));
  return float(sum);
}

/// Shapes do not tell of what kind they are; but of those that are no meshes only a ball has as
/// much area as the ball in its bounds.
std::optional<PeerBall> ball_of(const Shape& shape) {
  if (shape.mesh()) return std::nullopt;
  const Bounds3f bounds = shape.bounds();
  const float radius = (bounds.max.x - bounds.min.x) / 2;
  if (std::abs(shape.area() / (4 * pi * sqr(radius)) - 1) > 1e-3f) return std::nullopt;
  return PeerBall{(bounds.min + bounds.max) * 0.5f, radius};
}

/// Inscribed triangles, moved outward until they have the area of the ball.
TriangleMesh mesh_of(const Shape& shape, const PeerBall& ball, bool is_lamp) {
  TriangleMesh mesh = shape.tessellate(is_lamp ? lamp_level : fine_level);
  const float scale = std::sqrt(shape.area() / area_of(mesh));
  mesh.normals.clear();
  for (Vec3f& p : mesh.positions) {
    mesh.normals.push_back(normalize(p - ball.center));
    p = ball.center + (p - ball.center) * scale;
  }
  return mesh;
}

/// n_inside/n_outside, from what the bsdf does to light that enters.
float ior_of(const Bsdf& bsdf) {
  for (const float u_lobe : {0.999f, 0.001f}) {
    const BsdfSample entered = bsdf.sample({}, {0, 0, 1}, u_lobe, {0.5f, 0.5f}, Lobes::all);
    if (entered.transmission) return entered.eta;
  }
  return 1;
}

void set_material(const Bsdf& bsdf, PeerSurface& surface) {
  const auto albedo = [&](float cosine) {
    return bsdf.albedo({}, {std::sqrt(std::max(0.0f, 1 - sqr(cosine))), 0, cosine}, Lobes::all);
  };
  if (bsdf.traits().lobes == Lobes::diffuse && !bsdf.traits().transmits) {
    surface.material = PeerMaterial::diffuse;
    surface.reflectance = {albedo(1)};
  } else if (bsdf.traits().lobes == Lobes::delta && bsdf.traits().transmits) {
    surface.material = PeerMaterial::glass;
    surface.ior = ior_of(bsdf);
  } else if (bsdf.traits().lobes == Lobes::delta) {
    surface.material = PeerMaterial::mirror;
    for (int i = 0; i <= cosine_steps; ++i)
      surface.reflectance.push_back(albedo(std::max(1e-3f, float(i) / cosine_steps)));
  } else {
    throw Error(ErrorKind::input,
                surface.name + " is neither diffuse nor a mirror nor clear glass");
  }
}

PeerSurface surface_of(const Scene& scene, uint32_t index) {
  const Surface& given = scene.surface(index);
  const Shape& shape = scene.tracer().shape(index);
  PeerSurface surface;
  surface.name = given.name;
  set_material(*given.bsdf, surface);
  surface.radiance = Spectrum(0);
  if (given.light >= 0) {
    const SurfacePoint point = shape.sample_area({0.5f, 0.5f}).point;
    surface.radiance = scene.lights()[size_t(given.light)]->emitted(point, point.ng, {});
  }
  surface.ball = ball_of(shape);
  if (surface.ball)
    surface.mesh = mesh_of(shape, *surface.ball, surface.is_lamp());
  else
    surface.mesh = shape.tessellate(0);
  return surface;
}

}  // namespace

void use_peer_filter(Description& description) {
  override_property(description, fmt::format("rfilter.stddev={}", peer_filter_stddev));
}

PeerScene peer_scene_of(const Scene& scene) {
  const Camera& camera = scene.camera();
  const Vec2i size = scene.film().size;
  const auto direction = [&](float x, float y) {
    return camera.sample_ray({x * float(size.x), y * float(size.y)}, Camera::middle_of_lens())
        .direction;
  };
  PeerScene peer{size,
                 double(camera.traits().horizontal_fov * pi / 180),
                 camera.traits().position,
                 direction(0.5f, 0.5f),
                 normalize(direction(0.5f, 0) - direction(0.5f, 1)),
                 {}};
  size_t lamps = 0;
  for (uint32_t i = 0; i < scene.surface_count(); ++i) {
    peer.surfaces.push_back(surface_of(scene, i));
    if (peer.surfaces.back().is_lamp()) ++lamps;
  }
  if (lamps != scene.lights().size())
    throw Error(ErrorKind::input, "there are lamps that are no surfaces, which peers do not get");
  return peer;
}

}  // namespace kaustik::bench
