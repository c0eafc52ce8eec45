#include "kaustik/base/to_integer.h"
#include "kaustik/image/photometry.h"
#include "kaustik/image/picture_reader.h"
#include "kaustik/light/environment_light.h"
#include "kaustik/light/irradiance_harmonics.h"
#include "kaustik/light/latlong_distribution.h"
#include "kaustik/light/picture_around.h"

namespace kaustik {
namespace {

/// A picture around the scene in latitude and longitude, as Mitsuba 3 places it: +y is its upper
/// edge, whose pixels are all one direction, −z its left and right border, +x a quarter from the
/// left. Bilinear between the centres of columns and between rows. RGB.
class PictureSphere {
 public:
  explicit PictureSphere(const Image& image)
      : width_(image.width()), rows_(std::max(image.height(), 2)) {
    const RgbView pixels = rgb_view(image);
    texels_.reserve(size_t(width_) * size_t(rows_));
    for (int y = 0; y < rows_; ++y)
      for (int x = 0; x < width_; ++x) {
        const int row = std::min(y, image.height() - 1);
        const Vec3f c = pixels[size_t(row) * size_t(width_) + size_t(x)];
        texels_.push_back(spectrum_from_rgb(c.x, c.y, c.z));
      }
  }

  int width() const { return width_; }
  int rows() const { return rows_; }
  const Spectrum& texel(int column, int row) const {
    return texels_[size_t(row) * size_t(width_) + size_t(column)];
  }
  Spectrum eval(const LatLong& at) const {
    const double x = at.turn * width_ - 0.5, left = std::floor(x);
    const double y = std::acos(std::clamp(at.height, -1.0, 1.0)) / std::numbers::pi * (rows_ - 1);
    const int row = to_integer(y, 0, rows_ - 2);
    const int column = left < 0 ? width_ - 1 : to_integer(left, 0, width_ - 1);
    const int next = column + 1 < width_ ? column + 1 : 0;
    const float s = float(x - left), t = float(y - row);
    const Spectrum upper = texel(column, row) * (1 - s) + texel(next, row) * s;
    const Spectrum lower = texel(column, row + 1) * (1 - s) + texel(next, row + 1) * s;
    return upper * (1 - t) + lower * t;
  }
  /// The nodes of a grid, those of the picture among them and at least some dozens across:
  /// `visit` gets the radiance there, the direction, and the solid angle that it stands for.
  template <typename Visit>
  void for_each_node(const Visit& visit) const {
    const int columns = width_ * (width_ < 32 ? 32 / width_ | 1 : 1);
    const int rows = (rows_ - 1) * (rows_ < 17 ? 16 / (rows_ - 1) : 1) + 1;
    for (int row = 0; row < rows; ++row) {
      const double solid_angle = node_solid_angle(row, rows) / columns;
      for (int column = 0; column < columns; ++column) {
        const LatLong at{(column + 0.5) / columns, std::cos(std::numbers::pi * row / (rows - 1))};
        visit(eval(at), direction_of(at), solid_angle);
      }
    }
  }
  static LatLong place_of(const Vec3f& local) {
    const double turn = std::atan2(double(local.x), -double(local.z)) / (2 * std::numbers::pi);
    return {turn < 0 ? turn + 1 : turn, double(local.y)};
  }
  static Vec3f direction_of(const LatLong& at) {
    const double sine = std::sqrt(std::max(0.0, 1 - at.height * at.height));
    const double phi = 2 * std::numbers::pi * at.turn;
    return {float(sine * std::sin(phi)), float(at.height), float(-sine * std::cos(phi))};
  }

 private:
  /// ∫ (1 − |θ − angle|/step) sinθ dθ over the sphere: all nodes of a row together, sr. What is
  /// bilinear between the nodes has exactly the integral of the nodes by their solid angles.
  static double node_solid_angle(int row, int rows) {
    const double step = std::numbers::pi / (rows - 1), angle = step * row;
    double sum = 0;
    if (row > 0) sum += (std::sin(angle) - std::sin(angle - step)) / step - std::cos(angle);
    if (row + 1 < rows) sum += std::cos(angle) - (std::sin(angle + step) - std::sin(angle)) / step;
    return 2 * std::numbers::pi * sum;
  }

