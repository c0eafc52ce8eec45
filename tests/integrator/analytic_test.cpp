// Scenes whose radiance is known in closed form.

#include "tests/support/measure.h"
#include "tests/support/scene_text.h"

namespace kaustik {
namespace {

using namespace test;

/// Parameters that leave photon estimates hardly any bias.
std::string few_neighbors(int photons) {
  return set("global_photons", photons) + set("caustic_photons", photons) +
         set("global_neighbors", 12) + set("caustic_neighbors", 12);
}

/// Of what merges here there is little else.
std::string many_light_paths() { return set("light_paths", 1.0); }

const std::vector<std::string> reflected = {"direct", "caustic", "indirect"};

// ---------------------------------------------------------------- furnace

/// A closed sphere that emits 1 everywhere and reflects ρ: L = 1/(1 − ρ).
class Furnace : public testing::Test {
 protected:
  Furnace()
      : scene_(camera("0.2, 0.1, -0.3", "1, 0.3, 0.2", 80) +
               sphere("0, 0, 0", 1, diffuse("0.8, 0.5, 0.2") + area_light("1, 1, 1"), true)) {}

  void check(const std::string& type, const Passes& passes) {
    const double reflectance[] = {0.8, 0.5, 0.2};
    for (int channel = 0; channel < 3; ++channel) {
      const double rho = reflectance[channel];
      const std::string name = type + " furnace " + "RGB"[channel];
      expect_mean(name, passes.mean({""}, {}, channel), 1 / (1 - rho));
      expect_mean(name + " direct", passes.mean({"direct"}, {}, channel), rho);
      expect_mean(name + " indirect", passes.mean({"indirect"}, {}, channel),
                  rho * rho / (1 - rho));
    }
  }
  TestScene scene_;
};

TEST_F(Furnace, Path) { check("path", render(scene_, "path", "", {20})); }
TEST_F(Furnace, LightTracer) { check("lighttracer", render(scene_, "lighttracer", "", {350})); }
TEST_F(Furnace, Bdpt) { check("bdpt", render(scene_, "bdpt", "", {16})); }
TEST_F(Furnace, VcmLong) { check("vcm", render(scene_, "vcm", many_light_paths(), {80})); }
TEST_F(Furnace, PpmLong) { check("ppm", render(scene_, "ppm", many_light_paths(), {100})); }
TEST_F(Furnace, Auto) { check("auto", render(scene_, "auto", "", {100})); }
/// Gather rays have no bias of disks, and find the light of all numbers of events.
TEST_F(Furnace, IndirectCache) {
  check("cached",
        render(scene_, "ppm", many_light_paths() + set("indirect_cache", "always"), {20}));
}
TEST_F(Furnace, PhotonMap) {
  check("photonmap", render(scene_, "photonmap", few_neighbors(8'000), {16}));
}

/// The same within an ellipsoid, and within a leaning elliptic tube with its ends: the form makes
/// no difference.
class DistortedFurnace : public testing::Test {
 protected:
  static std::string shape(const std::string& type, const std::string& transform, bool flipped,
                           const std::string& more = "") {
    return fmt::format(
        R"(<shape type="{}"><transform name="to_world">{}{}</transform>
        <boolean name="flip_normals" value="{}"/>{}{}</shape>)",
        type, transform, distortion, flipped, more,
        diffuse("0.7, 0.7, 0.7") + area_light("1, 1, 1"));
  }
  static constexpr const char* distortion =
      R"(<matrix value="1.3 0.2 0.4 0  0 0.6 -0.2 0  0.1 0 0.9 0  0 0 0 1"/>)";

  DistortedFurnace()
      : ellipsoid_(view() + shape("sphere", "", true)),
        tube_(view() + shape("disk", translate("0, 0, -1"), false) +
              shape("disk", translate("0, 0, 1"), true) +
              shape("cylinder", "", true,
                    R"(<point name="p0" value="0, 0, -1"/><point name="p1" value="0, 0, 1"/>)")) {}
  static std::string view() { return camera("0.2, 0.1, -0.2", "1, 0.3, 0.2", 80); }

  void check(const std::string& type, double samples) {
    for (const TestScene* scene : {&ellipsoid_, &tube_}) {
      const Passes rendered = render(*scene, type, "", {.samples = samples});
      const std::string name = type + (scene == &tube_ ? " tube" : " ellipsoid");
      expect_mean(name, rendered.mean({""}), 1 / 0.3);
      expect_mean(name + " direct", rendered.mean({"direct"}), 0.7);
    }
  }
  TestScene ellipsoid_, tube_;
};

TEST_F(DistortedFurnace, Path) { check("path", 20); }
TEST_F(DistortedFurnace, LightTracer) { check("lighttracer", 220); }
TEST_F(DistortedFurnace, Bdpt) { check("bdpt", 16); }
TEST_F(DistortedFurnace, Auto) { check("auto", 160); }

// ---------------------------------------------------------------- light in a diffuse sphere

/// A lamp of flux Φ anywhere within: the light that was reflected at least once falls evenly,
/// E = Φ/(4πR²) ρ/(1 − ρ), whatever the lamp's place.
class DiffuseSphere : public testing::Test {
 protected:
  static constexpr double radius = 2, rho = 0.6, intensity = 3;
  DiffuseSphere()
      : scene_(camera("0.5, 0.2, -0.3", "2, 0.3, 0.2", 80) +
               sphere("0, 0, 0", radius, diffuse("0.6, 0.6, 0.6"), true) +
               point_light("0.6, 0.4, 0.3", intensity)) {}

  void check(const std::string& type, const Passes& passes) {
    const double irradiance = intensity / (radius * radius) * rho / (1 - rho);
    expect_mean(type + " sphere indirect", passes.mean({"indirect"}),
                rho / std::numbers::pi * irradiance);
    EXPECT_EQ(passes.mean({"caustic"}).mean(), 0);
  }
  TestScene scene_;
};

TEST_F(DiffuseSphere, Path) { check("path", render(scene_, "path", "", {30})); }
TEST_F(DiffuseSphere, LightTracer) {
  check("lighttracer", render(scene_, "lighttracer", "", {350}));
}
TEST_F(DiffuseSphere, Bdpt) { check("bdpt", render(scene_, "bdpt", "", {10})); }
TEST_F(DiffuseSphere, VcmLong) { check("vcm", render(scene_, "vcm", many_light_paths(), {120})); }
TEST_F(DiffuseSphere, PpmLong) { check("ppm", render(scene_, "ppm", many_light_paths(), {120})); }
TEST_F(DiffuseSphere, Auto) { check("auto", render(scene_, "auto", "", {180})); }
TEST_F(DiffuseSphere, PhotonMap) {
  check("photonmap", render(scene_, "photonmap", few_neighbors(20'000), {16}));
}
TEST_F(DiffuseSphere, PhotonMapWithoutCache) {
  check("photonmap without cache",
        render(scene_, "photonmap",
               few_neighbors(20'000) + set("irradiance_cache", false) + set("precompute_stride", 0),
               {16}));
}

// ---------------------------------------------------------------- parallel plates

/// Two plates with four perfect mirrors about them, which makes them infinite:
/// B₁ = (M₁ + ρ₁ M₂)/(1 − ρ₁ ρ₂).
class ParallelPlates : public testing::Test {
 protected:
  ParallelPlates()
      : scene_(camera("0.1, -0.05, 0.9", "0, 0.02, 0", 50, 16, "0, 1, 0") +
               flat("rectangle", scale("0.5, 0.5, 1"), diffuse("0.5, 0.5, 0.5") + area_light("1")) +
               flat("rectangle",
                    scale("0.5, 0.5, 1") + rotate("1, 0, 0", 180) + translate("0, 0, 1"),
                    diffuse("0.4, 0.4, 0.4") + area_light("2")) +
               wall(0) + wall(90) + wall(180) + wall(270)) {}
  static std::string wall(double degrees) {
    return flat("rectangle",
                scale("0.5, 0.5, 1") + rotate("0, 1, 0", -90) + translate("0.5, 0, 0.5") +
                    rotate("0, 0, 1", degrees),
                mirror());
  }
  /// Of the floor, what it reflects.
  void check(const std::string& type, const Passes& passes) {
    const double rho_1 = 0.5, rho_2 = 0.4, emitted_1 = 1, emitted_2 = 2;
    const double radiance = (emitted_1 + rho_1 * emitted_2) / (1 - rho_1 * rho_2);
    expect_mean(type + " plates", passes.mean(reflected), radiance - emitted_1);
    expect_mean(type + " plates emission", passes.mean({"emission"}), emitted_1);
  }
  TestScene scene_;
};

TEST_F(ParallelPlates, Path) { check("path", render(scene_, "path", "", {20})); }
TEST_F(ParallelPlates, LightTracer) {
  check("lighttracer", render(scene_, "lighttracer", "", {350}));
}
TEST_F(ParallelPlates, Bdpt) { check("bdpt", render(scene_, "bdpt", "", {16})); }
TEST_F(ParallelPlates, Vcm) { check("vcm", render(scene_, "vcm", many_light_paths(), {28})); }
TEST_F(ParallelPlates, Ppm) { check("ppm", render(scene_, "ppm", many_light_paths(), {28})); }
TEST_F(ParallelPlates, Auto) { check("auto", render(scene_, "auto", "", {24})); }
/// Few neighbours of many photons, because their disks leave the plates at the mirrors.
TEST_F(ParallelPlates, PhotonMap) {
  check("photonmap", render(scene_, "photonmap",
                            set("global_photons", 30'000) + set("caustic_photons", 30'000) +
                                set("global_neighbors", 6) + set("caustic_neighbors", 6),
                            {16}));
}

// ---------------------------------------------------------------- disk over a plane

/// A Lambertian disk of radius a and radiance L at height h, parallel to the floor. At distance d
/// from the axis E = πL/2 (1 − (d² + h² − a²)/√((d² + h² + a²)² − 4a²d²)), on it πL a²/(a² + h²).
class DiskOverPlane : public testing::Test {
 protected:
  static constexpr double a = 0.5, h = 1, radiance = 4, rho = 0.7, side = 0.8;
  DiskOverPlane()
      : scene_(camera("0, 0, 0.4", "0, 0, 0", 90, 16, "0, 1, 0") +
               flat("rectangle", scale("2, 2, 1"), diffuse("0.7, 0.7, 0.7")) +
               flat("disk", scale("0.5, 0.5, 1") + rotate("1, 0, 0", 180) + translate("0, 0, 1"),
                    diffuse("0, 0, 0") + area_light("4, 4, 4"))) {}

  static double irradiance(double d_sq) {
    const double s = d_sq + h * h + a * a;
    return std::numbers::pi * radiance / 2 *
           (1 - (d_sq + h * h - a * a) / std::sqrt(s * s - 4 * a * a * d_sq));
  }
  /// Mean radiance of the square of the given side that the picture shows.
  static double expected(double width) {
    constexpr int n = 400;
    double sum = 0;
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j)
        sum += irradiance(std::pow(width * ((i + 0.5) / n - 0.5), 2) +
                          std::pow(width * ((j + 0.5) / n - 0.5), 2));
    return rho / std::numbers::pi * sum / (n * n);
  }
  void check(const std::string& type, const Passes& passes) {
    expect_mean(type + " disk", passes.mean({""}), expected(side));
  }
  TestScene scene_;
};

TEST_F(DiskOverPlane, ClosedFormOnTheAxis) {
  EXPECT_NEAR(irradiance(0), std::numbers::pi * radiance * a * a / (a * a + h * h), 1e-12);
}
TEST_F(DiskOverPlane, Path) { check("path", render(scene_, "path", "", {64})); }
TEST_F(DiskOverPlane, LightTracer) {
  check("lighttracer", render(scene_, "lighttracer", "", {180}));
}
TEST_F(DiskOverPlane, Bdpt) { check("bdpt", render(scene_, "bdpt", "", {64})); }
TEST_F(DiskOverPlane, Vcm) { check("vcm", render(scene_, "vcm", "", {64})); }
TEST_F(DiskOverPlane, Ppm) { check("ppm", render(scene_, "ppm", "", {64})); }
TEST_F(DiskOverPlane, Auto) { check("auto", render(scene_, "auto", "", {64})); }
TEST_F(DiskOverPlane, PhotonMap) {
  check("photonmap", render(scene_, "photonmap", few_neighbors(2000), {64}));
}
/// The middle alone.
TEST_F(DiskOverPlane, OnTheAxis) {
  const TestScene spot(camera("0, 0, 0.4", "0, 0, 0", 2, 4, "0, 1, 0") +
                       flat("rectangle", scale("2, 2, 1"), diffuse("0.7, 0.7, 0.7")) +
                       flat("disk",
                            scale("0.5, 0.5, 1") + rotate("1, 0, 0", 180) + translate("0, 0, 1"),
                            diffuse("0, 0, 0") + area_light("4, 4, 4")));
  for (const char* type : {"path", "photonmap", "ppm", "auto"})
    expect_mean(std::string(type) + " disk on the axis", render(spot, type, "", {16}).mean({""}),
                rho * radiance * a * a / (a * a + h * h));
}

}  // namespace
}  // namespace kaustik
