#include "kaustik/image/stitch.h"

#include <gtest/gtest.h>

#include "kaustik/base/error.h"
#include "kaustik/image/image_io.h"
#include "tests/image/support.h"

namespace kaustik {
namespace {

float value_at(int x, int y, int channel) { return float(1000 * channel + 100 * y + x); }

/// The window (x, y) of a picture of 7 × 5 pixels, whose values tell their place.
Image part(int x, int y, int width, int height, const PictureFrame& picture = {7, 5, 0, 0}) {
  Image image(width, height, {"R", "N.X"});
  image.set_frame({picture.width, picture.height, x, y});
  for (int c = 0; c < 2; ++c)
    for (int row = 0; row < height; ++row)
      for (int column = 0; column < width; ++column)
        image.at(column, row, c) = value_at(x + column, y + row, c);
  image.set_metadata("scene", std::string("a.xml"));
  image.set_metadata("render_seconds", 1.5);
  image.set_metadata("passes", int64_t(width));
  return image;
}

using StitchedFiles = testing::FileTest;

std::string refusal(const std::vector<Image>& parts) {
  Stitcher stitcher;
  try {
    for (size_t i = 0; i < parts.size(); ++i) stitcher.add(std::to_string(i) + ".exr", parts[i]);
    std::move(stitcher).finish();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::input);
    return error.what();
  }
  return {};
}

TEST(Stitcher, EveryPixelGetsToItsPlace) {
  Stitcher stitcher;
  // In any order, overlapping where they agree, reaching beyond the picture.
  for (const Image& image : {part(3, -1, 6, 4), part(0, 2, 7, 3), part(0, 0, 4, 2)})
    stitcher.add("a.exr", image);
  EXPECT_EQ(stitcher.differing(), std::vector<std::string>{"passes"});
  const Image whole = std::move(stitcher).finish();
  ASSERT_EQ(whole.width(), 7);
  ASSERT_EQ(whole.height(), 5);
  EXPECT_TRUE(whole.is_whole());
  for (int c = 0; c < 2; ++c)
    for (int y = 0; y < 5; ++y)
      for (int x = 0; x < 7; ++x) EXPECT_EQ(whole.at(x, y, c), value_at(x, y, c));
  EXPECT_EQ(std::get<double>(*whole.find_metadata("render_seconds")), 4.5);
  EXPECT_EQ(std::get<std::string>(*whole.find_metadata("scene")), "a.xml");
  EXPECT_EQ(whole.find_metadata("passes"), nullptr);
}

TEST(Stitcher, MetadataOfOnePartDoesNotVanishUntold) {
  Image marked = part(0, 0, 7, 2);
  marked.set_metadata("passes", int64_t(7));
  marked.set_metadata("incomplete", std::string("ended within the first pass"));
  marked.set_metadata("artist", std::string("somebody"));
  const Image plain = part(0, 2, 7, 3);
  for (const bool marked_first : {true, false}) {
    SCOPED_TRACE(marked_first);
    Stitcher stitcher;
    stitcher.add("a.exr", marked_first ? marked : plain);
    stitcher.add("b.exr", marked_first ? plain : marked);
    EXPECT_EQ(stitcher.differing(), std::vector<std::string>{"artist"});
    const Image whole = std::move(stitcher).finish();
    EXPECT_EQ(whole.find_metadata("artist"), nullptr);
    ASSERT_NE(whole.find_metadata("incomplete"), nullptr);
    EXPECT_EQ(std::get<std::string>(*whole.find_metadata("incomplete")),
              "ended within the first pass");
    EXPECT_EQ(std::get<double>(*whole.find_metadata("render_seconds")), 3);
  }
}

// Of the kinds of numbers that files have, the widest: a third is not among 16-bit floats.
TEST_F(StitchedFiles, PartsOf32BitsStayThat) {
  const auto file = [&](const char* name) { return path(name); };
  Image upper = part(0, 0, 7, 2), lower = part(0, 2, 7, 3);
  for (float& value : upper.channel(0)) value = 1.0f / 3;
  WriteOptions floats, halves;
  floats.exr_half = false;
  for (const bool upper_first : {true, false}) {
    write_image(upper, file("upper.exr"), floats);
    write_image(lower, file("lower.exr"), halves);
    Stitcher stitcher;
    for (const bool is_upper : {upper_first, !upper_first})
      stitcher.add("part", read_image(file(is_upper ? "upper.exr" : "lower.exr")));
    write_image(std::move(stitcher).finish(), file("whole.exr"), halves);
    const Image whole = read_image(file("whole.exr"));
    EXPECT_EQ(whole.at(0, 0, whole.find_channel("R")), 1.0f / 3);
  }
  // The twin: where no part has 32 bits they are not made up.
  write_image(upper, file("upper.exr"), halves);
  Stitcher stitcher;
  stitcher.add("upper", read_image(file("upper.exr")));
  stitcher.add("lower", read_image(file("lower.exr")));
  write_image(std::move(stitcher).finish(), file("whole.exr"), halves);
  const Image whole = read_image(file("whole.exr"));
  EXPECT_NEAR(whole.at(0, 0, whole.find_channel("R")), 1.0f / 3, 1e-3);
  EXPECT_FALSE(whole.keeps_floats(whole.find_channel("R")));
}

TEST(Stitcher, RefusesWhatDoesNotFit) {
  EXPECT_EQ(refusal({part(0, 0, 7, 2), part(0, 2, 7, 3)}), "");
  EXPECT_NE(refusal({part(0, 0, 7, 2), part(0, 3, 7, 2)})
                .find("7 of 35 pixels are in no part, the first is 0, 2"),
            std::string::npos);
  EXPECT_NE(refusal({part(0, 0, 7, 2), part(0, 2, 7, 3, {7, 6, 0, 0})}).find("1.exr"),
            std::string::npos);
  Image other(7, 3, {"R", "G"});
  other.set_frame({7, 5, 0, 2});
  EXPECT_NE(refusal({part(0, 0, 7, 2), other}).find("other channels"), std::string::npos);
  Image changed = part(0, 1, 7, 4);
  changed.at(3, 0, 1) += 1;
  EXPECT_NE(refusal({part(0, 0, 7, 2), changed}).find("another value at pixel 3, 1"),
            std::string::npos);
  EXPECT_NE(refusal({}), "");
}

}  // namespace
}  // namespace kaustik
