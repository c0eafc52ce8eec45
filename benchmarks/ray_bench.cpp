// How much of bare Embree's speed is left in a light pass and in path tracing: their rays are
// recorded, then traced again by a bare loop of rtcIntersect1 and rtcOccluded1 on as many threads.
// And what the camera's rays would gain if they were traced in packets.
#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif
#include <tbb/enumerable_thread_specific.h>

#include <malloc.h>

#include <filesystem>
#include <fstream>

#include "benchmarks/report.h"
#include "benchmarks/shipped_scenes.h"
#include "kaustik/base/parallel.h"
#include "kaustik/integrator/override_integrator.h"
#include "kaustik/loader/mitsuba_xml.h"
#include "kaustik/render/session.h"
#include "kaustik/scene/overrides.h"

namespace {

using namespace kaustik;

constexpr int threads = 2;
constexpr int repeats = 5;
/// What path tracing has to keep of bare speed on cornell_box, and should.
constexpr bench::Bar path_bar{0.35, 0.5};

struct RecordedRay {
  Ray ray;
  bool shadow;
};

/// Keeps every ray, by thread, in the order in which it was traced.
class Recorder final : public RayObserver {
 public:
  void on_ray(const Ray& ray, bool shadow) override {
    if (enabled) lists_.local().push_back({ray, shadow});
  }
  std::vector<std::vector<RecordedRay>> take() {
    std::vector<std::vector<RecordedRay>> lists;
    for (auto& list : lists_) lists.push_back(std::move(list));
    lists_.clear();
    return lists;
  }
  std::atomic<bool> enabled{false};

