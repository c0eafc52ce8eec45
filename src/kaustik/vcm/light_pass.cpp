#include "kaustik/vcm/light_pass.h"

#include <algorithm>

#include "kaustik/base/parallel.h"
#include "kaustik/transport/direct_light.h"
#include "kaustik/transport/light_path.h"
#include "kaustik/transport/scatterer.h"

namespace kaustik {
namespace {

constexpr size_t paths_per_block = 1024;

/// A light path under way: its vertices so far.
struct PathUnderWay {
  std::vector<PathVertex> vertices;
  LightPathStart start;
  Facing last;  ///< of the last vertex; zero at a point without a surface
  float pdf_next_event = 0;
  bool kept = false;  ///< some vertex may be merged or connected
  /// The last vertex as what is learned there; without a normal where nothing is.
  LightScattering scattering;
};

/// What a block of light paths leaves.
struct Block {
  std::vector<PathVertex> vertices;
  std::vector<Vec3f> positions;
  std::vector<LightVertexData> data;  ///< `path` counts within the block
  std::vector<ConnectibleVertex> connectible;
  std::vector<DiscHierarchy::Disc> discs;  ///< of the following
  std::vector<MergeableMediumVertex> in_media;
  std::vector<LightPathBeginning> beginnings;
  std::vector<LightScattering> scatterings;
  uint64_t rays = 0, splats = 0;
};

/// Density with which direct light is sampled at `vertex` from the point where a light path begins,
/// `distance` away; measure as PathHalves::pdf_next_event.
float next_event_density(const Scene& scene, const LightQuery& query, int light,
                         const SurfacePoint& on_light, const Vec3f& to_light, float distance) {
  const Light& of = *scene.lights()[size_t(light)];
  if (of.traits().is_delta)
    return scene.light_selector().probability(query.reference, query.normal, light);
  if (of.is_infinite()) return direct_light_pdf(scene, query, LightChoice::one, light, to_light);
  return direct_light_pdf(scene, query, LightChoice::one, light, on_light) *
         abs_dot(to_light, of.placed().emitting_normal(on_light)) / sqr(distance);
}

/// Traces the paths of one block.
class Tracer {
 public:
  Tracer(const VcmLightInputs& in, const Pass& pass, Stream stream, SplatBuffer& splats)
      : in_(in), pass_(pass), stream_(stream), splats_(splats) {}

  Block trace(uint32_t begin, uint32_t end) {
    begin_ = begin;
    paths_.resize(end - begin);
    LightPathLimits limits;
    limits.maximum_events = std::max(0, in_.maximum_events - 1);
    limits.needs_reverse_pdf = true;
    limits.guide = in_.scattering;
    const auto emit = [this](uint32_t i) { return start(i); };
    const auto meet = Handlers{[this](const LightVertex& at) {
                                 add_vertex(at);
                                 return Lobes::all;
                               },
                               [this](const LightMediumVertex& at) { show_in_medium(at); },
                               [this](const LightMediumEvent& event) { add_event(event.at); }};
    block_.rays += trace_light_paths(in_.scene, begin, end, limits, emit, meet).rays;
    gather();
    return std::move(block_);
  }

 private:
  /// What is kept of a vertex until its path has come to its end.
  struct Kept {
    uint32_t path;
    Vec3f position;
    LightVertexData data;
  };

  std::optional<LightPath> start(uint32_t i) {
    PathUnderWay& path = paths_[i - begin_];
    path.vertices.clear();
    path.kept = false;
    path.scattering = {};
    Sampler sampler = Sampler::at(pass_.seed, pass_.index, stream_, 0, i);
    path.start = in_.emission.sample(sampler, pass_.wavelengths);
    const LightPathStart& start = path.start;
    if (start.light < 0 || start.emitted.flux.is_zero() || in_.maximum_events < 1)
      return std::nullopt;
    PathVertex on_light;
    on_light.pdf_light = start.density.endpoint;
    path.vertices.push_back(on_light);
    path.last = {start.emitted.on_surface ? start.emitted.origin.ng : Vec3f(0, 0, 0), 0};
    return LightPath(start.emitted.ray, start.emitted.flux, in_.scene.light_medium(start.light),
                     Lobes::specular, sampler, pass_.wavelengths);
  }

