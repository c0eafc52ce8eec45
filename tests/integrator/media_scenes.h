#pragma once
// Scenes with media as text.

#include <numbers>

#include "tests/support/measure.h"
#include "tests/support/scene_text.h"

namespace kaustik::test {

inline std::string medium(const std::string& name, const std::string& sigma_t,
                          const std::string& albedo, double g = 0) {
  return fmt::format(
      R"(<medium {} type="homogeneous"><rgb name="sigma_t" value="{}"/><rgb name="albedo" value="{}"/>
      <phase type="hg"><float name="g" value="{}"/></phase></medium>)",
      name.empty() ? "" : "name=\"" + name + "\"", sigma_t, albedo, g);
}
inline const std::string null_bsdf = R"(<bsdf type="null"/>)";

/// `camera` inside `medium`.
inline std::string camera_in(const std::string& medium, const std::string& camera) {
  std::string text = camera;
  return text.insert(text.find("<film"), medium);
}

/// A scene needs a shape; this one is out of the way.
inline const std::string far_shape = sphere("0, 0, -1000", 0.1, diffuse("0, 0, 0"));

/// A point light of intensity 1 in an infinite medium at distance `h` from a ray that starts
/// abreast of it: L = ∫ σ_s p(θ) exp(−σ_t (s + d)) / d² ds, by Simpson's rule over the angle at the
/// light, s = h tan φ, which makes the integrand smooth (the airlight integral, Sun et al. 2005).
inline double airlight(double sigma_t, double albedo, double g, double h, int steps = 4000) {
  const double end = std::numbers::pi / 2;
  double sum = 0;
  for (int i = 0; i <= steps; ++i) {
    const double phi = end * i / steps;
    const double cosine_phi = std::cos(phi);
    if (!(cosine_phi > 1e-9)) continue;
    const double d = h / cosine_phi, s = h * std::tan(phi);
    // Light travels from the lamp to the point (forward by sin φ), then back to the camera.
    const double cosine = -std::sin(phi);
    const double phase =
        (1 - g * g) / (4 * std::numbers::pi * std::pow(1 + g * g - 2 * g * cosine, 1.5));
    const double value =
        albedo * sigma_t * phase * std::exp(-sigma_t * (s + d)) / h;  // ds/d² = dφ/h
    sum += value * (i == 0 || i == steps ? 1 : i % 2 ? 4 : 2);
  }
  return sum * end / steps / 3;
}

inline constexpr double airlight_sigma[] = {0.3, 0.6, 1.2};
inline constexpr double airlight_albedo = 0.8, airlight_distance = 0.5;
/// The scene of airlight(): what a narrow picture sees is the same all over.
inline std::string airlight_scene(double g, double fov = 0.2) {
  return camera_in(medium("", "0.3, 0.6, 1.2", "0.8, 0.8, 0.8", g),
                   camera("0, 0, 0", "0, 0, 1", fov, 4, "0, 1, 0")) +
         far_shape + point_light("0.5, 0, 0", 1);
}

/// Simpson's rule.
template <typename Function>
double simpson(double from, double to, int steps, const Function& f) {
  double sum = 0;
  for (int i = 0; i <= steps; ++i)
    sum += f(from + (to - from) * i / steps) * (i == 0 || i == steps ? 1 : i % 2 ? 4 : 2);
  return sum * (to - from) / steps / 3;
}

/// A point light of intensity 1 in the middle of a ball of haze of radius 1, seen from outside: the
/// radiance that is scattered once into a ray at the distance h = sin u from the lamp, L = ∫ σ_s p
/// exp(−σ_t (d + e))/d² ds with e the way out of the ball; s = h tan φ makes it smooth.
inline double lamp_in_ball_radiance(double sigma_t, double albedo, double g, double u, int steps) {
  const double h = std::sin(u), half_chord = std::cos(u), end = std::numbers::pi / 2 - u;
  return simpson(-end, end, steps, [&](double phi) {
    const double d = h / std::cos(phi), s = h * std::tan(phi), cosine = -std::sin(phi);
    const double phase =
        (1 - g * g) / (4 * std::numbers::pi * std::pow(1 + g * g - 2 * g * cosine, 1.5));
    return albedo * sigma_t * phase * std::exp(-sigma_t * (d + s + half_chord)) / h;
  });
}

