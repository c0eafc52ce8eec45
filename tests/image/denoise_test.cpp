#include "kaustik/image/denoise.h"

#include <cmath>
#include <limits>
#include <random>

#include "kaustik/base/parallel.h"
#include "tests/image/support.h"

namespace kaustik {
namespace {

using testing::expect_input_error;

constexpr int size = 96;

/// What a renderer knows of one pixel.
struct Pixel {
  float albedo = 0.5f;
  Vec3f normal{0, 0, 1};
  float depth = 2;
  float irradiance = 1;  ///< photons and lamps bring it; scattered light is albedo × this
  float mirrored = 0;
  float emitted = 0;
};

/// A rendered picture whose scattered light, and what surfaces mirror, has Gaussian noise of the
/// given relative deviation.
Image rendered(float noise, const std::function<Pixel(int x, int y)>& scene,
               bool knows_noise = true) {
  Image image(size, size,
              {"R", "G", "B", "direct.R", "direct.G", "direct.B", "specular.R", "specular.G",
               "specular.B", "emission.R", "emission.G", "emission.B", "albedo.R", "albedo.G",
               "albedo.B", "N.X", "N.Y", "N.Z", "depth.Z"});
  const int noise_channel = image.channel_count();
  if (knows_noise)
    for (const char* name : {"noise.scattered", "noise.mirrored"}) image.add_channel(name);
  std::mt19937 generator(1);
  std::normal_distribution<float> normal;
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      const Pixel p = scene(x, y);
      const float clean = p.albedo * p.irradiance;
      const float scattered = clean * (1 + noise * normal(generator));
      const float mirrored = p.mirrored * (1 + noise * normal(generator));
      for (int k = 0; k < 3; ++k) {
        image.at(x, y, k) = scattered + mirrored + p.emitted;
        image.at(x, y, 3 + k) = scattered;
        image.at(x, y, 6 + k) = mirrored;
        image.at(x, y, 9 + k) = p.emitted;
        image.at(x, y, 12 + k) = p.albedo;
        image.at(x, y, 15 + k) = p.normal[k];
      }
      image.at(x, y, 18) = p.depth;
      if (knows_noise) {
        image.at(x, y, noise_channel) = clean * noise;
        image.at(x, y, noise_channel + 1) = p.mirrored * noise;
      }
    }
  return image;
}

struct Moments {
  double mean = 0, deviation = 0;
};
/// Of red, over the columns from x0 to x1.
Moments moments(const Image& image, int x0, int x1) {
  double sum = 0, squares = 0, n = 0;
  for (int y = 0; y < size; ++y)
    for (int x = x0; x < x1; ++x, ++n) {
      sum += double(image.at(x, y, 0));
      squares += double(image.at(x, y, 0)) * double(image.at(x, y, 0));
    }
  return {sum / n, std::sqrt(std::max(0.0, squares / n - sum * sum / n / n))};
}

TEST(Denoise, noise_on_a_wall_falls_to_a_tenth_and_the_mean_stays) {
  const auto wall = [](int, int) { return Pixel(); };
  for (const bool knows_noise : {true, false}) {
    const Image noisy = rendered(0.2f, wall, knows_noise);
    const Image clean = denoise(noisy);
    const Moments before = moments(noisy, 0, size), after = moments(clean, 0, size);
    EXPECT_NEAR(before.deviation, 0.1, 0.005);
    EXPECT_LT(after.deviation, 0.1 * before.deviation) << knows_noise;
    // The average is over the same pixels, so it may move by a fraction of its standard error.
    EXPECT_NEAR(after.mean, before.mean, 0.1 / size) << knows_noise;
  }
}

TEST(Denoise, what_surfaces_mirror_is_smoothed_apart_and_not_divided) {
  // A texture beneath a reflection, then one in it: albedo tells of the former alone.
  const auto scene = [](int x, int y) {
    Pixel p;
    p.albedo = (x / 8 + y / 8) % 2 ? 0.1f : 0.8f;
    p.mirrored = 2;
    return p;
  };
  const Image noisy = rendered(0.1f, scene), clean = denoise(noisy);
  double before = 0, after = 0;
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      const double truth = double(scene(x, y).albedo) + 2;
      before += std::pow(double(noisy.at(x, y, 0)) - truth, 2) / (size * size);
      after += std::pow(double(clean.at(x, y, 0)) - truth, 2) / (size * size);
    }
  EXPECT_NEAR(before, 0.2 * 0.2 + 0.1 * 0.1 * 0.325, 0.003);
  EXPECT_LT(after, 0.04 * before);
}

