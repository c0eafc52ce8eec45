#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kaustik/base/file.h"
#include "kaustik/base/photometric_units.h"
#include "kaustik/image/photometry.h"
#include "kaustik/image/picture_reader.h"
#include "kaustik/light/intensity_table.h"
#include "kaustik/light/light_kinds.h"
#include "kaustik/light/measured_light.h"
#include "kaustik/light/photometric_file.h"
#include "kaustik/light/picture_around.h"

namespace kaustik {
namespace {

/// What the arguments alone come to: intensities, and what their file says.
struct Goniogram {
  /// In W/sr, or those of a picture as they are. `axes`: see GoniometricLight.
  Goniogram(IntensityTable intensities, Frame axes_of_table)
      : table(std::move(intensities)), sampler(table), axes(axes_of_table) {}

  IntensityTable table;
  IntensitySampler sampler;
  Frame axes;
  std::string report;
  std::vector<std::string> remarks;
};

/// Shines from a point as a goniometer has measured it.
class GoniometricLight final : public PlacedLight, public MeasuredLight {
 public:
  /// `factor`: on the table. `axes`, in the world: x where its turn is 0, y where it is a quarter,
  /// z its axis.
  GoniometricLight(std::shared_ptr<const Goniogram> goniogram, const SpectralValue& factor,
                   const Vec3f& position, const Frame& axes,
                   const ClassicalAttenuation& attenuation)
      : goniogram_(std::move(goniogram)),
        factor_(factor),
        point_(free_point(position)),
        axes_(axes) {
    traits_.is_delta = true;
    traits_.power = factor_.rgb() * float(goniogram_->table.integral());
    traits_.bounds = bounds_at(position);
    traits_.attenuation = attenuation;
  }

  const std::string& report() const override { return goniogram_->report; }
  const std::vector<std::string>& remarks() const override { return goniogram_->remarks; }

  float expected_irradiance(const LightQuery& query) const override {
    const LightSample at = toward_point(point_, query.reference);
    if (!at.delta) return 0;
    return factor_.rgb().sum() * value_toward(-at.direction) / sqr(at.distance) *
           receiver_cosine(query, at.direction);
  }

  LightSample sample_toward(const LightQuery& query, const Vec2f&) const override {
    LightSample result = toward_point(point_, query.reference);
    if (!result.delta) return result;
    const float value = value_toward(-result.direction);
    if (!(value > 0)) return result;
    result.radiance = factor_.at(query.wavelengths) * (value / sqr(result.distance));
    result.pdf_solid_angle = 1;
    return result;
  }

  float pdf_toward(const LightQuery&, const LightTarget&) const override { return 0; }

  Spectrum emitted(const SurfacePoint&, const Vec3f& direction,
                   const Wavelengths& wavelengths) const override {
    return factor_.at(wavelengths) * value_toward(direction);
  }
  EmissionSample sample_emission(const Vec2f&, const Vec2f& u_direction,
                                 const Wavelengths& wavelengths) const override {
    EmissionSample result = sample_origin({});
    result.direction = direction_at(goniogram_->sampler.sample(u_direction));
    // Beside a node rounding may lead to another cell, for whoever asks later, too.
    result.pdf_direction = emission_pdf_direction(result.point, result.direction);
    if (result.pdf_direction > 0)
      result.flux =
          emitted(result.point, result.direction, wavelengths) * (1.0f / result.pdf_direction);
    return result;
  }
  float emission_pdf_position(const SurfacePoint&) const override { return 1; }
  float emission_pdf_direction(const SurfacePoint&, const Vec3f& direction) const override {
    return goniogram_->sampler.pdf(place_of(direction));
  }

  EmissionSample sample_origin(const Vec2f&) const override {
    EmissionSample result;
    result.point = point_;
    result.pdf_position = 1;
    return result;
  }

