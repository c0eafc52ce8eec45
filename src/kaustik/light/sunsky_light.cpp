// The emitters `sunsky`, `sky` and `sun`: one light with both parts or with one of them.

#include "kaustik/light/sunsky_light.h"

#include <fmt/format.h>

#include <optional>

#include "kaustik/base/color.h"
#include "kaustik/base/daylight_units.h"
#include "kaustik/base/warp.h"
#include "kaustik/image/photometry.h"
#include "kaustik/light/clear_sky.h"
#include "kaustik/light/environment_light.h"
#include "kaustik/light/irradiance_harmonics.h"
#include "kaustik/light/latlong_distribution.h"
#include "kaustik/light/power_distribution.h"
#include "kaustik/light/sun_position.h"

namespace kaustik {
namespace {

constexpr int columns = 256, rows = 65;  // of the grid that sky directions are sampled by

double luminance_of(const Vec3f& rgb) { return double(luminance(rgb)); }

/// Radiance of a cloudless sky in linear Rec. 709, W/(sr·m²); what lies outside of its colours is
/// cut off. Frame: +z is the zenith.
class SkyRadiance {
 public:
  /// `illuminance` on the ground, lx.
  SkyRadiance(const ClearSky& sky, double illuminance) : sky_(sky) {
    double on_ground = 0;
    for_each_node([&](const Vec3f& direction, double solid_angle) {
      on_ground += luminance_of(rgb(direction)) * double(direction.z) * solid_angle;
    });
    scale_ = illuminance / on_ground;
  }

  Vec3f rgb(const Vec3f& direction) const {
    const Rgb c = rgb_from_xyz(sky_.xyz(Vec3d(direction)) * scale_);
    return {std::max(float(c.r), 0.0f), std::max(float(c.g), 0.0f), std::max(float(c.b), 0.0f)};
  }

  /// Of the grid over the upper half of the sphere: (direction, solid angle), row by row.
  template <typename Visit>
  static void for_each_node(const Visit& visit) {
    const double step = 0.5 * std::numbers::pi / (rows - 1);
    for (int r = 0; r < rows; ++r) {
      const double angle = step * r;
      const double above = std::max(0.0, angle - 0.5 * step);
      const double below = std::min(0.5 * std::numbers::pi, angle + 0.5 * step);
      const double solid_angle =
          2 * std::numbers::pi / columns * (std::cos(above) - std::cos(below));
      for (int c = 0; c < columns; ++c) {
        const double phi = 2 * std::numbers::pi * (c + 0.5) / columns;
        visit(Vec3f(float(std::sin(angle) * std::cos(phi)), float(std::sin(angle) * std::sin(phi)),
                    float(std::max(std::cos(angle), 1e-6))),
              solid_angle);
      }
    }
  }

 private:
  ClearSky sky_;
  double scale_ = 1;
};

LatLongDistribution distribution_of(const SkyRadiance& sky) {
  std::vector<float> values;
  SkyRadiance::for_each_node(
      [&](const Vec3f& direction, double) { values.push_back(luminance(sky.rgb(direction))); });
  return {columns, std::move(values), 0.5 * std::numbers::pi};
}

/// The sun as a disk of even radiance.
class SunDisk {
 public:
  /// `irradiance` on a surface that faces it, W/m²; `half_angle` in radians.
  SunDisk(const Vec3f& to_sun, const Spectrum& irradiance, double half_angle)
      : frame_(to_sun),
        irradiance_(irradiance),
        one_minus_cos_(float(2 * std::pow(std::sin(0.5 * half_angle), 2))),
        radiance_(irradiance * float(1 / (std::numbers::pi * std::pow(std::sin(half_angle), 2)))) {}

  const Vec3f& direction() const { return frame_.z; }
  const Spectrum& irradiance() const { return irradiance_; }
  Spectrum fluence() const { return radiance_ * (2.0f * pi * one_minus_cos_); }
  /// Without the part below the horizon.
  Spectrum radiance(const Vec3f& direction) const {
    return direction.z >= 0 && holds(direction) ? radiance_ : Spectrum();
  }
  Vec3f sample(const Vec2f& u) const { return frame_.to_world(square_to_cone(u, one_minus_cos_)); }
  float pdf(const Vec3f& direction) const {
    return holds(direction) ? cone_pdf(one_minus_cos_) : 0.0f;
  }

 private:
  /// By the distance between the tips of the two unit vectors: their product has lost the angle.
  bool holds(const Vec3f& direction) const {
    return length_sq(direction - frame_.z) <= 2.0f * one_minus_cos_;
  }

