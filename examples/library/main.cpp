// Renders a scene file, or without one a square of buffers below a sky, and prints the mean
// radiance of the picture with its error. docs/guides/cpp.md explains it.
// Usage: mean_radiance [SCENE.xml [PICTURE]]

#include <kaustik/kaustik.h>

#include <cstdint>
#include <cstdio>
#include <string>

namespace {

/// Two metres wide at z = 0, reflecting half of the light that falls on it.
kaustik::Object square() {
  const float positions[] = {-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0};
  const uint32_t faces[] = {0, 1, 2, 0, 2, 3};
  kaustik::MeshBuffers buffers;
  buffers.positions = {positions, 4};
  buffers.faces = {faces, 2};
  const auto grey = kaustik::Object("bsdf", "diffuse", "grey").set("reflectance", 0.5);
  return kaustik::Mesh(buffers).shape("square").add(grey);
}

/// The square below a sky of radiance 1 W/(sr·m²), seen from above; it fills the picture.
kaustik::Scene square_below_sky() {
  const auto above = kaustik::Transform::look_at({0, 0, 1}, {0, 0, 0}, {0, 1, 0});
  const auto film = kaustik::Object("film", "hdrfilm").set("width", 32).set("height", 32);
  const auto camera =
      kaustik::Object("sensor", "perspective").set("fov", 60).set("to_world", above).add(film);
  const auto sky = kaustik::Object("emitter", "constant", "sky").set("radiance", 1);
  return kaustik::Scene({camera, sky, square()});
}

void print_mean(const char* name, const kaustik::Picture& picture) {
  const kaustik::Estimate mean = picture.mean();
  const kaustik::Interval interval = mean.interval(0.95);
  std::printf("%s: %d x %d pixels, %u passes, mean radiance %.4f (%.4f to %.4f)\n", name,
              picture.width(), picture.height(), picture.passes(), mean.value, interval.low,
              interval.high);
}

void render(const kaustik::Scene& scene, const char* file) {
  kaustik::SessionSettings settings;
  settings.integrator = "path";
  settings.passes = 4;
  settings.samples_per_pass = 16;
  kaustik::Callbacks callbacks;
  callbacks.message = [](kaustik::Severity, const std::string& text) {
    std::fprintf(stderr, "%s\n", text.c_str());
  };
  kaustik::Session session(scene, settings, callbacks);
  session.start();
  session.wait();  // snapshot(), progress() and stop() may be called meanwhile, from any thread
  const kaustik::Picture picture = session.picture();
  print_mean("scene", picture);
  if (file) picture.write(file);
}

/// The same square under a sky that is twice as bright: only the sky is built again.
void render_brighter(const kaustik::Scene& scene) {
  kaustik::SessionSettings settings;
  settings.integrator = "path";
  settings.passes = 4;
  kaustik::Session session(scene.edit("sky.radiance", 2), settings);
  session.run();
  print_mean("brighter", session.picture());
}

}  // namespace

int main(int argc, char** argv) {
  try {
    if (argc > 1) {
      render(kaustik::Scene::load_file(argv[1]), argc > 2 ? argv[2] : nullptr);
    } else {
      const kaustik::Scene scene = square_below_sky();
      render(scene, nullptr);
      render_brighter(scene);
    }
    return 0;
  } catch (const kaustik::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return error.kind() == kaustik::ErrorKind::input ? 2 : 1;
  }
}
