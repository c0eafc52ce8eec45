#pragma once
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "kaustik/geometry/ray_tracer.h"
#include "kaustik/image/image.h"
#include "kaustik/light/light.h"
#include "kaustik/material/bsdf.h"
#include "kaustik/medium/medium.h"
#include "kaustik/scene/built_parts.h"
#include "kaustik/scene/camera.h"
#include "kaustik/scene/description.h"

namespace kaustik {

/// What covers a shape.
struct Surface {
  std::shared_ptr<const Bsdf> bsdf;  ///< never null
  int light = -1;                    ///< index into Scene::lights(), −1: none
  std::string name;                  ///< the shape's id or "shape 'type' on line n", for messages
  /// The integrator that the shape itself holds, if any: how this surface looks.
  std::shared_ptr<const Object> illumination;
  std::shared_ptr<const Medium> interior, exterior;  ///< null: vacuum, or see separates_media()
  bool names_media = false;                          ///< also by those that are empty
  BsdfTraits traits;                                 ///< of the bsdf

  /// Whether the surface says what lies on its sides. If not, both are in the medium that a path
  /// arrives through.
  bool separates_media() const { return names_media; }
  /// What a path that arrived through `arrived` goes on through, on the side of the geometric
  /// normal (`outside`) or on the other.
  const Medium* medium_toward(bool outside, const Medium* arrived) const {
    if (!separates_media()) return arrived;
    return outside ? exterior.get() : interior.get();
  }
  /// Whether light may go straight on through it, all or a part.
  bool lets_pass() const { return traits.is_null || traits.passes_straight; }
};

/// A gauge of the camera where it stands in the scene.
struct PlacedGauge {
  SurfacePoint point;              ///< both normals are that of the side that is measured
  const Medium* medium = nullptr;  ///< that it stands in; null: vacuum
  float distance_around = 1;       ///< of what lies on that side, m: a median
};

/// Sees every ray that is traced; for benchmarks that repeat them.
class RayObserver {
 public:
  virtual ~RayObserver() = default;
  virtual void on_ray(const Ray& ray, bool shadow) = 0;
};

/// All that a ray can meet, immutable and shared by all threads. Made by build_scene.
class Scene {
 public:
  struct Parts {
    std::unique_ptr<const RayTracer> tracer;
    std::vector<Surface> surfaces;  ///< parallel to the tracer's shapes and parts of bodies
    std::vector<std::shared_ptr<const Light>> lights;  ///< never null
    FilmSettings film;
    std::unique_ptr<Camera> camera;
    std::shared_ptr<const Medium> camera_medium;  ///< null: vacuum
    /// Parallel to the lights: that they shine into; null: to be found out from the surfaces.
    std::vector<std::shared_ptr<const Medium>> light_media;
    std::vector<bool> hidden_lights = {};  ///< parallel to the lights, or empty: none is
    /// Parallel to the lights, or empty: they have none.
    std::vector<std::string> light_names = {};
    std::vector<std::string> warnings;
    RayObserver* observer = nullptr;
    BuiltParts built = {};
    BuildCounts counts = {};
  };
  /// Shares with `previous`, null: none, what depends on parts alone that both have.
  explicit Scene(Parts parts, const Scene* previous = nullptr);
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;

  bool intersect(const Ray& ray, Hit& hit) const {
    if (parts_.observer) parts_.observer->on_ray(ray, false);
    return parts_.tracer->intersect(ray, hit);
  }
  /// Closest hits of many rays at once, as RayTracer::intersect.
  void intersect(std::span<const Ray> rays, std::span<Hit> hits) const {
    if (parts_.observer)
      for (const Ray& ray : rays) parts_.observer->on_ray(ray, false);
    parts_.tracer->intersect(rays, hits);
  }
  bool occluded(const Ray& ray) const {
    if (parts_.observer) parts_.observer->on_ray(ray, true);
    return parts_.tracer->occluded(ray);
  }
  const RayTracer& tracer() const { return *parts_.tracer; }
  /// Of a SurfacePoint's `shape`.
  const Surface& surface(uint32_t shape) const { return parts_.surfaces[shape]; }
  /// Whether light may go straight on through what a ray has hit, Hit::shape: it is no more than a
  /// boundary of media, or passes a part, or is nothing at all, where a body's surface is hidden.
  /// Its point tells.
  bool may_let_pass(uint32_t shape) const {
    return may_let_pass_.empty() ? surface(shape).lets_pass() : may_let_pass_[shape] != 0;
  }
  size_t surface_count() const { return parts_.surfaces.size(); }
  const std::vector<std::shared_ptr<const Light>>& lights() const { return parts_.lights; }
  /// For people: its id, or that of its shape; where both have none, "lamp" and its number from 1
  /// on.
  std::string light_name(size_t light) const;
  const LightSelector& light_selector() const { return *light_selector_; }
  /// Indices of the lights that rays meet at infinity.
  const std::vector<int>& environment_lights() const { return environment_lights_; }
  /// Whether the camera looks past a light (−1: none) and, if it is a surface, through it: before
  /// anything on the way has been reflected, refracted or scattered, null boundaries apart.
  bool is_hidden(int light) const {
    return hides_lights_ && light >= 0 && parts_.hidden_lights[size_t(light)];
  }
  /// Whether it does so to any.
  bool hides_lights() const { return hides_lights_; }
  /// Whether there is any light that a ray which has been scattered may meet.
  bool has_lights_to_meet() const { return has_lights_to_meet_; }
  const Camera& camera() const { return *parts_.camera; }
  /// The camera's gauges; empty: it has none.
  const std::vector<PlacedGauge>& gauges() const { return gauges_; }
  const FilmSettings& film() const { return parts_.film; }
  /// What the picture holds, by what the film asks for and by what the camera is.
  Quantity quantity() const {
    return camera().traits().measures_irradiance ? Quantity::irradiance : film().quantity;
  }

