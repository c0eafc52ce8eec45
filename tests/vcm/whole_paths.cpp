#include "tests/vcm/whole_paths.h"

#include <fmt/format.h>

namespace kaustik::test {
namespace {

/// Points are the same to within this, m.
constexpr float near_by = 1e-4f;

bool is_near(const Vec3f& a, const Vec3f& b) { return length_sq(a - b) < sqr(near_by); }

/// The one way on that a delta event leaves, through what transmits; nothing if
/// it reflects.
std::optional<Vec3f> direction_through(const SurfaceVertex& vertex) {
  constexpr float last = 0.99999994f;
  const BsdfSample sample = vertex.sample(last, {0.5f, 0.5f}, Lobes::delta);
  if (sample.event != Lobes::delta || !sample.transmission) return std::nullopt;
  return sample.wi;
}

/// Finds the weights one after the other.
class Finder {
 public:
  Finder(const WholePathRules& rules, const WholePath& path)
      : rules_(rules), path_(path), light_(path.light()), n_(path.size()) {}

  bool find() {
    const Techniques& on = rules_.weights.settings().techniques;
    if (on.unidirectional && !add(Found::unidirectional, n_, unidirectional())) return false;
    if (on.splats && n_ >= 3 && !step(1).delta && !add(Found::splat, 0, splat())) return false;
    for (size_t t = 1; t < n_; ++t) {
      if (step(t).delta) continue;
      const bool is_last = t + 1 == n_;
      if (is_last && on.next_event && !add(Found::next_event, t, next_event())) return false;
      if (is_last) break;
      if (on.connections && !step(t + 1).delta && !add(Found::connection, t, connection(t)))
        return false;
      if (on.merging && !add(Found::merge, t, merge(t))) return false;
    }
    return true;
  }
  WholePathWeights result;

 private:
  const WholePathStep& step(size_t t) const { return path_.steps()[t - 1]; }
  const Light& lamp() const { return *rules_.scene.lights()[size_t(light_.start().light)]; }

  bool add(Found by, size_t t, std::optional<double> weight) {
    if (!weight) return false;
    result.parts.push_back({by, t, *weight});
    return true;
  }

  std::optional<double> unidirectional() const {
    if (lamp().traits().is_delta) return 0;
    SteeredWalk steered(rules_, path_, light_.light());
    if (!steered.go_to(n_ - 1) || !steered.leave(path_.steps().back())) return std::nullopt;
    const Vec3f direction = steered.walk().ray().direction;
    const Spectrum throughput = steered.walk().throughput();
    const bool arrives = steered.go_on();
    if (arrives == lamp().is_infinite()) return std::nullopt;
    const Spectrum alone =
        throughput * (arrives ? lamp().emitted(steered.walk().vertex().point(), -direction, {})
                              : lamp().distant().background(direction, {}));
    if (alone.is_zero()) return std::nullopt;
    return steered.found() / double(alone.sum());
  }

  std::optional<double> next_event() const {
    SteeredWalk steered(rules_, path_, light_.light());
    if (!steered.go_to(n_ - 1)) return std::nullopt;
    const SurfaceVertex& vertex = steered.walk().vertex();
    const LightQuery query = Receiver(vertex, std::min(steered.walk().events(), 1)).query();
    const EmittedRay& emitted = light_.start().emitted;
    DirectLight light;
    light.light = light_.start().light;
    light.wi = path_.steps().back().direction;
    light.on_light = emitted.origin;
    light.distance =
        lamp().is_infinite() ? infinity : length(emitted.origin.position - vertex.position());
    if (lamp().traits().is_delta)
      light.pdf_sampled =
          rules_.scene.light_selector().probability(query.reference, query.normal, light.light);
    else
      light.pdf_sampled =
          lamp().is_infinite()
              ? direct_light_pdf(rules_.scene, query, LightChoice::one, light.light, light.wi)
              : direct_light_pdf(rules_.scene, query, LightChoice::one, light.light,
                                 light.on_light);
    light.pdf_solid_angle = lamp().traits().is_delta ? 0 : light.pdf_sampled;
    return double(steered.path().weights().sampled(vertex, light));
  }