TEST(Denoise, irradiance_has_no_albedo_in_it) {
  // A picture of irradiance over a texture: the same everywhere, and so it stays.
  Image image = rendered(0.2f, [](int x, int y) {
    Pixel p;
    p.albedo = (x / 8 + y / 8) % 2 ? 0.45f : 0.55f;
    p.irradiance = 1 / p.albedo;
    return p;
  });
  const auto texture_left = [&] {
    const Image clean = denoise(image);
    double difference = 0;
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x)
        difference += ((x / 8 + y / 8) % 2 ? 1 : -1) * double(clean.at(x, y, 0)) / (size * size);
    return std::fabs(difference);
  };
  EXPECT_GT(texture_left(), 0.02);  // divided by the albedo, as radiance is
  image.set_metadata("quantity", std::string("irradiance"));
  EXPECT_LT(texture_left(), 0.01);
}

TEST(Denoise, what_has_no_noise_stays) {
  // The noise of the left half lets nothing of the right one change, told apart by brightness.
  const auto scene = [](int x, int y) {
    Pixel p;
    p.irradiance = x < size / 2 ? 100.0f : 1 + 0.5f * std::sin(float(x) * 0.3f + float(y) * 0.77f);
    p.emitted = x > 80 ? 5.0f : 0.0f;
    return p;
  };
  Image image = rendered(0, scene);
  const int noise = image.find_channel("noise.scattered");
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) image.at(x, y, noise) = x < size / 2 ? 5.0f : 0.0f;
  const Image result = denoise(image);
  for (int y = 0; y < size; ++y)
    for (int x = size / 2 + 3; x < size; ++x)
      ASSERT_NEAR(result.at(x, y, 0), image.at(x, y, 0), 1e-4f * image.at(x, y, 0))
          << x << " " << y;
}

TEST(Denoise, any_number_of_threads_gives_the_same_bits) {
  const Image noisy = rendered(0.2f, [](int x, int y) {
    Pixel p;
    p.irradiance = 1 + 0.5f * std::sin(float(x * y));
    p.mirrored = 0.3f;
    return p;
  });
  const auto by = [&](int threads) {
    Image result;
    with_threads(threads, [&] { result = denoise(noisy); });
    return result;
  };
  const Image one = by(1), three = by(3);
  for (int c = 0; c < 3; ++c) EXPECT_TRUE(std::ranges::equal(one.channel(c), three.channel(c)));
}

TEST(Denoise, textures_and_lamps_stay_sharp) {
  const auto scene = [](int x, int) {
    Pixel p;
    p.albedo = x < size / 2 ? 0.1f : 0.8f;
    p.emitted = x == 20 ? 7.0f : 0.0f;
    return p;
  };
  const Image clean = denoise(rendered(0.2f, scene));
  for (int y = 0; y < size; ++y) {
    EXPECT_NEAR(clean.at(size / 2 - 1, y, 0), 0.1f, 0.01f);
    EXPECT_NEAR(clean.at(size / 2, y, 0), 0.8f, 0.08f);
    EXPECT_NEAR(clean.at(20, y, 0), 7.1f, 0.02f);
    EXPECT_NEAR(clean.at(21, y, 0), 0.1f, 0.01f);
  }
}

TEST(Denoise, light_does_not_cross_edges_of_the_scene) {
  // Twice as bright on the right, well within the noise of a single pixel's neighbours.
  const auto corner = [](int x, int) {
    Pixel p;
    if (x >= size / 2) p = {0.5f, {1, 0, 0}, 2, 2};
    return p;
  };
  const auto step = [](int x, int) {
    Pixel p;
    if (x >= size / 2) p = {0.5f, {0, 0, 1}, 3, 2};
    return p;
  };
  const auto nothing = [](int x, int) {
    Pixel p;
    if (x >= size / 2) p.irradiance = 2;
    return p;
  };
  const auto bleeding = [](const Image& image) {
    return moments(image, size / 2 - 2, size / 2).mean / 0.5 - 1;
  };
  EXPECT_NEAR(bleeding(denoise(rendered(0.5f, corner))), 0, 0.05);
  EXPECT_NEAR(bleeding(denoise(rendered(0.5f, step))), 0, 0.05);
  // The twin: where surfaces do not tell them apart, light does cross.
  EXPECT_GT(bleeding(denoise(rendered(0.5f, nothing))), 0.1);
}