 private:
  tbb::enumerable_thread_specific<std::vector<RecordedRay>> lists_;
};

void trace_bare(RTCScene scene, const RecordedRay& recorded) {
  const Ray& r = recorded.ray;
  RTCRayHit query;
  query.ray = {
      r.origin.x, r.origin.y,  r.origin.z, 0, r.direction.x, r.direction.y, r.direction.z, 0,
      r.t_max,    0xffffffffu, 0,          0};
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
#if RTC_VERSION_MAJOR >= 4
  if (recorded.shadow)
    rtcOccluded1(scene, &query.ray);
  else
    rtcIntersect1(scene, &query);
#else
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  if (recorded.shadow)
    rtcOccluded1(scene, &context, &query.ray);
  else
    rtcIntersect1(scene, &context, &query);
#endif
}

/// Wall time of the bare loop over all rays, in blocks as they were traced.
double bare_seconds(const Scene& scene, const std::vector<std::vector<RecordedRay>>& lists) {
  struct Range {
    const RecordedRay* begin;
    size_t count;
  };
  std::vector<Range> ranges;
  constexpr size_t block = 8192;
  for (const auto& list : lists)
    for (size_t i = 0; i < list.size(); i += block)
      ranges.push_back({list.data() + i, std::min(block, list.size() - i)});
  const auto bare = static_cast<RTCScene>(scene.tracer().embree_scene());
  double seconds = 0;
  with_threads(threads, [&] {
    seconds = bench::seconds_of([&] {
      parallel_blocks(ranges.size(), 1, [&](size_t i, size_t, size_t) {
        for (size_t k = 0; k < ranges[i].count; ++k) trace_bare(bare, ranges[i].begin[k]);
      });
    });
  });
  return seconds;
}

/// The share of bare speed that `work` keeps: median over interleaved repeats.
template <typename Work>
void compare(const std::string& name, const Scene& scene, Recorder& recorder, const Work& work,
             const bench::Bar& bar = {}) {
  recorder.enabled = true;
  work();
  recorder.enabled = false;
  const auto rays = recorder.take();
  size_t count = 0;
  for (const auto& list : rays) count += list.size();
  std::vector<double> ratios, rates;
  for (int i = 0; i < repeats; ++i) {
    const double bare = bare_seconds(scene, rays);
    const double ours = work();
    ratios.push_back(bare / ours);
    rates.push_back(double(count) / bare / 1e6);
  }
  bench::report(name, bench::median(ratios), "ratio of rays per second",
                fmt::format("rtcIntersect1/rtcOccluded1 on the same {} rays in the same order, {} "
                            "threads, {:.1f} Mrays/s",
                            count, threads, bench::median(rates)),
                bar);
}

void compare_photons(const std::string& name, const Description& description,
                     uint32_t photon_count) {
  Recorder recorder;
  const auto scene = build_scene(description, {&recorder});
  LightPassSettings settings;
  settings.global_photons = photon_count;
  settings.caustic_photons = photon_count;
  const LightPass pass(*scene, settings, 1);
  compare(name, *scene, recorder, [&] {
    double seconds = 0;
    with_threads(threads, [&] { seconds = pass.trace(1, 0).trace_seconds; });
    return seconds;
  });
}

std::unique_ptr<Integrator> path_tracer(Description description, const Scene& scene,
                                        const std::vector<std::string>& settings = {}) {
  override_integrator(description, "path");
  for (const std::string& setting : settings) override_property(description, setting);
  std::vector<std::string> warnings;
  return make_integrator(description, scene, warnings);
}

double pass_seconds(const Scene& scene, const Integrator& integrator) {
  SessionSettings settings;
  settings.threads = threads;
  settings.passes = 1;
  settings.samples_per_pixel = 4;
  return Session(scene, integrator, settings).run().seconds;
}

/// All rays of path tracing: from the camera, scattered, and to lights.
void compare_path(const std::string& name, const Description& description,
                  const bench::Bar& bar = {}) {
  Recorder recorder;
  const auto scene = build_scene(description, {&recorder});
  const auto integrator = path_tracer(description, *scene);
  compare(
      name, *scene, recorder, [&] { return pass_seconds(*scene, *integrator); }, bar);
}

/// Seconds of one thread for the closest hits of all rays, so many at once.
double closest_hit_seconds(const Scene& scene, const std::vector<Ray>& rays, size_t at_once) {
  std::vector<Hit> hits(at_once);
  return bench::seconds_of([&] {
    for (size_t i = 0; i < rays.size(); i += at_once) {
      const std::span<const Ray> group(&rays[i], std::min(at_once, rays.size() - i));
      if (at_once == 1)
        scene.tracer().intersect(group[0], hits[0]);
      else
        scene.tracer().intersect(group, hits);
    }
  });
}

/// What the camera's rays in packets, as coherent as they are, would take off path tracing's time.
/// `description` is left with another integrator.
void compare_camera_packets(const std::string& name, const Description& description) {
  Recorder recorder;
  const auto scene = build_scene(description, {&recorder});
  const auto integrator = path_tracer(description, *scene);
  recorder.enabled = true;
  pass_seconds(*scene, *path_tracer(description, *scene, {"integrator.max_depth=1"}));
  recorder.enabled = false;
  std::vector<Ray> rays;
  for (const auto& list : recorder.take())
    for (const RecordedRay& recorded : list)
      if (!recorded.shadow) rays.push_back(recorded.ray);
  std::vector<double> gains, shares;
  for (int i = 0; i < repeats; ++i) {
    const double single = closest_hit_seconds(*scene, rays, 1);
    const double packets = closest_hit_seconds(*scene, rays, 64);
    gains.push_back(single / packets);
    shares.push_back((single - packets) / threads / pass_seconds(*scene, *integrator));
  }
  bench::report(name, bench::median(gains), "times less time for the camera's rays in packets",
                fmt::format("{} rays one by one; of a pass of path tracing, 4 samples per pixel, "
                            "that takes {:.1f} %",
                            rays.size(), 100 * bench::median(shares)));
}

/// A glass ball of 1.3 million triangles, wavy, in a box.
std::string million_triangle_scene(const std::filesystem::path& folder) {
  constexpr int rings = 820, sectors = 820;
  const auto mesh_path = folder / "ball.ply";
  std::ofstream out(mesh_path, std::ios::binary);
  out << "ply\nformat binary_little_endian 1.0\nelement vertex " << (rings + 1) * sectors
      << "\nproperty float x\nproperty float y\nproperty float z\nelement face "
      << rings * sectors * 2 << "\nproperty list uchar int vertex_indices\nend_header\n";
  for (int i = 0; i <= rings; ++i)
    for (int j = 0; j < sectors; ++j) {
      const float theta = pi * (float(i) + 0.01f) / (float(rings) + 0.02f);
      const float phi = 2 * pi * float(j) / sectors;
      const float r = 0.5f * (1 + 0.01f * std::sin(23 * theta) * std::sin(31 * phi));
      const Vec3f p =
          Vec3f(std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi)) *
          r;
      out.write(reinterpret_cast<const char*>(&p), sizeof(p));
    }
  for (int i = 0; i < rings; ++i)
    for (int j = 0; j < sectors; ++j) {
      const int a = i * sectors + j, b = i * sectors + (j + 1) % sectors;
      const int c = a + sectors, d = b + sectors;
      for (const auto& face : {std::array{a, b, d}, std::array{a, d, c}}) {
        out.put(3);
        out.write(reinterpret_cast<const char*>(face.data()), sizeof(face));
      }
    }
  return R"(<scene version="3.0.0"><sensor type="perspective"/>
<shape type="ply"><string name="filename" value="ball.ply"/><bsdf type="dielectric"/></shape>
<shape type="cube"><transform name="to_world"><scale value="2"/></transform>
  <bsdf type="twosided"><bsdf type="diffuse"/></bsdf></shape>
<shape type="rectangle"><transform name="to_world"><scale value="0.3"/>
  <rotate x="1" angle="90"/><translate y="1.99"/></transform>
  <emitter type="area"><rgb name="radiance" value="10"/></emitter></shape></scene>)";
}

}  // namespace

int main() {
#ifdef __GLIBC__
  mallopt(M_MMAP_THRESHOLD, 1 << 30);  // as the program does
  mallopt(M_TRIM_THRESHOLD, 1 << 30);
#endif
  const Description spheres = bench::load_shipped("cornell_spheres");
  compare_photons("photon_rays_vs_embree", spheres, 400000);
  const auto folder = std::filesystem::temp_directory_path() /
                      fmt::format("kaustik_ray_bench_{}",
                                  std::chrono::steady_clock::now().time_since_epoch().count());
  std::filesystem::create_directories(folder);
  const std::string text = million_triangle_scene(folder);
  compare_photons("photon_rays_vs_embree_1m",
                  parse_mitsuba_xml(text, "million triangles", folder.string()), 400000);
  std::filesystem::remove_all(folder);
  compare_path("path_rays_vs_embree", bench::load_shipped("cornell_box"), path_bar);
  compare_path("path_rays_vs_embree_spheres", spheres);
  compare_camera_packets("camera_rays_in_packets", bench::load_shipped("cornell_box"));
  return 0;
}
