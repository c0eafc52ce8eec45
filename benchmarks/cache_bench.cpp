// The irradiance cache's metrics beside one another: error of the diffuse indirect irradiance in
// the picture over the number of records, against many gather rays at each pixel; and lookups per
// second. `cache_bench [DIRECTORY [SCENE ...]]`: there it keeps the references (which take longest)
// and writes the curves (cache.csv) and, as SCENE.png, the irradiance from many rays, by the
// Hessian, by the split sphere without clamping, and without clamping and gradients, at the default
// quality.
#include <filesystem>
#include <fstream>
#include <map>

#include "benchmarks/report.h"
#include "benchmarks/shipped_scenes.h"
#include "kaustik/base/parallel.h"
#include "kaustik/image/image_io.h"
#include "kaustik/image/metrics.h"
#include "kaustik/loader/scene_format.h"
#include "kaustik/photonmap/photon_light.h"
#include "kaustik/scene/overrides.h"
#include "kaustik/transport/camera_walk.h"

namespace {

using namespace kaustik;

constexpr int size = 96;
constexpr int reference_samples = 2048;
constexpr uint64_t seed = 1;
constexpr int passes = 4;
constexpr int strides[] = {8, 4, 2, 1};  // as photonmap fills its cache

/// A scene with what gather rays see: photon maps of one pass, alike for all caches.
struct Subject {
  std::string name;
  std::shared_ptr<const Scene> scene;
  std::unique_ptr<PhotonMapSettings> settings;
  std::unique_ptr<PhotonMaps> maps;
  std::unique_ptr<ShadowSettings> no_shadows = std::make_unique<ShadowSettings>();
  std::unique_ptr<IrradianceMap> precomputed;
  std::unique_ptr<PhotonLight> light;
  std::vector<CachePoint> probes;   ///< one at the centre of every pixel that sees a surface
  std::vector<size_t> pixels;       ///< of the probes
  std::vector<Spectrum> reference;  ///< of the probes, W/m²
};

bool surface_at(const Subject& subject, const Vec2f& raster, CachePoint& point) {
  SampleSink nowhere{ComponentSet()};
  Sampler sampler(0, 0);
  CameraWalk walk(*subject.scene, raster, sampler, nowhere, subject.settings->traced());
  if (!walk.advance() || !any(walk.vertex().lobes() & Lobes::diffuse)) return false;
  point = {.point = walk.vertex().point(),
           .normal = walk.vertex().facing_normal(),
           .pixel_width = 2 * walk.footprint().width};
  return true;
}

void collect_probes(Subject& subject) {
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      CachePoint point;
      if (!surface_at(subject, {float(x) + 0.5f, float(y) + 0.5f}, point)) continue;
      subject.probes.push_back(point);
      subject.pixels.push_back(size_t(y * size + x));
    }
}

/// The points from which a cache is filled in a pass, round by round.
std::vector<std::vector<CachePoint>> fill_points(const Subject& subject, uint32_t pass) {
  std::vector<std::vector<CachePoint>> rounds;
  for (const int stride : strides) {
    rounds.emplace_back();
    for (int y = 0; y < size; y += stride)
      for (int x = 0; x < size; x += stride) {
        Sampler jitter = Sampler::at(seed, pass, Stream::cache, uint64_t(y * size + x) + 1,
                                     uint32_t(rounds.size()));
        const Vec2f raster = Vec2f(float(x), float(y)) + jitter.next_2d() * float(stride);
        CachePoint point;
        if (surface_at(subject, raster, point)) rounds.back().push_back(point);
      }
  }
  return rounds;
}

void compute_reference(Subject& subject) {
  HemisphereSettings hemisphere;
  hemisphere.samples = reference_samples;
  subject.reference.resize(subject.probes.size());
  parallel_blocks(subject.probes.size(), 16, [&](size_t begin, size_t end, size_t) {
    for (size_t i = begin; i < end; ++i)
      subject.reference[i] =
          sample_hemisphere(*subject.light, subject.probes[i].point, subject.probes[i].normal,
                            hemisphere, Sampler(hash_mix(99, i), 0))
              .irradiance;
  });
}

Image image_of(const Subject& subject, const std::vector<Spectrum>& values) {
  Image image(size, size, {"R", "G", "B"});
  for (size_t i = 0; i < values.size(); ++i)
    for (int c = 0; c < 3; ++c) image.channel(c)[subject.pixels[i]] = values[i][c];
  return image;
}

void write_float_image(const Image& image, const std::filesystem::path& path) {
  WriteOptions options;
  options.exr_half = false;
  write_image(image, path.string(), options);
}

