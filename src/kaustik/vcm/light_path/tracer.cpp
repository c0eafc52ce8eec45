#include "kaustik/vcm/light_path/tracer.h"

#include <algorithm>

#include "kaustik/transport/camera_splats.h"
#include "kaustik/transport/visibility.h"
#include "kaustik/vcm/light_path/densities.h"

namespace kaustik {
namespace {

/// Vertices before one, as records count them.
constexpr size_t most_before = 0xffff;

class Tracer {
 public:
  Tracer(const VcmLightInputs& in, const Pass& pass, Stream stream, SplatBuffer& splats)
      : in_(in),
        techniques_(in.weights.settings().techniques),
        pass_(pass),
        stream_(stream),
        wavelengths_(pass.wavelengths[in.set]),
        first_path_(uint32_t(in.set) * in.light_paths),
        // The picture is the mean over the sets.
        splats_(in.scene, in.components, in.light_paths * uint32_t(pass.wavelengths.count()),
                splats) {}

  LightBlock trace(uint32_t begin, uint32_t end) {
    begin_ = begin;
    paths_.resize(end - begin);
    LightPathLimits limits;
    limits.maximum_events = std::max(0, in_.maximum_events - 1);
    limits.needs_reverse_pdf = true;
    limits.guide = in_.scattering;
    limits.gauges = in_.gauges;
    const auto emit = [this](uint32_t i) { return start(i); };
    const auto handlers = Handlers{[this](const LightVertex& at) {
                                     add_vertex(at);
                                     return Lobes::all;
                                   },
                                   [this](const LightMediumVertex& at) { show_in_medium(at); },
                                   [this](const LightMediumEvent& event) { add_event(event.at); },
                                   [this](const LightAtGauge& at) { show_at_gauge(at); }};
    block_.rays += trace_light_paths(in_.scene, begin, end, limits, emit, handlers).rays;
    block_.rays += splats_.rays();
    block_.splats = splats_.shown();
    gather();
    return std::move(block_);
  }

 private:
  /// What is kept of a vertex until its path has come to its end.
  struct MergeablePoint {
    uint32_t path;
    Vec3f position;
    LightVertexData data;
  };

  std::optional<LightPath> start(uint32_t i) {
    LightPathUnderWay& path = paths_[i - begin_];
    Sampler sampler = Sampler::at(pass_.seed, pass_.index, stream_, 0, first_path_ + i);
    path.start = in_.emission.sample(sampler, wavelengths_);
    const LightPathStart& start = path.start;
    if (start.light < 0 || start.emitted.flux.is_zero() || in_.maximum_events < 1)
      return std::nullopt;
    begin_light_path(start, path);
    return LightPath(start.emitted.ray, start.emitted.flux, in_.scene.light_medium(start.light),
                     Lobes::specular, sampler, wavelengths_);
  }

  /// On a surface.
  void add_vertex(const LightVertex& at) {
    LightPathUnderWay& path = paths_[at.path - begin_];
    const SurfaceVertex& vertex = at.vertex;
    const Facing facing{vertex.point().ng, 0};
    if (in_.remembers_scattering && at.path < in_.remembered_paths) remember(at, path);
    path.vertices.push_back(next_light_vertex(in_, light_query(vertex, 1), facing, at.state,
                                              vertex.wo(), at.distance, path));
    path.last = facing;
    const bool has_events = path.vertices.size() >= 3;
    if (has_events && techniques_.splats)
      splats_.show(at, [&](const CameraConnection& connection, const SurfaceVertex& seen) {
        const BsdfValues values = seen.values(connection.direction);
        return in_.weights.splat(
            splat_halves(in_, path,
                         {connection, &seen, abs_dot(connection.direction, seen.point().ng),
                          values.pdf_reverse, values.glossy_share()}));
      });
    keep(at, path, has_events);
  }

