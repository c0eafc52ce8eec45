#pragma once
// Renders scenes given as text and measures them: one independent value per pass, from which the
// tests take means, standard errors and p values.

#include <gtest/gtest.h>

#include <cstdio>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "kaustik/base/statistics.h"
#include "kaustik/loader/mitsuba_xml.h"
#include "kaustik/render/session.h"

namespace kaustik::test {

/// Passes of a measurement, each a replicate of its own, and the share of the samples that is
/// taken, a tenth in all where programs run slowly.
#ifdef KAUSTIK_SLOW_BUILD
inline constexpr bool slow_build = true;
inline constexpr uint32_t measured_passes = 4;
inline constexpr double sample_share = 0.4;
#else
inline constexpr bool slow_build = false;
inline constexpr uint32_t measured_passes = replicate_count;
inline constexpr double sample_share = 1;
#endif

/// Level of a single check, if all of about a hundred together are wrong once in a hundred times.
inline double check_level() { return sidak_level(0.01, 100); }

inline Description description_of(const std::string& inside) {
  return parse_mitsuba_xml("<scene version=\"3.0.0\">\n" + inside + "\n</scene>\n", "test.xml", "");
}

class TestScene {
 public:
  explicit TestScene(const std::string& inside) : scene_(build_scene(description_of(inside))) {}
  const Scene& scene() const { return *scene_; }
  std::unique_ptr<Integrator> integrator(const std::string& type,
                                         const std::string& parameters = "") const {
    std::vector<std::string> warnings;
    auto result = make_integrator(
        description_of("<integrator type=\"" + type + "\">" + parameters + "</integrator>"),
        *scene_, warnings);
    EXPECT_TRUE(warnings.empty()) << warnings.front();
    return result;
  }

 private:
  std::shared_ptr<const Scene> scene_;
};

/// What a pixel counts for in a mean.
using PixelWeight = std::function<double(int x, int y)>;

/// The pictures of some passes, one by one.
class Passes {
 public:
  explicit Passes(std::vector<Image> images) : images_(std::move(images)) {}
  const std::vector<Image>& images() const { return images_; }

  /// Mean over pixels of the sum of `layers` ("" is the whole picture), a value per pass.
  RunningStatistics mean(const std::vector<std::string>& layers, const PixelWeight& weight = {},
                         int channel = 1) const {
    RunningStatistics result;
    for (const Image& image : images_) result.add(mean_of(image, layers, weight, channel));
    return result;
  }

  static double mean_of(const Image& image, const std::vector<std::string>& layers,
                        const PixelWeight& weight = {}, int channel = 1) {
    double sum = 0, weights = 0;
    for (const std::string& layer : layers) {
      const std::string name = (layer.empty() ? "" : layer + ".") + "RGB"[channel];
      const int index = image.find_channel(name);
      if (index < 0) throw std::runtime_error("no channel " + name);
      for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x) {
          const double w = weight ? weight(x, y) : 1;
          sum += w * double(image.at(x, y, index));
          weights += w;
        }
    }
    return sum / weights * double(layers.size());
  }

 private:
  std::vector<Image> images_;
};

struct RenderOptions {
  double samples = 16;  ///< per pixel and pass
  uint64_t seed = 1;
  uint32_t passes = measured_passes;
  int threads = 0;
};

inline Passes render(const TestScene& scene, const Integrator& integrator,
                     const RenderOptions& options = {}) {
  std::vector<Image> images;
  for (uint32_t pass = 0; pass < options.passes; ++pass) {
    SessionSettings settings;
    settings.seed = options.seed;
    settings.threads = options.threads;
    settings.first_pass = pass;
    settings.passes = 1;
    settings.samples_per_pixel = uint32_t(std::max(1.0, options.samples * sample_share));
    Session session(scene.scene(), integrator, settings);
    const SessionReport report = session.run();
    EXPECT_EQ(report.dropped_samples, 0u);
    images.push_back(session.film().image());
  }
  return Passes(std::move(images));
}
inline Passes render(const TestScene& scene, const std::string& type,
                     const std::string& parameters = "", const RenderOptions& options = {}) {
  return render(scene, *scene.integrator(type, parameters), options);
}

/// Two-sided, by Student's t over independent values. Rounding of single floats is no error.
inline double t_test_p_value(const RunningStatistics& values, double expected) {
  const double error = std::max(values.standard_error(), 1e-6 * std::fabs(expected));
  const double t = std::fabs(values.mean() - expected) / error;
  return 2 * student_t_cdf(-t, double(values.count() - 1));
}

/// Two means of independent values against one another (Welch 1947).
inline double t_test_p_value(const RunningStatistics& a, const RunningStatistics& b,
                             double factor = 1) {
  const double va = std::pow(a.standard_error(), 2);
  const double vb = std::pow(factor * b.standard_error(), 2);
  const double tiny = std::pow(1e-6 * a.mean(), 2);
  const double freedom = std::pow(va + vb + tiny, 2) /
                         (va * va / double(a.count() - 1) + vb * vb / double(b.count() - 1) +
                          tiny * tiny / double(a.count() - 1));
  const double t = std::fabs(a.mean() - factor * b.mean()) / std::sqrt(va + vb + tiny);
  return 2 * student_t_cdf(-t, freedom);
}

/// The measured values have the expected mean, and the check is sharp enough to tell it from one
/// that is off by 2 %: its standard error is at most 0.3 %, and the wrong value fails.
inline void expect_mean(const std::string& what, const RunningStatistics& values, double expected,
                        double largest_relative_error = 0.003) {
  const double relative_error = values.standard_error() / std::fabs(expected);
  std::printf("  %-58s %.6g, ratio %.5f ± %.5f\n", what.c_str(), values.mean(),
              values.mean() / expected, relative_error);
  EXPECT_GT(t_test_p_value(values, expected), check_level())
      << what << ": " << values.mean() << " for " << expected;
  if (slow_build) return;
  EXPECT_LE(relative_error, largest_relative_error) << what;
  EXPECT_LT(t_test_p_value(values, 1.02 * expected), check_level()) << what;
}

/// The same for two measurements.
inline void expect_equal_means(const std::string& what, const RunningStatistics& a,
                               const RunningStatistics& b, double largest_relative_error = 0.003) {
  const double relative_error =
      std::hypot(a.standard_error(), b.standard_error()) / std::fabs(b.mean());
  std::printf("  %-58s %.6g, ratio %.5f ± %.5f\n", what.c_str(), a.mean(), a.mean() / b.mean(),
              relative_error);
  EXPECT_GT(t_test_p_value(a, b), check_level()) << what << ": " << a.mean() << ", " << b.mean();
  if (slow_build) return;
  EXPECT_LE(relative_error, largest_relative_error) << what;
  EXPECT_LT(t_test_p_value(a, b, 1.02), check_level()) << what;
}

/// The same where the first is an estimate whose bias the parameters make small: its mean lies
/// within `tolerance` of the other's, relatively, beyond the errors of both.
inline void expect_near_means(const std::string& what, const RunningStatistics& a,
                              const RunningStatistics& b, double tolerance,
                              double largest_relative_error = 0.005) {
  const double error = std::hypot(a.standard_error(), b.standard_error());
  std::printf("  %-58s %.6g, ratio %.5f ± %.5f\n", what.c_str(), a.mean(), a.mean() / b.mean(),
              error / b.mean());
  EXPECT_NEAR(a.mean(), b.mean(), tolerance * b.mean() + (slow_build ? 6 : 3) * error) << what;
  if (!slow_build) {
    EXPECT_LE(error, largest_relative_error * b.mean()) << what;
  }
}

}  // namespace kaustik::test
