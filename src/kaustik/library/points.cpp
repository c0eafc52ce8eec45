#include "kaustik/points.h"

#include <algorithm>
#include <utility>

#include "kaustik/library/access.h"
#include "kaustik/library/boundary.h"
#include "kaustik/render/measuring.h"

namespace kaustik::v0 {
namespace {

using details::Access;
using details::SceneState;

/// (count, 3); a single row stands for `count` of them.
Property list_of(const char* name, std::span<const Vec3> rows, size_t count) {
  const bool is_one_for_all = rows.size() == 1;
  const size_t row_count = is_one_for_all ? count : rows.size();
  std::vector<double> numbers;
  numbers.reserve(3 * row_count);
  for (size_t i = 0; i < row_count; ++i) {
    const Vec3& row = rows[is_one_for_all ? 0 : i];
    numbers.insert(numbers.end(), {row.x, row.y, row.z});
  }
  return {name, kaustik::Array::of<double>({row_count, 3}, std::move(numbers)), {}};
}

/// Shares with the scene what is built of it.
Scene scene_of(const SceneState& scene, const char* sensor, std::vector<Property> lists) {
  return Access::made(
      SceneState{.description = measuring(scene.description, sensor, std::move(lists)),
                 .built = std::make_shared<details::BuiltScene>(scene.built)});
}

SessionSettings with_defaults(SessionSettings settings) {
  if (!settings.camera.empty())
    throw wrong_input("the setting 'camera' is given to what measures by itself", "leave it out");
  if (settings.integrator.empty()) settings.integrator = MeasuringDefaults::integrator;
  const bool has_end = settings.passes != 0 || settings.samples_per_pixel != 0 ||
                       settings.seconds != 0 || settings.error != 0;
  if (!has_end) settings.passes = MeasuringDefaults::passes;
  if (settings.samples_per_pixel == 0 && settings.samples_per_pass == 0)
    settings.samples_per_pass = MeasuringDefaults::samples_per_pass;
  return settings;
}

Estimates estimates_of(Picture picture, size_t count) {
  Estimates estimates{{}, {}, std::move(picture)};
  const Picture& from = estimates.picture;
  const auto red = from.plane("R"), green = from.plane("G"), blue = from.plane("B");
  const auto width = size_t(from.width());
  for (size_t i = 0; i < count; ++i) {
    estimates.luminance.push_back(from.pixel(int(i % width), int(i / width)));
    estimates.rgb.push_back({red[i], green[i], blue[i]});
  }
  return estimates;
}

Estimates measured(const Scene& scene, const char* sensor, const char* places_name,
                   std::span<const Vec3> places, const char* directions_name,
                   std::span<const Vec3> directions, const SessionSettings& settings,
                   Callbacks callbacks) {
  return guarded([&] {
    const SceneState& state = Access::scene(scene);
    const size_t count = std::max(places.size(), directions.size());
    const Scene meters = scene_of(
        state, sensor,
        {list_of(places_name, places, count), list_of(directions_name, directions, count)});
    Session session(meters, with_defaults(settings), std::move(callbacks));
    session.run();
    state.built->put(Access::scene(meters).built->get());
    return estimates_of(session.picture(), count);
  });
}

}  // namespace

Estimates irradiance(const Scene& scene, std::span<const Vec3> points,
                     std::span<const Vec3> normals, const SessionSettings& settings,
                     Callbacks callbacks) {
  return measured(scene, "irradiancepoints", "points", points, "normals", normals, settings,
                  std::move(callbacks));
}

Estimates radiance(const Scene& scene, std::span<const Vec3> origins,
                   std::span<const Vec3> directions, const SessionSettings& settings,
                   Callbacks callbacks) {
  return measured(scene, "radiancerays", "origins", origins, "directions", directions, settings,
                  std::move(callbacks));
}

}  // namespace kaustik::v0
