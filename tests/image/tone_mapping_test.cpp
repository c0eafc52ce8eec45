#include "kaustik/image/tone_mapping.h"

#include <algorithm>
#include <limits>

#include "kaustik/image/photometry.h"
#include "tests/image/support.h"

namespace kaustik {
namespace {

using testing::expect_input_error;

constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();

Image grey_image(int width, int height, const std::function<float(int, int)>& value) {
  Image image(width, height, {"R", "G", "B"});
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < 3; ++c) image.at(x, y, c) = value(x, y);
  return image;
}

void expect_displayable(const Image& image) {
  for (int c = 0; c < 3; ++c)
    for (const float value : image.channel(c)) {
      ASSERT_GE(value, 0);
      ASSERT_LE(value, 1);
    }
}

Image shown_by(const Image& image, const std::string& name = "histogram",
               const std::vector<std::string>& settings = {}) {
  return tone_map(image, *make_tone_operator(name, settings));
}

TEST(SimpleTone, scales) {
  const Image image = grey_image(2, 1, [](int x, int) { return x ? 4.0f : 0.125f; });
  EXPECT_NEAR(shown_by(image, "srgb").at(0, 0, 0), 0.125f, 1e-6);
  EXPECT_EQ(shown_by(image, "srgb").at(1, 0, 0), 1);
  EXPECT_NEAR(shown_by(image, "linear", {"exposure=2"}).at(0, 0, 1), 0.5f, 1e-6);
  EXPECT_NEAR(shown_by(image, "linear", {"exposure=-3"}).at(1, 0, 1), 0.5f, 1e-6);
}

// Operators that take an exposure add the film's; those that adapt as an eye does don't ask.
TEST(SimpleTone, adds_the_exposure_of_the_film) {
  const Image plain = grey_image(2, 1, [](int x, int) { return x ? 0.125f : 0.0625f; });
  Image exposed = plain;
  exposed.set_metadata(film_exposure_key, 2.0);
  EXPECT_NEAR(shown_by(exposed, "srgb").at(1, 0, 0), 0.5f, 1e-6);
  EXPECT_NEAR(shown_by(exposed, "linear", {"exposure=-1"}).at(1, 0, 1), 0.25f, 1e-6);
  EXPECT_EQ(shown_by(exposed, "aces").at(1, 0, 0),
            shown_by(plain, "aces", {"exposure=2"}).at(1, 0, 0));
  EXPECT_EQ(shown_by(exposed, "histogram").at(1, 0, 0), shown_by(plain, "histogram").at(1, 0, 0));
  exposed.set_metadata(film_exposure_key, std::string("no number"));
  EXPECT_NEAR(shown_by(exposed, "srgb").at(1, 0, 0), 0.125f, 1e-6);
}

/// A row of grey 0.1 beside a lamp of 100, whose edge covers a share of the pixels in between.
Image lamp_edge(const std::vector<float>& shares) {
  Image image(int(shares.size()), 1,
              {"R", "G", "B", "emission.R", "emission.G", "emission.B", "emission.A"});
  for (int x = 0; x < image.width(); ++x) {
    const float share = shares[size_t(x)];
    for (int c = 0; c < 3; ++c) {
      image.at(x, 0, 3 + c) = 100 * share;
      image.at(x, 0, c) = 100 * share + 0.1f * (1 - share);
    }
    image.at(x, 0, 6) = share;
  }
  return image;
}

// A pixel that a lamp fills to a tenth is a tenth of the way from the wall to the lamp as shown;
// its mean light alone is white many times over.
TEST(LampEdges, are_no_stairs) {
  const std::vector<float> shares = {0, 0, 0, 0, 0.1f, 0.5f, 0.9f, 1, 1, 1};
  for (const char* name : {"histogram", "reinhard", "aces", "linear", "srgb"}) {
    SCOPED_TRACE(name);
    const Image shown = shown_by(lamp_edge(shares), name);
    const float wall = shown.at(0, 0, 0), lamp = shown.at(9, 0, 0);
    ASSERT_GT(lamp, 2 * wall);
    for (int x = 0; x < shown.width(); ++x)
      EXPECT_NEAR(shown.at(x, 0, 1), std::lerp(wall, lamp, shares[size_t(x)]), 0.02f) << x;
  }
  // The twin: without the layer the pixel is as bright as the lamp.
  const Image image = lamp_edge(shares);
  Image bare(image.width(), 1, {"R", "G", "B"});
  for (int x = 0; x < image.width(); ++x)
    for (int c = 0; c < 3; ++c) bare.at(x, 0, c) = image.at(x, 0, c);
  EXPECT_EQ(shown_by(bare, "srgb").at(4, 0, 0), 1);
}

// What is in a layer of its own, or in false colours, is shown as it is.
TEST(LampEdges, are_measured_as_they_are) {
  const Image image = lamp_edge({0, 0.1f, 1});
  EXPECT_EQ(tone_map(image, *make_tone_operator("srgb"), "emission").at(1, 0, 0), 1);
  Image bare(3, 1, {"R", "G", "B"});
  for (int x = 0; x < 3; ++x)
    for (int c = 0; c < 3; ++c) bare.at(x, 0, c) = image.at(x, 0, c);
  const std::vector<std::string> plain = {"legend=false"};
  EXPECT_EQ(shown_by(image, "falsecolor", plain).at(1, 0, 1),
            shown_by(bare, "falsecolor", plain).at(1, 0, 1));
}

TEST(Operators, names_and_parameters) {
  expect_input_error([] { make_tone_operator("histgram"); }, "did you mean 'histogram'");
  expect_input_error([] { make_tone_operator("linear", {"exposur=1"}); },
                     "did you mean 'exposure'");
  expect_input_error([] { make_tone_operator("linear", {"exposure"}); }, "cannot read");
  expect_input_error([] { make_tone_operator("linear", {"exposure=much"}); }, "exposure");
  expect_input_error([] { make_tone_operator("linear", {"exposure=inf"}); }, "exposure");
  expect_input_error([] { make_tone_operator("histogram", {"display_maximum=0"}); },
                     "display_maximum");
  expect_input_error([] { make_tone_operator("histogram", {"display_range=1"}); }, "display_range");
  expect_input_error([] { make_tone_operator("histogram", {"display_minimum=100"}); },
                     "display_minimum");
  expect_input_error([] { make_tone_operator("reinhard", {"white=blue"}); }, "white");
  for (const ToneOperatorType& type : tone_operator_types()) {
    EXPECT_EQ(type.info.family, "tonemap");
    EXPECT_FALSE(type.info.sentence.empty());
    EXPECT_NE(make_tone_operator(type.info.name), nullptr);
  }
}

TEST(Operators, all_of_them_show_any_picture) {
  // One pixel, one value, all black, all bad, negative, twenty decades.
  const std::vector<Image> images = {
      grey_image(1, 1, [](int, int) { return 0.3f; }),
      grey_image(7, 3, [](int, int) { return 1e-30f; }),
      grey_image(7, 3, [](int, int) { return 1e30f; }),
      grey_image(7, 3, [](int, int) { return 0.0f; }),
      grey_image(7, 3, [](int, int) { return -1.0f; }),
      grey_image(7, 3, [](int, int) { return not_a_number; }),
      grey_image(7, 3, [](int x, int) { return x == 2 ? infinity : -infinity; }),
      grey_image(50, 40, [](int x, int y) { return std::pow(10.0f, float(x + y) / 4 - 11); }),
      testing::test_picture(60, 60, 5)};
  std::vector<std::pair<std::string, std::vector<std::string>>> operators = {
      {"histogram", {"human=true"}}, {"histogram", {"smooth=false"}}, {"reinhard", {"local=true"}}};
  for (const ToneOperatorType& type : tone_operator_types())
    operators.push_back({type.info.name, {}});
  for (const auto& [name, settings] : operators)
    for (size_t i = 0; i < images.size(); ++i) {
      SCOPED_TRACE(name + " of image " + std::to_string(i));
      expect_displayable(shown_by(images[i], name, settings));
    }
}

TEST(Reinhard, by_hand) {
  // The geometric mean, 10, becomes 0.18: the two are 0.018 and 1.8, which is white. Equation 4:
  // 0.018 (1 + 0.018 / 1.8²) / 1.018 = 0.0177800; 1.8 (1 + 1 / 1.8) / 2.8 = 1.
  const Image image = grey_image(2, 1, [](int x, int) { return x ? 100.0f : 1.0f; });
  EXPECT_NEAR(shown_by(image, "reinhard").at(0, 0, 0), 0.0177800, 2e-6);
  EXPECT_NEAR(shown_by(image, "reinhard").at(1, 0, 0), 1, 1e-5);
  // Without a white, equation 3: 0.36 / 1.36.
  const Image even = grey_image(4, 4, [](int, int) { return 7.0f; });
  EXPECT_NEAR(shown_by(even, "reinhard", {"key=0.36", "white=1e20"}).at(2, 2, 1), 0.264706, 1e-5);
}

TEST(Reinhard, dodging_and_burning_keeps_local_contrast) {
  // A texture of ±1 % around 5: alone it is compressed by 1 / (1 + 5); against its mean it is not.
  const Image image = grey_image(64, 64, [](int x, int y) { return (x + y) % 2 ? 1.01f : 0.99f; });
  const auto contrast = [&](const char* local) {
    const Image shown = shown_by(image, "reinhard", {"key=5", "white=1e20", local});
    return shown.at(32, 33, 0) / shown.at(32, 32, 0) - 1;
  };
  EXPECT_NEAR(contrast("local=false"), 0.0202 / 6, 1e-4);
  EXPECT_NEAR(contrast("local=true"), 0.0202, 1e-4);
}

TEST(Aces, by_hand) {
  // Grey passes both matrices; (x (x + 0.0245786) − 9.0537e-5) / (x (0.983729 x + 0.432951) +
  // 0.238081) is 0.105593 at 0.18 and 0.619115 at 1.
  const Image image = grey_image(3, 1, [](int x, int) { return x ? x == 1 ? 0.18f : 1.0f : 0; });
  const Image shown = shown_by(image, "aces");
  EXPECT_EQ(shown.at(0, 0, 0), 0);
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(shown.at(1, 0, c), 0.105593, 2e-5);
    EXPECT_NEAR(shown.at(2, 0, c), 0.619115, 2e-5);
  }
  EXPECT_NEAR(shown_by(image, "aces", {"exposure=1"}).at(1, 0, 0),
              shown_by(grey_image(1, 1, [](int, int) { return 0.36f; }), "aces").at(0, 0, 0), 1e-6);
}

