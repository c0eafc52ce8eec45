// By how much `auto` leads over `path` on caustics from balls that are not smooth: ground glass of
// several roughnesses, and glass with a coat and with Burley's parameters. Prints, for each, the
// relative MSE of both after equal times, and its ratio. `rough_caustics_bench [seconds of each
// picture [seconds of each reference]]`. The reference is of `bdpt`, which neither of both is.
#include <cstdlib>

#include "benchmarks/markdown_table.h"
#include "benchmarks/quality.h"
#include "kaustik/loader/mitsuba_xml.h"

namespace {

using namespace kaustik;

constexpr int picture_size = 96;

struct Finish {
  std::string name, bsdf;
};

std::string number(const std::string& name, double value) {
  return fmt::format("<float name=\"{}\" value=\"{}\"/>", name, value);
}
std::string of_type(const std::string& type, const std::string& inside) {
  return "<bsdf type=\"" + type + "\">" + inside + "</bsdf>";
}

std::vector<Finish> finishes() {
  std::vector<Finish> all;
  for (const double alpha : {0.01, 0.05, 0.1, 0.3})
    all.push_back({fmt::format("ground glass, alpha {}", alpha),
                   of_type("roughdielectric", number("alpha", alpha))});
  all.push_back(
      {"coated glass, roughness 0.2",
       of_type("openpbr", number("transmission_weight", 1) + number("specular_roughness", 0.2) +
                              number("coat_weight", 1) + number("coat_roughness", 0.1))});
  all.push_back({"principled glass, roughness 0.2",
                 of_type("principled", number("spec_trans", 1) + number("roughness", 0.2) +
                                           "<rgb name=\"base_color\" value=\"1\"/>")});
  return all;
}

/// A ball over a matt floor under a small lamp; the picture shows the floor beneath it.
std::string ball_scene(const std::string& bsdf) {
  return fmt::format(
      "<scene version=\"3.0.0\"><sensor type=\"perspective\"><float name=\"fov\" value=\"32\"/>"
      "<transform name=\"to_world\"><lookat origin=\"0, -5, 3\" target=\"0.3, 0, 0\" "
      "up=\"0, 0, 1\"/></transform><film type=\"hdrfilm\"><integer name=\"width\" value=\"{0}\"/>"
      "<integer name=\"height\" value=\"{0}\"/></film></sensor>"
      "<shape type=\"rectangle\"><transform name=\"to_world\"><scale value=\"4\"/></transform>"
      "<bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"0.7\"/></bsdf></shape>"
      "<shape type=\"sphere\"><point name=\"center\" value=\"-0.3, 0, 0.9\"/>"
      "<float name=\"radius\" value=\"0.6\"/>{1}</shape>"
      "<shape type=\"rectangle\"><transform name=\"to_world\"><scale value=\"0.1\"/>"
      "<lookat origin=\"-2, 0, 4\" target=\"-0.3, 0, 0.9\" up=\"0, 1, 0\"/></transform>"
      "<emitter type=\"area\"><rgb name=\"radiance\" value=\"400\"/></emitter></shape></scene>",
      picture_size, bsdf);
}

Image picture_of(const Scene& scene, const std::string& type, uint64_t seed, double seconds) {
  const Description description = parse_mitsuba_xml(
      "<scene version=\"3.0.0\"><integrator type=\"" + type + "\"/></scene>", "benchmark", "");
  std::vector<std::string> warnings;
  const auto method = make_integrator(description, scene, warnings);
  SessionSettings settings;
  settings.seed = seed;
  settings.threads = bench::picture_threads;
  settings.seconds = seconds;
  Session session(scene, *method, settings);
  session.run();
  return session.film().image();
}

}  // namespace

int main(int count, char** words) {
  const double seconds = count > 1 ? std::atof(words[1]) : 10;
  const double reference_seconds = count > 2 ? std::atof(words[2]) : 20 * seconds;
  bench::MarkdownTable table({"surface", "path", "auto", "lead"});
  for (const Finish& finish : finishes()) {
    const auto scene = build_scene(parse_mitsuba_xml(ball_scene(finish.bsdf), "benchmark", ""));
    const Image reference = picture_of(*scene, "bdpt", 1, reference_seconds);
    const double path = bench::error_of(picture_of(*scene, "path", 2, seconds), reference),
                 chosen = bench::error_of(picture_of(*scene, "auto", 3, seconds), reference);
    bench::report("rough_caustic: " + finish.name, path / chosen,
                  "relative MSE of path over that of auto at equal time",
                  fmt::format("path {:.3g}, auto {:.3g} after {:g} s", path, chosen, seconds));
    table.add({finish.name, fmt::format("{:.3g}", path), fmt::format("{:.3g}", chosen),
               fmt::format("{:.1f}", path / chosen)});
  }
  fmt::print("{}", table.text());
}
