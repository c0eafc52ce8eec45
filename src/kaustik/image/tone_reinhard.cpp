// "reinhard": the photographic operator of Reinhard, Stark, Shirley and Ferwerda 2002.

#include "kaustik/base/parallel.h"
#include "kaustik/image/photometry.h"
#include "kaustik/image/tone_operators.h"

namespace kaustik {
namespace {

using Plane = Grid<float>;

/// The weights of a Gaussian exp(−x²/r²) from its middle outward; their sum over both sides is 1.
std::vector<float> gaussian(float r) {
  std::vector<float> weights;
  double sum = 0;
  for (int i = 0; float(i) <= 2.5f * r; ++i) {
    weights.push_back(std::exp(-sqr(float(i) / r)));
    sum += (i == 0 ? 1 : 2) * double(weights.back());
  }
  for (float& weight : weights) weight = float(weight / sum);
  return weights;
}

/// Convolution with the Gaussian of the paper's equation for R_i, whose r is α s; borders are
/// continued by their outermost pixels.
Plane blurred(const Plane& plane, float r) {
  const std::vector<float> weights = gaussian(r);
  const int reach = int(weights.size()) - 1;
  Plane rows = plane, result = plane;
  constexpr size_t lines_per_block = 8;
  const auto pass = [&](const Plane& from, Plane& to, int dx, int dy) {
    parallel_blocks(size_t(from.rows), lines_per_block, [&](size_t begin, size_t end, size_t) {
      for (int y = int(begin); y < int(end); ++y)
        for (int x = 0; x < from.columns; ++x) {
          float sum = 0;
          for (int i = -reach; i <= reach; ++i)
            sum +=
                weights[size_t(std::abs(i))] * from.at(std::clamp(x + i * dx, 0, from.columns - 1),
                                                       std::clamp(y + i * dy, 0, from.rows - 1));
          to.at(x, y) = sum;
        }
    });
  };
  pass(plane, rows, 1, 0);
  pass(rows, result, 0, 1);
  return result;
}

class Reinhard : public ToneOperator {
 public:
  explicit Reinhard(const Arguments& arguments)
      : key_(float(arguments.number("key"))),
        is_local_(arguments.boolean("local")),
        sharpening_(float(arguments.number("sharpening"))) {
    const auto white = arguments.number_or_name("white");
    if (const double* value = std::get_if<double>(&white)) white_ = float(*value);
  }

  std::vector<Vec3f> displayed(Picture picture) const override {
    const double to_key = double(key_) / geometric_mean(picture);
    const Plane scaled = scaled_luminance(picture, to_key);
    const float white =
        white_ > 0 ? white_ : *std::max_element(scaled.cells.begin(), scaled.cells.end());
    const Plane surround = is_local_ ? local_average(scaled) : scaled;
    for (size_t i = 0; i < picture.pixels.size(); ++i)
      show(picture.pixels[i], scaled.cells[i], surround.cells[i], white);
    for (Vec3f& colour : picture.parts) {
      const auto l = float(std::max(0.0, to_key * double(photopic(colour))));
      show(colour, l, l, white);
    }
    return with_parts(std::move(picture));
  }

 private:
  /// `l`: luminance on the key's scale, as `white` and `surround`.
  static void show(Vec3f& colour, float l, float surround, float white) {
    if (!(l > 0)) {
      colour = Vec3f(0);
      return;
    }
    const float y = photopic(colour), shown = l * (1 + l / sqr(white)) / (1 + surround);
    colour *= shown / y;
  }

  static double geometric_mean(const Picture& picture) {
    double sum = 0;
    size_t count = 0;
    for (const Vec3f& colour : picture.pixels)
      if (const float y = photopic(colour); y > 0) {
        sum += std::log(double(y));
        ++count;
      }
    return count > 0 ? std::exp(sum / double(count)) : 1;
  }

  /// Luminance with its geometric mean brought to the key.
  static Plane scaled_luminance(const Picture& picture, double to_key) {
    Plane plane{picture.width, picture.height, {}};
    plane.cells.reserve(picture.pixels.size());
    for (const Vec3f& colour : picture.pixels)
      plane.cells.push_back(float(std::max(0.0, to_key * double(photopic(colour)))));
    return plane;
  }

  /// The mean luminance around each pixel, over the largest of eight scales across which the
  /// surroundings do not change much ("dodging and burning").
  Plane local_average(const Plane& scaled) const {
    constexpr int scales = 8;
    constexpr float ratio = 1.6f, threshold = 0.05f;
    constexpr float first_radius = 0.35355339f;  // 1/(2√2), of the centre at scale 1
    Plane centre = blurred(scaled, first_radius), result = centre;
    std::vector<bool> is_settled(scaled.cells.size(), false);
    float s = 1;
    for (int i = 0; i < scales; ++i, s *= ratio) {
      // The surround of a scale is the centre of the next.
      Plane surround = blurred(scaled, first_radius * s * ratio);
      const float floor = std::exp2(sharpening_) * key_ / sqr(s);
      for (size_t p = 0; p < scaled.cells.size(); ++p) {
        if (is_settled[p]) continue;
        const float activity =
            std::fabs(centre.cells[p] - surround.cells[p]) / (floor + centre.cells[p]);
        if (activity < threshold)
          result.cells[p] = centre.cells[p];
        else
          is_settled[p] = true;
      }
      centre = std::move(surround);
    }
    return result;
  }

  float key_;
  float white_ = 0;  ///< 0: the brightest pixel
  bool is_local_;
  float sharpening_;
};

}  // namespace

ToneOperatorType reinhard_tone() {
  return {
      {"tonemap",
       "reinhard",
       "The photographic operator of Reinhard et al. (2002): a film-like curve, optionally with "
       "dodging and burning.",
       {number_parameter("key", 0.18, "Display value of the mean luminance (mean of logarithms).")
            .range(1e-6, 1e6),
        number_or_name_parameter(
            "white", std::string("auto"), {"auto"},
            "Luminance that becomes white, on the key's scale; auto: the brightest pixel.")
            .range(1e-6, 1e30),
        boolean_parameter(
            "local", false,
            "Dodging and burning: adapts each pixel to the region of similar luminance around it."),
        number_parameter("sharpening", 8, "Strength of dodging and burning (the paper's φ).")
            .range(0, 20)}},
      [](const Arguments& arguments) -> std::unique_ptr<ToneOperator> {
        return std::make_unique<Reinhard>(arguments);
      }};
}

}  // namespace kaustik