TEST(Gamut, keeps_luminance_and_hue) {
  for (const Vec3f& colour : {Vec3f(2, 0.1f, 0.1f), Vec3f(0.5f, 0.5f, 3), Vec3f(-0.2f, 0.7f, 0.3f),
                              Vec3f(1.3f, 0.4f, -0.1f)}) {
    const Vec3f shown = into_gamut(colour);
    for (int c = 0; c < 3; ++c) {
      EXPECT_GE(shown[c], 0);
      EXPECT_LE(shown[c], 1);
    }
    EXPECT_NEAR(photopic(shown), photopic(colour), 1e-5);
    // The same direction from grey.
    const Vec3f from = colour - Vec3f(photopic(colour)), to = shown - Vec3f(photopic(shown));
    EXPECT_NEAR(dot(normalize(from), normalize(to)), 1, 1e-5);
  }
  EXPECT_EQ(into_gamut(Vec3f(0.2f, 0.9f, 1)), Vec3f(0.2f, 0.9f, 1));
  EXPECT_EQ(into_gamut(Vec3f(9, 5, 5)), Vec3f(1));
  EXPECT_EQ(into_gamut(Vec3f(-1, 0, 0)), Vec3f(0));
}

TEST(FieldOfView, comes_from_the_metadata) {
  Image image(2, 2, {"Y"});
  EXPECT_FALSE(field_of_view(image));
  image.set_metadata("horizontal_fov", 40.0);
  EXPECT_EQ(field_of_view(image)->horizontal, 40);
  EXPECT_EQ(field_of_view(image)->vertical, 0);
  image.set_metadata("vertical_fov", std::string("30.5"));  // as PNG and TIFF keep it
  EXPECT_EQ(field_of_view(image)->vertical, 30.5f);
  image.set_metadata("horizontal_fov", std::string("wide"));
  EXPECT_FALSE(field_of_view(image));
  image.set_metadata("horizontal_fov", -3.0);
  EXPECT_FALSE(field_of_view(image));
}