  const Light& light_of(const PathUnderWay& path) const {
    return *in_.scene.lights()[size_t(path.start.light)];
  }

  /// What follows the last vertex, `distance` away in the direction opposite to `wo`.
  PathVertex next_vertex(PathUnderWay& path, const LightQuery& query, const Facing& facing,
                         const PathState& state, const Vec3f& wo, float distance) const {
    std::vector<PathVertex>& vertices = path.vertices;
    const float cosine = facing.factor(wo);
    const float distance_sq = sqr(distance);
    PathVertex next;
    if (facing.extinction > 0) next.mean_free_path = 1 / facing.extinction;
    if (vertices.size() == 1) {
      const Light& light = light_of(path);
      if (light.is_infinite()) {
        next.pdf_light = path.start.density.rest * cosine;
        next.to_previous = light.traits().is_delta ? 0.0f : 1.0f;
      } else {
        next.pdf_light = path.start.density.rest * cosine / distance_sq;
        // Lights that are no surface are never met.
        next.to_previous = light.traits().shape < 0 ? 0.0f : path.last.factor(wo) / distance_sq;
      }
      path.pdf_next_event = next_event_density(in_.scene, query, path.start.light,
                                               path.start.emitted.origin, wo, distance);
    } else {
      const bool after_delta = state.pdf_forward == 0;
      vertices.back().delta = after_delta;
      vertices[vertices.size() - 2].pdf_camera =
          (after_delta ? 1.0f : state.pdf_reverse) * vertices.back().to_previous;
      next.pdf_light = (after_delta ? 1.0f : state.pdf_forward) * cosine / distance_sq;
      next.to_previous = path.last.factor(wo) / distance_sq;
    }
    next.spread = in_.weights.spread_after(vertices.back().spread, next.pdf_light, next,
                                           vertices.back().delta);
    return next;
  }
  PathVertex next_in_medium(PathUnderWay& path, const LightMediumVertex& at) const {
    PathVertex next =
        next_vertex(path, LightQuery(at.position, {0, 0, 0}, 1),
                    {{}, at.medium.mean_extinction(at.position)}, at.state, at.wo, at.distance);
    next.merge_volume = in_.media.merge_volume(at.position, at.medium);
    return next;
  }

  void add_vertex(const LightVertex& at) {
    PathUnderWay& path = paths_[at.path - begin_];
    const SurfaceVertex& vertex = at.vertex;
    const Facing facing{vertex.point().ng, 0};
    if (in_.remembers_scattering && at.path < in_.remembered_paths) remember(at, path);
    path.vertices.push_back(
        next_vertex(path, light_query(vertex, 1), facing, at.state, vertex.wo(), at.distance));
    path.last = facing;
    const bool has_events = path.vertices.size() >= 3;
    if (has_events && in_.weights.settings().techniques.splats) splat(at, path);
    keep(at, path, has_events);
  }