  std::optional<double> splat() const {
    const LonePath::Vertex& at = *light_.at(path_.last());
    const CameraConnection camera =
        rules_.scene.camera().connect(at.vertex.position(), Camera::middle_of_lens());
    const std::optional<double> splatted = light_.splatted(path_.last());
    const Spectrum alone = at.record.data.flux.spectrum() *
                           at.vertex.eval_cosine(camera.direction, Lobes::all) *
                           (camera.importance / sqr(camera.distance));
    if (!splatted || alone.is_zero()) return std::nullopt;
    return *splatted / double(alone.sum());
  }

  std::optional<double> connection(size_t t) const {
    const LonePath::Vertex& other = *light_.at(step(t + 1).light);
    LightVertices light;
    light.vertices = light_.light().vertices;
    light.connectible = {other.record};
    light.path_count = 1;
    SteeredWalk steered(rules_, path_, light);
    if (!steered.go_to(t)) return std::nullopt;
    const SurfaceVertex& vertex = steered.walk().vertex();
    const Vec3f between = other.vertex.position() - vertex.position();
    const Vec3f direction = normalize(between);
    const Spectrum alone = steered.walk().throughput() * vertex.eval_cosine(direction, Lobes::all) *
                           other.vertex.eval_cosine(-direction, Lobes::all) *
                           other.record.data.flux.spectrum() * (1 / length_sq(between));
    if (alone.is_zero()) return std::nullopt;
    steered.path().connect();
    return steered.found() / double(alone.sum());
  }

  std::optional<double> merge(size_t t) {
    LightVertices light;
    light.vertices = light_.light().vertices;
    light.path_count = 1;
    const auto& tree = light_.light().tree.tree();
    for (uint32_t i = 0; i < tree.size(); ++i)
      if (tree.data(i).before == step(t).light)
        light.tree = SidedTree<LightVertexData>(std::vector<Vec3f>{tree.key(i)},
                                                std::vector<LightVertexData>{tree.data(i)});
    if (light.tree.empty()) return std::nullopt;
    SteeredWalk steered(rules_, path_, light);
    if (!steered.go_to(t) || !lies_free(steered.walk(), t)) return std::nullopt;
    const auto alone = steered.path().merged_vertices();
    if (alone.size() != 1 || alone[0].light.is_zero()) return std::nullopt;
    steered.path().merge();
    const double weight = steered.found() / double(alone[0].light.sum());
    const Vec3f exact = -light_.at(step(t).light)->record.ray.direction;
    const SurfaceVertex& vertex = steered.walk().vertex();
    const LightVertexData& stored = light.tree.tree().data(0);
    double error = rounding(vertex, stored.direction.unpack(), exact);
    if (vertex.lobes() == Lobes::diffuse) error += 2 * rounding_of_normal(vertex, stored, exact);
    result.rounding += 2 * weight * (1 - weight) * error;
    return weight;
  }

  /// Relative error of densities by that of a direction.
  static double rounding(const SurfaceVertex& vertex, const Vec3f& stored, const Vec3f& exact) {
    const auto change = [](float a, float b) { return std::fabs(double(a) / double(b) - 1); };
    return change(vertex.pdf(stored, Lobes::all), vertex.pdf(exact, Lobes::all)) +
           change(vertex.pdf_reverse(stored, Lobes::all), vertex.pdf_reverse(exact, Lobes::all));
  }

  /// The same by that of a normal in 3 × 8 bits, of which merging on matt surfaces takes its
  /// cosine. It counts twice: in the density of the next vertex, and in the spread of those merged
  /// there.
  static double rounding_of_normal(const SurfaceVertex& vertex, const LightVertexData& stored,
                                   const Vec3f& exact) {
    const double coarse = std::fabs(double(stored.side.dot(exact))) / double(stored.side.length());
    return std::fabs(coarse / double(abs_dot(exact, vertex.point().ng)) - 1);
  }

