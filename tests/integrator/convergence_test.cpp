// How fast errors fall from pass to pass.

#include "kaustik/image/image.h"
#include "tests/support/forgetful.h"
#include "tests/support/measure.h"
#include "tests/support/scene_text.h"

namespace kaustik {
namespace {

using namespace test;

/// Mean over pixels of the squared error in green.
double squared_error(const Image& image, const Image& truth) {
  const int green = image.find_channel("G"), of_truth = truth.find_channel("G");
  double sum = 0;
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x) {
      const double e = double(image.at(x, y, green)) - double(truth.at(x, y, of_truth));
      sum += e * e;
    }
  return sum / (double(image.width()) * image.height());
}

Image picture(const Scene& scene, const Integrator& integrator, uint64_t seed, uint32_t passes,
              uint32_t samples_per_pass) {
  SessionSettings settings;
  settings.seed = seed;
  settings.passes = passes;
  settings.samples_per_pass = samples_per_pass;
  Session session(scene, integrator, settings);
  session.run();
  return session.film().image();
}

/// The same of a layer after 1, 2, 4 … passes up to `last`, each pass of a seed of its own: those
/// of one seed stratify one another from the seventeenth on. `truth_variance` is the reference's
/// own.
std::vector<double> errors_of_independent_passes(const Scene& scene, const Integrator& integrator,
                                                 const std::vector<double>& truth,
                                                 double truth_variance, uint32_t last,
                                                 uint64_t pictures) {
  std::vector<double> errors;
  for (uint64_t picture = 0; picture < pictures; ++picture) {
    std::vector<double> sum(truth.size());
    size_t next = 0;
    for (uint32_t pass = 0; pass < last; ++pass) {
      SessionSettings settings;
      settings.seed = 1000 * picture + pass;
      settings.first_pass = pass;
      settings.passes = 1;
      settings.samples_per_pass = 4;
      Session session(scene, integrator, settings);
      session.run();
      for (size_t i = 0; i < sum.size(); ++i) sum[i] += session.film().total(i, 1);
      if (pass + 1 != 1u << next) continue;
      double squares = 0;
      for (size_t i = 0; i < sum.size(); ++i)
        squares += std::pow(sum[i] / (pass + 1) - truth[i], 2) / double(sum.size());
      if (errors.size() == next) errors.push_back(-truth_variance);
      errors[next++] += squares / double(pictures);
    }
  }
  return errors;
}

/// Mean squared error over seeds after 1, 2, 4 … passes of one sample, up to `last`.
std::vector<double> errors_over_passes(const Scene& scene, const Integrator& integrator,
                                       const Image& truth, uint32_t last, int seeds) {
  std::vector<double> errors;
  for (uint32_t passes = 1; passes <= last; passes *= 2) errors.push_back(0);
  for (int seed = 1; seed <= seeds; ++seed) {
    SessionSettings settings;
    settings.seed = uint64_t(seed);
    settings.passes = last;
    settings.samples_per_pass = 1;
    Session session(scene, integrator, settings);
    size_t next = 0;
    session.run({}, {}, [&] {
      if (session.film().pass_count() != 1u << next) return;
      errors[next++] += squared_error(session.film().image(), truth) / seeds;
    });
  }
  return errors;
}

/// Of log error over log passes, which double from one to the next.
double slope(const std::vector<double>& errors) {
  const double n = double(errors.size());
  double sum_x = 0, sum_y = 0, sum_xx = 0, sum_xy = 0;
  for (size_t i = 0; i < errors.size(); ++i) {
    const double x = double(i), y = std::log2(errors[i]);
    std::printf("    %.4g", errors[i]);
    sum_x += x, sum_y += y, sum_xx += x * x, sum_xy += x * y;
  }
  return (n * sum_xy - sum_x * sum_y) / (n * sum_xx - sum_x * sum_x);
}

void expect_slope(const char* what, const std::vector<double>& errors, double expected,
                  double tolerance) {
  const double found = slope(errors);
  std::printf("  %s: slope %.3f\n", what, found);
  if (!slow_build) {
    EXPECT_NEAR(found, expected, tolerance) << what;
  }
}

/// Up to 16 passes are replicates of their own: independent samples.
TEST(Convergence, UnbiasedTechniques) {
  constexpr int seeds = slow_build ? 2 : 40;
  const TestScene scene(camera("0, -2.2, 1.3", "0, 0.2, 0.35", 48, 16) +
                        flat("rectangle", "", diffuse("0.5, 0.5, 0.5")) +
                        sphere("-0.3, 0.3, 0.4", 0.4, diffuse("0.6, 0.6, 0.6")) +
                        flat("rectangle",
                             scale("0.5, 0.5, 1") + rotate("1, 0, 0", 180) + translate("0, 0, 1.9"),
                             diffuse("0, 0, 0") + area_light("5")));
  const auto path = scene.integrator("path");
  const Image truth = picture(scene.scene(), *path, 99, 16, slow_build ? 16 : 256);
  for (const char* type : {"path", "bdpt"})
    expect_slope(type, errors_over_passes(scene.scene(), *scene.integrator(type), truth, 16, seeds),
                 -1, 0.05);
}

/// A point lamp's light that falls on a floor through a pane: nothing but caustic light, and
/// smooth, so that disks of a few pixels have hardly any bias. (Smaller ones share a pixel's light,
/// whose mean knows no disks.)
class LightThroughAPane : public testing::Test {
 protected:
  static constexpr int size = 24;
  static constexpr uint32_t last = slow_build ? 8 : 128;
  LightThroughAPane() : truth_(size_t(size) * size) {
    // What light tracing finds without bias, as are the variances of its passes.
    const auto light = scene_.integrator("lighttracer", set("components", "caustic"));
    SessionSettings settings;
    settings.seed = 77;
    settings.passes = replicate_count;
    settings.samples_per_pass = slow_build ? 50 : 1000;
    Session session(scene_.scene(), *light, settings);
    session.run();
    const double n = replicate_count;
    for (size_t i = 0; i < truth_.size(); ++i) {
      truth_[i] = session.film().total(i, 1) / n;
      truth_variance_ += (session.film().total_squares(i, 1) / n - truth_[i] * truth_[i]) /
                         (n - 1) / double(truth_.size());
    }
  }
  std::vector<double> errors(const Integrator& integrator, uint64_t pictures) const {
    return errors_of_independent_passes(scene_.scene(), integrator, truth_, truth_variance_, last,
                                        pictures);
  }