  /// How the path came here from the vertex before, and what this one may teach.
  void remember(const LightVertex& at, LightPathUnderWay& path) {
    if (!path.scattering.normal.equalWithAbsError({0, 0, 0}, 0)) {
      path.scattering.next = at.vertex.position();
      path.scattering.pdf = at.state.pdf_forward;
      path.scattering.pdf_unguided = at.state.pdf_unguided;
      scatterings_.push_back(path.scattering);
    }
    path.scattering = {};
    if (!ScatterGuide::guides(at.vertex)) return;
    const Vec3f& ng = at.vertex.point().ng;
    path.scattering.path = at.path - begin_;
    path.scattering.number = at.path;
    path.scattering.at = uint32_t(path.vertices.size());
    path.scattering.position = at.vertex.position();
    path.scattering.normal = at.vertex.on_front() ? ng : -ng;
  }

  /// In a medium, where the path goes on from.
  void add_event(const LightMediumVertex& at) {
    LightPathUnderWay& path = paths_[at.path - begin_];
    path.vertices.push_back(next_light_vertex(in_, at, path));
    path.last = {{0, 0, 0}, at.medium.mean_extinction(at.position)};
    if (!techniques_.connections || path.vertices.size() > most_before ||
        at.path >= LightVertices::most_connectible_paths)
      return;
    ConnectibleVertex vertex;
    vertex.ray = {at.position, -at.wo, infinity};
    vertex.medium = &at.medium;
    vertex.in_medium = true;
    vertex.data.specular = false;
    vertex.data.before = uint16_t(path.vertices.size() - 1);
    vertex.data.pdf_next_event = path.pdf_next_event;
    vertex.data.flux = at.flux;
    keep_connectible(vertex, at.path, path);
  }

  /// In a medium, where no path goes on from, but light is shown: merged and splatted.
  void show_in_medium(const LightMediumVertex& at) {
    if (!techniques_.merging && !techniques_.splats) return;
    LightPathUnderWay& path = paths_[at.path - begin_];
    const PathVertex vertex = next_light_vertex(in_, at, path);
    const size_t before = path.vertices.size();
    if (techniques_.merging && before <= most_before) {
      path.kept = true;
      MergeableMediumVertex data;
      data.flux = at.flux;
      data.direction = PackedDirection(at.wo);
      data.before = uint16_t(before);
      data.path = at.path - begin_;
      data.pdf_next_event = path.pdf_next_event;
      data.pdf_light = vertex.pdf_light;
      data.to_previous = vertex.to_previous;
      data.medium = &at.medium;
      block_.discs.push_back({at.position, in_.media.radius(at.position, at.medium)});
      block_.in_media.push_back(data);
    }
    if (!techniques_.splats || before < 2) return;
    path.vertices.push_back(vertex);
    splats_.show(at, [&](const CameraConnection& connection) {
      return in_.weights.splat(
          splat_halves(in_, path,
                       {connection, nullptr, at.medium.mean_extinction(at.position),
                        at.medium.phase().eval(connection.direction, at.wo), 0}));
    });
    path.vertices.pop_back();
  }

  /// Where the path passes a gauge: merged there alone. As on surfaces, light from the lamp itself
  /// is not.
  void show_at_gauge(const LightAtGauge& at) {
    LightPathUnderWay& path = paths_[at.path - begin_];
    const size_t before = path.vertices.size();
    if (before < 2 || before > most_before || at.flux.is_zero()) return;
    const GaugeDisks::Crossing& crossing = at.crossing;
    const SurfacePoint& gauge = in_.scene.gauges()[crossing.gauge].point;
    if (!is_unobstructed(in_.scene, spawn_ray_to(gauge, crossing.position), block_.rays)) return;
    const PathVertex vertex =
        next_light_vertex(in_, LightQuery(crossing.position, gauge.ng, 1, at.state.wavelengths),
                          {gauge.ng, 0}, at.state, at.wo, at.distance, path);
    path.kept = true;
    GaugeVertex kept;
    kept.data.flux = at.flux;
    kept.data.direction = PackedDirection(at.wo);
    kept.data.side = CoarseNormal(gauge.ng);
    kept.data.specular = at.path_class.diffuse_events() == 0;
    kept.data.before = uint16_t(before);
    kept.data.path = at.path - begin_;
    kept.data.pdf_next_event = path.pdf_next_event;
    kept.gauge = crossing.gauge;
    kept.offset_sq = crossing.offset_sq;
    kept.pdf_light = vertex.pdf_light;
    kept.to_previous = vertex.to_previous;
    block_.at_gauges.push_back(kept);
  }

