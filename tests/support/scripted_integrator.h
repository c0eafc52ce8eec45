#pragma once
// An integrator that does what a test wants, and small scenes for it.

#include <functional>

#include "kaustik/loader/mitsuba_xml.h"
#include "kaustik/transport/integrator.h"

namespace kaustik::test {

inline std::shared_ptr<const Scene> scene_with(const std::string& film,
                                               const std::string& objects) {
  return build_scene(parse_mitsuba_xml(
      "<scene version=\"3.0.0\"><sensor type=\"perspective\"><float name=\"fov\" value=\"45\"/>"
      "<transform name=\"to_world\"><lookat origin=\"0,-4,2\" target=\"0,0,0.5\" up=\"0,0,1\"/>"
      "</transform>" +
          film + "</sensor>" + objects + "</scene>",
      "test.xml", ""));
}

inline std::string film_of(int width, int height, const std::string& inside = "") {
  return "<film type=\"hdrfilm\"><integer name=\"width\" value=\"" + std::to_string(width) +
         "\"/><integer name=\"height\" value=\"" + std::to_string(height) + "\"/>" + inside +
         "</film>";
}

inline constexpr const char* room =
    "<shape type=\"rectangle\"><transform name=\"to_world\"><scale "
    "value=\"3\"/></transform></shape>"
    "<shape type=\"sphere\"><point name=\"center\" x=\"0\" y=\"0\" z=\"0.6\"/>"
    "<float name=\"radius\" value=\"0.6\"/><bsdf type=\"dielectric\"/></shape>"
    "<shape type=\"rectangle\"><transform name=\"to_world\"><scale value=\"0.5\"/>"
    "<rotate x=\"1\" angle=\"180\"/><translate z=\"3\"/></transform>"
    "<emitter type=\"area\"><rgb name=\"radiance\" value=\"9\"/></emitter></shape>";

inline std::shared_ptr<const Scene> plain_scene(int sample_count = 0) {
  return scene_with(
      film_of(20, 18) + (sample_count > 0 ? "<sampler type=\"independent\"><integer name=\""
                                            "sample_count\" value=\"" +
                                                std::to_string(sample_count) + "\"/></sampler>"
                                          : std::string()),
      room);
}

/// What a test wants to happen in an integrator.
struct Script {
  std::function<void(const Pass&, SplatBuffer&)> prepare = [](const Pass&, SplatBuffer&) {};
  std::function<void(const Vec2f&, Sampler&, SampleSink&)> sample = [](const Vec2f&, Sampler&,
                                                                       SampleSink& sink) {
    sink.add(Component::direct, {1, 2, 3, 0});
  };
  bool splats = false, estimates_bias = false;
  std::vector<std::string> warnings;
};

class Scripted final : public Integrator {
 public:
  explicit Scripted(Script script) : script_(std::move(script)) {
    traits_ = {.splats = script_.splats, .estimates_bias = script_.estimates_bias};
  }
  std::unique_ptr<PassState> prepare(const Pass& pass, SplatBuffer& splats, std::stop_token,
                                     const ProgressFunction& progress) const override {
    script_.prepare(pass, splats);
    progress(0.5);
    auto state = std::make_unique<PassState>();
    state->report.warnings = script_.warnings;
    return state;
  }
  void sample(const PassState&, const Vec2f& raster, Sampler& sampler,
              SampleSink& sink) const override {
    script_.sample(raster, sampler, sink);
  }

 private:
  Script script_;
};

}  // namespace kaustik::test
