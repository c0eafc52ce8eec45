#include "scenes/paintings.h"

#include "kit/furniture.h"

namespace kaustik::scenes {
namespace {

constexpr double frame_width = 0.09, frame_depth = 0.05;
constexpr double pixels_across = 96;  ///< of the shorter side

Mesh canvas(const Painting& p) {
  const double x = 0.5 * p.width + 0.01, z = 0.5 * p.height + 0.01;  // a little under the frame
  Mesh mesh = sheet(
      1, 1, [=](double u, double v) { return Vec3d((2 * u - 1) * x, -0.008, (2 * v - 1) * z); });
  for (Vertex& vertex : mesh.vertices) vertex.uv.y = 1 - vertex.uv.y;  // v = 0 is a picture's top
  return mesh;
}

Mesh placed(Mesh mesh, const Painting& p) {
  if (p.lean != 0) {
    mesh = moved(std::move(mesh), {0, 0, 0.5 * p.height + frame_width});
    mesh = turned(std::move(mesh), {1, 0, 0}, -p.lean);
  }
  return moved(turned(std::move(mesh), {0, 0, 1}, p.turn), p.center);
}

}  // namespace

double foot_of_leaning(const Painting& p) {
  return (p.height + 2 * frame_width) * std::sin(p.lean * pi_d / 180) + 0.001;
}

void add_paintings(SceneFolder& scene, const std::vector<Painting>& paintings, uint64_t seed) {
  Mesh frames;
  for (const Painting& p : paintings) {
    const double scale = pixels_across / std::min(p.width, p.height);
    const std::string file =
        scene.write_picture(p.name, p.paint(int(p.width * scale), int(p.height * scale), seed));
    Xml texture = object("texture", "bitmap", {text("filename", file), text("wrap_mode", "clamp")});
    scene.add_bsdf(p.name, object("bsdf", "diffuse", {std::move(texture).named("reflectance")}));
    scene.add_mesh("canvas_" + p.name, placed(canvas(p), p), p.name,
                   {.normals = Normals::flat, .uvs = true});
    frames.append(placed(frame(frame_outline(frame_width, frame_depth), p.width, p.height), p));
  }
  // Flat: light that metal reflects by bent normals reaches places where it can't come from.
  scene.add_mesh("frames", frames, "gold", {.normals = Normals::flat}, "Frames of the pictures.");
}

}  // namespace kaustik::scenes
