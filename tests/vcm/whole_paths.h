#pragma once
// Whole paths that real light paths have found, found once more by every other
// technique of connection and merging, by the code that renders. Camera walks
// are steered along them, and what a technique adds, over what it would add
// alone, is its weight.

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "kaustik/photon/coverage/merge_disk.h"
#include "kaustik/vcm/camera_path/camera_path.h"
#include "kaustik/vcm/light_pass.h"

namespace kaustik::test {

/// What the paths of a pass have in common.
struct WholePathRules {
  const Scene& scene;
  PathWeights weights;
  PixelPlans plans;
  std::shared_ptr<const LightPathEmission> emission;
  std::shared_ptr<const ScatterGuide> scattering;  ///< null: not guided
  float camera_samples = 4;
  int maximum_events = 7;

  /// Paths whose pass and numbers these are.
  LightVertices trace(const Pass& pass, uint32_t paths, SplatBuffer& splats) const {
    PassReport report;
    return trace_light_vertices({.scene = scene,
                                 .emission = *emission,
                                 .weights = weights,
                                 .maximum_events = maximum_events,
                                 .light_paths = paths,
                                 .camera_samples = camera_samples,
                                 .plans = plans,
                                 .remembered_paths = paths,
                                 .scattering = scattering.get(),
                                 .remembers_scattering = true},
                                pass, Stream::light_path, splats, {}, {}, report);
  }
};

/// The sum over the lanes and components.
inline double sum_of(const SampleSink& sink) {
  Spectrum sum;
  for (int c = 0; c < component_count; ++c) sum += sink.radiance(Component(c));
  return double(sum.sum());
}

/// A light path y₀, y₁, … alone, and where its vertices lie.
class LonePath {
 public:
  struct Vertex {
    ConnectibleVertex record;
    SurfaceVertex vertex;
    Vec2f raster;  ///< below 0: not seen
  };
  LonePath(const WholePathRules& rules, uint32_t number) : splats_(rules.scene.film(), all()) {
    const Pass pass{5, number, 1};
    light_ = rules.trace(pass, 1, splats_);
    if (light_.beginnings.empty()) return;
    // Other techniques leave the path as it is, but remember less of where it
    // went.
    WholePathRules connected = rules;
    PathWeights::Settings settings = rules.weights.settings();
    settings.techniques.connections = true;
    connected.weights = PathWeights(settings);
    SplatBuffer nowhere(rules.scene.film(), ComponentSet());
    vertices_.resize(light_.vertices.size());
    const LightVertices met = connected.trace(pass, 1, nowhere);
    for (const ConnectibleVertex& record : met.connectible) {
      Vertex at{record, {}, {-1, -1}};
      at.vertex.meet(rules.scene, record.ray, record.hit, TransportMode::flux);
      const CameraConnection camera =
          rules.scene.camera().connect(at.vertex.position(), Camera::middle_of_lens());
      const Vec2i size = rules.scene.film().crop_size;
      const bool is_inside = camera.raster.x >= 0 && camera.raster.x < float(size.x) &&
                             camera.raster.y >= 0 && camera.raster.y < float(size.y);
      if (camera.importance > 0 && is_inside) at.raster = camera.raster;
      vertices_[record.data.before] = at;
    }
  }

  size_t size() const { return vertices_.size(); }
  const LightVertices& light() const { return light_; }
  const LightPathStart& start() const { return light_.beginnings[0].start; }
  /// yᵢ; null where events are delta alone.
  const Vertex* at(size_t i) const { return vertices_[i] ? &*vertices_[i] : nullptr; }
  bool is_seen(size_t i) const { return at(i) && at(i)->raster.x >= 0; }
  bool is_delta(size_t i) const { return light_.vertices[i].delta; }
  /// What yᵢ has splatted; nothing where another vertex may have splatted into
  /// the same pixel.
  std::optional<double> splatted(size_t i) const {
    const Vec2i pixel = pixel_of(i);
    for (size_t k = 1; k < size(); ++k)
      if (k != i && is_seen(k) && pixel_of(k) == pixel) return std::nullopt;
    Spectrum sum;
    for (int c = 0; c < component_count; ++c) sum += splats_.value(pixel.x, pixel.y, Component(c));
    return double(sum.sum());
  }

 private:
  static ComponentSet all() { return ComponentSet::all(); }
  Vec2i pixel_of(size_t i) const { return {int(at(i)->raster.x), int(at(i)->raster.y)}; }