  /// Light from the lamp itself is not merged on surfaces: sampling it is better, and has no bias.
  void keep(const LightVertex& at, LightPathUnderWay& path, bool may_merge) {
    const SurfaceVertex& vertex = at.vertex;
    const bool wants_irradiance = in_.scene.film().quantity == Quantity::irradiance;
    const bool scatters = any(vertex.lobes() & (Lobes::diffuse | Lobes::glossy));
    const bool merges = techniques_.merging || at.path < in_.remembered_paths;
    if (!scatters && !(wants_irradiance && merges)) return;
    const Vec3f& ng = vertex.point().ng;
    const float cos_geometric = dot(vertex.wo(), ng);
    if (cos_geometric == 0 || path.vertices.size() > most_before) return;
    LightVertexData data;
    data.direction = PackedDirection(vertex.wo());
    data.on_front = cos_geometric > 0;
    data.side = CoarseNormal(cos_geometric > 0 ? ng : -ng);
    data.specular = at.path_class.diffuse_events() == 0;
    data.before = uint16_t(path.vertices.size() - 1);
    data.pdf_next_event = path.pdf_next_event;
    if (techniques_.connections && scatters && at.path < LightVertices::most_connectible_paths) {
      data.flux = at.state.throughput;
      keep_connectible({at.ray, at.hit, data, at.state.medium, false}, at.path, path);
    }
    if (merges && may_merge) {
      path.kept = true;
      // As for photons: the density on the surface counts flux by the geometric cosine.
      const float factor = vertex.has_relief()
                               ? 1.0f
                               : abs_dot(vertex.wo(), vertex.normal()) / std::fabs(cos_geometric);
      data.flux = at.state.throughput * factor;
      mergeable_.push_back({at.path - begin_, vertex.position(), data});
    }
  }

  void keep_connectible(const ConnectibleVertex& vertex, uint32_t number, LightPathUnderWay& path) {
    path.kept = true;
    block_.connectible.push_back(vertex);
    block_.connectible.back().data.path = number - begin_;
  }

  /// Puts the vertices path by path.
  void gather() {
    std::vector<uint32_t> begins(paths_.size());
    for (size_t i = 0; i < paths_.size(); ++i) {
      if (!paths_[i].kept) continue;
      begins[i] = uint32_t(block_.vertices.size());
      if (begin_ + i < in_.remembered_paths)
        block_.beginnings.push_back({begins[i], paths_[i].start});
      block_.vertices.insert(block_.vertices.end(), paths_[i].vertices.begin(),
                             paths_[i].vertices.end());
    }
    for (MergeablePoint& point : mergeable_) {
      point.data.path = begins[point.path];
      block_.positions.push_back(point.position);
      block_.data.push_back(point.data);
    }
    for (LightScattering& event : scatterings_) {
      if (!paths_[event.path].kept) continue;
      event.path = begins[event.path];
      block_.scatterings.push_back(event);
    }
    for (MergeableMediumVertex& vertex : block_.in_media) vertex.path = begins[vertex.path];
    for (GaugeVertex& vertex : block_.at_gauges) vertex.data.path = begins[vertex.data.path];
    for (ConnectibleVertex& vertex : block_.connectible)
      vertex.data.path = begins[vertex.data.path];
  }

  const VcmLightInputs& in_;
  const Techniques techniques_;
  const Pass& pass_;
  Stream stream_;
  const Wavelengths wavelengths_;
  const uint32_t first_path_;  ///< of the set
  CameraSplats splats_;
  uint32_t begin_ = 0;
  std::vector<LightPathUnderWay> paths_;
  std::vector<MergeablePoint> mergeable_;
  std::vector<LightScattering> scatterings_;
  LightBlock block_;  ///< `path` counts the paths until gather()
};

}  // namespace

LightBlock trace_light_block(const VcmLightInputs& inputs, const Pass& pass, Stream stream,
                             SplatBuffer& splats, uint32_t begin, uint32_t end) {
  return Tracer(inputs, pass, stream, splats).trace(begin, end);
}

}  // namespace kaustik
