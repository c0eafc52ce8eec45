#pragma once
// Renders scenes given as text and measures them: one independent value per pass, from which the
// tests take means, standard errors and p values.

#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "kaustik/base/statistics.h"
#include "kaustik/loader/mitsuba_xml.h"
#include "kaustik/render/session.h"
#include "tests/support/same_bits.h"

namespace kaustik::test {

/// Passes of a measurement, each a replicate of its own.
#ifdef KAUSTIK_SLOW_BUILD
inline constexpr bool slow_build = true;
inline constexpr uint32_t measured_passes = 4;
#else
inline constexpr bool slow_build = false;
inline constexpr uint32_t measured_passes = replicate_count;
#endif
/// Whether all samples are taken, as `make test-long` wants.
inline bool is_thorough() {
  static const bool value = std::getenv("KAUSTIK_THOROUGH") != nullptr;
  return value;
}
/// The share of a pass's samples that is taken otherwise. Where programs run slowly there are fewer
/// passes, too, and a tenth of the samples in all.
inline double sample_share() { return is_thorough() && !slow_build ? 1 : 0.4; }
/// Noise with that share over noise with all samples, at most: strata make it fall faster than the
/// root of their number.
inline double noise_factor() { return is_thorough() ? 1 : 2; }

/// Level of a single check, if all of about a hundred together are wrong once in a hundred times.
inline double check_level() { return sidak_level(0.01, 100); }

inline Description description_of(const std::string& inside) {
  return parse_mitsuba_xml("<scene version=\"3.0.0\">\n" + inside + "\n</scene>\n", "test.xml", "");
}

class TestScene {
 public:
  explicit TestScene(const std::string& inside) : TestScene(description_of(inside)) {}
  explicit TestScene(const Description& description) : scene_(build_scene(description)) {}
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
  /// Whether all pictures have the same bits.
  friend bool same_bits(const Passes& a, const Passes& b) {
    return same_bits(a.images_, b.images_);
  }