  /// Whether the disk at x_t is whole.
  bool lies_free(CameraWalk& walk, size_t t) const {
    size_t first = 1;
    while (step(first).delta) ++first;
    const Vec3f side = MergeDisk(walk.vertex(), 1).side();
    const float area =
        t == first ? rules_.plans.at(path_.raster(), 1, walk.vertex().position(), side).merge_area
                   : rules_.weights.settings().merge_area;
    const float radius = std::sqrt(inv_pi * area);
    const DiskCoverage covered(rules_.scene, MergeDisk(walk.vertex(), radius), walk.rays());
    if (!(covered.clear_radius() >= radius)) return false;
    for (const float angle : {0.0f, 1.0f, 2.0f, 3.0f, 4.0f, 5.0f})
      if (!covered.holds(radius, radius, angle)) return false;
    return true;
  }

  const WholePathRules& rules_;
  const WholePath& path_;
  const LonePath& light_;
  size_t n_;
};

}  // namespace

bool WholePath::retrace() {
  const Light& lamp = *rules_.scene.lights()[size_t(light_.start().light)];
  Ray ray = rules_.scene.camera().sample_ray(raster_, Camera::middle_of_lens());
  bool before_last = true;
  size_t i = m_;
  while (i > 0) {
    Hit hit;
    if (steps_.size() > 2 * m_ + 2 || !rules_.scene.intersect(ray, hit)) return false;
    const SurfaceVertex vertex(rules_.scene, ray, hit, TransportMode::radiance);
    // What it emits itself would count as found.
    if (vertex.light() >= 0) return false;
    const LonePath::Vertex* here = light_.at(i);
    const bool arrived = here && is_near(here->vertex.position(), vertex.position());
    if (arrived) {
      before_last = false;
      steps_.push_back(step_from(i--, vertex, ray.direction));
    } else {
      const std::optional<Vec3f> through = direction_through(vertex);
      if (!through || (here && !before_last)) return false;
      steps_.push_back({*through, before_last ? 0 : i, true});
      if (!before_last) --i;
    }
    ray = spawn_ray(vertex.point(), steps_.back().direction);
  }
  return lamp.traits().is_delta || ends_at_light(ray);
}

WholePathStep WholePath::step_from(size_t i, const SurfaceVertex& vertex,
                                   const Vec3f& arriving) const {
  if (i < m_ && light_.is_delta(i)) return {arriving, i, true};
  const bool has_point =
      i > 1 || !rules_.scene.lights()[size_t(light_.start().light)]->is_infinite();
  const Vec3f* next = nullptr;
  if (i == 1 && has_point) next = &light_.start().emitted.origin.position;
  if (i > 1 && light_.at(i - 1)) next = &light_.at(i - 1)->vertex.position();
  const Vec3f direction =
      next ? normalize(*next - vertex.position()) : -light_.at(i)->record.ray.direction;
  return {direction, i, false};
}

bool WholePath::ends_at_light(const Ray& ray) const {
  const LightPathStart& start = light_.start();
  Hit hit;
  const bool meets = rules_.scene.intersect(ray, hit);
  if (rules_.scene.lights()[size_t(start.light)]->is_infinite()) return !meets;
  if (!meets) return false;
  const SurfaceVertex vertex(rules_.scene, ray, hit, TransportMode::radiance);
  return vertex.light() == start.light && is_near(vertex.position(), start.emitted.origin.position);
}

std::string WholePathWeights::text() const {
  std::string text;
  for (const Part& part : parts)
    text += fmt::format("{} {} {:.6f}, ", found_names[size_t(part.by)], part.t, part.weight);
  return text + fmt::format("sum {:.7f}, rounding {:.1e}", sum(), rounding);
}

std::optional<WholePathWeights> weights_of(const WholePathRules& rules, const WholePath& path) {
  Finder finder(rules, path);
  if (!finder.find()) return std::nullopt;
  if (finder.result.sum() == 0) return std::nullopt;
  return std::move(finder.result);
}

}  // namespace kaustik::test