  /// Whether there is any medium or null boundary. Without them every segment ends at a surface,
  /// and light on it keeps its strength.
  bool has_media() const { return has_media_; }
  /// Whether there are surfaces through which a part of the light goes straight on.
  bool passes_straight() const { return passes_straight_; }
  /// Whether any medium scatters light.
  bool has_scattering() const { return has_scattering_; }
  /// Around the camera; null: vacuum.
  const Medium* camera_medium() const { return parts_.camera_medium.get(); }
  /// That light `light` shines into; null: vacuum. Infinite lights: what reaches the scene.
  const Medium* light_medium(int light) const { return light_media_[size_t(light)]; }
  /// What build_scene found odd but could live with.
  const std::vector<std::string>& warnings() const { return parts_.warnings; }
  /// What build_scene built it of, and how much of that it made itself.
  const BuiltParts& built() const { return parts_.built; }
  const BuildCounts& build_counts() const { return parts_.counts; }

 private:
  void find_hidden_surfaces();
  void find_media();
  void make_light_selector(const Scene* previous);
  bool probes_lights_like(const Scene& other) const;

  Parts parts_;
  std::shared_ptr<const LightSelector> light_selector_;
  std::vector<int> environment_lights_;
  bool has_media_ = false, has_scattering_ = false, has_lights_to_meet_ = false;
  bool hides_lights_ = false, passes_straight_ = false;
  std::vector<const Medium*> light_media_;  ///< parallel to the lights
  std::vector<uint8_t> may_let_pass_;       ///< by shape; empty: as its surface says
  std::vector<PlacedGauge> gauges_;
};

struct BuildOptions {
  RayObserver* observer = nullptr;                          ///< must outlive the scene
  int64_t texture_memory_bytes = default_picture_memory();  ///< that its pictures may take
};

/// Checks every object against the table of its type and builds the scene. Throws Error with all
/// problems found. Ignores the integrator, which is the render room's, but for what Mitsuba has it
/// say of the lights: `hide_emitters`.
std::shared_ptr<const Scene> build_scene(const Description& description,
                                         const BuildOptions& options = {});

/// The same, to the bit, for a description that differs little from that of `previous` (null: there
/// is none): what is described alike and made from files that have not changed since is shared, see
/// PartKeys. That are shapes, textures, bsdfs, lights with their tables, the ray tracing structures
/// of shape groups, and the one over the whole world if no shape or instance of it has changed. A
/// shape that is moved by its own to_world is made anew, with that structure; one in a group that
/// an instance moves is not. Where lights are chosen by what the camera's surroundings see of them,
/// that is learned anew when the camera, a shape or a light has changed. `previous` may be
/// rendering meanwhile and need not outlive the new scene. Scene::build_counts() tells what was
/// made.
std::shared_ptr<const Scene> build_scene(const Description& description,
                                         const std::shared_ptr<const Scene>& previous,
                                         const BuildOptions& options = {});

/// Type of the integrator of scenes that name none.
inline constexpr const char* default_integrator = "auto";

/// The scene's integrator object: the one of the top level, null if there is none there. Of several
/// it is the one that no shape refers to; throws Error if that leaves none, or several.
std::shared_ptr<Object> find_integrator(const Description& description);
/// The same to be changed: where shapes refer to it too, they keep theirs, and the scene gets a
/// copy (without its id).
std::shared_ptr<Object> own_integrator(Description& description);

}  // namespace kaustik
