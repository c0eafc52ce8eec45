// Path tracing beside Blender Cycles on the Cornell box at equal time, start-up excluded.
// `cycles_bench [seconds [reference.exr]]`: 30 per picture, and the stored reference unless told.
// Cycles gets the scene as Kaustik has loaded it (RGB, as both compute), by cycles_render.py.
#include <cstdlib>
#include <fstream>
#include <iterator>

#include "benchmarks/quality.h"

namespace {

using namespace kaustik;

constexpr const char* scene_name = "cornell_box";
constexpr double filter_stddev =
    0.5;  ///< pixels; what a scene's "gaussian" means if it says no more
/// The means of both pictures may differ by this; otherwise they are not of the same scene.
constexpr double mean_tolerance = 0.005;

/// A folder that goes with its contents.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string pattern = std::filesystem::temp_directory_path() / "kaustik_cycles_XXXXXX";
    if (!::mkdtemp(pattern.data())) throw Error(ErrorKind::system, "no temporary folder");
    path_ = pattern;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  std::string operator/(const char* name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

std::string json_of(const Vec3f& v) {
  return fmt::format("[{:.9g}, {:.9g}, {:.9g}]", v.x, v.y, v.z);
}
std::string json_of(const Spectrum& s) { return json_of(Vec3f(s[0], s[1], s[2])); }

/// One mesh with its reflectance and its radiance. Throws Error for what is no diffuse mesh.
std::string json_of_surface(const Scene& scene, uint32_t index) {
  const Surface& surface = scene.surface(index);
  const Shape& shape = scene.tracer().shape(index);
  const TriangleMesh* mesh = shape.mesh();
  if (!mesh || surface.bsdf->lobes() != Lobes::diffuse)
    throw Error(ErrorKind::input, surface.name + " is not a diffuse mesh");
  std::vector<std::string> positions, triangles;
  for (const Vec3f& p : mesh->positions) positions.push_back(json_of(p));
  for (const auto& [a, b, c] : mesh->triangles)
    triangles.push_back(fmt::format("[{}, {}, {}]", a, b, c));
  Spectrum radiance(0);
  if (surface.light >= 0) {
    const SurfacePoint point = shape.sample_area({0.5f, 0.5f}).point;
    radiance = scene.lights()[size_t(surface.light)]->emitted(point, point.ng);
  }
  return fmt::format(
      "{{\"name\": \"{}\", \"reflectance\": {}, \"radiance\": {},\n  \"positions\": [{}],\n"
      "  \"triangles\": [{}]}}",
      index, json_of(surface.bsdf->albedo({}, {0, 0, 1}, Lobes::all)), json_of(radiance),
      fmt::join(positions, ", "), fmt::join(triangles, ", "));
}

/// The scene with the names that cycles_render.py reads.
std::string json_of_scene(const Scene& scene) {
  std::vector<std::string> surfaces;
  for (uint32_t i = 0; i < scene.surface_count(); ++i)
    surfaces.push_back(json_of_surface(scene, i));
  const Camera& camera = scene.camera();
  const Vec2i size = scene.film().size;
  const auto direction = [&](float x, float y) {
    return camera.sample_ray({x * float(size.x), y * float(size.y)}).direction;
  };
  return fmt::format(
      "{{\"size\": [{}, {}], \"filter_stddev\": {}, \"horizontal_fov\": {:.9g},\n"
      "\"position\": {}, \"forward\": {}, \"up\": {},\n\"surfaces\": [{}]}}\n",
      size.x, size.y, filter_stddev, camera.horizontal_fov() * pi / 180, json_of(camera.position()),
      json_of(direction(0.5f, 0.5f)), json_of(normalize(direction(0.5f, 0) - direction(0.5f, 1))),
      fmt::join(surfaces, ",\n"));
}

struct CyclesPicture {
  Image image;
  double samples_per_pixel = 0, seconds = 0;
};

/// Renders the scene with Cycles. Throws Error with what Blender said if that fails.
CyclesPicture render_with_cycles(double seconds, int seed) {
  const TemporaryFolder folder;
  Description description = bench::load_shipped(scene_name);
  override_property(description, fmt::format("rfilter.stddev={}", filter_stddev));
  std::ofstream(folder / "scene.json") << json_of_scene(*build_scene(description));
  const std::string command = fmt::format(
      "blender --background --factory-startup --python-exit-code 1 --python "
      "'{}/benchmarks/cycles_render.py' -- '{}' {} {} {} '{}' '{}' >'{}' 2>&1",
      KAUSTIK_SOURCE_DIR, folder / "scene.json", seconds, bench::picture_threads, seed,
      folder / "picture.exr", folder / "times.txt", folder / "blender.log");
  CyclesPicture picture;
  if (std::system(command.c_str()) != 0 ||
      !(std::ifstream(folder / "times.txt") >> picture.samples_per_pixel >> picture.seconds)) {
    std::ifstream log(folder / "blender.log");
    throw Error(ErrorKind::system,
                "Blender failed:\n" + std::string(std::istreambuf_iterator<char>(log), {}));
  }
  picture.image = read_image(folder / "picture.exr");
  return picture;
}

void throw_unless_same_scene(const ImageComparison& with_reference) {
  for (int c = 0; c < 3; ++c)
    if (std::abs(with_reference.mean_ratio[c] - 1) > mean_tolerance)
      throw Error(ErrorKind::system,
                  fmt::format("Cycles' picture is {:.3f} times as bright as the reference in "
                              "channel {}: not the same scene",
                              with_reference.mean_ratio[c], c));
}

/// The relative MSE of one of two independent pictures of the same mean, by their difference: what
/// the conversion of the scene may have changed does not count as error.
double noise_of(const Image& a, const Image& b, const Image& reference) {
  const RgbView x = rgb_view(a), y = rgb_view(b), r = rgb_view(reference);
  std::vector<double> errors(reference.pixel_count());
  for (size_t i = 0; i < errors.size(); ++i)
    for (size_t c = 0; c < 3; ++c)
      errors[i] += sqr(x.planes[c][i] - y.planes[c][i]) / 2 / (sqr(r.planes[c][i]) + 0.01f) / 3;
  return trimmed_mean(std::move(errors));
}

void compare_with_cycles(double seconds, const Image& reference) {
  const CyclesPicture cycles = render_with_cycles(seconds, 1);
  const CyclesPicture again = render_with_cycles(seconds, 2);
  const ImageComparison with_reference = compare_images(cycles.image, reference);
  throw_unless_same_scene(with_reference);
  const bench::Rendering path = bench::render_for(scene_name, "path", seconds, reference);
  // Both are unbiased: their error falls as 1/time, by which the rest of the difference in time is
  // made good.
  const double noise = noise_of(cycles.image, again.image, reference);
  const double cycles_error = noise * (cycles.seconds + again.seconds) / 2 / path.seconds;
  bench::report(
      "path_vs_cycles", cycles_error / path.error(), "ratio of relative MSE",
      fmt::format("Cycles: {:.3g} ({:.0f} samples per pixel in {:.2f} s, brought to path's time as "
                  "1/time, from the difference of two pictures; {:.3g} from the reference), path: "
                  "{:.3g} ({:.0f} in {:.2f} s), {} threads, start-up excluded, no denoiser, no "
                  "clamping; the reference itself: {:.2g}",
                  cycles_error, cycles.samples_per_pixel, cycles.seconds,
                  with_reference.relative_mse_trimmed, path.error(), path.samples_per_pixel,
                  path.seconds, bench::picture_threads, bench::error_of_reference(reference)));
}

}  // namespace

int main(int argc, char** argv) {
  const double seconds = argc > 1 ? std::atof(argv[1]) : 30;
  try {
    if (std::system("command -v blender >/dev/null") != 0) {
      fmt::print(stderr,
                 "there is no blender to compare with; on Debian: apt-get install blender\n");
      return 0;
    }
    const std::optional<Image> reference =
        argc > 2 ? read_image(argv[2]) : bench::reference_of(scene_name);
    if (reference) compare_with_cycles(seconds, *reference);
  } catch (const Error& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
  return 0;
}
