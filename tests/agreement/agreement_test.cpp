// Every method against stored references, block by block and pixel by pixel: pictures of real size,
// whose parts no analytic test reaches. Seeds are fixed, so each result is always the same. The
// references were made by other methods, see scenes.cpp, and their noise counts.

#include <gtest/gtest.h>

#include <cstdio>

#include "kaustik/base/statistics.h"
#include "tests/agreement/pixel_tests.h"
#include "tests/agreement/scenes.h"
#include "tests/agreement/sign_flips.h"

namespace kaustik::agreement {
namespace {

/// Chance that one component of one method fails where all is right.
constexpr double level = 1e-4;
/// A bias of the whole component that has to be found, else the test says nothing.
constexpr double bias_to_find = 0.03;
/// A deviation of a single pixel that half of them have to find.
constexpr double pixel_bias_to_find = 0.75;
constexpr int coarse_parts = 4;  ///< per side of the picture
constexpr int quick_size = 64;   ///< of pictures that are compared in each run

void check_without_bias(const std::string& component, const Replicates& tested,
                        const Replicates& reference) {
  const Verdict verdict = compare(tested, reference);
  const double smallest = smallest_bias_found(tested, reference, level);
  std::printf(
      "  %-9s mean %+.3f ± %.3f %%, p of mean %.2g, of all blocks %.2g, of the worst %.2g (t "
      "%+.1f); finds a bias "
      "of %.2f %%\n",
      component.c_str(), 100 * verdict.mean_difference, 100 * verdict.mean_difference_error,
      verdict.p_mean, verdict.p_blocks, verdict.p_worst, verdict.worst_t, 100 * smallest);
  EXPECT_FALSE(verdict.rejects(level)) << component << ", worst block " << verdict.worst_block;
  EXPECT_LE(smallest, bias_to_find) << component << " is too noisy to tell";
}

void check_tolerance(const std::string& component, const Replicates& tested,
                     const Replicates& reference, double tolerance, int size) {
  const int columns = size / block_pixels, factor = columns / coarse_parts;
  const Replicates coarse = coarser(tested, columns, factor),
                   coarse_reference = coarser(reference, columns, factor);
  const Verdict verdict = compare(tested, reference);
  const double p = p_beyond(coarse, coarse_reference, tolerance);
  std::printf("  %-9s mean %+.3f ± %.3f %%, p of being more than %.0f %% away %.2g\n",
              component.c_str(), 100 * verdict.mean_difference, 100 * verdict.mean_difference_error,
              100 * tolerance, p);
  EXPECT_GE(p, level) << component;
  const double planted = 2 * (tolerance + bias_to_find);
  EXPECT_LT(p_beyond(coarse, coarse_reference, tolerance, planted), level)
      << component << " is too noisy to tell";
}

/// Of light that is merged: its means may be away by what is told, in each part of the picture.
void check_told_bias(const std::string& component, const Replicates& tested,
                     const Replicates& reference, const Replicates& told, int size) {
  const int columns = size / block_pixels, factor = columns / coarse_parts;
  const Replicates coarse = coarser(tested, columns, factor),
                   coarse_reference = coarser(reference, columns, factor),
                   coarse_told = coarser(told, columns, factor);
  const Verdict verdict = compare(tested, reference);
  const double p = p_beyond_told(coarse, coarse_reference, coarse_told);
  double found = 1e-3;
  const auto finds = [&](double bias) {
    return p_beyond_told(coarse, coarse_reference, coarse_told, bias) < level;
  };
  while (found < 1 && !(finds(found) && finds(-found))) found *= 1.2;
  double all_told = 0, all = 0;
  for (const std::vector<float>& row : coarse_told)
    for (const float value : row) all_told += double(value);
  for (const std::vector<float>& row : coarse_reference)
    for (const float value : row) all += double(value);
  std::printf(
      "  %-9s mean %+.3f ± %.3f %%, told %+.3f %%, p of being beyond what is told %.2g; finds a "
      "bias of %.2f %%\n",
      component.c_str(), 100 * verdict.mean_difference, 100 * verdict.mean_difference_error,
      100 * all_told / all, p, 100 * found);
  EXPECT_GE(p, level) << component;
  EXPECT_LE(found, bias_to_find) << component << " is too noisy to tell";
}

void check_pixels(const std::string& component, const Replicates& tested,
                  const PixelMoments& reference, int columns) {
  const PixelVerdict verdict = compare_pixels(tested, reference, columns);
  std::printf(
      "  %-9s p of the worst of %zu pixels %.2g (t %+.1f), half of them tell a deviation of %.0f "
      "%%\n",
      component.c_str(), verdict.counted, verdict.p_worst, verdict.worst_t,
      100 * verdict.median_found);
  EXPECT_GE(verdict.p_worst, pixel_level) << component << " at " << verdict.worst_pixel % columns
                                          << ", " << verdict.worst_pixel / columns;
  EXPECT_LE(verdict.median_found, pixel_bias_to_find) << component << " is too noisy to tell";
}

/// Empty: pixels of that picture are not compared.
PixelReference pixel_reference(const BlockRender& render) {
  for (const ReferenceRecipe& recipe : reference_recipes()) {
    const BlockRender& first = recipe.parts.at(0);
    if (recipe.is_of_pixels && first.scene == render.scene && first.size == render.size)
      return read_pixels(reference_path(recipe.name));
  }
  return {};
}

void check(const Contender& contender) {
  const Components reference = read_blocks(reference_path(contender.reference));
  const Rendered tested = render_replicates(contender.render);
  const int size = contender.render.size;
  const PixelReference pixels = pixel_reference(contender.render);
  for (const auto& [component, replicates] : tested.blocks) {
    if (component == bias_layer) continue;
    const Replicates& right = reference.at(component);
    if (contender.tells_bias && component != "direct")
      check_told_bias(component, replicates, right, tested.blocks.at(bias_layer), size);
    else if (contender.tolerance > 0)
      check_tolerance(component, replicates, right, contender.tolerance, size);
    else
      check_without_bias(component, replicates, right);
    // Direct light has no bias by any method. Of the camera's pixels lighttracer knows too little.
    if (component == "direct" && pixels.contains(component) &&
        contender.render.integrator != "lighttracer")
      check_pixels(component, tested.pixels.at(component), pixels.at(component), size);
  }
}

std::vector<Contender> contenders_of(bool quick) {
  std::vector<Contender> chosen;
  for (const Contender& contender : contenders())
    if (quick == (contender.render.size == quick_size)) chosen.push_back(contender);
  return chosen;
}

std::string name_of(const testing::TestParamInfo<Contender>& of) {
  const Contender& contender = of.param;
  return contender.reference + "_" + contender.render.integrator +
         (contender.note.empty() ? "" : "_" + contender.note);
}

class Agreement : public testing::TestWithParam<Contender> {};

TEST_P(Agreement, WithTheReference) {
#ifdef KAUSTIK_SLOW_BUILD
  GTEST_SKIP() << "in slow builds methods run in all other tests";
#endif
  check(GetParam());
}
INSTANTIATE_TEST_SUITE_P(Small, Agreement, testing::ValuesIn(contenders_of(true)), name_of);

class AgreementAtRealSize : public testing::TestWithParam<Contender> {};

TEST_P(AgreementAtRealSize, WithTheReferenceLong) { check(GetParam()); }
INSTANTIATE_TEST_SUITE_P(Scenes, AgreementAtRealSize, testing::ValuesIn(contenders_of(false)),
                         name_of);

}  // namespace
}  // namespace kaustik::agreement
