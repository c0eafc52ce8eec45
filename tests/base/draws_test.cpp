// The tables of what random numbers are drawn for.
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <utility>

#include <gtest/gtest.h>

#include "kaustik/base/sampler.h"

using namespace kaustik;

namespace {

// Twins of the tables, each with one fault that the assertions of draws.h must not let pass.
constexpr ForkRow of_two_uses[] = {{Fork::light_group, Parent::vertex, 4, 1, "a branch"},
                                   {Fork::light, Parent::vertex, 4, 1, "a part"}};
constexpr ForkRow within_others[] = {{Fork::light_group, Parent::vertex, 0, 16, "groups"},
                                     {Fork::light, Parent::vertex, 15, 1, "the last group's"}};
constexpr ForkRow of_two_parents[] = {{Fork::light_group, Parent::vertex, 4, 1, "a branch"},
                                      {Fork::light, Parent::probe, 4, 1, "a part"}};
constexpr ForkRow in_wrong_order[] = {{Fork::light, Parent::vertex, 1, 1, "a light"},
                                      {Fork::light_group, Parent::vertex, 2, 1, "a group"}};
constexpr StreamRow stream_of_two[] = {{Stream::camera, 0, 0, 8, "pixels"},
                                       {Stream::photon_global, 0, 7, 8, "photons"}};

}  // namespace

TEST(draws, collisions_are_found) {
  EXPECT_TRUE(are_sound(of_two_parents, Fork::light));
  EXPECT_FALSE(are_sound(of_two_uses, Fork::light));
  EXPECT_FALSE(are_sound(within_others, Fork::light));
  EXPECT_FALSE(are_sound(stream_of_two, Stream::photon_global));
}

TEST(draws, rows_out_of_order_or_missing_are_found) {
  EXPECT_FALSE(are_sound(in_wrong_order, Fork::light));
  EXPECT_FALSE(are_sound(of_two_parents, Fork::light_probe));
  EXPECT_FALSE(are_sound(of_two_parents, Fork::light_group));
}

namespace {

/// Two pairs tell 2⁹⁶ samplers apart: equal ones are the same.
using Numbers = std::array<float, 4>;

Numbers numbers_of(Sampler sampler) {
  const Vec2f first = sampler.next_2d(), second = sampler.next_2d();
  return {first.x, first.y, second.x, second.y};
}

/// Of the first and the last of each row.
template <typename Row, typename Make>
void add_numbers(const Row& row, const Make& make, std::multiset<Numbers>& all) {
  all.insert(numbers_of(make(uint64_t(0))));
  if (row.count > 1) all.insert(numbers_of(make(row.count - 1)));
}

size_t different(const std::multiset<Numbers>& all) {
  return std::set(all.begin(), all.end()).size();
}

}  // namespace

TEST(draws, every_row_has_numbers_of_its_own) {
  Sampler parent(3, 4);
  parent.next_2d();
  std::multiset<Numbers> at_vertex, streams;
  at_vertex.insert(numbers_of(parent));
  for (const ForkRow& row : fork_rows)
    if (row.of == Parent::vertex)
      add_numbers(
          row, [&](uint64_t i) { return parent.fork(row.use, uint32_t(i)); }, at_vertex);
  for (const SplitRow& row : split_rows)
    if (row.of == Parent::vertex)
      add_numbers(
          row, [&](uint64_t i) { return parent.split(row.use, 4, uint32_t(i)); }, at_vertex);
  for (const SeriesRow& row : series_rows)
    add_numbers(
        row, [&](uint64_t) { return parent.one_of(row.use, 1, 0); }, at_vertex);
  EXPECT_GT(at_vertex.size(), 15u);
  EXPECT_EQ(different(at_vertex), at_vertex.size());
  for (const StreamRow& row : stream_rows)
    add_numbers(
        row, [&](uint64_t i) { return Sampler::at(1, 0, row.use, i, 0); }, streams);
  EXPECT_EQ(streams.size(), 2 * std::size(stream_rows));
  EXPECT_EQ(different(streams), streams.size());
  std::multiset<Numbers> points;
  for (const QuadratureRow& row : quadrature_rows)
    if (row.of == Integrand::light || row.of == Integrand::aim)
      add_numbers(
          row, [&](uint64_t i) { return Sampler::of(row.use, 0, i); }, points);
  EXPECT_GT(points.size(), 7u);
  EXPECT_EQ(different(points), points.size());
  // Asked twice, the same are found.
  at_vertex.insert(numbers_of(parent.fork(Fork::lens)));
  EXPECT_EQ(different(at_vertex) + 1, at_vertex.size());
}

namespace {

/// Whether a line of a source makes a sampler of any scramble: `Sampler(7, i)`, `Sampler s{7, i}`.
bool is_scrambled_by_hand(const std::string& line) {
  static const std::regex pattern("(^|[^A-Za-z_:])Sampler( [a-z_]+)?[({][^&]*,");
  return std::regex_search(line, pattern);
}

}  // namespace

TEST(draws, samplers_are_made_of_rows) {
  EXPECT_TRUE(is_scrambled_by_hand("  Sampler sampler(0x61696d, k);"));
  EXPECT_TRUE(is_scrambled_by_hand("const Vec2f u = Sampler(scramble + 2, k).next_2d();"));
  EXPECT_TRUE(is_scrambled_by_hand("  const Sampler numbers{0, 0};"));
  EXPECT_FALSE(is_scrambled_by_hand("Sampler sampler = Sampler::of(Quadrature::aim_box, k);"));
  EXPECT_FALSE(is_scrambled_by_hand("void scatter(Sampler& sampler, const Vec2f& u);"));
  EXPECT_FALSE(is_scrambled_by_hand("EmissionSampler sampler(scene, lobes);"));
  size_t sources = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(
           std::string(KAUSTIK_SOURCE_DIR) + "/src/kaustik")) {
    const std::filesystem::path& path = entry.path();
    if (path.extension() != ".cpp" && path.extension() != ".h") continue;
    // The second makes Parent::waves, of a seed that the scene names.
    if (path.filename() == "sampler.h" || path.filename() == "wave_field.cpp") continue;
    std::ifstream file(path);
    ++sources;
    for (std::string line; std::getline(file, line);)
      EXPECT_FALSE(is_scrambled_by_hand(line)) << path << ": a row of base/draws.h is missing:\n"
                                               << line;
  }
  EXPECT_GT(sources, 300u);
}