TEST(FieldOfView, is_checked) {
  const Image image(2, 2, {"R", "G", "B"});
  const auto refuses = [&](FieldOfView view, const char* part) {
    expect_input_error([&] { tone_map(image, *make_tone_operator("srgb"), "", view); }, part);
  };
  refuses({180, 0}, "horizontal");
  refuses({0, 0}, "horizontal");
  refuses({50, not_a_number}, "vertical");
}

TEST(Foveal, cells_are_one_degree) {
  const Image image = grey_image(400, 200, [](int, int) { return 1.0f; });
  const auto count = [&](FieldOfView view) {
    return foveal_means(Picture(image, "", view)).cells.size();
  };
  // 2 tan 25° / 2 tan 0.5° = 53.4; half as many rows.
  EXPECT_EQ(count({50, 0}), 53u * 27u);
  EXPECT_EQ(count({50, 50}), 53u * 53u);
  EXPECT_EQ(count({0.5f, 0.1f}), 1u);
}

TEST(Foveal, values_are_means) {
  const Image image = grey_image(100, 100, [](int x, int) { return x % 2 ? 3.0f : 1.0f; });
  const Grid<Vec3f> means = foveal_means(Picture(image, "", {1, 1}));
  ASSERT_EQ(means.cells.size(), 1u);
  EXPECT_NEAR(means.cells[0].x, 2, 1e-4);
}