  int width_, rows_;
  std::vector<Spectrum> texels_;
};

LatLongDistribution distribution_of(const PictureSphere& picture) {
  std::vector<float> values;
  values.reserve(size_t(picture.width()) * size_t(picture.rows()));
  for (int row = 0; row < picture.rows(); ++row)
    for (int column = 0; column < picture.width(); ++column) {
      const Spectrum& c = picture.texel(column, row);
      values.push_back(photopic({c[0], c[1], c[2]}));
    }
  return {picture.width(), std::move(values), std::numbers::pi};
}

/// What the picture and its scale come to, whatever the scene.
struct EnvmapTables {
  EnvmapTables(const Image& image, float scale)
      : picture(image), distribution(distribution_of(picture)) {
    picture.for_each_node([&](const Spectrum& radiance, const Vec3f& local, double solid_angle) {
      const Spectrum weighted = radiance * (scale * float(solid_angle));
      for (size_t lane = 0; lane < 4; ++lane) fluence[lane] += double(weighted[int(lane)]);
      harmonics.add(local, double(weighted.sum()));
    });
  }

  PictureSphere picture;
  LatLongDistribution distribution;
  IrradianceHarmonics harmonics;
  std::array<double, 4> fluence{};
};

class EnvmapLight final : public EnvironmentLight {
 public:
  EnvmapLight(std::shared_ptr<const EnvmapTables> tables, float scale, const Transform& to_world,
              const EmissionDisk& disk)
      : EnvironmentLight(disk),
        tables_(std::move(tables)),
        scale_(scale),
        to_world_(to_world),
        to_local_(to_world.inverse()) {
    const std::array<double, 4>& f = tables_->fluence;
    set_fluence({float(f[0]), float(f[1]), float(f[2]), float(f[3])});
  }

  /// False for a black picture.
  bool shines() const { return tables_->distribution.integral() > 0; }

  Spectrum background(const Vec3f& direction, const Wavelengths& wavelengths) const override {
    return lanes_from_emission(tables_->picture.eval(place_of(direction)) * scale_, wavelengths);
  }
  float expected_irradiance(const LightQuery& query) const override {
    if (query.normal == Vec3f(0, 0, 0)) return tables_->harmonics.irradiance(query.normal);
    return tables_->harmonics.irradiance(normalize(to_local_.vector(query.normal)));
  }

 private:
  Vec3f sample_direction(const Vec2f& u, Purpose) const override {
    return normalize(
        to_world_.vector(PictureSphere::direction_of(tables_->distribution.sample(u))));
  }
  float direction_pdf(const Vec3f& direction, Purpose) const override {
    return tables_->distribution.pdf(place_of(direction));
  }
  LatLong place_of(const Vec3f& direction) const {
    return PictureSphere::place_of(normalize(to_local_.vector(direction)));
  }

  std::shared_ptr<const EnvmapTables> tables_;
  float scale_;
  Transform to_world_, to_local_;
};

/// A texel of four floats and the numbers of its distribution.
constexpr int64_t bytes_per_pixel = 32;

std::unique_ptr<Light> create_envmap(const LightInputs& inputs) {
  const Arguments& arguments = inputs.arguments;
  const Transform& to_world = emitter_transform(inputs);
  if (!keeps_angles(to_world))
    throw Error(ErrorKind::input, "'to_world' distorts this environment",
                "leave out shear and scaling by unequal factors", arguments.place_of("to_world"));
  PictureReader own_reader;
  PictureReader& pictures = inputs.pictures ? *inputs.pictures : own_reader;
  const auto scale = float(arguments.number("scale"));
  const auto tables = shared_tables<EnvmapTables>(inputs, [&] {
    return std::make_shared<EnvmapTables>(
        picture_around(arguments, pictures, bytes_per_pixel, gamma_of(arguments)), scale);
  });
  auto light =
      std::make_unique<EnvmapLight>(tables, scale, to_world, EmissionDisk(inputs.scene_bounds));
  if (!light->shines())
    throw Error(ErrorKind::input, picture_name(arguments) + " is black: it would light nothing",
                "give a picture with some light in it, or remove the emitter",
                picture_place(arguments));
  return with_finite_power(std::move(light), inputs);
}

}  // namespace

LightType envmap_light_type() {
  static const TypeInfo info{
      "emitter", "envmap", "A picture of the light around the scene, in latitude and longitude.",
      picture_parameters(
          ": radiance.",
          {number_parameter("scale", 1, "Factor on the radiance.").range(0, 1e30),
           gamma_parameter(),
           to_world_parameter(
               "Transform from the picture's space to the world. The upper edge is +y."),
           projection_parameter(), visible_parameter(),
           ignored_parameter("mis_compensation", ParameterKind::boolean),
           ignored_parameter("cache", ParameterKind::boolean), ignored_sampling_weight()})};
  return {info, false, create_envmap};
}

}  // namespace kaustik
