// Files of NanoVDB: values, tiles, the place in the world, packing, and what is wrong with files.

#include "kaustik/loader/nanovdb_file.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <cstring>
#include <random>

#include "kaustik/base/error.h"

namespace kaustik {
namespace {

/// Writes numbers into bytes at any place.
class NanoBytes {
 public:
  template <typename T>
  void put(size_t at, const T& value) {
    if (bytes.size() < at + sizeof(T)) bytes.resize(at + sizeof(T));
    std::memcpy(bytes.data() + at, &value, sizeof(T));
  }
  void set_bit(size_t at, size_t bit) { bytes[at + bit / 8] |= uint8_t(1 << (bit % 8)); }
  std::vector<uint8_t> bytes;
};

constexpr size_t tree_at = 672, root_at = tree_at + 64, upper_at = root_at + 64 + 32,
                 lower_at = upper_at + 270400, leaf_at = lower_at + 33856, end_at = leaf_at + 2144;

/// A voxel of 0.5 m, moved by (1, 2, 3) m. The leaf of voxels (0, 0, 0) to (7, 7, 7) holds
/// x + 10 y + 100 z; the next one along z is a tile of 5.
NanoBytes small_grid() {
  NanoBytes grid;
  grid.bytes.resize(end_at);
  std::memcpy(grid.bytes.data(), "NanoVDB0", 8);
  grid.put(32, uint64_t(end_at));
  for (size_t i = 0; i < 3; ++i) {
    grid.put(296 + 88 + 8 * (4 * i), 0.5);
    grid.put(296 + 232 + 8 * i, double(i + 1));
  }
  grid.put(636, uint32_t(1));
  grid.put(tree_at + 24, uint64_t(root_at - tree_at));
  const int32_t low[] = {0, 0, 0}, high[] = {7, 7, 15};
  for (size_t i = 0; i < 3; ++i) {
    grid.put(root_at + 4 * i, low[i]);
    grid.put(root_at + 12 + 4 * i, high[i]);
  }
  grid.put(root_at + 24, uint32_t(1));
  grid.put(root_at + 64 + 8, uint64_t(upper_at - root_at));
  grid.set_bit(upper_at + 4128, 0);
  grid.put(upper_at + 8256, uint64_t(lower_at - upper_at));
  grid.set_bit(lower_at + 544, 0);
  grid.put(lower_at + 1088, uint64_t(leaf_at - lower_at));
  grid.put(lower_at + 1088 + 8, 5.0f);
  for (size_t i = 0; i < 512; ++i)
    grid.put(leaf_at + 96 + 4 * i, float(i >> 6) + 10 * float((i >> 3) & 7) + 100 * float(i & 7));
  return grid;
}

enum class Codec : uint16_t { none, zip, blosc };

std::vector<uint8_t> file_of(const NanoBytes& grid, Codec codec = Codec::none,
                             const std::string& name = "density") {
  std::vector<uint8_t> stored = grid.bytes;
  if (codec == Codec::zip) {
    uLongf size = compressBound(uLong(grid.bytes.size()));
    stored.resize(8 + size);
    compress(stored.data() + 8, &size, grid.bytes.data(), uLong(grid.bytes.size()));
    stored.resize(8 + size);
    const auto packed = uint64_t(size);
    std::memcpy(stored.data(), &packed, 8);
  }
  NanoBytes file;
  file.bytes.resize(16 + 176);
  std::memcpy(file.bytes.data(), "NanoVDB0", 8);
  file.put(8, uint32_t(32u << 21));
  file.put(12, uint16_t(1));
  file.put(14, codec);
  file.put(16, uint64_t(grid.bytes.size()));
  file.put(16 + 8, uint64_t(stored.size()));
  file.put(16 + 136, uint32_t(name.size() + 1));
  file.put(16 + 168, codec);
  file.bytes.insert(file.bytes.end(), name.begin(), name.end());
  file.bytes.push_back(0);
  file.bytes.insert(file.bytes.end(), stored.begin(), stored.end());
  return file.bytes;
}

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
