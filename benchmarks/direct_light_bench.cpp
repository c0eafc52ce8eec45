// Direct light in a room with 1 to 144 lamps: one lamp for each sample, every lamp, and every lamp
// with shadow photons. Prints shadow rays, relative MSE against many samples of every lamp, and
// time. One pass, so that the photons serve all samples. `direct_light_bench [largest number of
// lamps]`.
#include <cstdlib>

#include "benchmarks/quality.h"
#include "kaustik/loader/mitsuba_xml.h"
#include "kaustik/photon/shadow_pass.h"

namespace {

using namespace kaustik;

constexpr int picture_size = 48, shadow_photons = 20'000;
/// The reference has so many times as many samples as what is measured.
constexpr int reference_factor = 8;

std::string rectangle(const std::string& transform, const std::string& inside) {
  return fmt::format(
      "<shape type=\"rectangle\"><transform name=\"to_world\">{}</transform>{}</shape>", transform,
      inside);
}

/// A room of 4 × 4 × 2 m whose ceiling holds `columns` × `rows` lamps of the same power together,
/// with five balls that throw shadows.
std::string room(int columns, int rows) {
  const std::string wall =
      "<bsdf type=\"twosided\"><bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"0.7\"/>"
      "</bsdf></bsdf>";
  std::string text = fmt::format(
      "<scene version=\"3.0.0\"><sensor type=\"perspective\"><float name=\"fov\" value=\"70\"/>"
      "<transform name=\"to_world\"><lookat origin=\"0, -1.9, 1.2\" target=\"0, 0.5, 0.5\" "
      "up=\"0, 0, 1\"/></transform><film type=\"hdrfilm\"><integer name=\"width\" value=\"{0}\"/>"
      "<integer name=\"height\" value=\"{0}\"/></film></sensor>",
      picture_size);
  text += rectangle("<scale value=\"2\"/>", wall);
  text += rectangle("<scale value=\"2\"/><rotate x=\"1\" angle=\"90\"/><translate y=\"2\"/>", wall);
  for (const int side : {-1, 1})
    text += rectangle(fmt::format("<scale value=\"2\"/><rotate y=\"1\" angle=\"90\"/>"
                                  "<translate x=\"{}\"/>",
                                  2 * side),
                      wall);
  for (int i = 0; i < 5; ++i)
    text += fmt::format(
        "<shape type=\"sphere\"><point name=\"center\" x=\"{}\" y=\"{}\" z=\"{}\"/>"
        "<float name=\"radius\" value=\"0.25\"/>{}</shape>",
        0.6 * (i - 2), 0.5 * ((i * 2) % 3), 0.3 + 0.15 * ((i * 3) % 4), wall);
  const int lamps = columns * rows;
  for (int i = 0; i < lamps; ++i)
    text += rectangle(
        fmt::format("<scale value=\"{}\"/><rotate x=\"1\" angle=\"180\"/>"
                    "<translate x=\"{}\" y=\"{}\" z=\"2\"/>",
                    0.15 / std::sqrt(double(lamps)), 3.4 * ((i % columns) + 0.5) / columns - 1.7,
                    3.4 * ((i / columns) + 0.5) / rows - 1.7),
        "<emitter type=\"area\"><rgb name=\"radiance\" value=\"50\"/></emitter>");
  return text + "</scene>";
}

struct Result {
  Image picture;
  double rays = 0, seconds = 0;
};

Result render(const Scene& scene, const std::string& parameters, int samples) {
  const Description description = parse_mitsuba_xml(
      "<scene version=\"3.0.0\"><integrator type=\"photonmap\"><string name=\"components\" "
      "value=\"direct\"/>" +
          parameters + "</integrator></scene>",
      "benchmark", "");
  std::vector<std::string> warnings;
  const auto method = make_integrator(description, scene, warnings);
  SessionSettings settings;
  settings.threads = bench::picture_threads;
  settings.passes = 1;
  settings.samples_per_pixel = uint32_t(samples);
  Session session(scene, *method, settings);
  const SessionReport report = session.run();
  const double camera_rays = double(picture_size) * picture_size * samples;
  return {session.film().image(), double(report.rays) - camera_rays, report.seconds};
}

std::string text(const char* name, const char* value) {
  return fmt::format("<string name=\"{}\" value=\"{}\"/>", name, value);
}
std::string integer(const char* name, int value) {
  return fmt::format("<integer name=\"{}\" value=\"{}\"/>", name, value);
}

struct Measured {
  double error = 0, rays = 0, seconds = 0;
};

Measured measure(const Scene& scene, const Image& reference, int samples,
                 const std::string& parameters) {
  const Result result = render(scene, parameters, samples);
  return {double(compare_images(result.picture, reference).relative_mse), result.rays,
          result.seconds};
}

/// `b` beside `a`: equal samples, then with the error of `a` brought to the time of `b` as 1/time.
void compare(const std::string& name, int samples, const Measured& a, const Measured& b) {
  bench::report(name, a.error * a.seconds / b.seconds / b.error,
                "ratio of relative MSE at equal time (above 1: the second is better)",
                fmt::format("{} samples: shadow rays {:.0f} and {:.0f} (saved {:.1f} %), "
                            "relative MSE {:.3g} and {:.3g}, seconds {:.2f} and {:.2f}",
                            samples, a.rays, b.rays, 100 * (1 - b.rays / a.rays), a.error, b.error,
                            a.seconds, b.seconds));
}

void run(int columns, int rows) {
  const int lamps = columns * rows;
  const int samples = lamps <= 4 ? 64 : lamps <= 16 ? 32 : 8;
  const auto scene = build_scene(parse_mitsuba_xml(room(columns, rows), "benchmark", ""));
  const std::string every = text("light_sampling", "all");
  const Image reference =
      render(*scene, every + integer("light_samples", lamps), reference_factor * samples).picture;
  const auto measured = [&](const std::string& parameters) {
    return measure(*scene, reference, samples, parameters);
  };
  const Measured all = measured(every);
  compare(fmt::format("one_vs_every_lamp_of_{}", lamps), samples,
          measured(text("light_sampling", "one")), all);
  ShadowReport photons;
  (void)trace_shadow_photons(*scene, shadow_photons, 0, 0, {}, photons);
  for (const int neighbors : {50, std::max(50, 8 * lamps)}) {
    Measured with = measured(every + integer("shadow_photons", shadow_photons) +
                             integer("shadow_neighbors", neighbors));
    with.rays -= double(photons.rays);
    compare(fmt::format("every_lamp_of_{}_vs_shadow_photons_{}_neighbors", lamps, neighbors),
            samples, all, with);
    if (neighbors == 8 * lamps || 8 * lamps <= 50) break;
  }
}

}  // namespace

int main(int argc, char** argv) {
  const int largest = argc > 1 ? std::atoi(argv[1]) : 144;
  try {
    for (const auto& [columns, rows] :
         {std::pair(1, 1), std::pair(2, 1), std::pair(2, 2), std::pair(4, 4), std::pair(12, 12)})
      if (columns * rows <= largest) run(columns, rows);
  } catch (const Error& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
  return 0;
}