 private:
  LatLong place_of(const Vec3f& direction) const {
    const Vec3d d(axes_.to_local(direction));
    const double turn = std::atan2(d.y, d.x) / (2 * std::numbers::pi);
    // As exact beside the axis as across it.
    return {turn < 0 ? turn + 1 : turn, std::cos(std::atan2(std::hypot(d.x, d.y), d.z))};
  }
  Vec3f direction_at(const LatLong& at) const {
    const double sine = std::sqrt(std::max(0.0, 1 - at.height * at.height));
    const double phi = 2 * std::numbers::pi * at.turn;
    return normalize(axes_.to_world(
        {float(sine * std::cos(phi)), float(sine * std::sin(phi)), float(at.height)}));
  }
  float value_toward(const Vec3f& direction) const {
    return goniogram_->table.value(place_of(direction));
  }
  /// The cone about the axis, or about its opposite, whichever is narrower.
  LightBounds bounds_at(const Vec3f& position) const {
    LightBounds bounds;
    bounds.position.extendBy(position);
    const auto [first_lit, last] = goniogram_->table.lit_angles();
    const double first = std::max(0.0, first_lit - IntensitySampler::widest_step);
    const bool is_upward = std::numbers::pi - first < last;
    constexpr double slack = 1e-4;
    const double angle = (is_upward ? std::numbers::pi - first : last) + slack;
    bounds.axis = is_upward ? -axes_.z : axes_.z;
    bounds.cos_angle = bounds.cos_spread = float(std::cos(std::min(angle, std::numbers::pi)));
    return bounds;
  }

