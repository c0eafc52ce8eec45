#include "kaustik/render/statistical_checks.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kaustik/base/error.h"
#include "kaustik/base/sampler.h"
#include "kaustik/image/photometry.h"
#include "kaustik/material/density_check.h"
#include "kaustik/render/session.h"

namespace kaustik {
namespace {

double mean_luminance(const Image& image) {
  const int red = image.find_channel("R"), green = image.find_channel("G"),
            blue = image.find_channel("B");
  double sum = 0;
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x)
      sum += double(photopic({image.at(x, y, red), image.at(x, y, green), image.at(x, y, blue)}));
  return sum / (double(image.width()) * image.height());
}

/// Such that all passes together have at least `samples`.
uint32_t samples_per_pixel_and_pass(const Scene& scene, int64_t samples) {
  const int64_t shares =
      int64_t{replicate_count} * scene.film().crop_size.x * scene.film().crop_size.y;
  return uint32_t(std::clamp<int64_t>((samples + shares - 1) / shares, 1, 1 << 24));
}

Vec3f direction_at(double cosine, double phi) {
  const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
  return Vec3f(float(sine * std::cos(phi)), float(sine * std::sin(phi)), float(cosine));
}

std::shared_ptr<const Bsdf> first_bsdf(const Description& description) {
  return build_scene(description)->surface(0).bsdf;
}

}  // namespace

RunningStatistics picture_luminances(const Description& description, const CheckEffort& effort) {
  const auto scene = build_scene(description);
  std::vector<std::string> warnings;
  const auto integrator = make_integrator(description, *scene, warnings);
  RunningStatistics values;
  for (uint32_t pass = 0; pass < replicate_count; ++pass) {
    SessionSettings settings;
    settings.seed = effort.seed;
    settings.threads = effort.threads;
    settings.first_pass = pass;
    settings.passes = 1;
    settings.samples_per_pixel = samples_per_pixel_and_pass(*scene, effort.samples);
    settings.layers = false;
    Session session(*scene, *integrator, settings);
    session.run();
    values.add(mean_luminance(session.film().image()));
  }
  return values;
}

RunningStatistics reflected_luminances(const Description& description, double angle_degrees,
                                       const CheckEffort& effort) {
  const Vec3f wo = direction_at(std::cos(angle_degrees * std::numbers::pi / 180), 0);
  return sampled_reflectance(*first_bsdf(description), wo, effort.samples, effort.seed);
}

double sampling_p_value(const Description& description, int direction, const DensityCells& cells,
                        const CheckEffort& effort) {
  const auto bsdf = first_bsdf(description);
  if (!any(bsdf->traits().lobes & (Lobes::diffuse | Lobes::glossy)))
    throw Error(ErrorKind::input, "the bsdf has no density to check",
                "mirrors and clear glass send light one way: leave them out",
                description.scene->place);
  const uint64_t bits = hash_mix(effort.seed, uint64_t(direction));
  const double height = double(bits >> 40) * 0x1p-24, turn = double(bits & 0xffffff) * 0x1p-24;
  const Vec3f wo = direction_at(height, 2 * std::numbers::pi * turn);
  return check_density(*bsdf, wo, {cells.rows, int(effort.samples), cells.minimum_expected},
                       hash_mix(effort.seed, 1 + uint64_t(direction)));
}

}  // namespace kaustik
