// What reading costs in memory and time, and what is told where that is too much.

#include <ctime>
#include <random>

#include "kaustik/image/image_io.h"
#include "kaustik/image/picture_reader.h"
#include "tests/image/child.h"
#include "tests/image/samples.h"
#include "tests/image/support.h"

namespace kaustik {
namespace {

using Budget = testing::FileTest;
using testing::Caught;

/// A Radiance picture of one pixel and older runs that repeat it.
std::string old_runs(int width, int height, int lines) {
  std::string file =
      "#?RADIANCE\n\n-Y " + std::to_string(height) + " +X " + std::to_string(width) + "\n";
  const auto run = [](int count) { return std::string{1, 1, 1, char(count)}; };
  for (int y = 0; y < lines; ++y) {
    const int rest = width - 1;
    file += std::string("\100\100\100\200", 4) + run(rest & 255) + run(rest >> 8 & 255) +
            run(rest >> 16);
  }
  return file;
}

TEST_F(Budget, more_than_it_is_lack_of_memory) {
  const Image image = testing::test_picture(100, 50, 1);
  for (const char* name : {"a.exr", "a.hdr", "a.pfm", "a.tif", "a.png", "a.jpg", "a.ppm"}) {
    write_image(image, path(name));
    ReadOptions options;
    options.memory_bytes = 100 * 50 * 12 - 1 + int64_t(contents(path(name)).size());
    options.memory_remedy = "do this";
    const Caught error = testing::caught([&] { read_image(path(name), options); });
    ASSERT_TRUE(error.is_error) << name;
    EXPECT_EQ(error.kind, ErrorKind::system) << error.text;
    EXPECT_NE(error.text.find(path(name)), std::string::npos) << error.text;
    EXPECT_NE(error.text.find("100 x 50 pixels"), std::string::npos) << error.text;
    EXPECT_EQ(error.remedy, "do this");
    // LogLuv is decoded by strips.
    options.memory_bytes = 100 * 50 * 20 + int64_t(contents(path(name)).size());
    EXPECT_EQ(read_image(path(name), options).width(), 100);
    options.kept_bytes_per_pixel = 20;
    EXPECT_TRUE(testing::caught([&] { read_image(path(name), options); }).is_error) << name;
  }
}

TEST_F(Budget, has_room_for_the_file_too) {
  write_image(testing::test_picture(100, 50, 1), path("a.pfm"));
  const auto file_bytes = int64_t(contents(path("a.pfm")).size());
  ReadOptions options;
  options.memory_bytes = 100 * 50 * 12 + file_bytes;
  EXPECT_EQ(read_image(path("a.pfm"), options).width(), 100);
  // Too little for both, and for the file alone, which is not even read.
  for (const int64_t bytes : {options.memory_bytes - 1, file_bytes - 1}) {
    options.memory_bytes = bytes;
    const Caught error = testing::caught([&] { read_image(path("a.pfm"), options); });
    ASSERT_TRUE(error.is_error);
    EXPECT_EQ(error.kind, ErrorKind::system) << error.text;
    EXPECT_NE(error.text.find("memory"), std::string::npos) << error.text;
  }
}

TEST_F(Budget, bounds_the_whole_of_a_small_window) {
  Image window = testing::test_picture(4, 3, 1);
  window.set_frame({1000, 500, 10, 10});
  EXPECT_EQ(whole_picture(window, 1000 * 500 * 12).width(), 1000);
  const Caught error = testing::caught([&] { whole_picture(window, 1000 * 500 * 12 - 1); });
  ASSERT_TRUE(error.is_error);
  EXPECT_EQ(error.kind, ErrorKind::system) << error.text;
  EXPECT_NE(error.text.find("1000 x 500 pixels"), std::string::npos) << error.text;
}

#ifndef KAUSTIK_SLOW_BUILD
TEST_F(Budget, promises_that_a_file_does_not_keep_cost_nothing) {
  put(path("a.hdr"), old_runs(100000, 1000, 3));
  // 100 million pixels would be 1.2 GB.
  constexpr int64_t much = 100'000'000;
  const std::clock_t start = std::clock();
  const int64_t growth = testing::memory_growth([&] {
    const Caught error = testing::caught([&] { read_image(path("a.hdr")); });
    if (error.text.find("truncated") == std::string::npos) throw std::runtime_error(error.text);
  });
  EXPECT_LT(growth, much);
  EXPECT_LT(double(std::clock() - start) / CLOCKS_PER_SEC, 1);
  // That it would be seen: a picture that is there.
  put(path("b.hdr"), old_runs(100000, 100, 100));
  EXPECT_GT(testing::memory_growth([&] { read_image(path("b.hdr")); }), much);
}

// In whichever allocation of whichever library it is that fails.
TEST_F(Budget, lack_of_memory_is_told_as_that_when_writing) {
  Image noise(400, 400, {"R", "G", "B"});
  std::mt19937 generator(1);
  for (int c = 0; c < 3; ++c)
    for (float& value : noise.channel(c)) value = float(generator()) * 0x1p-32f;
  for (const char* name : {"a.exr", "a.hdr", "a.pfm", "a.tif", "a.png", "a.jpg", "a.ppm"}) {
    int failures = 0;
    for (int64_t more = 50'000; more < 10'000'000; more += more / 2)
      failures += int(testing::result_in_child([&] {
        testing::limit_memory(more);
        const Caught error = testing::caught([&] {
          WriteOptions options;
          options.tone = make_tone_operator("srgb");
          encode_image(noise, name, options);
        });
        if (!error.is_error) return 0;
        const bool is_told = error.kind == ErrorKind::system &&
                             error.text.find("memory") != std::string::npos &&
                             error.text.find("format") == std::string::npos;
        if (!is_told) std::fputs((error.text + "\n").c_str(), stderr);
        return is_told ? 1 : 1000;
      }));
    EXPECT_GT(failures, 0) << name;
    EXPECT_LT(failures, 1000) << name;
  }
}
#endif

TEST_F(Budget, what_fits_is_read_however_small_its_file) {
  put(path("a.hdr"), old_runs(100000, 20, 20));
  const Image image = read_image(path("a.hdr"));
  EXPECT_EQ(image.width(), 100000);
  EXPECT_FLOAT_EQ(image.at(99999, 19, 2), 64.5f / 256);
}

TEST_F(Budget, metadata_take_time_in_proportion) {
  Image image(1, 1, {"Y"});
  constexpr int count = 150'000;
  const std::clock_t start = std::clock();
  for (int i = 0; i < count; ++i) image.set_metadata("key" + std::to_string(i), int64_t(i));
  for (const char* name : {"a.exr", "a.tif"}) {
    write_image(image, path(name));
    const Image read = read_image(path(name));
    ASSERT_NE(read.find_metadata("key149999"), nullptr) << name;
    EXPECT_GE(read.metadata().size(), size_t{count}) << name;
  }
  [[maybe_unused]] const double taken_s = double(std::clock() - start) / CLOCKS_PER_SEC;
#ifndef KAUSTIK_SLOW_BUILD
  EXPECT_LT(taken_s, 10);  // a search through all of them for each took a minute
#endif
}

TEST_F(Budget, damaged_and_countless_texts_of_png_are_refused) {
  Image image(2, 2, {"R", "G", "B"});
  image.set_metadata("scene", std::string("box"));
  write_image(image, path("a.png"));
  const std::string file = contents(path("a.png"));
  const size_t text = file.find("scene");
  ASSERT_NE(text, std::string::npos);
  std::string damaged = file;
  damaged[text + 6] = 'B';
  put(path("b.png"), damaged);
  testing::expect_input_error([&] { read_image(path("b.png")); }, "CRC");
  // Behind the header of 8 + 25 bytes.
  const auto with = [&](const std::string& chunk, int count) {
    std::string more;
    for (int i = 0; i < count; ++i) more += chunk;
    put(path("c.png"), file.substr(0, 33) + more + file.substr(33));
  };
  with(testing::png_chunk("tEXt", std::string("k\0v", 3)), 3000);
  EXPECT_NE(read_image(path("c.png")).find_metadata("k"), nullptr);
  with(testing::png_chunk("tEXt", std::string("k\0v", 3)), 20000);
  testing::expect_input_error([&] { read_image(path("c.png")); }, "texts");
}

const TypeInfo& picture_info() {
  static const TypeInfo info{"texture", "picture", "", picture_parameters("", {})};
  return info;
}

class PictureOfScene : public testing::FileTest {
 protected:
  Image read(PictureReader& reader, const std::string& name, int64_t kept_bytes) const {
    Problems problems;
    const Place place = place_in("scene.xml", 3, 4);
    const Arguments arguments(picture_info(), {{"filename", path(name), place}}, place, problems);
    problems.throw_if_any();
    return reader.read(arguments, kept_bytes);
  }
};

TEST_F(PictureOfScene, all_pictures_share_one_budget) {
  write_image(testing::test_picture(100, 50, 1), path("a.pfm"));
  PictureReader reader(5000 * (2 * 20 + 12) + int64_t(contents(path("a.pfm")).size()));
  read(reader, "a.pfm", 20);
  read(reader, "a.pfm", 20);
  const Caught error = testing::caught([&] { read(reader, "a.pfm", 20); });
  ASSERT_TRUE(error.is_error);
  EXPECT_EQ(error.kind, ErrorKind::system);
  EXPECT_NE(error.text.find("scene.xml:3:4"), std::string::npos) << error.text;
  EXPECT_NE(error.text.find("texture memory"), std::string::npos) << error.text;
}

TEST_F(PictureOfScene, bad_pixels_are_repaired_and_counted) {
  Image image(3, 2, {"R", "G", "B"});
  for (int c = 0; c < 3; ++c)
    for (float& value : image.channel(c)) value = float(c + 1);
  image.at(1, 0, 0) = -4;
  image.at(2, 0, 1) = std::numeric_limits<float>::infinity();
  image.at(0, 1, 2) = std::numeric_limits<float>::quiet_NaN();
  write_image(image, path("a.pfm"));
  PictureReader reader;
  const Image read_back = read(reader, "a.pfm", 0);
  EXPECT_EQ(read_back.at(1, 0, 0), 0);
  EXPECT_EQ(read_back.at(1, 0, 1), 2);
  EXPECT_EQ(read_back.at(2, 0, 1), 3);
  EXPECT_EQ(read_back.at(0, 1, 2), 0);
  ASSERT_EQ(reader.warnings().size(), 1u);
  EXPECT_NE(reader.warnings()[0].find("3 of its 6 pixels"), std::string::npos);
  EXPECT_NE(reader.warnings()[0].find("(1, 0)"), std::string::npos) << reader.warnings()[0];
}

}  // namespace
}  // namespace kaustik