/// The same from the distance `eye`: the mean over a square picture of field of view `fov`
/// (degrees).
inline double lamp_in_ball(double sigma_t, double albedo, double g, double eye, double fov,
                           int steps = 400) {
  // Over the picture plane at distance 1, in rings of radius tan γ, with sin γ = h/eye.
  const double sum = simpson(1e-7, std::numbers::pi / 2, steps, [&](double u) {
    const double sine = std::sin(u) / eye, cosine = std::sqrt(1 - sine * sine);
    return lamp_in_ball_radiance(sigma_t, albedo, g, u, steps) * 2 * std::numbers::pi * sine /
           (cosine * cosine * cosine * cosine) * std::cos(u) / eye;
  });
  const double half_width = std::tan(fov / 2 * std::numbers::pi / 180);
  return sum / (4 * half_width * half_width);
}

inline constexpr double ball_sigma[] = {0.4, 0.8, 1.2};
inline constexpr double ball_albedo = 0.8, ball_eye = 4, ball_fov = 31;
inline std::string lamp_in_ball_scene(double g, const std::string& albedo = "0.8, 0.8, 0.8") {
  return camera("0, 0, 4", "0, 0, 0", ball_fov, 8, "0, 1, 0") +
         sphere("0, 0, 0", 1, null_bsdf + medium("interior", "0.4, 0.8, 1.2", albedo, g)) +
         point_light("0, 0, 0", 1);
}

/// Of a pixel of that picture's 8 × 8: those neither near the lamp, where discs of photons are so
/// small that few rays meet them, nor near the ball's edge, where discs reach out of it.
inline double beside_the_lamp(int x, int y) {
  const double distance = std::hypot(x - 3.5, y - 3.5);
  return distance > 1 && distance < 2.2 ? 1.0 : 0.0;
}
/// The mean of the same light over these pixels, by midpoints of 16 × 16 parts of each.
inline double lamp_in_ball_beside(double sigma_t, double albedo, double g) {
  constexpr int parts = 16, steps = 200;
  const double half_width = std::tan(ball_fov / 2 * std::numbers::pi / 180);
  double sum = 0, pixels = 0;
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 8; ++x) {
      if (beside_the_lamp(x, y) == 0) continue;
      ++pixels;
      for (int part = 0; part < parts * parts; ++part) {
        const double u = (x + (part % parts + 0.5) / parts) / 4 - 1;
        const double v = (y + (part / parts + 0.5) / parts) / 4 - 1;
        const double h = ball_eye * std::sin(std::atan(half_width * std::hypot(u, v)));
        if (h < 1)
          sum += lamp_in_ball_radiance(sigma_t, albedo, g, std::asin(h), steps) / (parts * parts);
      }
    }
  return sum / pixels;
}

/// The camera stands in haze, with a glass ball and a ball of denser haze.
inline std::string hazy_room() {
  const std::string haze = "0.1, 0.2, 0.3", albedo = "0.9, 0.8, 0.7";
  return camera_in(medium("", haze, albedo, 0.3), camera("0, -3.5, 1.4", "0, 0, 0.6", 50, 8)) +
         flat("rectangle", scale("2"), diffuse("0.7, 0.6, 0.5")) +
         flat("rectangle", scale("2") + rotate("1, 0, 0", 90) + translate("0, 2, 1"),
              diffuse("0.5, 0.6, 0.7")) +
         sphere("0.7, 0, 0.5", 0.4, glass() + medium("exterior", haze, albedo, 0.3)) +
         sphere("-0.7, 0, 0.6", 0.5,
                null_bsdf + medium("interior", "1, 2, 3", albedo) +
                    medium("exterior", haze, albedo, 0.3)) +
         flat("rectangle", scale("0.5") + rotate("1, 0, 0", 180) + translate("0, 0, 2.2"),
              diffuse("0, 0, 0") + area_light("6, 6, 6"));
}

/// A ball of haze on a matt floor with a matt ball within, seen from outside.
inline std::string hazy_ball(const std::string& albedo = "0.9, 0.8, 0.7") {
  return camera("0, -4, 1.5", "0, 0, 0.7", 35, 8) +
         flat("rectangle", scale("1.5"), diffuse("0.7, 0.6, 0.5")) +
         sphere("0, 0, 0.9", 0.8, null_bsdf + medium("interior", "0.5, 0.8, 1.2", albedo, 0.4)) +
         sphere("0.2, 0.1, 0.8", 0.3, diffuse("0.6, 0.6, 0.6")) + point_light("1, -1, 2.5", 4);
}

}  // namespace kaustik::test