  Frame frame_;
  Spectrum irradiance_;
  float one_minus_cos_;
  Spectrum radiance_;
};

/// What the parameters come to.
struct SunSkySettings {
  double turbidity = 3;
  double ground_albedo = 0.3;              ///< photopic
  Vec3d to_sun;                            ///< unit, +z is the zenith, above the horizon
  std::optional<Spectrum> sun_irradiance;  ///< given, instead of that by turbidity
  double sun_scale = 1, sky_scale = 1;
  double sun_aperture = 0;  ///< radians, the whole angle
  Transform to_world;
};

/// Of air with less haze the light is known, but not how the sky spreads it: as it does at this.
constexpr double least_fitted_turbidity = 2;

class SunSkyLight final : public EnvironmentLight {
 public:
  SunSkyLight(const SunSkySettings& settings, const Daylight& day, const EmissionDisk& disk)
      : EnvironmentLight(disk),
        sky_(ClearSky(std::max(settings.turbidity, least_fitted_turbidity), settings.to_sun),
             sky_illuminance(settings, day)),
        sky_distribution_(distribution_of(sky_)),
        sky_scale_(float(settings.sky_scale)),
        sun_(Vec3f(settings.to_sun), sun_irradiance(settings, day), 0.5 * settings.sun_aperture),
        to_world_(settings.to_world),
        to_local_(settings.to_world.inverse()) {
    Spectrum sky_fluence;
    SkyRadiance::for_each_node([&](const Vec3f& direction, double solid_angle) {
      const Spectrum weighted = sky_radiance(direction) * float(solid_angle);
      sky_fluence += weighted;
      harmonics_.add(direction, double(weighted.sum()));
    });
    set_fluence(sky_fluence + sun_.fluence());
    const double sun = importance_of(sun_.fluence()), sky = importance_of(sky_fluence);
    if (!(sun > 0)) return;
    sun_share_when_emitting_ = float(sun / (sun + sky));
    // The sun needs few samples for its smooth shadows, and many surfaces do not face it.
    sun_share_when_seeing_ = sky > 0 ? std::clamp(sun_share_when_emitting_, 0.25f, 0.5f) : 1.0f;
  }

  Spectrum background(const Vec3f& direction, const Wavelengths& wavelengths) const override {
    const Vec3f local = to_local(direction);
    return lanes_from_emission(sky_radiance(local) + sun_.radiance(local), wavelengths);
  }
  float expected_irradiance(const LightQuery& query) const override {
    const bool has_normal = query.normal != Vec3f(0, 0, 0);
    const LightQuery local(query.reference, has_normal ? to_local(query.normal) : query.normal);
    const float from_sky = sky_scale_ > 0 ? harmonics_.irradiance(local.normal) : 0.0f;
    return from_sky + sun_.irradiance().sum() * receiver_cosine(local, sun_.direction());
  }
  SunPlace sun_place() const { return {Vec3d(sun_.direction()), to_world(sun_.direction())}; }

 private:
  /// Sky on the ground, lx: what light of sun and sky the ground sends up, the air sends back in
  /// part, time and again (Bird and Hulstrom 1981).
  static double sky_illuminance(const SunSkySettings& settings, const Daylight& day) {
    const double from_sun = luminance_of(Vec3f(day.sun_rgb)) * settings.to_sun.z;
    const double all =
        (from_sun + day.sky_illuminance) / (1 - settings.ground_albedo * day.sky_albedo);
    return all - from_sun;
  }
  static Spectrum sun_irradiance(const SunSkySettings& settings, const Daylight& day) {
    if (settings.sun_irradiance) return *settings.sun_irradiance * float(settings.sun_scale);
    const Vec3d rgb = day.sun_rgb * settings.sun_scale;
    return spectrum_from_rgb(std::max(float(rgb.x), 0.0f), std::max(float(rgb.y), 0.0f),
                             std::max(float(rgb.z), 0.0f));
  }

  float sun_share(Purpose purpose) const {
    return purpose.receiver ? sun_share_when_seeing_ : sun_share_when_emitting_;
  }
  Vec3f sample_direction(const Vec2f& u, Purpose purpose) const override {
    const float share = sun_share(purpose);
    if (u.x < share) return to_world(sun_.sample({rescaled(u.x, 0.0f, share), u.y}));
    const LatLong at = sky_distribution_.sample({rescaled(u.x, share, 1.0f - share), u.y});
    const double sine = std::sqrt(std::max(0.0, 1 - at.height * at.height));
    const double phi = 2 * std::numbers::pi * at.turn;
    return to_world(
        Vec3f(float(sine * std::cos(phi)), float(sine * std::sin(phi)), float(at.height)));
  }
  float direction_pdf(const Vec3f& direction, Purpose purpose) const override {
    const Vec3f local = to_local(direction);
    const double turn = std::atan2(double(local.y), double(local.x)) / (2 * std::numbers::pi);
    const float sky = sky_distribution_.pdf({turn < 0 ? turn + 1 : turn, double(local.z)});
    const float share = sun_share(purpose);
    return share * sun_.pdf(local) + (1.0f - share) * sky;
  }