TEST(Histogram, two_values_far_apart_both_show) {
  const Image image = grey_image(60, 60, [](int x, int) { return x < 30 ? 1e-3f : 1e3f; });
  const Image shown = shown_by(image);
  expect_displayable(shown);
  EXPECT_LT(shown.at(5, 5, 0), 0.05f);
  EXPECT_GT(shown.at(55, 5, 0), 0.9f);
}

TEST(Histogram, equal_pixels_and_black_images) {
  for (const float value : {1e-6f, 0.5f, 1e6f}) {
    // The middle of the display, 10 cd/m², over its black of 1 and below its white of 100.
    const Image shown = shown_by(grey_image(8, 8, [=](int, int) { return value; }));
    for (const float result : shown.channel(0)) EXPECT_NEAR(result, 9 / 99.0, 1e-4);
  }
  const Image black = shown_by(grey_image(8, 8, [](int, int) { return 0.0f; }));
  for (int c = 0; c < 3; ++c)
    for (const float result : black.channel(c)) EXPECT_EQ(result, 0);
}

TEST(Histogram, the_displays_black_can_be_given_as_such) {
  const Image image = testing::test_picture(60, 60, 5);
  const Image by_range = shown_by(image, "histogram", {"display_maximum=80", "display_range=40"});
  const Image by_black = shown_by(image, "histogram", {"display_maximum=80", "display_minimum=2"});
  for (size_t i = 0; i < image.pixel_count(); ++i)
    ASSERT_NEAR(by_range.channel(0)[i], by_black.channel(0)[i], 1e-5);
}