/// Reads the reference if `directory` has it; else computes it and keeps it there.
void provide_reference(Subject& subject, const std::filesystem::path& directory) {
  const std::filesystem::path path = directory / (subject.name + "_reference.exr");
  if (!directory.empty() && std::filesystem::exists(path)) {
    const Image image = read_image(path.string());
    const RgbView rgb = rgb_view(image);
    for (const size_t pixel : subject.pixels)
      subject.reference.emplace_back(rgb.planes[0][pixel], rgb.planes[1][pixel],
                                     rgb.planes[2][pixel], 0.0f);
    return;
  }
  compute_reference(subject);
  if (!directory.empty()) write_float_image(image_of(subject, subject.reference), path);
}

Description description_of(const std::string& name) {
  Description description =
      name == "cornell_box"
          ? bench::load_shipped(name)
          : load_scene(std::string(KAUSTIK_SOURCE_DIR) + "/benchmarks/scenes/" + name + ".xml");
  for (const char* side : {"film.width", "film.height"})
    override_property(description, fmt::format("{}={}", side, size));
  return description;
}

Subject make_subject(const std::string& name, const std::filesystem::path& directory) {
  Subject subject;
  subject.name = name;
  subject.scene = build_scene(description_of(name));
  Problems problems;
  const Arguments arguments(PhotonMapSettings::info(), {}, {}, problems);
  subject.settings = std::make_unique<PhotonMapSettings>(arguments);
  subject.maps = std::make_unique<PhotonMaps>(
      LightPass(*subject.scene, subject.settings->light_pass, seed).trace(seed, 0));
  subject.precomputed = std::make_unique<IrradianceMap>(
      precomputed_irradiance(*subject.scene, *subject.settings, *subject.maps, GatherRadii{}));
  subject.light =
      std::make_unique<PhotonLight>(*subject.scene, *subject.settings, *subject.maps, GatherRadii{},
                                    *subject.precomputed, nullptr, *subject.no_shadows, Pass{});
  collect_probes(subject);
  provide_reference(subject, directory);
  return subject;
}

/// What came of one cache.
struct Outcome {
  double records = 0;  ///< in a pass
  double seconds = 0;  ///< of filling, all passes
  double error = 0;    ///< relative MSE, without the worst 0.1 %
  double lookups_per_second = 0;
  std::vector<Spectrum> irradiance;
};

double relative_error(const Subject& subject, const std::vector<Spectrum>& values) {
  double mean = 0;
  for (const Spectrum& r : subject.reference) mean += double(r.sum()) / 3;
  mean /= double(subject.reference.size());
  std::vector<double> errors;
  for (size_t i = 0; i < values.size(); ++i) {
    double error = 0;
    for (int c = 0; c < 3; ++c) {
      const double r = double(subject.reference[i][c]), off = double(values[i][c]) - r;
      error += off * off / (r * r + 1e-4 * mean * mean) / 3;
    }
    errors.push_back(error);
  }
  return trimmed_mean(std::move(errors));
}

/// Fills and asks a cache in every one of `passes`, whose mean counts, as in a picture.
Outcome measure(const Subject& subject, const CacheSettings& settings) {
  Outcome outcome;
  outcome.irradiance.resize(subject.probes.size());
  double lookup_seconds = 0;
  for (uint32_t pass = 0; pass < passes; ++pass) {
    IrradianceCache cache(settings);
    const auto rounds = fill_points(subject, pass);
    outcome.seconds += bench::seconds_of([&] {
      uint32_t round = 0;
      for (const auto& points : rounds)
        cache.fill_round(points, *subject.light, Sampler::at(seed, pass, Stream::cache, 0, 0),
                         round++, {});
    });
    outcome.records += double(cache.record_count()) / passes;
    lookup_seconds += bench::seconds_of([&] {
      for (size_t i = 0; i < subject.probes.size(); ++i) {
        Spectrum irradiance;
        if (!cache.interpolate(subject.probes[i], irradiance))
          cache.interpolate(subject.probes[i], irradiance, 2);
        outcome.irradiance[i] += irradiance * (1.0f / passes);
      }
    });
  }
  outcome.lookups_per_second = passes * double(subject.probes.size()) / lookup_seconds;
  outcome.error = relative_error(subject, outcome.irradiance);
  return outcome;
}

/// One way to place records.
struct Variant {
  const char* name;
  CacheMetric metric;
  bool gradients, clamping;
};
constexpr Variant variants[] = {
    {"hessian", CacheMetric::hessian, true, true},
    {"hessian_without_clamping", CacheMetric::hessian, true, false},
    {"split_sphere", CacheMetric::split_sphere, true, true},
    {"split_sphere_without_clamping", CacheMetric::split_sphere, true, false},
    {"split_sphere_without_gradients", CacheMetric::split_sphere, false, true},
    {"split_sphere_without_both", CacheMetric::split_sphere, false, false},
};
constexpr float default_quality = 0.25f;
constexpr float qualities[] = {0.6f, default_quality, 0.15f};