  TestScene scene_{camera("0, 0, 0.9", "0, 0, 0", 58.1, size, "0, 1, 0") +
                   flat("rectangle", scale("1, 1, 1"), diffuse("0.6, 0.6, 0.6")) +
                   flat("rectangle", scale("1, 1, 1") + translate("0, 0, 1"), glass()) +
                   point_light("0, 0, 2", 10)};
  std::vector<double> truth_;
  double truth_variance_ = 0;
};

/// Of `errors`, those from the eighth pass on: it takes some passes until sums over them are as
/// their integrals.
std::vector<double> later(const std::vector<double>& errors) {
  return {errors.begin() + (slow_build ? 0 : 3), errors.end()};
}

/// The areas of disks shrink as i^(−1/3): the noise of a mean of n passes falls as n^(−2/3) (Knaus
/// and Zwicker 2011). The twin: disks that don't shrink, whose noise falls as that of any mean.
TEST_F(LightThroughAPane, NoiseOfShrinkingDisksLong) {
  constexpr double expected = -2.0 / 3, tolerance = 0.1;
  const auto ppm = scene_.integrator("ppm", set("components", "caustic") + set("radius", 0.12) +
                                                set("guiding", false) + set("adaptive", false) +
                                                set("light_paths", 1.0));
  expect_slope("ppm, disks that shrink", later(errors(*ppm, slow_build ? 1 : 4)), expected,
               tolerance);
  if (slow_build) return;
  const ForgetfulIntegrator stays(*ppm, ForgetfulIntegrator::Forgets::index);
  const double found = slope(later(errors(stays, 1)));
  std::printf("  ppm, disks that stay: slope %.3f\n", found);
  EXPECT_LT(found, expected - tolerance);
}

}  // namespace
}  // namespace kaustik
