// What a photon costs: memory, a radiance estimate beside the bare search of the tree, and merging
// at matt and at glossy surfaces.
#include <ctime>
#include <random>

#include "benchmarks/report.h"
#include "benchmarks/shipped_scenes.h"
#include "kaustik/loader/mitsuba_xml.h"
#include "kaustik/vcm/camera_path/camera_path.h"
#include "kaustik/vcm/merging/matt_merging.h"

namespace {

using namespace kaustik;

constexpr int neighbors = 50;
constexpr size_t query_count = 50000;
constexpr int repeats = 9;
/// Million contributions per second and core, bsdf and weight included.
constexpr bench::Bar merging_bar{8};

double cpu_seconds_of(const auto& work) {
  const std::clock_t start = std::clock();
  work();
  return double(std::clock() - start) / CLOCKS_PER_SEC;
}

void measure_estimate(const PhotonMap& map) {
  std::mt19937 random(3);
  std::normal_distribution<float> jitter(0, 2e-4f);
  std::vector<std::pair<Vec3f, Vec3f>> queries;
  for (size_t i = 0; i < query_count; ++i) {
    const auto index = uint32_t(random() % map.size());
    queries.emplace_back(map.tree().key(index) + Vec3f(jitter(random), jitter(random), 0),
                         map.tree().data(index).side.unpack());
  }
  EstimateSettings settings;
  settings.neighbors = neighbors;
  settings.kernel = Kernel::cone;
  KdTree<3, Vec3f, Photon>::Neighbors found;
  Scratch scratch;
  double sum = 0;
  std::vector<double> searches, estimates;
  for (int i = 0; i < repeats; ++i) {
    searches.push_back(cpu_seconds_of([&] {
      for (const auto& [position, side] : queries) {
        map.tree().nearest(position, neighbors, infinity, KdAcceptAll(), found);
        sum += double(found.farthest_sq());
      }
    }));
    estimates.push_back(cpu_seconds_of([&] {
      for (const auto& [position, side] : queries)
        sum += double(map.irradiance(position, side, settings, scratch).value.sum());
    }));
  }
  const double search = bench::median(searches), estimate = bench::median(estimates);
  bench::report(
      "estimate_vs_search", estimate / search, "ratio of times (lower is better)",
      fmt::format("bare search for {} photons: {:.2f} us, estimate {:.2f} us (checksum "
                  "{:.3g})",
                  neighbors, 1e6 * search / query_count, 1e6 * estimate / query_count, sum));
}

/// Light vertices strewn over a square of 1 m², as after a diffuse event.
LightVertices strewn_vertices(size_t count) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> unit(0, 1);
  LightVertices light;
  light.path_count = uint32_t(count);
  std::vector<Vec3f> positions(count);
  std::vector<LightVertexData> data(count);
  for (size_t i = 0; i < count; ++i) {
    positions[i] = {unit(random), unit(random), 0};
    for (size_t lane = 0; lane < 3; ++lane) data[i].flux.lanes[lane] = unit(random);
    data[i].side = CoarseNormal({0, 0, 1});
    data[i].direction = PackedDirection(normalize(Vec3f(unit(random), unit(random), 1)));
    data[i].before = 2;
    data[i].specular = false;
    data[i].path = uint32_t(3 * i);
    data[i].pdf_next_event = 1;
    for (int k = 0; k < 3; ++k) light.vertices.push_back({1, 1, 1, 1, false});
  }
  light.tree = {std::move(positions), std::move(data)};
  return light;
}

/// Contributions of light vertices to points, bsdf and weight included, on one core.
void measure_merging(const LightVertices& light, double per_point) {
  PathWeights::Settings settings;
  settings.techniques = {true, true, true, true, true};
  settings.light_paths = float(light.path_count);
  const PathWeights weights(settings);
  const MattMerging merging(light, weights);
  const double area = per_point / double(light.path_count);
  const PathVertex seen{1, 0, 0, 1, false};
  MattDisk disk;
  disk.normal = {0, 0, 1};
  disk.radius = float(std::sqrt(area / double(pi)));
  disk.flatness = 0.3f * disk.radius;
  disk.least_cosine = 0.5f;
  disk.weights = weights.matt_vertex({&seen, 1}, float(area), 0.1f);
  double sum = 0;
  std::vector<double> times;
  for (int i = 0; i < repeats; ++i) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> unit(0.1f, 0.9f);
    times.push_back(cpu_seconds_of([&] {
      for (size_t q = 0; q < query_count; ++q) {
        disk.center = {unit(random), unit(random), 0};
        sum += double(merging.merge(disk).other.wide.sum());
      }
    }));
  }
  bench::report(fmt::format("merging_{:.0f}", per_point),
                per_point * query_count / bench::median(times) / 1e6,
                "million contributions per second and core",
                fmt::format("{} light vertices, {:.0f} near each point (checksum {:.3g})",
                            light.path_count, per_point, sum),
                merging_bar);
}

