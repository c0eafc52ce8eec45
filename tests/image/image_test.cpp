#include "kaustik/image/image.h"

#include "tests/image/support.h"

namespace kaustik {
namespace {

using testing::caught;
using testing::expect_input_error;

TEST(Image, keeps_channels_apart) {
  Image image(3, 2, {"R", "G", "B", "depth.Z"});
  EXPECT_EQ(image.pixel_count(), 6u);
  image.at(2, 1, 3) = 7;
  image.at(0, 0, 0) = 1;
  EXPECT_EQ(image.channel(3)[5], 7);
  EXPECT_EQ(image.channel(0)[0], 1);
  float sum = 0;
  for (int c = 0; c < 4; ++c)
    for (const float value : image.channel(c)) sum += value;
  EXPECT_EQ(sum, 8);
  EXPECT_EQ(image.find_channel("depth.Z"), 3);
  EXPECT_EQ(image.find_channel("depth"), -1);
}

TEST(Image, adds_channels_and_keeps_the_others) {
  Image image(2, 2, {"Y"});
  image.at(1, 1, 0) = 5;
  EXPECT_EQ(image.add_channel("A"), 1);
  EXPECT_EQ(image.at(1, 1, 0), 5);
  EXPECT_EQ(image.at(1, 1, 1), 0);
  expect_input_error([&] { image.add_channel("A"); }, "'A'");
}

TEST(Image, metadata_keep_their_order_and_are_replaced) {
  Image image;
  image.set_metadata("b", 1.5);
  image.set_metadata("a", int64_t{3});
  image.set_metadata("b", std::string("x"));
  ASSERT_EQ(image.metadata().size(), 2u);
  EXPECT_EQ(image.metadata()[0].first, "b");
  EXPECT_EQ(std::get<std::string>(image.metadata()[0].second), "x");
  EXPECT_EQ(std::get<int64_t>(*image.find_metadata("a")), 3);
  EXPECT_EQ(image.find_metadata("c"), nullptr);
}

TEST(Image, refuses_impossible_sizes) {
  for (const auto& [width, height] :
       {std::pair(0, 4), std::pair(4, 0), std::pair(-1, 4), std::pair(4, -1), std::pair(0, 0)})
    expect_input_error([&, w = width, h = height] { Image(w, h, {"R"}); }, "pixels");
  // A billion pixels, and products that overflow.
  expect_input_error([] { Image(31623, 31623, {"R", "G", "B"}); }, "31623 x 31623");
  expect_input_error([] { Image(2147483647, 2147483647, {"R", "G", "B"}); }, "2147483647");
  expect_input_error([] { check_image_size(INT64_MAX, INT64_MAX, 3); }, "too large");
  expect_input_error([] { check_image_size(4, INT64_MAX, 3); }, "too large");
  expect_input_error([] { check_image_size(20000, 20000, 1000000); }, "memory");
  check_image_size(4096, 4096, 30);
}

TEST(Image, refuses_names_that_are_empty_or_twice_there) {
  expect_input_error([] { Image(1, 1, {"R", ""}); }, "no name");
  expect_input_error([] { Image(1, 1, {"R", "R"}); }, "'R'");
}

TEST(RgbView, finds_channels_of_other_programs) {
  Image image(1, 1, {"View.Combined.r", "View.Combined.g", "View.Combined.b", "Mist.V", "mask"});
  for (int c = 0; c < image.channel_count(); ++c) image.at(0, 0, c) = float(c);
  EXPECT_EQ(rgb_view(image, "View.Combined")[0], Vec3f(0, 1, 2));
  EXPECT_EQ(rgb_view(image, "Mist")[0], Vec3f(3));
  EXPECT_EQ(rgb_view(image, "mask")[0], Vec3f(4));
  expect_input_error([&] { rgb_view(image); }, "View.Combined.r");
  Image single(1, 1, {"irradiance"});
  single.at(0, 0, 0) = 7;
  EXPECT_EQ(rgb_view(single)[0], Vec3f(7));
}

TEST(RgbView, finds_the_picture_among_layers) {
  const auto channels = [](std::vector<std::string> names) { return colour_channels(names); };
  using Found = std::array<int, 3>;
  EXPECT_EQ(channels({"beauty.B", "beauty.G", "beauty.R", "depth.Z"}), (Found{2, 1, 0}));
  EXPECT_EQ(channels({"V.Combined.B", "V.Combined.G", "V.Combined.R", "V.Diff.B", "V.Diff.G",
                      "V.Diff.R"}),
            (Found{2, 1, 0}));
  EXPECT_EQ(channels({"A", "G", "R"}), (Found{2, 1, -1}));
  EXPECT_EQ(channels({"A", "R"}), (Found{1, 1, 1}));
  EXPECT_FALSE(channels({"a.B", "a.G", "a.R", "b.B", "b.G", "b.R"}));
  EXPECT_FALSE(channels({"A"}));
  const Image image(2, 1, {"R", "G"});
  EXPECT_EQ(rgb_view(image)[1].z, 0);
}

TEST(RgbView, finds_layers) {
  Image image(1, 1,
              {"R", "G", "B", "direct.R", "direct.G", "direct.B", "N.X", "N.Y", "N.Z", "depth.Z"});
  for (int c = 0; c < image.channel_count(); ++c) image.at(0, 0, c) = float(c);
  EXPECT_EQ(rgb_view(image)[0], Vec3f(0, 1, 2));
  EXPECT_EQ(rgb_view(image, "direct")[0], Vec3f(3, 4, 5));
  EXPECT_EQ(rgb_view(image, "N")[0], Vec3f(6, 7, 8));
  EXPECT_EQ(rgb_view(image, "depth")[0], Vec3f(9, 9, 9));
  expect_input_error([&] { rgb_view(image, "indirect"); }, "'indirect'");
  const Image grey(1, 1, {"Y"});
  EXPECT_EQ(rgb_view(grey)[0], Vec3f(0));
  const Image without_colours(1, 1, {"A"});
  expect_input_error([&] { rgb_view(without_colours); }, "no colour");
}

}  // namespace
}  // namespace kaustik
