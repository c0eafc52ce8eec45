// What many lights cost: a hall under 1, 100 and 10 000 lamps of the same power together, each of
// them a rectangle or a spot, lit directly, by whole paths, and by what `auto` makes of it. Prints
// processor time and error of a picture with the same samples, beside one lamp. `many_lights_bench
// [samples per pixel]`.
#include <cstdlib>
#include <ctime>

#include "benchmarks/markdown_table.h"
#include "benchmarks/quality.h"
#include "kaustik/loader/mitsuba_xml.h"

namespace {

using namespace kaustik;

constexpr int picture_size = 64;
/// The reference has so many times as many samples as what is measured.
constexpr int reference_factor = 8;
/// The quickest of so many runs is what a picture costs.
constexpr int runs = 3;

enum class Lamp { rectangle, spot };

std::string box(const Vec3d& from, const Vec3d& to, double reflectance) {
  const Vec3d half = (to - from) * 0.5, middle = (to + from) * 0.5;
  return fmt::format(
      "<shape type=\"cube\"><transform name=\"to_world\"><scale x=\"{}\" y=\"{}\" z=\"{}\"/>"
      "<translate x=\"{}\" y=\"{}\" z=\"{}\"/></transform><bsdf type=\"twosided\">"
      "<bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"{}\"/></bsdf></bsdf></shape>",
      half.x, half.y, half.z, middle.x, middle.y, middle.z, reflectance);
}

/// Facing down from a height of 4.9 m, one of `columns`² whose power is one lamp's together.
std::string lamp(Lamp kind, int columns, int column, int row) {
  const double x = 30 * ((column + 0.5) / columns - 0.5), y = 30 * ((row + 0.5) / columns - 0.5);
  if (kind == Lamp::rectangle)
    return fmt::format(
        "<shape type=\"rectangle\"><transform name=\"to_world\"><scale value=\"{}\"/>"
        "<rotate x=\"1\" angle=\"180\"/><translate x=\"{}\" y=\"{}\" z=\"4.9\"/></transform>"
        "<emitter type=\"area\"><rgb name=\"radiance\" value=\"1000\"/></emitter></shape>",
        0.5 / columns, x, y);
  return fmt::format(
      "<emitter type=\"spot\"><float name=\"cutoff_angle\" value=\"75\"/><transform "
      "name=\"to_world\"><lookat origin=\"{0}, {1}, 4.9\" target=\"{0}, {1}, 0\" up=\"0, 1, 0\"/>"
      "</transform><rgb name=\"intensity\" value=\"{2}\"/></emitter>",
      x, y, 1000.0 / (columns * columns));
}

/// 32 × 32 × 5 m with pillars every 4 m.
std::string hall(Lamp kind, int columns) {
  std::string text = fmt::format(
      "<scene version=\"3.0.0\"><sensor type=\"perspective\"><float name=\"fov\" value=\"70\"/>"
      "<transform name=\"to_world\"><lookat origin=\"1, -15, 2.5\" target=\"0, 0, 1.5\" "
      "up=\"0, 0, 1\"/></transform><film type=\"hdrfilm\"><integer name=\"width\" value=\"{0}\"/>"
      "<integer name=\"height\" value=\"{0}\"/></film></sensor>",
      picture_size);
  text += box({-16, -16, 0}, {16, 16, 5}, 0.5);
  for (int x = -14; x <= 14; x += 4)
    for (int y = -14; y <= 14; y += 4)
      text += box({x - 0.3, y - 0.3, 0}, {x + 0.3, y + 0.3, 4.5}, 0.7);
  for (int i = 0; i < columns * columns; ++i) text += lamp(kind, columns, i % columns, i / columns);
  return text + "</scene>";
}

struct Rendered {
  Image picture;
  double seconds = 0;  ///< of processor time
};

Rendered render(const Scene& scene, const Integrator& method, uint64_t seed, int samples,
                int threads) {
  SessionSettings settings;
  settings.seed = seed;
  settings.threads = threads;
  settings.samples_per_pixel = uint32_t(samples);
  Session session(scene, method, settings);
  const std::clock_t start = std::clock();
  session.run();
  return {session.film().image(), double(std::clock() - start) / CLOCKS_PER_SEC};
}

struct Measured {
  double seconds = 1e30, error = 0;
};

std::unique_ptr<Integrator> method_of(const Scene& scene, const std::string& type,
                                      const std::string& parameters) {
  const Description description =
      parse_mitsuba_xml("<scene version=\"3.0.0\"><integrator type=\"" + type + "\">" + parameters +
                            "</integrator></scene>",
                        "benchmark", "");
  std::vector<std::string> warnings;
  return make_integrator(description, scene, warnings);
}

/// By path tracing.
Image reference_of(const Scene& scene, const std::string& parameters, int samples) {
  return render(scene, *method_of(scene, "path", parameters), 1, reference_factor * samples,
                bench::picture_threads)
      .picture;
}

/// An integrator is made anew for each run: what it learns is part of the picture's cost.
Measured measure(const Scene& scene, const std::string& type, const std::string& parameters,
                 int samples, const Image& reference) {
  Measured measured;
  for (int i = 0; i < runs; ++i) {
    const auto method = method_of(scene, type, parameters);
    const Rendered rendered = render(scene, *method, 2, samples, 1);
    measured.seconds = std::min(measured.seconds, rendered.seconds);
    measured.error = bench::error_of(rendered.picture, reference);
  }
  return measured;
}

/// Lamps that are seen are left out: pixels that hold some of many have errors of their own.
std::string components(const std::string& names) {
  return "<string name=\"components\" value=\"" + names + "\"/>";
}

/// Time, what it is beside one lamp's, and error, as cells of a table.
void add_cells(const Measured& measured, const Measured& one, std::vector<std::string>& row) {
  row.push_back(fmt::format("{:.3f}", measured.seconds));
  row.push_back(fmt::format("{:.2f}", measured.seconds / one.seconds));
  row.push_back(fmt::format("{:.3f}", std::sqrt(measured.error)));
}

void report_cost(const std::string& name, const Measured& measured, const Measured& one,
                 const std::string& how) {
  bench::report(name, measured.seconds / one.seconds,
                "ratio of processor time of a picture by " + how,
                fmt::format("one lamp of the same power: {:.3f} and {:.3f} s", measured.seconds,
                            one.seconds));
}

void run(Lamp kind, int samples, bench::MarkdownTable& table) {
  const std::string name = kind == Lamp::spot ? "spots" : "rectangles";
  const std::string whole =
      components("direct,indirect") + "<integer name=\"max_depth\" value=\"6\"/>";
  Measured one_direct, one_path, one_auto;
  for (const int columns : {1, 10, 100}) {
    const Description description = parse_mitsuba_xml(hall(kind, columns), "benchmark", "");
    const std::clock_t start = std::clock();
    const auto scene = build_scene(description);
    const double built = double(std::clock() - start) / CLOCKS_PER_SEC;
    const Image lit_directly = reference_of(*scene, components("direct"), samples),
                lit = reference_of(*scene, whole, samples);
    const Measured direct = measure(*scene, "path", components("direct"), samples, lit_directly),
                   path = measure(*scene, "path", whole, samples, lit),
                   chosen = measure(*scene, "auto", whole, samples, lit);
    if (columns == 1) {
      one_direct = direct;
      one_path = path;
      one_auto = chosen;
    }
    const int lamps = columns * columns;
    std::vector<std::string> row{fmt::format("{} {}", lamps, name), fmt::format("{:.2f}", built)};
    add_cells(direct, one_direct, row);
    add_cells(path, one_path, row);
    add_cells(chosen, one_auto, row);
    table.add(row);
    report_cost(fmt::format("cost_of_{}_{}", lamps, name), path, one_path, "paths");
    report_cost(fmt::format("cost_of_{}_{}_auto", lamps, name), chosen, one_auto, "auto");
  }
}

}  // namespace

int main(int argc, char** argv) {
  const int samples = argc > 1 ? std::max(1, std::atoi(argv[1])) : 16;
  bench::MarkdownTable table({"lamps", "building, s", "direct light, s", "beside one lamp",
                              "relative error", "paths, s", "beside one lamp", "relative error",
                              "auto, s", "beside one lamp", "relative error"});
  try {
    for (const Lamp kind : {Lamp::rectangle, Lamp::spot}) run(kind, samples, table);
  } catch (const Error& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
  fmt::print(stderr, "{}", table.text());
  return 0;
}