  /// How the path came here from the vertex before, and what this one may teach.
  void remember(const LightVertex& at, PathUnderWay& path) {
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

  /// Where the path goes on from.
  void add_event(const LightMediumVertex& at) {
    PathUnderWay& path = paths_[at.path - begin_];
    path.vertices.push_back(next_in_medium(path, at));
    path.last = {{}, at.medium.mean_extinction(at.position)};
    if (!in_.weights.settings().techniques.connections || path.vertices.size() > 0xffff ||
        at.path >= LightVertices::most_connectible_paths)
      return;
    path.kept = true;
    ConnectibleVertex vertex;
    vertex.ray = {at.position, -at.wo, infinity};
    vertex.medium = &at.medium;
    vertex.in_medium = true;
    vertex.data.specular = false;
    vertex.data.before = uint16_t(path.vertices.size() - 1);
    vertex.data.pdf_next_event = path.pdf_next_event;
    vertex.data.flux = at.flux;
    block_.connectible.push_back(vertex);
    connectible_paths_.push_back(at.path - begin_);
  }

  /// Where no path goes on from, but light is shown: merged and splatted.
  void show_in_medium(const LightMediumVertex& at) {
    const Techniques& techniques = in_.weights.settings().techniques;
    if (!techniques.merging && !techniques.splats) return;
    PathUnderWay& path = paths_[at.path - begin_];
    const PathVertex vertex = next_in_medium(path, at);
    const size_t before = path.vertices.size();
    if (techniques.merging && before <= 0xffff) {
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
    // Nobody asks for the irradiance of haze.
    if (!techniques.splats || before < 2 || in_.scene.film().quantity == Quantity::irradiance)
      return;
    path.vertices.push_back(vertex);
    splat_from_medium(at, path);
    path.vertices.pop_back();
  }

  /// By a point of the lens that a fork of `sampler` tells.
  CameraConnection connect_to_camera(const Vec3f& point, const Sampler& sampler) const {
    const Camera& camera = in_.scene.camera();
    return camera.connect(point, camera.forked_lens_numbers(sampler));
  }

  void splat_from_medium(const LightMediumVertex& at, const PathUnderWay& path) {
    if (!in_.components.has(Component::volume)) return;
    const CameraConnection connection = connect_to_camera(at.position, at.sampler);
    if (!(connection.importance > 0)) return;
    const float phase = at.medium.phase().eval(at.wo, connection.direction);
    const float weight =
        in_.weights.splat(splat_halves(path, connection, at.medium.mean_extinction(at.position),
                                       at.medium.phase().eval(connection.direction, at.wo)));
    const Spectrum value =
        at.flux * phase *
        (weight * connection.importance / (sqr(connection.distance) * float(in_.light_paths)));
    if (!(weight > 0) || value.is_zero()) return;
    SurfacePoint point;
    point.position = at.position;
    const Spectrum visible =
        shadow_ray_transmittance(in_.scene, spawn_ray_to(point, connection.lens), &at.medium,
                                 {at.state.wavelengths, at.sampler}, block_.rays);
    if (visible.is_zero()) return;
    ++block_.splats;
    splats_.add(connection.raster, Component::volume, value * visible, at.state.wavelengths);
  }

  /// `facing`: of the last vertex to the camera. `pdf_reverse`: density with which a path from the
  /// camera would be scattered there to the vertex before.
  PathHalves splat_halves(const PathUnderWay& path, const CameraConnection& connection,
                          float facing, float pdf_reverse) const {
    PathHalves halves;
    halves.light = path.vertices;
    halves.pdf_camera_last =
        connection.importance * in_.camera_samples * facing / sqr(connection.distance);
    halves.pdf_camera_before_last = pdf_reverse * path.vertices.back().to_previous;
    halves.pdf_next_event = path.pdf_next_event;
    const PixelPlan plan = in_.plans.at(connection.raster, in_.shrinkage);
    halves.first_merge_area = plan.counted_area(in_.camera_samples);
    halves.first_survival = plan.counted_survival();
    return halves;
  }

  /// Light from the lamp itself is not merged on surfaces: sampling it is better, and has no bias.
  void keep(const LightVertex& at, PathUnderWay& path, bool may_merge) {
    const Techniques& techniques = in_.weights.settings().techniques;
    const SurfaceVertex& vertex = at.vertex;
    const bool wants_irradiance = in_.scene.film().quantity == Quantity::irradiance;
    const bool scatters = any(vertex.lobes() & (Lobes::diffuse | Lobes::glossy));
    const bool merges = techniques.merging || at.path < in_.remembered_paths;
    if (!scatters && !(wants_irradiance && merges)) return;
    const Vec3f& ng = vertex.point().ng;
    const float cos_geometric = dot(vertex.wo(), ng);
    if (cos_geometric == 0 || path.vertices.size() > 0xffff) return;
    LightVertexData data;
    data.direction = PackedDirection(vertex.wo());
    data.on_front = cos_geometric > 0;
    data.side = CoarseNormal(cos_geometric > 0 ? ng : -ng);
    data.specular = at.path_class.diffuse_events() == 0;
    data.before = uint16_t(path.vertices.size() - 1);
    data.pdf_next_event = path.pdf_next_event;
    if (techniques.connections && scatters && at.path < LightVertices::most_connectible_paths) {
      path.kept = true;
      data.flux = at.state.throughput;
      block_.connectible.push_back({at.ray, at.hit, data, at.state.medium, false});
      connectible_paths_.push_back(at.path - begin_);
    }
    if (merges && may_merge) {
      path.kept = true;
      // As for photons: the density on the surface counts flux by the geometric cosine.
      data.flux =
          at.state.throughput *
          (vertex.has_relief() ? 1.0f
                               : abs_dot(vertex.wo(), vertex.normal()) / std::fabs(cos_geometric));
      kept_.push_back({at.path - begin_, vertex.position(), data});
    }
  }

  void splat(const LightVertex& at, const PathUnderWay& path) {
    SurfaceVertex painted;
    const bool wants_irradiance = in_.scene.film().quantity == Quantity::irradiance;
    if (wants_irradiance) {
      painted = at.vertex;
      painted.paint_white();
    }
    const SurfaceVertex& vertex = wants_irradiance ? painted : at.vertex;
    const Lobes seen = vertex.lobes() & (Lobes::diffuse | Lobes::glossy);
    if (!any(seen)) return;
    const CameraConnection connection = connect_to_camera(vertex.position(), at.sampler);
    if (!(connection.importance > 0)) return;
    const float weight = in_.weights.splat(
        splat_halves(path, connection, abs_dot(connection.direction, vertex.point().ng),
                     vertex.pdf_reverse(connection.direction, Lobes::all)));
    if (!(weight > 0)) return;
    const float scale =
        weight * connection.importance / (sqr(connection.distance) * float(in_.light_paths));
    Spectrum visible;
    bool traced = false;
    for (const Lobes lobe : {Lobes::diffuse, Lobes::glossy}) {
      const Component component = at.path_class.component_seen_by(lobe);
      if (!any(seen & lobe) || !in_.components.has(component)) continue;
      const Spectrum value =
          at.state.throughput * vertex.eval_cosine(connection.direction, lobe) * scale;
      if (value.is_zero()) continue;
      if (!traced) {
        traced = true;
        const Ray sight = spawn_ray_to(vertex.point(), connection.lens);
        visible =
            wants_irradiance
                ? Spectrum(is_unobstructed(in_.scene, sight, block_.rays) ? pi : 0.0f)
                : shadow_ray_transmittance(
                      in_.scene, sight, vertex.medium_toward(connection.direction, at.state.medium),
                      {at.state.wavelengths, at.sampler}, block_.rays);
        if (visible.is_zero()) return;
        ++block_.splats;
      }
      splats_.add(connection.raster, component, value * visible, at.state.wavelengths);
    }
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
    for (Kept& kept : kept_) {
      kept.data.path = begins[kept.path];
      block_.positions.push_back(kept.position);
      block_.data.push_back(kept.data);
    }
    for (LightScattering& event : scatterings_) {
      if (!paths_[event.path].kept) continue;
      event.path = begins[event.path];
      block_.scatterings.push_back(event);
    }
    for (MergeableMediumVertex& vertex : block_.in_media) vertex.path = begins[vertex.path];
    for (size_t i = 0; i < connectible_paths_.size(); ++i)
      block_.connectible[i].data.path = begins[connectible_paths_[i]];
  }

  const VcmLightInputs& in_;
  const Pass& pass_;
  Stream stream_;
  SplatBuffer& splats_;
  uint32_t begin_ = 0;
  std::vector<PathUnderWay> paths_;
  std::vector<Kept> kept_;
  std::vector<LightScattering> scatterings_;
  std::vector<uint32_t> connectible_paths_;
  Block block_;
};

/// So that vertices of the list's neighbourhood are near one another.
MediumVertices in_order(const std::vector<DiscHierarchy::Disc>& discs,
                        const std::vector<MergeableMediumVertex>& data) {
  if (data.empty()) return {};
  std::vector<Vec3f> positions;
  positions.reserve(discs.size());
  for (const DiscHierarchy::Disc& disc : discs) positions.push_back(disc.center);
  const std::vector<uint32_t> order = order_in_space(positions);
  std::vector<DiscHierarchy::Disc> ordered(discs.size());
  MediumVertices result;
  result.data.resize(data.size());
  for (size_t i = 0; i < order.size(); ++i) {
    ordered[i] = discs[order[i]];
    result.data[i] = data[order[i]];
  }
  result.discs = DiscHierarchy(std::move(ordered));
  return result;
}

}  // namespace

LightVertices trace_light_vertices(const VcmLightInputs& inputs, const Pass& pass, Stream stream,
                                   SplatBuffer& splats, std::stop_token stop,
                                   const ProgressFunction& progress, PassReport& report) {
  const size_t count = (inputs.light_paths + paths_per_block - 1) / paths_per_block;
  std::vector<Block> blocks(count);
  WorkCounter counter(inputs.light_paths, progress);
  parallel_blocks(inputs.light_paths, paths_per_block, [&](size_t begin, size_t end, size_t i) {
    if (stop.stop_requested()) return;
    blocks[i] = Tracer(inputs, pass, stream, splats).trace(uint32_t(begin), uint32_t(end));
    counter.add(end - begin);
  });
  LightVertices result;
  result.path_count = inputs.light_paths;
  result.remembered_paths = std::min(inputs.remembered_paths, inputs.light_paths);
  std::vector<size_t> vertex_begin(count + 1), data_begin(count + 1), connectible_begin(count + 1);
  std::vector<size_t> beginning_begin(count + 1), medium_begin(count + 1);
  std::vector<size_t> scattering_begin(count + 1);
  for (size_t i = 0; i < count; ++i) {
    vertex_begin[i + 1] = vertex_begin[i] + blocks[i].vertices.size();
    data_begin[i + 1] = data_begin[i] + blocks[i].data.size();
    connectible_begin[i + 1] = connectible_begin[i] + blocks[i].connectible.size();
    beginning_begin[i + 1] = beginning_begin[i] + blocks[i].beginnings.size();
    scattering_begin[i + 1] = scattering_begin[i] + blocks[i].scatterings.size();
    medium_begin[i + 1] = medium_begin[i] + blocks[i].in_media.size();
    report.rays += blocks[i].rays;
    report.photons += blocks[i].splats;
  }
  result.vertices.resize(vertex_begin[count]);
  result.connectible.resize(connectible_begin[count]);
  result.beginnings.resize(beginning_begin[count]);
  result.scatterings.resize(scattering_begin[count]);
  std::vector<Vec3f> positions(data_begin[count]);
  std::vector<LightVertexData> data(data_begin[count]);
  std::vector<DiscHierarchy::Disc> discs(medium_begin[count]);
  std::vector<MergeableMediumVertex> in_media(medium_begin[count]);
  parallel_blocks(count, 8, [&](size_t first, size_t last, size_t) {
    for (size_t i = first; i < last; ++i) {
      Block& block = blocks[i];
      for (LightVertexData& d : block.data) d.path += uint32_t(vertex_begin[i]);
      for (ConnectibleVertex& c : block.connectible) c.data.path += uint32_t(vertex_begin[i]);
      for (MergeableMediumVertex& m : block.in_media) m.path += uint32_t(vertex_begin[i]);
      for (LightPathBeginning& b : block.beginnings) b.path += uint32_t(vertex_begin[i]);
      for (LightScattering& s : block.scatterings) s.path += uint32_t(vertex_begin[i]);
      const auto copy = [](const auto& from, auto& to, size_t at) {
        std::copy(from.begin(), from.end(), to.begin() + std::ptrdiff_t(at));
      };
      copy(block.vertices, result.vertices, vertex_begin[i]);
      copy(block.positions, positions, data_begin[i]);
      copy(block.data, data, data_begin[i]);
      copy(block.connectible, result.connectible, connectible_begin[i]);
      copy(block.discs, discs, medium_begin[i]);
      copy(block.in_media, in_media, medium_begin[i]);
      copy(block.beginnings, result.beginnings, beginning_begin[i]);
      copy(block.scatterings, result.scatterings, scattering_begin[i]);
      block = {};
    }
  });
  const bool merges = inputs.weights.settings().techniques.merging;
  const size_t merging_count = merges ? data.size() + in_media.size() : 0;
  report.photons += merging_count > 0 ? merging_count : result.connectible.size();
  result.in_media = in_order(discs, in_media);
  if (!data.empty()) result.tree = {std::move(positions), std::move(data)};
  return result;
}

}  // namespace kaustik