CacheSettings settings_of(const Variant& variant, float quality) {
  CacheSettings settings;
  settings.metric = variant.metric;
  settings.gradients = variant.gradients;
  settings.neighbor_clamping = variant.clamping;
  settings.quality = quality;
  settings.hemisphere.samples = 128;
  return settings;
}

/// The error at so many records, by a power law between the measurements beside that number; NaN
/// beyond them.
double error_at(const std::vector<Outcome>& curve, double records) {
  if (records < curve.front().records || records > curve.back().records) return std::nan("");
  size_t next = 1;
  while (next + 1 < curve.size() && curve[next].records < records) ++next;
  const Outcome &a = curve[next - 1], &b = curve[next];
  const double t = std::log(records / a.records) / std::log(b.records / a.records);
  return a.error * std::pow(b.error / a.error, t);
}

/// Irradiances beside one another, as seen on a display where twice the mean is white.
void write_strip(const Subject& subject, const std::vector<const std::vector<Spectrum>*>& pictures,
                 const std::filesystem::path& path) {
  constexpr int zoom = 3;
  double mean = 0;
  for (const Spectrum& r : subject.reference)
    mean += double(r.sum()) / 3 / double(subject.reference.size());
  Image strip(zoom * size * int(pictures.size()), zoom * size, {"R", "G", "B"});
  for (size_t k = 0; k < pictures.size(); ++k) {
    const Image image = image_of(subject, *pictures[k]);
    for (int y = 0; y < strip.height(); ++y)
      for (int x = 0; x < zoom * size; ++x)
        for (int c = 0; c < 3; ++c) {
          const float value = image.at(x / zoom, y / zoom, c) / float(2 * mean);
          strip.at(x + int(k) * zoom * size, y, c) = std::clamp(value, 0.0f, 1.0f);
        }
  }
  write_shown_image(strip, path.string());
}

void compare_metrics(const std::string& name, const std::filesystem::path& directory,
                     std::ostream& curves) {
  const Subject subject = make_subject(name, directory);
  std::map<std::string, std::vector<Outcome>> measured;
  for (const Variant& variant : variants)
    for (const float quality : qualities) {
      const Outcome& o =
          measured[variant.name].emplace_back(measure(subject, settings_of(variant, quality)));
      curves << fmt::format("{},{},{},{:.0f},{:.3g},{:.3g},{:.3g}\n", name, variant.name, quality,
                            o.records, o.error, o.seconds / passes, o.lookups_per_second);
      curves.flush();
    }
  const Outcome& ours = measured["hessian"][1];
  for (const Variant& variant : variants) {
    const std::vector<Outcome>& curve = measured[variant.name];
    const Outcome& o = curve[1];
    bench::report(fmt::format("cache_{}_{}", name, variant.name), o.error, "relative MSE",
                  fmt::format("{} gather rays at each pixel; quality {}, {:.0f} records, filled in "
                              "{:.2f} s, {:.2g} lookups/s; with {:.0f} records {:.2g}",
                              reference_samples, default_quality, o.records, o.seconds / passes,
                              o.lookups_per_second, ours.records, error_at(curve, ours.records)));
  }
  bench::report(fmt::format("cache_{}_hessian_vs_split_sphere", name),
                error_at(measured["split_sphere"], ours.records) / ours.error,
                "ratio of relative MSE at equal records",
                fmt::format("split_sphere, {:.0f} records", ours.records));
  if (directory.empty()) return;
  write_strip(subject,
              {&subject.reference, &ours.irradiance,
               &measured["split_sphere_without_clamping"][1].irradiance,
               &measured["split_sphere_without_both"][1].irradiance},
              directory / (name + ".png"));
}

}  // namespace

int main(int argc, char** argv) {
  if (argc > 1 && argv[1][0] == '-') {
    fmt::print(
        "cache_bench [FOLDER [SCENE …]]: the metrics of the irradiance cache compared;\n"
        "curves and pictures into FOLDER\n");
    return std::string(argv[1]) == "--help" ? 0 : 2;
  }
  try {
    const std::filesystem::path directory = argc > 1 ? argv[1] : "";
    std::ofstream curves;
    if (!directory.empty()) {
      std::filesystem::create_directories(directory);
      curves.open(directory / "cache.csv");
      curves << "scene,variant,quality,records,relative_mse,fill_seconds,lookups_per_second\n";
    }
    std::vector<std::string> names(argv + std::min(argc, 2), argv + argc);
    if (names.empty()) names = {"cornell_box", "museum_ceiling", "gallery_frame"};
    for (const std::string& name : names) compare_metrics(name, directory, curves);
  } catch (const Error& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
  return 0;
}
