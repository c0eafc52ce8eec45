// Every method against stored references, block by block: pictures of real size, whose parts no
// analytic test reaches. Seeds are fixed, so each result is always the same. The references were
// made by other methods, see scenes.cpp, and their noise counts.

#include <gtest/gtest.h>

#include <cstdio>

#include "kaustik/base/statistics.h"
#include "tests/agreement/scenes.h"
#include "tests/agreement/sign_flips.h"

namespace kaustik::agreement {
namespace {

/// Chance that one component of one method fails where all is right.
constexpr double level = 1e-4;
/// A bias of the whole component that has to be found, else the test says nothing.
constexpr double bias_to_find = 0.03;
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

void check(const Contender& contender) {
  const Components reference = read_blocks(reference_path(contender.reference));
  const Components tested = render_blocks(contender.render);
  for (const auto& [component, replicates] : tested)
    if (contender.tolerance > 0)
      check_tolerance(component, replicates, reference.at(component), contender.tolerance,
                      contender.render.size);
    else
      check_without_bias(component, replicates, reference.at(component));
}

std::vector<Contender> contenders_of(bool quick) {
  std::vector<Contender> chosen;
  for (const Contender& contender : contenders())
    if (quick == (contender.render.size == quick_size)) chosen.push_back(contender);
  return chosen;
}

std::string name_of(const testing::TestParamInfo<Contender>& of) {
  return of.param.reference + "_" + of.param.render.integrator;
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
