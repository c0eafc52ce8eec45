// What files of blocks keep: means to 32 bits, and noise, even if it is less than 16 bits tell.

#include "tests/agreement/block_samples.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "kaustik/base/error.h"
#include "kaustik/image/image_io.h"
#include "tests/support/temporary_folder.h"

namespace kaustik::agreement {
namespace {

constexpr int columns = 16;
constexpr size_t blocks = size_t(columns) * size_t(columns);

/// Blocks of all brightnesses, one of them black, with that noise as a share of each.
Replicates noisy(double noise) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  Replicates all;
  for (int r = 0; r < replicate_total; ++r) {
    std::vector<float>& row = all.emplace_back();
    for (size_t b = 0; b < blocks; ++b)
      row.push_back(b == 7 ? 0.0f
                           : float(std::exp(double(b % 30) - 15) * (1 + noise * normal(random))));
  }
  return all;
}

/// The largest difference, as a share of a block's mean.
double largest_difference(const Replicates& a, const Replicates& b) {
  const std::vector<double> means = mean_of_renders(b);
  double largest = 0;
  for (size_t r = 0; r < size_t(replicate_total); ++r)
    for (size_t i = 0; i < blocks; ++i)
      if (means[i] > 0)
        largest = std::max(largest, std::fabs(double(a[r][i]) - double(b[r][i])) / means[i]);
  return largest;
}

TEST(BlockSamples, KeepTheirNoise) {
  const test::TemporaryFolder folder;
  const std::string path = folder.path("blocks.exr");
  for (const double noise : {1e-4, 1e-2, 0.2}) {
    const Components written = {{"caustic", noisy(noise)}, {"direct", noisy(2 * noise)}};
    write_blocks(written, path);
    const Components read = read_blocks(path);
    ASSERT_EQ(read.size(), 2u);
    for (const auto& [component, replicates] : written) {
      EXPECT_LT(largest_difference(read.at(component), replicates), 5e-3 * noise + 2e-7);
      EXPECT_EQ(read.at(component)[3][7], 0);
    }
  }
  // The twin: renders as 16-bit floats lose what noise there is.
  const Replicates rendered = noisy(1e-4);
  Image image(columns, columns, {"direct"});
  std::copy(rendered[0].begin(), rendered[0].end(), image.channel(0).begin());
  for (float& value : image.channel(0)) value *= 1e-3f;
  write_image(image, path);
  const Image halves = read_image(path);
  double largest = 0;
  for (size_t b = 0; b < blocks; ++b)
    if (rendered[0][b] > 1)
      largest = std::max(
          largest, std::fabs(double(halves.channel(0)[b]) * 1e3 / double(rendered[0][b]) - 1));
  EXPECT_GT(largest, 1e-4);
}

TEST(BlockSamples, TellOfMissingChannels) {
  const test::TemporaryFolder folder;
  const std::string path = folder.path("blocks.exr");
  write_image(Image(4, 4, {"direct", "direct.00"}), path);
  EXPECT_THROW(read_blocks(path), Error);
}

}  // namespace
}  // namespace kaustik::agreement
