// One ball of each material on a matt floor, which fills the picture: all integrators see the same
// light on it, in each channel.

#include "tests/support/measure.h"
#include "tests/support/scene_text.h"

namespace kaustik {
namespace {

using namespace test;

struct Material {
  std::string name, bsdf;
  double samples = 4;        ///< for half a percent of noise in each channel
  double quick_samples = 1;  ///< for one percent
  /// Of photonmap: where it gathers, f is what it is on the mean over even light.
  double photonmap_tolerance = 0.03;
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
       bsdf("roughdiffuse", rgb("reflectance", "0.8, 0.7, 0.5") + set("roughness", 0.9)), 4, 1,
       0.05},
      {"ground_glass", bsdf("roughdielectric", set("alpha", 0.3)), 40, 4},
      {"pane", bsdf("thindielectric", rgb("specular_transmittance", "0.7, 0.8, 0.9"))},
      {"plastic", bsdf("plastic", rgb("diffuse_reflectance", "0.6, 0.7, 0.2")), 16, 16},
      {"rough_plastic",
       bsdf("roughplastic", rgb("diffuse_reflectance", "0.6, 0.7, 0.2") + set("alpha", 0.3))},
      {"principled_metal", bsdf("principled", rgb("base_color", "0.9, 0.7, 0.3") +
                                                  set("metallic", 0.7) + set("roughness", 0.5))},
      {"principled_cloth", bsdf("principled", rgb("base_color", "0.3, 0.5, 0.7") +
                                                  set("sheen", 1.0) + set("flatness", 0.5))},
      {"principled_glass",
       bsdf("principled",
            rgb("base_color", "0.8, 0.9, 0.7") + set("spec_trans", 0.7) + set("roughness", 0.5)),
       32, 4},
      {"leaf",
       bsdf("principledthin",
            rgb("base_color", "0.4, 0.8, 0.3") + set("diff_trans", 1.0) + set("spec_trans", 0.3)),
       24, 4},
      {"ward", bsdf("ward", rgb("diffuse_reflectance", "0.4, 0.2, 0.3") +
                                rgb("specular_reflectance", "0.3, 0.5, 0.4") + set("alpha_u", 0.2) +
                                set("alpha_v", 0.5))},
      {"metal_of_colours",
       bsdf("roughconductor", rgb("reflectance", "0.9, 0.6, 0.3") +
                                  rgb("edge_tint", "0.3, 0.8, 0.6") + set("alpha", 0.4))},
      {"car_paint",
       bsdf("openpbr", rgb("base_color", "0.8, 0.4, 0.2") + set("base_metalness", 0.6) +
                           set("specular_roughness", 0.6) + set("coat_weight", 1.0) +
                           set("coat_roughness", 0.5) + rgb("coat_color", "1, 0.8, 0.6"))},
      {"coated_glass",
       bsdf("openpbr", set("transmission_weight", 0.6) + set("specular_roughness", 0.6) +
                           rgb("transmission_color", "0.7, 0.9, 1") + set("coat_weight", 0.5) +
                           set("coat_roughness", 0.5) + set("fuzz_weight", 0.3)),
       32, 1}};
  return all;
}

std::vector<Material> mixed_materials() {
  std::vector<Material> mixed;
  for (const char* name :
       {"ground_glass", "plastic", "principled_glass", "leaf", "ward", "coated_glass"})
    for (const Material& material : materials())
      if (material.name == name) mixed.push_back(material);
  return mixed;
}

/// All pixels see the ball, whose radius is 8.4 degrees. What merges does so over pixels: were they
/// few, disks would be as wide as the ball is round.
TestScene ball_of(const std::string& material) {
  return TestScene(
      camera("0, -4, 1.6", "0, 0, 0.62", 11, 64) +
      flat("rectangle", scale("2, 2, 1"), diffuse("0.6")) +
      flat("rectangle", scale("2, 2, 1") + rotate("1, 0, 0", 90) + translate("0, 2, 0"),
           diffuse("0.6, 0.5, 0.4")) +
      flat("rectangle", scale("0.5, 0.5, 1") + rotate("1, 0, 0", 180) + translate("0.8, 0, 2"),
           diffuse("0") + area_light("8, 6, 7")) +
      sphere("0, 0, 0.62", 0.6, material));
}

constexpr const char* channel_names = "RGB";

Passes picture_of(const TestScene& scene, const std::string& type, const std::string& parameters,
                  double samples) {
  RenderOptions options;
  options.samples = samples;
  return render(scene, type, parameters, options);
}

/// With the same seed.
Comparison in_channel(const Passes& a, const Passes& b, int channel) {
  return Comparison::same_seed(a.values({""}, {}, channel), b.values({""}, {}, channel));
}

class Materials : public testing::TestWithParam<Material> {
 protected:
  /// Beside `path`, with the same seed.
  void expect_agreement(const TestScene& scene, const Passes& path, const std::string& type,
                        const std::string& parameters, double tolerance, double samples,
                        double largest_error = 0.005) const {
    const Passes found = picture_of(scene, type, parameters, samples);
    for (int channel = 0; channel < 3; ++channel)
      expect_near_means(GetParam().name + ", " + type + ", " + channel_names[channel],
                        in_channel(found, path, channel), tolerance, largest_error);
  }
  void expect_bdpt_agrees(double tolerance, double samples) const {
    const TestScene scene = ball_of(GetParam().bsdf);
    expect_agreement(scene, picture_of(scene, "path", "", samples), "bdpt", "", tolerance, samples,
                     tolerance / 2);
  }
};

TEST_P(Materials, BdptAgreesWithPathLong) { expect_bdpt_agrees(0.01, GetParam().samples); }

/// Those with most lobes.
class MixedMaterials : public Materials {};

TEST_P(MixedMaterials, BdptAgreesWithPath) { expect_bdpt_agrees(0.02, GetParam().quick_samples); }

// What merges has a bias of its own.
TEST_P(Materials, AllAgreeWithPathLong) {
  const TestScene scene = ball_of(GetParam().bsdf);
  const Passes path = picture_of(scene, "path", "", 8 * GetParam().samples);
  const double samples = 2 * GetParam().samples;
  expect_agreement(scene, path, "vcm", set("light_paths", 2.0), 0.01, samples);
  expect_agreement(scene, path, "auto", "", 0.02, samples);
  expect_agreement(scene, path, "photonmap", set("global_photons", 100000),
                   GetParam().photonmap_tolerance, samples);
}

// A ball that is off by 4 % in one channel is found out in that channel, and in no other.
TEST(MaterialsPlanted, AnErrorInOneChannelIsFound) {
  if (slow_build) GTEST_SKIP();
  const auto ball = [](const std::string& reflectance) {
    return ball_of(bsdf("plastic", rgb("diffuse_reflectance", reflectance)));
  };
  const Passes right = picture_of(ball("0.6, 0.7, 0.2"), "path", "", 4),
               wrong = picture_of(ball("0.6, 0.7, 0.21"), "path", "", 4);
  for (int channel = 0; channel < 3; ++channel) {
    const double p = in_channel(wrong, right, channel).p_value_of_nearness(0.01);
    EXPECT_EQ(p > nearness_level(), channel != 2) << channel_names[channel];
  }
}

INSTANTIATE_TEST_SUITE_P(All, Materials, testing::ValuesIn(materials()),
                         [](const auto& instance) { return instance.param.name; });
INSTANTIATE_TEST_SUITE_P(All, MixedMaterials, testing::ValuesIn(mixed_materials()),
                         [](const auto& instance) { return instance.param.name; });

}  // namespace
}  // namespace kaustik
