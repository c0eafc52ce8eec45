// What aiming caustic photons brings: photons that arrive and the variance of the caustic, per
// second of the light pass, for every aim.
#include "benchmarks/report.h"
#include "benchmarks/shipped_scenes.h"
#include "kaustik/base/statistics.h"
#include "kaustik/loader/mitsuba_xml.h"

namespace {

using namespace kaustik;

constexpr int passes = 16, photons = 60'000;
constexpr size_t place_count = 500;

const std::string floor_and_camera =
    "<scene version=\"3.0.0\"><sensor type=\"perspective\"><float name=\"fov\" value=\"60\"/>"
    "<transform name=\"to_world\"><lookat origin=\"0, -2.5, 2.5\" target=\"0, 0, 0\" "
    "up=\"0, 0, 1\"/></transform><film type=\"hdrfilm\"/></sensor><shape "
    "type=\"rectangle\"><transform "
    "name=\"to_world\"><scale value=\"3\"/></transform><bsdf type=\"diffuse\"/></shape>";

std::string glass_ball(double x, double y, double z, double radius) {
  return fmt::format(
      "<shape type=\"sphere\"><point name=\"center\" x=\"{}\" y=\"{}\" z=\"{}\"/>"
      "<float name=\"radius\" value=\"{}\"/><bsdf type=\"dielectric\"/></shape>",
      x, y, z, radius);
}

/// A hundred small balls of glass under a square lamp.
std::string many_balls() {
  std::string text = floor_and_camera;
  for (int i = 0; i < 100; ++i)
    text += glass_ball(0.4 * (i % 10 - 4.5), 0.4 * (i / 10 - 4.5), 0.2 + 0.02 * (i * 7 % 10), 0.05);
  return text +
         "<shape type=\"rectangle\"><transform name=\"to_world\"><scale value=\"0.1\"/><rotate "
         "x=\"1\" angle=\"180\"/><translate z=\"3\"/></transform><emitter type=\"area\"/>"
         "</shape></scene>";
}

/// One ball of glass, twenty metres from a closed box of a lamp.
std::string far_ball() {
  return floor_and_camera + glass_ball(0, 0, 0.5, 0.3) +
         "<shape type=\"cube\"><transform name=\"to_world\"><scale value=\"0.3\"/><translate "
         "x=\"3\" z=\"20\"/></transform><emitter type=\"area\"><rgb name=\"radiance\" "
         "value=\"1000\"/></emitter></shape></scene>";
}

/// Places where caustics fall: photons of a pass of their own, the same for every aim.
struct Place {
  Vec3f position, side;
};
std::vector<Place> caustic_places(const Scene& scene) {
  LightPassSettings settings;
  settings.caustic_photons = photons;
  const PhotonMap map = LightPass(scene, settings, 7).trace(7, 0).caustic;
  std::vector<Place> places;
  for (size_t i = 0; i < place_count; ++i) {
    const auto index = uint32_t(i * map.size() / place_count);
    places.push_back({map.tree().key(index), map.tree().data(index).side.unpack()});
  }
  return places;
}

struct Result {
  double stored_per_second = 0;
  double seconds = 0;   ///< median over passes of the time that tracing takes
  double variance = 0;  ///< of irradiance in a fixed radius, over its squared mean, over all places
};

Result measure(const Scene& scene, const std::vector<Place>& places, Aim aim) {
  LightPassSettings settings;
  settings.caustic_photons = photons;
  settings.aim = aim;
  const LightPass pass(scene, settings, 1);
  EstimateSettings estimate;
  estimate.neighbors = 1'000'000;
  estimate.maximum_radius = 0.02f * bounding_radius(scene.tracer().bounds());
  std::vector<RunningStatistics> irradiances(places.size());
  std::vector<double> seconds;
  double stored = 0;
  Scratch scratch;
  for (uint32_t i = 0; i < passes; ++i) {
    const PhotonMaps maps = pass.trace(1, i);
    seconds.push_back(maps.trace_seconds);
    stored += double(maps.caustic.size());
    for (size_t k = 0; k < places.size(); ++k)
      irradiances[k].add(
          double(maps.caustic.irradiance(places[k].position, places[k].side, estimate, scratch)
                     .value.sum()));
  }
  Result result;
  result.seconds = bench::median(seconds);
  result.stored_per_second = stored / passes / result.seconds;
  double variance = 0, squares = 0;
  for (const RunningStatistics& irradiance : irradiances) {
    variance += irradiance.variance();
    squares += irradiance.mean() * irradiance.mean();
  }
  result.variance = variance / squares;
  return result;
}

void compare(const std::string& name, const Description& description) {
  const auto scene = build_scene(description);
  const std::vector<Place> places = caustic_places(*scene);
  double by_power = 0;
  for (const auto& [aim, text] : {std::pair(Aim::none, "none"), std::pair(Aim::boxes, "boxes"),
                                  std::pair(Aim::projection_map, "projection_map")}) {
    const Result result = measure(*scene, places, aim);
    const double cost = result.variance * result.seconds;
    if (aim == Aim::none) by_power = cost;
    bench::report(fmt::format("{}_{}", name, text), by_power / cost,
                  "variance x seconds without aiming over that with",
                  fmt::format("{:.3g} photons stored per second, {:.3g} s for {} photons, relative "
                              "variance {:.3g}",
                              result.stored_per_second, result.seconds, photons, result.variance));
  }
}

}  // namespace

int main() {
  try {
    compare("many_balls", parse_mitsuba_xml(many_balls(), "benchmark", ""));
    compare("far_ball", parse_mitsuba_xml(far_ball(), "benchmark", ""));
    for (const char* name : {"metal_ring", "cornell_spheres"})
      compare(name, bench::load_shipped(name));
  } catch (const Error& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
  return 0;
}