  SplatBuffer splats_;
  LightVertices light_;
  std::vector<std::optional<Vertex>> vertices_;
};

/// A vertex of a whole path, from the camera's side: x₁ comes first.
struct WholePathStep {
  Vec3f direction;   ///< to the next
  size_t light = 0;  ///< number on the light path; 0: before its last vertex
  bool delta = false;
};

/// The path from the camera to yₘ, and back to the light along the light path.
class WholePath {
 public:
  WholePath(const WholePathRules& rules, const LonePath& light, size_t m)
      : rules_(rules), light_(light), m_(m), raster_(light.at(m)->raster) {
    is_complete_ = retrace();
  }
  /// Whether a camera walk came all the way.
  bool is_complete() const { return is_complete_; }
  const std::vector<WholePathStep>& steps() const { return steps_; }
  /// Vertices, the one on the light among them.
  size_t size() const { return steps_.size() + 1; }
  const LonePath& light() const { return light_; }
  const Vec2f& raster() const { return raster_; }
  size_t last() const { return m_; }

 private:
  bool retrace();
  /// Where the path goes on from yᵢ.
  WholePathStep step_from(size_t i, const SurfaceVertex& vertex, const Vec3f& arriving) const;
  bool ends_at_light(const Ray& ray) const;

  const WholePathRules& rules_;
  const LonePath& light_;
  size_t m_;
  Vec2f raster_;
  std::vector<WholePathStep> steps_;
  bool is_complete_ = false;
};

/// A camera walk that goes along a whole path.
class SteeredWalk {
 public:
  SteeredWalk(const WholePathRules& rules, const WholePath& path, const LightVertices& light)
      : path_(path),
        matt_(light, rules.weights),
        tails_(light, rules.weights),
        inputs_{.scene = rules.scene,
                .emission = *rules.emission,
                .weights = rules.weights,
                .light = light,
                .matt = matt_,
                .tails = &tails_,
                .seen = rules.plans.seen(),
                .camera_samples = rules.camera_samples,
                .connection_scale = 1,
                .merge_radius_sq = rules.weights.settings().merge_area * inv_pi,
                .scattering = rules.scattering.get(),
                .plans = &rules.plans},
        sampler_(Sampler::at(1, 0, Stream::camera, 0, 1)),
        sink_(ComponentSet::all()),
        camera_path_(inputs_, rules.plans.at(path.raster(), 1), path.raster(), sampler_, sink_) {}

  /// To xₜ; false if the walk went astray, or would have no chance of coming
  /// there.
  bool go_to(size_t t) {
    for (size_t i = 0; i < t; ++i)
      if (!go_on() || (i + 1 < t && !leave(path_.steps()[i]))) return false;
    return true;
  }
  /// From xₜ on.
  bool leave(const WholePathStep& step) {
    BsdfSample event;
    event.wi = step.direction;
    event.event = step.delta ? Lobes::delta : Lobes::diffuse;
    event.pdf_solid_angle = step.delta ? 1.0f : walk().vertex().pdf(event.wi, Lobes::all);
    if (!(event.pdf_solid_angle > 0)) return false;
    // The throughput stays 1, but for roulette.
    event.weight = Spectrum(1 / event.pdf_solid_angle);
    walk().branch(event);
    camera_path_.leave();
    return true;
  }
  bool go_on() { return camera_path_.go_on(false) == CameraWalk::Arrival::surface; }

  CameraWalk& walk() { return camera_path_.walk(); }
  CameraPath& path() { return camera_path_; }
  double found() const { return sum_of(sink_); }

 private:
  const WholePath& path_;
  MattMerging matt_;
  LightTails tails_;
  CameraPathInputs inputs_;
  Sampler sampler_;
  SampleSink sink_;
  CameraPath camera_path_;
};

enum class Found { unidirectional, next_event, splat, connection, merge };
inline constexpr std::array<const char*, 5> found_names = {"unidirectional", "next event", "splat",
                                                           "connection", "merge"};

/// The weights of all techniques that find a path.
struct WholePathWeights {
  struct Part {
    Found by;
    size_t t;  ///< vertices on the camera's side
    double weight;
  };
  std::vector<Part> parts;
  double rounding = 0;  ///< error of the sum, at most, by that of the directions
                        ///< that are stored for merging, in 2 × 16 bits, and normals in 3 × 8

  double sum() const {
    double result = 0;
    for (const Part& part : parts) result += part.weight;
    return result;
  }
  std::string text() const;
};

/// Nothing where some technique can't tell its weight: the path carries no
/// light, a disk of merging lies on an edge.
std::optional<WholePathWeights> weights_of(const WholePathRules& rules, const WholePath& path);

}  // namespace kaustik::test
