// Files of NanoVDB: values, tiles, the place in the world, packing, and what is wrong with files.

#include "kaustik/loader/nanovdb_file.h"

#include <gtest/gtest.h>

#include <random>

#include "kaustik/base/error.h"
#include "tests/loader/nanovdb_bytes.h"

namespace kaustik {
namespace {

using namespace nano;

DenseGrid read(const std::vector<uint8_t>& file, size_t most = 1u << 20,
               const std::string& name = "density") {
  return read_nanovdb(file, name, most, place_in("smoke.nvdb"));
}

float sample(const DenseGrid& grid, size_t x, size_t y, size_t z) {
  return grid.samples[x + grid.size[0] * (y + grid.size[1] * z)];
}

TEST(NanoVdb, HasVoxelsAndTilesWithAMargin) {
  for (const Codec codec : {Codec::none, Codec::zip}) {
    const DenseGrid grid = read(file_of(small_grid(), codec));
    EXPECT_EQ(grid.size, (std::array<size_t, 3>{10, 10, 18}));
    EXPECT_EQ(grid.voxels_per_sample, 1);
    for (size_t z = 0; z < 18; ++z)
      for (size_t y = 0; y < 10; ++y)
        for (size_t x = 0; x < 10; ++x) {
          const bool is_inside = x > 0 && x < 9 && y > 0 && y < 9 && z > 0 && z < 17;
          const float in_leaf = float(x - 1) + 10 * float(y - 1) + 100 * float(z - 1);
          const float wanted = !is_inside ? 0.0f : z < 9 ? in_leaf : 5.0f;
          ASSERT_EQ(sample(grid, x, y, z), wanted) << x << ' ' << y << ' ' << z;
        }
  }
}

/// The centre of voxel (0, 0, 0) lies where the file's map takes the origin.
TEST(NanoVdb, LiesWhereItsMapSays) {
  const DenseGrid grid = read(file_of(small_grid()));
  const Vec3f center = grid.to_world.point({1.5f / 10, 1.5f / 10, 1.5f / 18});
  EXPECT_NEAR(center.x, 1, 1e-5);
  EXPECT_NEAR(center.y, 2, 1e-5);
  EXPECT_NEAR(center.z, 3, 1e-5);
  const Vec3f next = grid.to_world.point({2.5f / 10, 1.5f / 10, 1.5f / 18});
  EXPECT_NEAR(next.x - center.x, 0.5, 1e-5);
}

TEST(NanoVdb, AveragesWhatIsTooMuch) {
  const DenseGrid fine = read(file_of(small_grid())), coarse = read(file_of(small_grid()), 300);
  EXPECT_EQ(coarse.voxels_per_sample, 2);
  EXPECT_EQ(coarse.size, (std::array<size_t, 3>{5, 5, 9}));
  double sum = 0, coarse_sum = 0;
  for (const float value : fine.samples) sum += double(value);
  for (const float value : coarse.samples) coarse_sum += 8 * double(value);
  EXPECT_NEAR(coarse_sum, sum, 1e-3 * sum);
  EXPECT_NEAR(sample(coarse, 2, 2, 2), 3.5 + 35 + 350, 1e-3);
}

std::string problem_of(const std::vector<uint8_t>& file, const std::string& name = "density") {
  try {
    (void)read(file, 1u << 20, name);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::input);
    EXPECT_EQ(*error.problems().front().place.file, "smoke.nvdb");
    EXPECT_FALSE(error.problems().front().remedy.empty());
    return error.problems().front().message;
  }
  return "";
}

TEST(NanoVdb, TellsWhatIsWrong) {
  EXPECT_NE(problem_of(file_of(small_grid()), "fire").find("density"), std::string::npos);
  EXPECT_NE(problem_of(file_of(small_grid(), Codec::blosc)).find("Blosc"), std::string::npos);
  EXPECT_NE(problem_of({'<', 'x'}).find("no file of NanoVDB"), std::string::npos);
  NanoBytes doubles = small_grid();
  doubles.put(636, uint32_t(2));
  EXPECT_NE(problem_of(file_of(doubles)).find("floats"), std::string::npos);
  NanoBytes endless = small_grid();
  endless.put(leaf_at + 96, std::numeric_limits<float>::infinity());
  EXPECT_NE(problem_of(file_of(endless)).find("finite"), std::string::npos);
  NanoBytes flat = small_grid();
  flat.put(296 + 88, 0.0);
  EXPECT_NE(problem_of(file_of(flat)).find("affine"), std::string::npos);
}

/// All children the same node: what would take hours is refused.
TEST(NanoVdb, UsesNoNodeTwice) {
  NanoBytes grid = small_grid();
  for (size_t i = 0; i < 4096; ++i) {
    grid.set_bit(lower_at + 544, i);
    grid.put(lower_at + 1088 + 8 * i, uint64_t(leaf_at - lower_at));
  }
  EXPECT_NE(problem_of(file_of(grid)).find("twice"), std::string::npos);
}

TEST(NanoVdb, DamageIsNoCrash) {
  const std::vector<uint8_t> whole = file_of(small_grid());
  // Where the numbers are that lead on.
  const size_t grid_at = whole.size() - end_at;
  const std::vector<std::pair<size_t, size_t>> parts = {{0, grid_at + 672 + 64 + 96},
                                                        {grid_at + upper_at + 4000, 300},
                                                        {grid_at + upper_at + 8256, 64},
                                                        {grid_at + lower_at, 1200},
                                                        {grid_at + leaf_at, 200}};
  std::mt19937 numbers(5);
  int refused = 0;
  for (int i = 0; i < 2000; ++i) {
    std::vector<uint8_t> file = whole;
    for (int change = 0; change < 1 + i % 3; ++change) {
      const auto& [begin, size] = parts[numbers() % parts.size()];
      file[begin + numbers() % size] = uint8_t(numbers());
    }
    if (i % 10 == 0) file.resize(numbers() % file.size());
    try {
      const DenseGrid grid = read(file);
      ASSERT_LE(grid.samples.size(), size_t(1) << 20);
    } catch (const Error&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 300);
}

}  // namespace
}  // namespace kaustik
