// Renders a scene file, or without one a square of buffers below a sky, and prints the mean
// radiance of the picture. docs/library.md explains it. Usage: mean_radiance [SCENE.xml]

#include <array>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "kaustik/base/error.h"
#include "kaustik/image/image.h"
#include "kaustik/loader/scene_format.h"
#include "kaustik/render/job.h"
#include "kaustik/scene/description.h"

namespace {

using namespace kaustik;

std::shared_ptr<Object> object(std::string family, std::string type,
                               std::vector<Property> properties, std::vector<Child> children = {}) {
  return std::make_shared<Object>(Object{.family = std::move(family),
                                         .type = std::move(type),
                                         .id = "",
                                         .properties = std::move(properties),
                                         .children = std::move(children),
                                         .place = place_in("example")});
}

Property property(std::string name, Value value) {
  return {std::move(name), std::move(value), place_in("example")};
}

/// Two metres wide at z = 0, reflecting half of the light that falls on it.
std::shared_ptr<Object> square() {
  const auto positions = Array::of<float>({4, 3}, {-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0});
  const auto faces = Array::of<uint32_t>({2, 3}, {0, 1, 2, 0, 2, 3});
  const auto grey = object("bsdf", "diffuse", {property("reflectance", 0.5)});
  return object("shape", "mesh", {property("positions", positions), property("faces", faces)},
                {{"", grey}});
}

/// The square below a sky of radiance 1 W/(sr·m²), seen from above; it fills the picture.
Description square_below_sky() {
  const auto film =
      object("film", "hdrfilm", {property("width", int64_t{32}), property("height", int64_t{32})});
  const auto above = Transform::look_at({0, 0, 1}, {0, 0, 0}, {0, 1, 0});
  const auto camera = object("sensor", "perspective",
                             {property("fov", 60.0), property("to_world", above)}, {{"", film}});
  const auto sky = object("emitter", "constant", {property("radiance", 1.0)});
  return {object("scene", "", {}, {{"", camera}, {"", sky}, {"", square()}})};
}

/// Of all pixels, linear Rec. 709.
std::array<double, 3> mean_radiance(const Image& image) {
  const RgbView rgb = rgb_view(image);
  std::array<double, 3> mean{};
  for (size_t pixel = 0; pixel < image.pixel_count(); ++pixel)
    for (int c = 0; c < 3; ++c) mean[size_t(c)] += rgb[pixel][c] / double(image.pixel_count());
  return mean;
}

void render(Description description) {
  JobSettings settings;
  settings.record.recipe.integrator = "path";
  settings.session.passes = 4;
  settings.session.samples_per_pass = 16;
  JobListener listener;
  listener.messages.warning = [](const std::string& text) {
    std::fprintf(stderr, "%s\n", text.c_str());
  };
  Job job(std::move(description), std::move(settings), std::move(listener));
  job.start();
  const JobResult& result = job.wait();  // snapshot() may be called meanwhile, from any thread
  const Image picture = job.snapshot().value();
  const auto [r, g, b] = mean_radiance(picture);
  std::printf("%d x %d pixels, %u passes, mean radiance %.4f %.4f %.4f\n", picture.width(),
              picture.height(), result.report.passes, r, g, b);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    render(argc > 1 ? load_scene(argv[1]) : square_below_sky());
    return 0;
  } catch (const Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return error.kind() == ErrorKind::input ? 2 : 1;
  }
}