TEST(Histogram, each_model_changes_a_dark_picture_and_human_is_all_four) {
  Image image(120, 120, {"R", "G", "B"});
  for (int y = 0; y < 120; ++y)
    for (int x = 0; x < 120; ++x) {
      const float level = (x > 100 ? 30.0f : 1e-4f) * (1 + 0.5f * float((x + y) % 2));
      for (int c = 0; c < 3; ++c) image.at(x, y, c) = level / float(1 + c);
    }
  image.set_metadata("horizontal_fov", 4.0);
  const Image plain = shown_by(image);
  const auto difference = [&](const Image& a, const Image& b) {
    double sum = 0;
    for (size_t i = 0; i < a.pixel_count(); ++i)
      sum += std::fabs(double(a.channel(0)[i]) - double(b.channel(0)[i]));
    return sum / double(a.pixel_count());
  };
  const char* models[] = {"contrast_sensitivity=true", "glare=true", "acuity=true",
                          "color_sensitivity=true"};
  for (const char* model : models)
    EXPECT_GT(difference(shown_by(image, "histogram", {model}), plain), 1e-4) << model;
  EXPECT_EQ(difference(shown_by(image, "histogram", {"human=true"}),
                       shown_by(image, "histogram", {std::begin(models), std::end(models)})),
            0);
  EXPECT_GT(difference(shown_by(image, "histogram", {"human=true", "glare=false"}),
                       shown_by(image, "histogram", {"human=true"})),
            1e-3);
}

TEST(Histogram, bad_pixels_do_not_poison_the_others) {
  const Image clean = testing::test_picture(60, 60, 5);
  Image dirty = clean;
  dirty.at(10, 40, 0) = not_a_number;
  dirty.at(20, 40, 1) = infinity;
  dirty.at(30, 40, 2) = -infinity;
  const Image wanted = shown_by(clean), shown = shown_by(dirty);
  expect_displayable(shown);
  for (int c = 0; c < 3; ++c) {
    EXPECT_EQ(shown.at(10, 40, c), 0);
    EXPECT_EQ(shown.at(20, 40, c), 1);
    EXPECT_EQ(shown.at(30, 40, c), 0);
    for (int x = 0; x < 60; ++x)
      if (x % 10 != 0) {
        EXPECT_NEAR(shown.at(x, 40, c), wanted.at(x, 40, c), 0.02);
      }
  }
}

TEST(Histogram, scale_of_the_scene_does_not_matter) {
  const Image image = testing::test_picture(60, 60, 5);
  Image scaled = image;
  for (int c = 0; c < 3; ++c)
    for (float& value : scaled.channel(c)) value *= 0x1p-20f;
  const Image a = shown_by(image), b = shown_by(scaled);
  for (size_t i = 0; i < image.pixel_count(); ++i)
    ASSERT_NEAR(a.channel(1)[i], b.channel(1)[i], 2e-3);
}

TEST(ToneMapping, counts_what_cannot_be_shown) {
  Image image(5, 1, {"R", "G", "B"});
  image.at(0, 0, 1) = not_a_number;
  image.at(1, 0, 1) = infinity;
  image.at(2, 0, 1) = -infinity;
  image.at(3, 0, 1) = -1;
  const BadPixels bad = count_bad_pixels(rgb_view(image));
  EXPECT_EQ(bad.not_a_number, 1u);
  EXPECT_EQ(bad.infinite, 2u);
  EXPECT_EQ(bad.negative, 1u);
}

TEST(SrgbBytes, rounds_to_nearest) {
  Image image(3, 1, {"R", "G", "B"});
  image.at(1, 0, 0) = 1;
  image.at(1, 0, 1) = linear_from_srgb(100.4f / 255);
  image.at(1, 0, 2) = linear_from_srgb(100.6f / 255);
  image.at(2, 0, 0) = not_a_number;
  image.at(2, 0, 1) = 7;
  image.at(2, 0, 2) = -7;
  EXPECT_EQ(srgb_bytes(image), (std::vector<uint8_t>{0, 0, 0, 255, 100, 101, 0, 255, 0}));
}

}  // namespace
}  // namespace kaustik
