#include "kaustik/material/thin_film.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <vector>

#include "kaustik/base/color.h"
#include "kaustik/base/vec.h"

namespace kaustik {
namespace {

/// Share of one polarisation that is reflected. With amplitude r at the first side, finesse
/// 4r²/(1 − r²)² and half the phase δ between neighbouring beams, it is f sin²/(1 + f sin²).
double airy_share(double finesse, double sine_sq) {
  const double product = finesse * sine_sq;
  return product / (1 + product);
}

/// What both polarisations see of a film.
struct FilmView {
  /// `eta`: the film's index over that of its surroundings.
  FilmView(double cos_incident, double eta) {
    const double below_sq = eta * eta - 1 + cos_incident * cos_incident;  // (η cos)² in the film
    tunnels = below_sq < 0;
    below = std::sqrt(std::max(std::abs(below_sq), 1e-12));
    // Amplitudes are (a − b)/(a + b); b is imaginary where light tunnels.
    const double eta_sq = eta * eta;
    finesse_s = finesse_of(cos_incident, below);
    finesse_p = finesse_of(eta_sq * cos_incident, below);
  }
  double finesse_of(double a, double b) const {
    const double sum = tunnels ? a * a + b * b : a * a - b * b;
    return sum * sum / (4 * a * a * b * b);
  }

  bool tunnels;
  double below;  ///< (index of the film) · (cosine in it), over the index around; or its decay
  double finesse_s, finesse_p;
};

/// sin² of half the phase between neighbouring beams, or sinh² of the decay.
double sine_sq(const FilmView& view, double optical_thickness_nm, double nm) {
  const double half_phase = 2 * double(pi) * optical_thickness_nm * view.below / nm;
  // Beyond 20 nothing comes through.
  const double s = view.tunnels ? std::sinh(std::min(half_phase, 20.0)) : std::sin(half_phase);
  return s * s;
}

double reflectance_at(const FilmView& view, double optical_thickness_nm, double nm) {
  const double s = sine_sq(view, optical_thickness_nm, nm);
  return 0.5 * (airy_share(view.finesse_s, s) + airy_share(view.finesse_p, s));
}

/// airy_share() in RGB mode, by the path difference of neighbouring beams and the amplitude at one
/// side. Beyond the longest path red, green and blue are the same: the mean over phases.
class FilmColors {
 public:
  static const FilmColors& instance() {
    static const FilmColors colors;
    return colors;
  }

  Vec3d at(double path_nm, double finesse) const {
    // From the finesse: r = (√(1 + f) − 1)/√f.
    const double amplitude = finesse > 0 ? (std::sqrt(1 + finesse) - 1) / std::sqrt(finesse) : 0;
    const double x = path_nm / path_step_nm, y = amplitude * (amplitudes - 1);
    if (x >= paths - 1) {
      const double r = amplitude * amplitude;
      return Vec3d(2 * r / (1 + r));
    }
    const auto i = size_t(x), j = std::min(size_t(y), size_t(amplitudes - 2));
    const double u = x - double(i), v = y - double(j);
    return (entry(i, j) * (1 - u) + entry(i + 1, j) * u) * (1 - v) +
           (entry(i, j + 1) * (1 - u) + entry(i + 1, j + 1) * u) * v;
  }

 private:
  static constexpr int paths = 1601, amplitudes = 33;
  static constexpr double path_step_nm = 10;

  FilmColors() : entries_(size_t(paths) * amplitudes) {
    std::vector<std::pair<double, Vec3d>> weights;  // by wavelength
    Vec3d sum(0);
    for (int nm = 360; nm <= 830; nm += 2) {
      const Rgb rgb = rgb_from_xyz(cie_xyz_at(nm));
      weights.emplace_back(nm, Vec3d(rgb.r, rgb.g, rgb.b) * d65_at(nm));
      sum += weights.back().second;
    }
    for (size_t i = 0; i < size_t(paths); ++i)
      for (size_t j = 0; j < size_t(amplitudes); ++j) {
        const double r = double(j) / (amplitudes - 1);
        // A side that reflects all has no limit: the largest that is told apart.
        const double finesse = 4 * r * r / sqr(std::max(1 - r * r, 1e-6));
        Vec3d total(0);
        for (const auto& [nm, weight] : weights) {
          const double s = std::sin(double(pi) * double(i) * path_step_nm / nm);
          total += weight * airy_share(finesse, s * s);
        }
        Vec3d& color = entries_[i * amplitudes + j];
        // Some colours of films are purer than Rec. 709 can show.
        for (int c = 0; c < 3; ++c) color[c] = std::clamp(total[c] / sum[c], 0.0, 1.0);
      }
  }
  const Vec3d& entry(size_t i, size_t j) const { return entries_[i * amplitudes + j]; }

  std::vector<Vec3d> entries_;
};

Spectrum rgb_reflectance(const FilmView& view, double optical_thickness_nm) {
  Vec3d color;
  if (view.tunnels) {
    constexpr std::array nm{610.0, 545.0, 460.0};
    for (int c = 0; c < 3; ++c)
      color[c] = reflectance_at(view, optical_thickness_nm, nm[size_t(c)]);
  } else {
    const double path = 2 * optical_thickness_nm * view.below;
    const FilmColors& colors = FilmColors::instance();
    color = (colors.at(path, view.finesse_s) + colors.at(path, view.finesse_p)) * 0.5;
  }
  return spectrum_from_rgb(float(color.x), float(color.y), float(color.z));
}

}  // namespace

Spectrum film_reflectance(float cos_incident, const Spectrum& eta,
                          const Spectrum& optical_thickness_nm, const Wavelengths& wavelengths) {
  // At grazing angles all is reflected.
  const double cosine = std::clamp(double(cos_incident), 1e-4, 1.0);
  if (wavelengths.is_rgb())
    return rgb_reflectance(FilmView(cosine, double(eta[0])), double(optical_thickness_nm[0]));
  Spectrum result;
  for (int lane = 0; lane < Spectrum::lane_count; ++lane) {
    const FilmView view(cosine, double(eta[lane]));
    result.set(lane, float(reflectance_at(view, double(optical_thickness_nm[lane]),
                                          double(wavelengths[lane]))));
  }
  return result;
}

}  // namespace kaustik