  std::shared_ptr<const Goniogram> goniogram_;
  SpectralValue factor_;
  SurfacePoint point_;  ///< without a normal
  Frame axes_;
};

// ---- from files ----

/// Larger files are none of a luminaire.
constexpr size_t most_bytes = size_t{64} << 20;

/// In the light's own space the photometric zero is +z, C 0 is −x and C 90 is +y: seen by a lookat
/// whose target is the floor, C goes from the right over the up vector, as it should from above.
Frame axes_of_luminaires() {
  Frame axes;
  axes.x = {-1, 0, 0};
  axes.y = {0, 1, 0};
  axes.z = {0, 0, 1};
  return axes;
}
/// Of pictures as 'envmap' places them: their upper edge is +y, their left one −z, +x a quarter
/// from there.
Frame axes_of_pictures() {
  Frame axes;
  axes.x = {0, 0, -1};
  axes.y = {1, 0, 0};
  axes.z = {0, 1, 0};
  return axes;
}

std::shared_ptr<const Goniogram> goniogram_of_text(std::string_view text, const std::string& name) {
  Photometry file = read_photometry(text, name);
  const double lumens = file.candelas.integral();
  const float most = file.candelas.maximum();
  const LatLong brightest = file.candelas.brightest();
  auto goniogram = std::make_shared<Goniogram>(
      file.candelas.times(float(1 / lumens_per_watt_white)), axes_of_luminaires());
  goniogram->report = fmt::format(
      "{:.5g} lm in its file, at most {:.5g} cd, toward C {:.4g}°, γ {:.4g}° ({})", lumens, most,
      360 * brightest.turn, std::acos(brightest.height) * 180 / std::numbers::pi, file.facts);
  for (const std::string& remark : file.remarks)
    goniogram->remarks.push_back(fmt::format("'{}': {}", name, remark));
  return goniogram;
}

std::shared_ptr<const Goniogram> goniogram_of_picture(const LightInputs& inputs) {
  PictureReader own_reader;
  PictureReader& pictures = inputs.pictures ? *inputs.pictures : own_reader;
  // A float, and a number of its distribution.
  constexpr int64_t bytes_per_pixel = 24;
  const Image image = picture_around(inputs.arguments, pictures, bytes_per_pixel, 0);
  const int width = image.width(), rows = std::max(image.height(), 2);
  const RgbView pixels = rgb_view(image);
  std::vector<double> turns, angles;
  std::vector<float> values;
  for (int x = 0; x < width; ++x) turns.push_back((x + 0.5) / width);
  for (int y = 0; y < rows; ++y) {
    angles.push_back(std::numbers::pi * y / (rows - 1));
    const size_t row = size_t(std::min(y, image.height() - 1)) * size_t(width);
    for (int x = 0; x < width; ++x) values.push_back(photopic(pixels[row + size_t(x)]));
  }
  return std::make_shared<Goniogram>(
      IntensityTable(std::move(turns), std::move(angles), std::move(values)), axes_of_pictures());
}

std::shared_ptr<const Goniogram> read_goniogram(const LightInputs& inputs) {
  const Arguments& arguments = inputs.arguments;
  if (arguments.given("profile")) return goniogram_of_text(arguments.text("profile"), "profile");
  if (arguments.array("data")) return goniogram_of_picture(inputs);
  const std::string& path = arguments.text("filename");
  const std::vector<uint8_t> bytes = read_file_start(path, most_bytes + 1);
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  constexpr size_t head = 8192;
  if (!is_photometry(path, text.substr(0, head))) return goniogram_of_picture(inputs);
  if (bytes.size() > most_bytes)
    throw Error(ErrorKind::input, fmt::format("'{}' has more than 64 MiB", path),
                "name the file of a luminaire", arguments.place_of("filename"));
  return goniogram_of_text(text, path);
}

/// What the table is multiplied by.
SpectralValue factor_of(const LightInputs& inputs, const Goniogram& goniogram) {
  const Arguments& arguments = inputs.arguments;
  const SpectralValue tint = emission_argument(inputs, "intensity");
  const auto scale = float(arguments.number("scale"));
  if (!arguments.given("power")) return tint * scale;
  const Spectrum rgb = tint.rgb();
  const double power_of_one =
      goniogram.table.integral() * double(photopic({rgb[0], rgb[1], rgb[2]}));
  if (!(power_of_one > 0)) return tint * scale;
  return tint * float(double(scale) * arguments.number("power") / power_of_one);
}

std::unique_ptr<Light> create_goniometric(const LightInputs& inputs) {
  const Arguments& arguments = inputs.arguments;
  const Transform& to_world = emitter_transform(inputs);
  if (!keeps_angles(to_world))
    throw Error(ErrorKind::input, "'to_world' distorts the directions of this light",
                "leave out shear and scaling by unequal factors", arguments.place_of("to_world"));
  const auto goniogram = shared_tables<Goniogram>(inputs, [&] { return read_goniogram(inputs); });
  if (!(goniogram->table.integral() > 0))
    throw Error(ErrorKind::input, "the file of this light is dark: it would light nothing",
                "give one with some light in it, or remove the emitter",
                arguments.place_of(arguments.given("profile") ? "profile" : "filename"));
  const Frame world = axes_of(to_world);
  Frame axes;
  axes.x = world.to_world(goniogram->axes.x);
  axes.y = world.to_world(goniogram->axes.y);
  axes.z = world.to_world(goniogram->axes.z);
  const Vec3f position = to_world.point({0, 0, 0});
  return with_finite_power(
      std::make_unique<GoniometricLight>(goniogram, factor_of(inputs, *goniogram), position, axes,
                                         ClassicalAttenuation(arguments, position)),
      inputs);
}

}  // namespace

LightType goniometric_light_type() {
  static const TypeInfo info{
      "emitter", "goniometric",
      "Light from a point as it was measured: a luminaire by its IES or EULUMDAT file, or a "
      "picture of intensities.",
      picture_parameters(
          " of intensities in W/sr; or the IES (.ies) or EULUMDAT (.ldt) file of a luminaire.",
          {text_parameter("profile", "", "The text of an IES or EULUMDAT file.")
               .instead_of("filename"),
           color_parameter("intensity", 1, "Factor on the intensities of the file; its colour."),
           number_parameter("scale", 1, "Another factor.").range(0, 1e30),
           optional(number_parameter("power", 1,
                                     "Power of all its light, instead of that of the file; 1 W of "
                                     "white is 179 lm."))
               .range(0, 1e30)
               .in("W"),
           projection_parameter(),
           to_world_parameter("Transform from the light's space to the world. Luminaires shine "
                              "along +z, C 0 is −x and C 90 is +y; of pictures the upper edge is "
                              "+y."),
           attenuation_parameter(), ignored_sampling_weight()})};
  return {info, false, create_goniometric};
}

}  // namespace kaustik