  Spectrum sky_radiance(const Vec3f& local) const {
    if (sky_scale_ == 0) return {};
    const Vec3f rgb = sky_.rgb(local) * sky_scale_;
    return spectrum_from_rgb(rgb.x, rgb.y, rgb.z);
  }
  Vec3f to_world(const Vec3f& local) const { return normalize(to_world_.vector(local)); }
  Vec3f to_local(const Vec3f& direction) const { return normalize(to_local_.vector(direction)); }

  SkyRadiance sky_;
  LatLongDistribution sky_distribution_;
  float sky_scale_;
  SunDisk sun_;
  Transform to_world_, to_local_;
  IrradianceHarmonics harmonics_;
  float sun_share_when_seeing_ = 0, sun_share_when_emitting_ = 0;
};

const std::vector<std::string>& time_names() {
  static const std::vector<std::string> names = {
      "latitude", "longitude", "timezone", "year", "month", "day", "hour", "minute", "second"};
  return names;
}

/// As given, in the world.
Vec3d given_sun_direction(const Arguments& arguments, const Transform& to_world) {
  for (const std::string& name : time_names())
    if (arguments.given(name))
      throw Error(ErrorKind::input,
                  fmt::format("emitter '{}' has both 'sun_direction' and '{}'",
                              arguments.info().name, name),
                  "give the direction, or place and time", arguments.place_of(name));
  const Vec3d given = arguments.point("sun_direction");
  if (!(given.length() > 0))
    throw Error(ErrorKind::input, "'sun_direction' is zero", "give the direction to the sun",
                arguments.place_of("sun_direction"));
  return Vec3d(to_world.inverse().vector(Vec3f(given.normalized()))).normalized();
}

Vec3d sun_direction_by_clock(const Arguments& arguments) {
  PlaceAndTime at;
  at.latitude = arguments.number("latitude");
  at.longitude = arguments.number("longitude");
  at.timezone = arguments.number("timezone");
  at.year = int(arguments.integer("year"));
  at.month = int(arguments.integer("month"));
  at.day = int(arguments.integer("day"));
  at.hour = arguments.number("hour") + arguments.number("minute") / 60 +
            arguments.number("second") / 3600;
  if (!is_date(at.year, at.month, at.day))
    throw Error(ErrorKind::input,
                fmt::format("there is no day {}-{:02}-{:02}", at.year, at.month, at.day),
                "correct year, month and day", arguments.place_of("day"));
  return sun_direction_at(at);
}

SunSkySettings read_settings(const LightInputs& inputs) {
  const Arguments& arguments = inputs.arguments;
  const auto number = [&](const char* name, double otherwise) {
    return arguments.info().find(name) ? arguments.number(name) : otherwise;
  };
  SunSkySettings settings;
  settings.to_world = emitter_transform(inputs);
  if (!keeps_angles(settings.to_world))
    throw Error(ErrorKind::input, "'to_world' distorts the sky",
                "leave out shear and scaling by unequal factors", arguments.place_of("to_world"));
  const bool by_direction = arguments.given("sun_direction");
  settings.to_sun = by_direction ? given_sun_direction(arguments, settings.to_world)
                                 : sun_direction_by_clock(arguments);
  if (!(settings.to_sun.z > 1e-4))
    throw Error(
        ErrorKind::input,
        fmt::format("the sun stands {:.1f} degrees below the horizon",
                    std::asin(std::clamp(-settings.to_sun.z, -1.0, 1.0)) * 180 / std::numbers::pi),
        "choose a time of the day, or a 'sun_direction' above the plane of the emitter's x "
        "and y",
        arguments.place_of(by_direction ? "sun_direction" : "hour"));
  settings.turbidity = arguments.number("turbidity");
  const Spectrum albedo = reflectance_spectrum(arguments.color("albedo"));
  if (albedo.max_lane() > 1)
    throw Error(ErrorKind::input, "'albedo' is above 1",
                "give what share of light the ground reflects", arguments.place_of("albedo"));
  settings.ground_albedo = double(photopic({albedo[0], albedo[1], albedo[2]}));
  const double unit = arguments.text("units") == "mitsuba" ? mitsuba_daylight : 1;
  settings.sun_scale = unit * number("sun_scale", 0);
  settings.sky_scale = unit * number("sky_scale", 0);
  if (arguments.info().find("irradiance") && arguments.given("irradiance"))
    settings.sun_irradiance = emission_spectrum(arguments.color("irradiance"));
  settings.sun_aperture = number("sun_aperture", 0.5358) * std::numbers::pi / 180;
  return settings;
}

std::unique_ptr<Light> create_sunsky(const LightInputs& inputs) {
  const SunSkySettings settings = read_settings(inputs);
  return with_finite_power(
      std::make_unique<SunSkyLight>(settings, daylight(settings.turbidity, settings.to_sun.z),
                                    EmissionDisk(inputs.scene_bounds)),
      inputs);
}

enum class Parts { sun, sky, both };

std::vector<Parameter> parameters(Parts parts) {
  std::vector<Parameter> table = {
      number_parameter(
          "turbidity", 3,
          "Haze of the air: 1 pure air, 2 very clear, 3 clear, 6 warm and moist, 10 hazy.")
          .range(1, 10)
          .clamped(),
      color_parameter("albedo", 0.3,
                      "Reflectance of the ground around. The sky scatters part of it back."),
      number_parameter("latitude", 35.6894, "Latitude, north positive.")
          .range(-90, 90)
          .in("degrees"),
      number_parameter("longitude", 139.6917, "Longitude, east positive.")
          .range(-180, 180)
          .in("degrees"),
      number_parameter("timezone", 9, "Hours by which local time is ahead of universal time.")
          .range(-14, 14)
          .in("hours"),
      integer_parameter("year", 2010, "Part of the date.").range(1600, 2400),
      integer_parameter("month", 7, "Part of the date.").range(1, 12),
      integer_parameter("day", 10, "Part of the date.").range(1, 31),
      number_parameter("hour", 15, "Part of the local time.").range(0, 24),
      number_parameter("minute", 0, "Part of the local time.").range(0, 60),
      number_parameter("second", 0, "Part of the local time.").range(0, 60),
      optional(point_parameter("sun_direction", {0, 0, 1},
                               "Direction to the sun in the world, instead of place and time."))
          .moved(WhenMoved::turned)};
  if (parts == Parts::sun)
    table.push_back(optional(color_parameter("irradiance", 0,
                                             "What a surface that faces the sun receives; by "
                                             "turbidity and altitude if absent."))
                        .range(0, 1e30)
                        .in("W/m²"));
  if (parts != Parts::sky) {
    table.push_back(
        number_parameter("sun_scale", 1, "Factor on the sun's radiance.").range(0, 1e30));
    table.push_back(number_parameter("sun_aperture", 0.5358,
                                     "Angular diameter of the sun. Its irradiance stays the same.")
                        .range(1e-3, 90)
                        .in("degrees"));
  }
  if (parts != Parts::sun)
    table.push_back(
        number_parameter("sky_scale", 1, "Factor on the sky's radiance.").range(0, 1e30));
  table.push_back(
      choice_parameter("units", "physical", {"physical", "mitsuba"},
                       "Unit of radiance: W/(sr·m²), or per nanometre as in Mitsuba, which is "
                       "1/408 of it. Scenes of Mitsuba before 2.0 and since 3.7 mean the latter."));
  table.push_back(to_world_parameter(
      "Transform from the sky's space to the world: +z is the zenith, +x south and +y west."));
  table.push_back(visible_parameter());
  table.push_back(ignored_parameter("complex_sun", ParameterKind::boolean));
  table.push_back(ignored_parameter("stretch", ParameterKind::number));
  table.push_back(ignored_parameter("extend", ParameterKind::boolean));
  table.push_back(ignored_parameter("resolution", ParameterKind::integer));
  table.push_back(ignored_sampling_weight());
  return table;
}

}  // namespace

std::optional<SunPlace> sun_place(const Light& light) {
  const auto* day = dynamic_cast<const SunSkyLight*>(&light);
  return day ? std::optional(day->sun_place()) : std::nullopt;
}

LightType sunsky_light_type() {
  static const TypeInfo info{"emitter", "sunsky", "Sun and sky of a cloudless day.",
                             parameters(Parts::both)};
  return {info, false, create_sunsky};
}

LightType sky_light_type() {
  static const TypeInfo info{"emitter", "sky", "The sky of a cloudless day, without the sun.",
                             parameters(Parts::sky)};
  return {info, false, create_sunsky};
}

LightType sun_light_type() {
  static const TypeInfo info{"emitter", "sun", "The sun of a cloudless day, without the sky.",
                             parameters(Parts::sun)};
  return {info, false, create_sunsky};
}

}  // namespace kaustik