  /// Mean over pixels of the sum of `layers` ("" is the whole picture), a value per pass.
  std::vector<double> values(const std::vector<std::string>& layers, const PixelWeight& weight = {},
                             int channel = 1) const {
    std::vector<double> result;
    for (const Image& image : images_) result.push_back(mean_of(image, layers, weight, channel));
    return result;
  }
  RunningStatistics mean(const std::vector<std::string>& layers, const PixelWeight& weight = {},
                         int channel = 1) const {
    RunningStatistics result;
    for (const double value : values(layers, weight, channel)) result.add(value);
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
    settings.samples_per_pixel = uint32_t(std::max(1.0, options.samples * sample_share()));
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

/// Two measured means, or one and a number that is known.
class Comparison {
 public:
  /// Measured independently of one another.
  Comparison(const RunningStatistics& a, const RunningStatistics& b) : a_(of(a)), b_(of(b)) {}
  Comparison(const RunningStatistics& a, double known) : a_(of(a)), b_{known, 0, 0} {}

  /// Measured pass by pass with the same seed: what random numbers make alike in both cancels in
  /// the difference, and the error is that of what is left.
  static Comparison same_seed(const std::vector<double>& a, const std::vector<double>& b) {
    RunningStatistics of_a, of_b, of_sum;
    for (size_t i = 0; i < a.size(); ++i) of_a.add(a[i]), of_b.add(b[i]), of_sum.add(a[i] + b[i]);
    Comparison result(of_a, of_b);
    const double count = double(a.size());
    result.covariance_ = (of_sum.variance() - of_a.variance() - of_b.variance()) / (2 * count);
    result.paired_ = true;
    return result;
  }

  double mean() const { return a_.mean; }
  double ratio() const { return a_.mean / b_.mean; }
  /// Standard error of the ratio, over it.
  double relative_error() const { return error(1, ratio()) / a_.mean; }

  /// Student's t of factor_a·a − factor_b·b, and the chance of one as large or larger where the
  /// difference is 0 (Welch 1947, for the degrees of freedom of independent measurements).
  /// Rounding of single floats is no error. Of two that are 0 without noise, neither exceeds: 1/2.
  double p_value_of_excess(double factor_a, double factor_b) const {
    const double rounding = 1e-6 * std::fabs(factor_b * b_.mean);
    const double excess = factor_a * a_.mean - factor_b * b_.mean;
    if (excess == 0) return 0.5;
    const double t = excess / std::hypot(error(factor_a, factor_b), rounding);
    const double va = sqr(factor_a) * a_.variance, vb = sqr(factor_b) * b_.variance;
    double freedom = a_.freedom;
    if (!paired_ && b_.freedom > 0 && va + vb > 0)
      // By shares, whose squares do not underflow.
      freedom = 1 / (sqr(va / (va + vb)) / a_.freedom + sqr(vb / (va + vb)) / b_.freedom);
    return student_t_cdf(-t, freedom);
  }
  /// Of the hypothesis that factor·a has the mean b, two-sided.
  double p_value_of_equality(double factor = 1) const {
    return 2 * std::min(p_value_of_excess(factor, 1), 1 - p_value_of_excess(factor, 1));
  }
  /// Of the hypothesis that factor·a differs from b by at most `tolerance`, relatively: that of its
  /// border on the side where a lies, one-sided. 1/2 on the border, more within.
  double p_value_of_nearness(double tolerance, double factor = 1) const {
    return factor * a_.mean > b_.mean ? p_value_of_excess(factor, 1 + tolerance)
                                      : 1 - p_value_of_excess(factor, 1 - tolerance);
  }

 private:
  struct Measured {
    double mean, variance, freedom;  ///< variance of the mean
  };
  static Measured of(const RunningStatistics& s) {
    return {s.mean(), sqr(s.standard_error()), double(s.count() - 1)};
  }
  static double sqr(double x) { return x * x; }
  double error(double factor_a, double factor_b) const {
    return std::sqrt(std::max(0.0, sqr(factor_a) * a_.variance + sqr(factor_b) * b_.variance -
                                       2 * factor_a * factor_b * covariance_));
  }

  Measured a_, b_;
  double covariance_ = 0;  ///< of the means
  bool paired_ = false;
};

/// Largest relative standard error of a comparison that is worth something.
inline constexpr double sharp = 0.003;

/// Prints a comparison and demands that it is sharp.
inline void expect_sharp(const std::string& what, const Comparison& c, double largest_error) {
  std::printf("  %-58s %.6g, ratio %.5f ± %.5f\n", what.c_str(), c.mean(), c.ratio(),
              c.relative_error());
  if (!slow_build) {
    EXPECT_LE(c.relative_error(), noise_factor() * largest_error)
        << what << " is too noisy to tell";
  }
}

/// The first has the mean of the second, and the check is sharp enough to tell it from one that is
/// off by 2 %: its standard error is at most 0.3 %, and the wrong value, farther off on the side
/// where the right one lies, would fail. (Errors planted in scenes and methods have tests of their
/// own.) Both are twice as much where not all samples are taken.
inline void expect_equal_means(const std::string& what, const Comparison& c,
                               double largest_error = sharp) {
  expect_sharp(what, c, largest_error);
  EXPECT_GT(c.p_value_of_equality(), check_level()) << what << ": ratio " << c.ratio();
  if (slow_build) return;
  const double planted = 1 + 0.02 * noise_factor();
  const double twin = c.ratio() > 1 ? planted : 1 / planted;
  EXPECT_LT(c.p_value_of_equality(twin), check_level())
      << what << ": a factor of " << planted << " goes unseen";
}
inline void expect_equal_means(const std::string& what, const RunningStatistics& a,
                               const RunningStatistics& b) {
  expect_equal_means(what, Comparison(a, b));
}
inline void expect_mean(const std::string& what, const RunningStatistics& values, double expected) {
  expect_equal_means(what, Comparison(values, expected));
}

/// Level of a check for nearness. Its hypothesis is a whole interval, and the level is the chance
/// of a false alarm on the border only: a mean in the middle of ± 1 %, measured to 0.3 %, fails
/// once in 10⁵ times. So it needs no correction for their number; but few samples do.
inline double nearness_level() { return slow_build ? check_level() : 0.05; }

/// The same where the first is an estimate whose bias the parameters make small: its mean lies
/// within `tolerance` of the other's, relatively. What is measured may lie beyond it by as much as
/// the noise explains, 1.7 standard errors of at most 0.3 %, so at ± 1 % all that is off by 1.5 %
/// fails. An error of twice the tolerance on top of the estimate's own would fail, of three times
/// where not all samples are taken.
inline void expect_near_means(const std::string& what, const Comparison& c, double tolerance,
                              double largest_error = sharp) {
  expect_sharp(what, c, largest_error);
  EXPECT_GT(c.p_value_of_nearness(tolerance), nearness_level())
      << what << ": ratio " << c.ratio() << " is not within " << tolerance;
  if (slow_build) return;
  const double planted = 1 + (1 + noise_factor()) * tolerance;
  const double twin = c.ratio() > 1 ? planted : 1 / planted;
  EXPECT_LT(c.p_value_of_nearness(tolerance, twin), nearness_level())
      << what << ": a factor of " << planted << " goes unseen";
}
inline void expect_near_means(const std::string& what, const RunningStatistics& a,
                              const RunningStatistics& b, double tolerance) {
  expect_near_means(what, Comparison(a, b), tolerance);
}

}  // namespace kaustik::test
