#include "benchmarks/peers/povray.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <fstream>

#include "kaustik/base/error.h"
#include "kaustik/image/image_io.h"

namespace kaustik::bench {
namespace {

/// Where the falloff of lamps starts, metres: much nearer than anything that they light.
constexpr double fade_distance = 1e-3;
/// Rows and columns of lights that stand for an area.
constexpr int lights_across = 5;

std::string vector_of(const Vec3f& v) {
  return fmt::format("<{:.9g}, {:.9g}, {:.9g}>", v.x, v.y, v.z);
}
std::string color_of(const Spectrum& s) {
  return fmt::format("rgb <{:.9g}, {:.9g}, {:.9g}>", s[0], s[1], s[2]);
}

template <typename T>
std::string list_of(const std::vector<T>& values) {
  std::vector<std::string> all;
  for (const T& value : values) all.push_back(vector_of(value));
  return fmt::format("{}, {}", values.size(), fmt::join(all, ", "));
}

std::string shape_text(const PeerSurface& surface) {
  if (surface.ball)
    return fmt::format("sphere {{ {}, {:.9g}\n", vector_of(surface.ball->center),
                       surface.ball->radius);
  std::vector<std::string> triangles;
  for (const auto& [a, b, c] : surface.mesh.triangles)
    triangles.push_back(fmt::format("<{}, {}, {}>", a, b, c));
  std::string text =
      fmt::format("mesh2 {{ vertex_vectors {{ {} }}\n", list_of(surface.mesh.positions));
  if (!surface.mesh.normals.empty())
    text += fmt::format("normal_vectors {{ {} }}\n", list_of(surface.mesh.normals));
  return text +
         fmt::format("face_indices {{ {}, {} }}\n", triangles.size(), fmt::join(triangles, ", "));
}

std::string material_text(const PeerSurface& surface) {
  // Light that lamps emit comes from the lights that stand for them.
  if (surface.is_lamp())
    return fmt::format(
        "pigment {{ {} }} finish {{ ambient 0 diffuse 0 emission 1 }} no_shadow "
        "no_radiosity\n",
        color_of(surface.radiance));
  switch (surface.material) {
    case PeerMaterial::diffuse:
      return fmt::format("pigment {{ {} }} finish {{ ambient 0 diffuse 1 }}\n",
                         color_of(surface.reflectance.front()));
    case PeerMaterial::mirror:
      return fmt::format(
          "pigment {{ rgb 0 }} finish {{ ambient 0 diffuse 0 reflection {{ {} }} }} "
          "photons {{ target reflection on }}\n",
          color_of(surface.reflectance.back()));
    case PeerMaterial::glass:
      return fmt::format(
          "pigment {{ rgbt 1 }} finish {{ ambient 0 diffuse 0 reflection {{ 0, 1 fresnel on }} "
          "conserve_energy }} interior {{ ior {:.9g} }} "
          "photons {{ target reflection on refraction on }}\n",
          surface.ior);
  }
  return {};
}

/// What makes a light of an area, and of which radiant intensity it is along its normal.
struct LightShape {
  std::string text;
  Vec3f center;
  float area_seen;  ///< m²
};

LightShape ball_light(const PeerBall& ball) {
  const float r = ball.radius;
  return {fmt::format("area_light <{0:.9g}, 0, 0>, <0, {0:.9g}, 0>, {1}, {1} circular orient",
                      2 * r, lights_across),
          ball.center, pi * r * r};
}

/// The first triangle, from the corner opposite its longest side on.
std::array<Vec3f, 3> from_widest_corner(const TriangleMesh& mesh) {
  const auto& [a, b, c] = mesh.triangles.front();
  std::array<Vec3f, 3> corners{mesh.positions[a], mesh.positions[b], mesh.positions[c]};
  const auto opposite_side = [&] { return length(corners[1] - corners[2]); };
  for (int i = 0; i < 2; ++i)
    if (opposite_side() < length(corners[0] - corners[1]) ||
        opposite_side() < length(corners[0] - corners[2]))
      std::rotate(corners.begin(), corners.begin() + 1, corners.end());
  return corners;
}

/// Of a flat lamp: the parallelogram of its first triangle.
LightShape flat_light(const TriangleMesh& mesh) {
  Vec3f center(0), normal(0);
  for (const Vec3f& p : mesh.positions) center += p / float(mesh.positions.size());
  for (const auto& [a, b, c] : mesh.triangles)
    normal += cross(mesh.positions[b] - mesh.positions[a], mesh.positions[c] - mesh.positions[a]);
  const float area = length(normal) / 2;
  normal = normalize(normal);
  const auto [corner, one, other] = from_widest_corner(mesh);
  return {fmt::format("area_light {0}, {1}, {2}, {2} area_illumination on\nspotlight point_at {3} "
                      "radius 90 falloff 90 tightness 1",
                      vector_of(one - corner), vector_of(other - corner), lights_across,
                      vector_of(center + normal)),
          center + normal * 1e-4f, area};
}

std::string light_text(const PeerSurface& lamp) {
  const LightShape shape = lamp.ball ? ball_light(*lamp.ball) : flat_light(lamp.mesh);
  // A diffuse surface shows light × reflectance × cosine × 2/(1 + (d/fade)²), which is to be
  // intensity × reflectance × cosine / (π d²).
  const float light = shape.area_seen / (2 * pi * float(sqr(fade_distance)));
  return fmt::format(
      "light_source {{ {}, {}\n{} adaptive 1 jitter\nfade_power 2 fade_distance {}\n"
      "photons {{ reflection on refraction on area_light }} }}\n",
      vector_of(shape.center), color_of(lamp.radiance * light), shape.text, fade_distance);
}

std::string camera_text(const PeerScene& scene) {
  const float half = std::tan(float(scene.horizontal_fov) / 2);
  const Vec3f right = normalize(cross(scene.forward, scene.up));
  return fmt::format("camera {{ perspective location {} direction {} right {} up {} }}\n",
                     vector_of(scene.position), vector_of(scene.forward),
                     vector_of(right * (2 * half)),
                     vector_of(scene.up * (2 * half * float(scene.size.y) / float(scene.size.x))));
}

/// The seconds that POV-Ray's log tells of one stage: "  Trace Time:  … (1.234 seconds)".
double seconds_in(const std::string& log, const std::string& stage) {
  const size_t line = log.find(stage + " Time:");
  if (line == std::string::npos) return 0;
  const size_t open = log.find('(', line), end = log.find('\n', line);
  if (open > end) return 0;
  double seconds = 0;
  std::from_chars(log.data() + open + 1, log.data() + end, seconds);
  return seconds;
}

PeerPicture render_once(const PeerScene& scene, double effort, int threads) {
  const TemporaryFolder folder;
  std::ofstream(folder / "scene.pov") << povray_text(scene, effort);
  const int across = std::clamp(int(std::lround(2 * std::sqrt(effort))), 1, 9);
  PeerPicture picture;
  const auto start = std::chrono::steady_clock::now();
  const std::string log = run_peer(
      fmt::format("cd '{}' && povray +Iscene.pov +Opicture.exr +FE File_Gamma=1.0 +W{} +H{} -D "
                  "+WT{} -V +A0.0 +AM1 +R{} +J",
                  folder / "", scene.size.x, scene.size.y, threads, across),
      folder);
  const double all =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  for (const char* stage : {"Photon", "Radiosity", "Trace"})
    picture.seconds += seconds_in(log, stage);
  if (picture.seconds == 0)
    throw Error(ErrorKind::system, "POV-Ray did not tell how long it took:\n" + log);
  picture.start_up_seconds = all - picture.seconds;
  picture.effort = fmt::format("{} samples per pixel", across * across);
  picture.image = read_image(folder / "picture.exr");
  return picture;
}

}  // namespace

std::string povray_text(const PeerScene& scene, double effort) {
  std::string text = fmt::format(
      "#version 3.7;\nglobal_settings {{ assumed_gamma 1.0 max_trace_level 40 adc_bailout 1e-3\n"
      "photons {{ count {} autostop 0 jitter 0.4 max_trace_level 40 }}\n"
      "radiosity {{ pretrace_start 0.08 pretrace_end {:.5f} count {} nearest_count 10\n"
      "error_bound {:.4f} recursion_limit 4 gray_threshold 0 minimum_reuse 0.005 brightness 1 }} "
      "}}\n"
      "background {{ rgb 0 }}\n",
      int(50000 * effort), std::min(0.02 / std::sqrt(effort), 0.08),
      std::clamp(int(100 * effort), 20, 1600), std::clamp(0.6 / std::pow(effort, 0.25), 0.1, 1.8));
  text += camera_text(scene);
  for (const PeerSurface& surface : scene.surfaces) {
    text += shape_text(surface) + material_text(surface) + "}\n";
    if (surface.is_lamp()) text += light_text(surface);
  }
  return text;
}

PeerPicture render_with_povray(const PeerScene& scene, double seconds, int threads) {
  double effort = 0.1;
  PeerPicture best = render_once(scene, effort, threads);
  double last_seconds = best.seconds;
  // Time does not quite follow effort: approach it.
  for (int i = 0; i < 4 && (last_seconds < 0.8 * seconds || last_seconds > 1.1 * seconds); ++i) {
    effort *= std::clamp(0.95 * seconds / last_seconds, 0.1, 10.0);
    PeerPicture next = render_once(scene, effort, threads);
    last_seconds = next.seconds;
    if (std::abs(next.seconds - seconds) < std::abs(best.seconds - seconds)) best = std::move(next);
  }
  return best;
}

}  // namespace kaustik::bench