constexpr float picture_size = 256;
/// Of vertices that take many times as long as matt ones.
constexpr size_t glossy_queries = 5000;

/// The square over which light vertices are strewn, of that material, as a camera above sees it.
std::shared_ptr<const Scene> glossy_square(const std::string& bsdf) {
  return build_scene(parse_mitsuba_xml(
      "<scene version=\"3.0.0\"><sensor type=\"perspective\"><float name=\"fov\" value=\"20\"/>"
      "<transform name=\"to_world\"><lookat origin=\"0.5, 0.3, 2\" target=\"0.5, 0.5, 0\" "
      "up=\"0, 1, 0\"/></transform><film type=\"hdrfilm\"><integer name=\"width\" value=\"256\"/>"
      "<integer name=\"height\" value=\"256\"/></film></sensor>"
      "<emitter type=\"point\"><point name=\"position\" x=\"0\" y=\"0\" z=\"3\"/></emitter>"
      "<shape type=\"rectangle\"><transform name=\"to_world\"><scale value=\"0.5\"/>"
      "<translate x=\"0.5\" y=\"0.5\"/></transform>" +
          bsdf + "</shape></scene>",
      "benchmark", ""));
}

/// Merges at the first vertices of camera paths or, to know what that takes alone, only goes there;
/// returns the sum of what was found.
double merge_along(const CameraPathInputs& inputs, const PixelPlan& plan, bool merges) {
  double sum = 0;
  for (size_t q = 0; q < glossy_queries; ++q) {
    Sampler sampler = Sampler::at(1, 0, Stream::camera, q, 0);
    SampleSink sink(ComponentSet::all());
    const Vec2f raster = sampler.next_2d() * picture_size;
    CameraPath path(inputs, plan, raster, sampler, sink);
    if (path.go_on(false) != CameraWalk::Arrival::surface) continue;
    if (merges) path.merge();
    for (int c = 0; c < component_count; ++c) sum += double(sink.radiance(Component(c)).sum());
  }
  return sum;
}

/// The same as measure_merging() where bsdfs and weights are found vertex by vertex: with the rays
/// that tell how much of each disk is surface.
void measure_glossy_merging(const LightVertices& light, const std::string& name,
                            const std::string& bsdf, double per_point) {
  const auto scene = glossy_square(bsdf);
  const LightPathEmission emission(*scene);
  PathWeights::Settings settings;
  settings.techniques = {true, true, true, true, true};
  settings.light_paths = float(light.path_count);
  const PathWeights weights(settings);
  const MattMerging no_matt;
  const SeenSurfaces seen;
  PixelPlan plan;
  plan.merge_area = float(per_point / double(light.path_count));
  const LightTails tails(light, weights);
  const CameraPathInputs inputs{.scene = *scene,
                                .emission = emission,
                                .weights = weights,
                                .light = light,
                                .matt = no_matt,
                                .tails = &tails,
                                .seen = seen,
                                .connection_scale = 1};
  double sum = 0;
  std::vector<double> times;
  for (int i = 0; i < repeats; ++i) {
    const double going = cpu_seconds_of([&] { merge_along(inputs, plan, false); });
    times.push_back(cpu_seconds_of([&] { sum += merge_along(inputs, plan, true); }) - going);
  }
  bench::report(fmt::format("merging_{}_{:.0f}", name, per_point),
                per_point * glossy_queries / bench::median(times) / 1e6,
                "million contributions per second and core",
                fmt::format("{} light vertices, {:.0f} near each point, with the rays that find "
                            "how much of a disk is covered (checksum {:.3g})",
                            light.path_count, per_point, sum),
                merging_bar);
}

}  // namespace

int main() {
  const PhotonMap map = bench::ring_caustic(1000000);
  bench::report("bytes_per_photon", double(map.size_in_bytes()) / double(map.size()), "bytes",
                "4 lanes of flux (16), position (12), direction, distance, side, tree");
  bench::report("kdtree_build_temporary_bytes_per_photon",
                double(sizeof(Vec3f) + sizeof(Photon) + sizeof(uint32_t)), "bytes",
                "input arrays and order, freed when the build ends");
  measure_estimate(map);
  const LightVertices light = strewn_vertices(1000000);
  for (const double per_point : {30.0, 300.0}) measure_merging(light, per_point);
  for (const double per_point : {30.0, 300.0}) {
    measure_glossy_merging(light, "phong",
                           "<bsdf type=\"phong\"><float name=\"exponent\" value=\"30\"/></bsdf>",
                           per_point);
    measure_glossy_merging(
        light, "roughconductor",
        "<bsdf type=\"roughconductor\"><float name=\"alpha\" value=\"0.2\"/></bsdf>", per_point);
  }
  return 0;
}