TEST(Denoise, shadows_deeper_than_the_noise_keep_their_edges) {
  const Image clean = denoise(rendered(0.1f, [](int x, int) {
    Pixel p;
    p.irradiance = x < size / 2 ? 0.05f : 1.0f;
    return p;
  }));
  EXPECT_NEAR(moments(clean, size / 2 - 4, size / 2 - 2).mean, 0.025, 0.0025);
  EXPECT_NEAR(moments(clean, size / 2 + 2, size / 2 + 4).mean, 0.5, 0.025);
}

TEST(Denoise, layers_stay_and_the_picture_is_marked) {
  const Image noisy = rendered(0.2f, [](int, int) { return Pixel(); });
  const Image clean = denoise(noisy);
  EXPECT_EQ(clean.channel_names(), noisy.channel_names());
  for (int c = 3; c < noisy.channel_count(); ++c)
    EXPECT_TRUE(std::ranges::equal(clean.channel(c), noisy.channel(c))) << noisy.channel_names()[c];
  EXPECT_NE(clean.find_metadata("denoised"), nullptr);
  EXPECT_EQ(noisy.find_metadata("denoised"), nullptr);
}

TEST(Denoise, values_that_are_not_finite_stay_where_they_are) {
  Image noisy = rendered(0.2f, [](int, int) { return Pixel(); });
  for (const char* name : {"direct.R", "R"})
    noisy.at(40, 40, noisy.find_channel(name)) = std::numeric_limits<float>::quiet_NaN();
  noisy.at(50, 50, noisy.find_channel("N.X")) = std::numeric_limits<float>::infinity();
  const Image clean = denoise(noisy);
  for (size_t i = 0; i < clean.pixel_count(); ++i)
    EXPECT_EQ(std::isfinite(clean.channel(0)[i]), i != 40 * size + 40) << i;
}

TEST(Denoise, one_pixel_and_one_row) {
  for (const auto& [width, height] : {std::pair(1, 1), std::pair(7, 1), std::pair(1, 7)}) {
    Image image(width, height,
                {"R", "G", "B", "direct.R", "direct.G", "direct.B", "albedo.R", "albedo.G",
                 "albedo.B", "N.X", "N.Y", "N.Z", "depth.Z"});
    for (int c = 0; c < image.channel_count(); ++c)
      std::fill(image.channel(c).begin(), image.channel(c).end(), 0.5f);
    EXPECT_NEAR(denoise(image).at(width - 1, height - 1, 1), 0.5f, 1e-5f);
  }
}

TEST(Denoise, odd_values_make_no_others) {
  for (const auto& [name, value] :
       {std::pair("depth.Z", -1.0f), std::pair("depth.Z", 1e38f),
        std::pair("noise.scattered", 3e38f), std::pair("noise.mirrored", -3e38f),
        std::pair("albedo.R", -1e30f)}) {
    Image image = rendered(0.2f, [](int, int) {
      Pixel p;
      p.mirrored = 1;
      return p;
    });
    const auto values = image.channel(image.find_channel(name));
    std::fill(values.begin(), values.end(), value);
    const Image clean = denoise(image);
    for (const float red : clean.channel(0)) ASSERT_TRUE(std::isfinite(red)) << name << value;
  }
}

TEST(Denoise, pictures_without_layers_are_refused) {
  EXPECT_FALSE(can_denoise(testing::test_picture(8, 8, 3)));
  expect_input_error([] { denoise(testing::test_picture(8, 8, 3)); }, "lacks the layers");
  Image image = rendered(0.2f, [](int, int) { return Pixel(); });
  EXPECT_TRUE(can_denoise(image));
  expect_input_error([&] { denoise(denoise(image)); }, "denoised before");
  // Of photons alone nothing is known of the surfaces.
  const auto depth = image.channel(image.find_channel("depth.Z"));
  std::fill(depth.begin(), depth.end(), 0.0f);
  EXPECT_FALSE(can_denoise(image));
}

}  // namespace
}  // namespace kaustik
