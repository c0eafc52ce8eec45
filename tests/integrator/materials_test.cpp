// One ball of each material on a matt floor: all integrators see the same light.

#include "tests/support/glossy_scenes.h"
#include "tests/support/measure.h"

namespace kaustik {
namespace {

using namespace test;

struct Material {
  std::string name, bsdf;
};
void PrintTo(const Material& material, std::ostream* out) { *out << material.name; }

std::string bsdf(const std::string& type, const std::string& inside) {
  return "<bsdf type=\"" + type + "\">" + inside + "</bsdf>";
}
std::string rgb(const std::string& name, const std::string& value) {
  return "<rgb name=\"" + name + "\" value=\"" + value + "\"/>";
}

const std::vector<Material>& materials() {
  static const std::vector<Material> all = {
      {"rough_matt",
       bsdf("roughdiffuse", rgb("reflectance", "0.8, 0.7, 0.5") + set("roughness", 0.9))},
      {"ground_glass", bsdf("roughdielectric", set("alpha", 0.3))},
      {"pane", bsdf("thindielectric", rgb("specular_transmittance", "0.7, 0.8, 0.9"))},
      {"plastic", bsdf("plastic", rgb("diffuse_reflectance", "0.6, 0.7, 0.2"))},
      {"rough_plastic",
       bsdf("roughplastic", rgb("diffuse_reflectance", "0.6, 0.7, 0.2") + set("alpha", 0.3))},
      {"principled_metal", bsdf("principled", rgb("base_color", "0.9, 0.7, 0.3") +
                                                  set("metallic", 0.7) + set("roughness", 0.5))},
      {"principled_cloth", bsdf("principled", rgb("base_color", "0.3, 0.5, 0.7") +
                                                  set("sheen", 1.0) + set("flatness", 0.5))},
      {"principled_glass", bsdf("principled", rgb("base_color", "0.8, 0.9, 0.7") +
                                                  set("spec_trans", 0.7) + set("roughness", 0.5))}};
  return all;
}

TestScene ball_of(const Material& material) {
  return TestScene(
      glossy_scene(diffuse("0.6"), diffuse("0.6"), sphere("0, 0, 0.62", 0.6, material.bsdf), 16));
}

class Materials : public testing::TestWithParam<Material> {
 protected:
  /// Beside `path`, with the same seed.
  void expect_agreement(const TestScene& scene, const std::vector<double>& path,
                        const std::string& type, const std::string& parameters, double tolerance,
                        double samples) const {
    RenderOptions options;
    options.samples = samples;
    expect_near_means(
        GetParam().name + ", " + type,
        Comparison::same_seed(render(scene, type, parameters, options).values({""}), path),
        tolerance, 0.005);
  }
  std::vector<double> path_of(const TestScene& scene, double samples) const {
    RenderOptions options;
    options.samples = samples;
    return render(scene, "path", "", options).values({""});
  }
};

TEST_P(Materials, BdptAgreesWithPath) {
  const TestScene scene = ball_of(GetParam());
  expect_agreement(scene, path_of(scene, 64), "bdpt", "", 0.01, 64);
}

// What merges has a bias of its own.
TEST_P(Materials, AllAgreeWithPathLong) {
  const TestScene scene = ball_of(GetParam());
  const std::vector<double> path = path_of(scene, 512);
  expect_agreement(scene, path, "vcm", set("light_paths", 2.0), 0.01, 128);
  expect_agreement(scene, path, "auto", "", 0.02, 128);
  expect_agreement(scene, path, "photonmap", set("global_photons", 100000), 0.03, 128);
}

INSTANTIATE_TEST_SUITE_P(All, Materials, testing::ValuesIn(materials()),
                         [](const auto& instance) { return instance.param.name; });

}  // namespace
}  // namespace kaustik
