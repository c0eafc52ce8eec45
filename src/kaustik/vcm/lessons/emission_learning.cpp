#include "kaustik/vcm/lessons/emission_learning.h"

#include <algorithm>
#include <cmath>

namespace kaustik {
namespace {

/// Share of the light paths that what was learned never takes from the others: whatever was not
/// seen has at least so much of the chance that it would have without (of what only aimed rays come
/// to, times the part of them that is left).
constexpr double plain_share = 0.2;
/// Directions of a light are learned from so many of its paths on …
constexpr size_t least_paths = 64;
/// … and where the second moment falls at least to this share.
constexpr double worthwhile = 0.8;
/// All of it is taken up where it falls at least to this share: learned paths bring more vertices,
/// which take their time.
constexpr double worth_its_time = 0.65;
/// Of the share that is aimed so much may be left: never nothing, for what was not seen.
constexpr std::array<float, 3> aimed_parts{1, 0.5f, 0.2f};
/// Less is aimed, where nothing else is learned, if that takes off as much, and so many paths say
/// so.
constexpr double worth_aiming_less = 0.95;
constexpr size_t least_paths_for_aim = 1024;

/// Of what was learned only how much is aimed.
std::vector<LightPathEmission::Guide> aims_alone(const LightPathEmission& plain,
                                                 std::vector<LightPathEmission::Guide> guides) {
  for (size_t i = 0; i < guides.size(); ++i)
    guides[i] = {
        .chance = plain.chance(int(i)), .share = 0, .aimed = guides[i].aimed, .rays = nullptr};
  return guides;
}

}  // namespace

/// What is known of a light.
struct EmissionLearning::OfLight {
  std::vector<GuideSquare::Point> points;
  size_t paths = 0;
  /// Σ f² q/p by the plain emission of this light alone, for each of aimed_parts.
  std::array<double, aimed_parts.size()> plain_moments{};
  double root = 0;  ///< of the least moment that is known
};

EmissionLearning::EmissionLearning(const LightPathEmission& plain)
    : plain_(plain), maps_(plain.scene().lights().size()) {}

EmissionLearning::~EmissionLearning() = default;

void EmissionLearning::add(const LightPathStart& start, double use) {
  const double density = double(start.density.endpoint) * double(start.density.rest);
  const SurfacePoint& origin = start.emitted.origin;
  const Vec3f& direction = start.emitted.ray.direction;
  Path path;
  path.light = start.light;
  path.weight = use * use * density;
  path.plain = plain_.plain_pdf(start.light, origin, direction);
  path.own = plain_.own_pdf(start.light, origin, direction);
  if (!(path.weight > 0 && path.plain > 0) || !std::isfinite(path.weight)) return;
  path.place = map_of(start.light).place_of(origin, direction);
  paths_.push_back(path);
}

const GuideMap& EmissionLearning::map_of(int light) {
  auto& map = maps_[size_t(light)];
  const Scene& scene = plain_.scene();
  const Light& of = *scene.lights()[size_t(light)];
  if (!map)
    map = std::make_shared<const GuideMap>(of, shape_of(scene, of), scene.tracer().bounds());
  return *map;
}

namespace {

struct StoredPath {
  double weight = 0;
  float u[2] = {0, 0};
  float scale = 0, plain = 0, own = 0;
  int32_t light = -1;
};
static_assert(sizeof(StoredPath) == 32);

}  // namespace

void EmissionLearning::write(ByteWriter& writer) const {
  std::vector<StoredPath> stored;
  stored.reserve(paths_.size());
  for (const Path& path : paths_)
    stored.push_back({.weight = path.weight,
                      .u = {path.place.u.x, path.place.u.y},
                      .scale = path.place.scale,
                      .plain = path.plain,
                      .own = path.own,
                      .light = path.light});
  writer.put_array(stored);
}

void EmissionLearning::read(ByteReader& reader) {
  paths_.clear();
  for (const StoredPath& stored : reader.get_array<StoredPath>()) {
    if (stored.light < 0 || size_t(stored.light) >= maps_.size())
      reader.damaged("a path in it begins at no light");
    map_of(int(stored.light));
    for (const double value : {double(stored.plain), double(stored.own), stored.weight})
      if (!(value >= 0) || !std::isfinite(value)) reader.damaged("a density in it is none");
    if (!(stored.plain > 0)) reader.damaged("a density in it is none");
    Path path;
    path.light = int(stored.light);
    path.place.u = {stored.u[0], stored.u[1]};
    path.place.scale = stored.scale;
    path.plain = stored.plain;
    path.own = stored.own;
    path.weight = stored.weight;
    paths_.push_back(path);
  }
}

double EmissionLearning::plain_pdf(const Path& path, float aimed) const {
  const float all = plain_.aimed_share(path.light);
  const double part = all > 0 ? double(aimed / all) : 0.0;
  return double(path.own) + part * (double(path.plain) - double(path.own));
}

/// By every `step`th path from `first` on.
std::vector<LightPathEmission::Guide> EmissionLearning::learn(size_t first, size_t step) const {
  std::vector<OfLight> lights(maps_.size());
  size_t count = 0;
  for (size_t i = first; i < paths_.size(); i += step, ++count) {
    const Path& path = paths_[i];
    OfLight& of = lights[size_t(path.light)];
    ++of.paths;
    const float aimed = plain_.aimed_share(path.light);
    for (size_t part = 0; part < aimed_parts.size(); ++part)
      of.plain_moments[part] += path.weight / plain_pdf(path, aimed * aimed_parts[part]);
    if (path.place.scale > 0)
      of.points.push_back({path.place.u, path.weight / double(path.place.scale)});
  }
  std::vector<LightPathEmission::Guide> guides(lights.size());
  double roots = 0;
  size_t only_once = 0;
  for (size_t i = 0; i < lights.size(); ++i) {
    OfLight& of = lights[i];
    size_t part = 0;
    if (of.paths >= least_paths)
      part = size_t(std::min_element(of.plain_moments.begin(), of.plain_moments.end()) -
                    of.plain_moments.begin());
    guides[i].aimed = plain_.aimed_share(int(i)) * aimed_parts[part];
    double moment = of.plain_moments[part];
    if (of.points.size() >= least_paths) {
      GuideSquare square(std::move(of.points));
      if (square.expected_sum() < worthwhile * moment) {
        moment = square.expected_sum();
        guides[i].rays = std::make_shared<const GuidedLight>(maps_[i], std::move(square));
      }
    }
    of.root = std::sqrt(moment);
    roots += of.root;
    only_once += of.paths == 1 ? 1 : 0;
  }
  // How likely the next path of use comes from a light that none came from yet (Good 1953).
  const double unseen = count > 0 ? double(only_once) / double(count) : 1.0;
  const double left = plain_share + (1 - plain_share) * unseen;
  for (size_t i = 0; i < lights.size(); ++i) {
    const double by_use = roots > 0 ? (1 - left) * lights[i].root / roots : 0.0;
    const double chance = left * double(plain_.chance(int(i))) + by_use;
    guides[i].chance = float(chance);
    if (guides[i].rays) guides[i].share = float(by_use / chance);
  }
  return guides;
}

double EmissionLearning::second_moment(const LightPathEmission& emission, size_t first,
                                       size_t step) const {
  double sum = 0;
  for (size_t i = first; i < paths_.size(); i += step) {
    const Path& path = paths_[i];
    const auto plain = float(plain_pdf(path, emission.aimed_share(path.light)));
    const double density = double(emission.chance(path.light)) *
                           double(emission.pdf_of_chosen(path.light, plain, path.place));
    sum += path.weight / density;
  }
  return sum;
}

double EmissionLearning::second_moment(const LightPathEmission& emission) const {
  return second_moment(emission, 0, 1);
}

std::shared_ptr<const LightPathEmission> EmissionLearning::learned() const {
  if (paths_.size() < least_paths) return nullptr;
  double guided = 0, aimed = 0;
  for (size_t half = 0; half < 2; ++half) {
    std::vector<LightPathEmission::Guide> guides = learn(half, 2);
    guided += second_moment({plain_, guides}, 1 - half, 2);
    aimed += second_moment({plain_, aims_alone(plain_, guides)}, 1 - half, 2);
  }
  const double plain = second_moment(plain_);
  const bool may_aim_less = paths_.size() >= least_paths_for_aim;
  if (guided < worth_its_time * (may_aim_less ? std::min(plain, aimed) : plain))
    return std::make_shared<const LightPathEmission>(plain_, learn(0, 1));
  if (may_aim_less && aimed < worth_aiming_less * plain)
    return std::make_shared<const LightPathEmission>(plain_, aims_alone(plain_, learn(0, 1)));
  return nullptr;
}

}  // namespace kaustik
