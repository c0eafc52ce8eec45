// Regions in files: gone on with, merged, damaged.

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "kaustik/base/checksum.h"
#include "kaustik/render/checkpoint_merge.h"
#include "tests/render/region_testing.h"
#include "tests/support/temporary_folder.h"

namespace kaustik {
namespace {

using namespace test;

RenderRecord record_for(uint32_t passes, uint32_t first = 0) {
  RenderRecord record;
  record.recipe.seed = 5;
  record.recipe.samples_per_pass = 2;
  record.plan = {first, passes, {}, {}};
  return record;
}

/// Stopped within the region's passes, kept in a file, and gone on with.
TEST(Regions, ResumedOnesHaveTheSameBits) {
  const TemporaryFolder folder;
  for (const char* type : {"path", "auto", "ppm", "photonmap"}) {
    const auto integrator = integrator_of(type);
    // After the second pass five of the region, after the third two.
    const auto ask = [](Session& session) {
      const Film& film = session.film();
      const uint32_t asked = film.regional_pass_count();
      if (film.pass_count() == 2 && asked == 0) {
        EXPECT_TRUE(session.refine({floor_region, 5}));
      }
      if (film.pass_count() == 3 && asked == 5) {
        EXPECT_TRUE(session.refine({floor_region, 2}));
      }
    };
    Session whole(ball().scene(), *integrator, refined_settings(4));
    whole.run({}, {}, [&] { ask(whole); });
    ASSERT_EQ(whole.film().regional_pass_count(), 7u);

    const auto before = integrator_of(type);
    std::stop_source stop;
    Session begun(ball().scene(), *before, refined_settings(4));
    const SessionReport report = begun.run(stop.get_token(), {}, [&] {
      ask(begun);
      if (begun.film().regional_pass_count() == 3) stop.request_stop();
    });
    ASSERT_EQ(begun.film().regional_pass_count(), 3u);
    EXPECT_EQ(report.picture_error, begun.film().picture_error());
    const std::string path = folder.path(std::string(type) + ".kpt");
    write_checkpoint(path, record_for(4), begun.film(), before->lessons());

    Checkpoint kept = read_checkpoint(path);
    const auto after = integrator_of(type);
    if (!kept.lessons.empty()) after->go_on_with(kept.lessons, LessonUse::go_on);
    Session resumed(ball().scene(), *after, refined_settings(4, {{floor_region, 2}}),
                    std::move(kept.film));
    resumed.run({}, {}, [&] { ask(resumed); });
    EXPECT_EQ(film_bytes(resumed.film()), film_bytes(whole.film())) << type;
    EXPECT_TRUE(same_bits(resumed.film().image(), whole.film().image())) << type;
    EXPECT_EQ(resumed.film().picture_error(), whole.film().picture_error());
  }
}

TEST(Regions, PartsAreMergedInAnyOrder) {
  const auto integrator = integrator_of("path");
  constexpr PixelRegion elsewhere{0, 0, 5, 6};
  const Film a = refined_film(*integrator, refined_settings(2, {{floor_region, 3}}));
  const Film b = refined_film(*integrator, refined_settings(2, {{elsewhere, 4}}, 2));
  const Film plain = refined_film(*integrator, refined_settings(4));
  Checkpoint ab{record_for(2), a, {}}, ba{record_for(2, 2), b, {}};
  ab.record.instruction_sets = {"one"};
  ba.record.instruction_sets = {"other"};
  RenderRecord of_other = record_for(2, 2), of_one = record_for(2);
  of_other.instruction_sets = {"other"};
  of_one.instruction_sets = {"one"};
  merge_checkpoint(ab, "a.kpt", {of_other, b, {}}, "b.kpt");
  merge_checkpoint(ba, "b.kpt", {of_one, a, {}}, "a.kpt");
  EXPECT_EQ(film_bytes(ab.film), film_bytes(ba.film));
  EXPECT_EQ(ab.record.instruction_sets, (std::set<std::string>{"one", "other"}));
  EXPECT_EQ(ba.record.instruction_sets, ab.record.instruction_sets);
  const TemporaryFolder folder;
  write_checkpoint(folder.path("b.kpt"), record_for(2, 2), b);
  Checkpoint by_rows{record_for(2), a, {}};
  merge_checkpoint_file(by_rows, "a.kpt", folder.path("b.kpt"));
  EXPECT_EQ(film_bytes(by_rows.film), film_bytes(ab.film));
  ASSERT_EQ(ab.film.regions().size(), 2u);
  EXPECT_TRUE(ab.film.regions()[0].pixels == elsewhere);
  const Image merged = ab.film.image(), expected = plain.image();
  for (int y = 0; y < 24; ++y)
    for (int x = 0; x < 24; ++x)
      if (!floor_region.holds(x, y) && !elsewhere.holds(x, y)) {
        ASSERT_EQ(channel_at(merged, x, y, "G"), channel_at(expected, x, y, "G"));
      }
  // Within, the sums are those of all passes.
  for (const auto& [x, y] : {std::pair(12, 17), std::pair(2, 3)}) {
    const size_t pixel = size_t(y) * 24 + size_t(x);
    EXPECT_EQ(ab.film.pass_count(pixel), floor_region.holds(x, y) ? 7u : 8u);
    const auto own = [&](const Film& film) { return film.total(pixel, 1); };
    EXPECT_DOUBLE_EQ(own(ab.film), own(a) + own(b));
    if (floor_region.holds(x, y)) {
      EXPECT_NE(channel_at(merged, x, y, "G"), channel_at(expected, x, y, "G"));
    }
  }
  // The same passes of the same pixels.
  const Film again = refined_film(*integrator, refined_settings(2, {{{10, 15, 3, 3}, 3}}, 2));
  Checkpoint twice{record_for(2), a, {}};
  ASSERT_EQ(a.twice_in_regions(again).count(), 2u);
  write_checkpoint(folder.path("c.kpt"), record_for(2, 2), again);
  for (const bool is_file : {false, true}) try {
      if (is_file)
        merge_checkpoint_file(twice, "a.kpt", folder.path("c.kpt"));
      else
        merge_checkpoint(twice, "a.kpt", {record_for(2, 2), again, {}}, "c.kpt");
      ADD_FAILURE() << "passes of regions came twice";
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find("given before"), std::string::npos) << error.what();
    }
}

TEST(Regions, DamagedFilesAreRefused) {
  const Film film = refined_film(*integrator_of("path"), refined_settings(2, {{floor_region, 3}}));
  const std::vector<uint8_t> good = checkpoint_bytes(record_for(2), film);
  EXPECT_EQ(film_bytes(parse_checkpoint(good, "good.kpt").film), film_bytes(film));
  const auto with_checksum = [](std::vector<uint8_t> bytes) {
    const uint64_t sum = checksum(std::span(bytes).first(bytes.size() - sizeof(uint64_t)));
    std::memcpy(bytes.data() + bytes.size() - sizeof sum, &sum, sizeof sum);
    return bytes;
  };
  // The region's row: its place, its orders, its size.
  const PixelRegion& r = floor_region;
  const std::vector<int32_t> row = {r.x, r.y, 1, 0, 1, 4, 1, r.width};
  const auto* first = reinterpret_cast<const uint8_t*>(row.data());
  const auto at = std::search(good.begin(), good.end(), first, first + row.size() * 4);
  ASSERT_NE(at, good.end());
  const auto place = at - good.begin();
  int refused = 0;
  for (const auto& [offset, value] : std::vector<std::pair<int, int32_t>>{{0, -1},
                                                                          {0, 12},
                                                                          {0, 1 << 30},
                                                                          {4, 16},
                                                                          {8, 0},
                                                                          {8, 1 << 30},
                                                                          {16, 5},
                                                                          {16, 2},
                                                                          {20, -1},
                                                                          {20, 6},
                                                                          {24, -1},
                                                                          {28, 0},
                                                                          {28, 1 << 30},
                                                                          {-8, 2},
                                                                          {-8, 0}}) {
    std::vector<uint8_t> bad = good;
    std::memcpy(bad.data() + place + offset, &value, sizeof value);
    EXPECT_THROW(parse_checkpoint(with_checksum(bad), "bad.kpt"), Error) << offset << ": " << value;
    ++refused;
  }
  EXPECT_EQ(refused, 15);
  for (size_t size = size_t(place); size < good.size(); size += 97) {
    std::vector<uint8_t> cut(good.begin(), good.begin() + std::ptrdiff_t(size));
    cut.resize(cut.size() + sizeof(uint64_t));
    EXPECT_THROW(parse_checkpoint(with_checksum(cut), "cut.kpt"), Error);
  }
  std::mt19937 generator(3);
  for (int i = 0; i < 300; ++i) {
    std::vector<uint8_t> flipped = good;
    const size_t where = size_t(place) + generator() % (good.size() - size_t(place) - 8);
    flipped[where] ^= uint8_t(1u << generator() % 8);
    try {
      parse_checkpoint(with_checksum(flipped), "flipped.kpt").film.image();
    } catch (const Error&) {
    }
  }
}

// Pixels would count it twice, and be told to have less noise than they have.

TEST(Regions, AFileWithAPassTwiceForTheSamePixelsIsRefused) {
  const auto film_of = [](bool is_same_pass) {
    FilmAndPasses all;
    MadeUpPasses passes(1);
    all.add_whole(0, passes.next(size_t(picture_width) * picture_height));
    Pass pass = regional_pass(all.film, first_region, 1);
    for (const PixelRegion& region : {first_region, second_region}) {
      if (!is_same_pass) pass = regional_pass(all.film, region, 1);
      const RegionPixels pixels = passes.next(size_t(region.pixel_count()));
      all.film.add_regional_pass(region, pass_of(pixels, {region.width, region.height}), pass);
    }
    return std::move(all.film);
  };
  EXPECT_NO_THROW(parse_checkpoint(film_bytes(film_of(false)), "good.kpt"));
  EXPECT_THROW(parse_checkpoint(film_bytes(film_of(true)), "twice.kpt"), Error);
}

// No pixel is left that has the passes of the picture alone.

}  // namespace
}  // namespace kaustik
