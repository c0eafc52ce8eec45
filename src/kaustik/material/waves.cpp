#include "kaustik/base/wave_field.h"
#include "kaustik/material/bsdf_kinds.h"
#include "kaustik/material/procedural_parameters.h"
#include "kaustik/material/space_transform.h"

namespace kaustik {
namespace {

/// Water waves over the plane z = 0 of the texture's space; as a colour, their height.
class Waves final : public Texture {
 public:
  explicit Waves(const Arguments& arguments)
      : waves_(settings_of(arguments)),
        color0_(color_argument(arguments, "color0")),
        color1_(color_argument(arguments, "color1")),
        shade_(0.5f / std::max(waves_.largest_height(), 1e-30f)),
        space_(arguments.transform("to_world")) {}

  Spectrum eval(const TextureCoordinates& at, const Wavelengths& wavelengths) const override {
    const Vec3f p = space_.point(at);
    return mixed(color0_.at(wavelengths), color1_.at(wavelengths),
                 0.5f + shade_ * waves_.height({p.x, p.y}, space_.width(at)));
  }
  float maximum() const override {
    return std::max(color0_.rgb().max_lane(), color1_.rgb().max_lane());
  }
  /// Exact: no height leaves the span between the colours, and their mean is 0.
  Spectrum mean() const override { return (color0_.rgb() + color1_.rgb()) * 0.5f; }
  HeightGradient height_gradient(const TextureCoordinates& at) const override {
    const Vec3f p = space_.point(at);
    const Vec2f slope = waves_.slope({p.x, p.y}, space_.width(at));
    return {{0, 0}, space_.gradient({slope.x, slope.y, 0})};
  }

 private:
  static WaveSettings settings_of(const Arguments& arguments) {
    WaveSettings s;
    s.amplitude = float(arguments.number("amplitude"));
    s.wavelength = float(arguments.number("wavelength"));
    s.count = int(arguments.integer("count"));
    s.direction = float(arguments.number("direction"));
    s.spread = float(arguments.number("spread"));
    s.time = float(arguments.number("time"));
    s.seed = uint64_t(arguments.integer("seed"));
    return s;
  }

  WaveField waves_;
  SpectralValue color0_, color1_;
  float shade_;
  SpaceTransform space_;
};

const TypeInfo& waves_info() {
  static const WaveSettings defaults;
  static const TypeInfo info{
      "texture",
      "waves",
      "Water waves on the xy plane, for bump maps. As a colour it is their height.",
      {number_parameter("amplitude", 0.004, "Root mean square of the height.")
           .range(0, 1e6)
           .in("m"),
       number_parameter("wavelength", 0.5,
                        "Length of the longest waves. The shortest have a sixteenth of it.")
           .range(1e-6, 1e6)
           .in("m"),
       integer_parameter("count", defaults.count, "Number of waves that are summed.").range(1, 512),
       number_parameter("direction", 0, "Direction of the waves, from x towards y.")
           .range(-360, 360)
           .in("degrees"),
       number_parameter("spread", 180,
                        "Largest deviation from that direction; 180: all directions.")
           .range(0, 180)
           .in("degrees"),
       number_parameter("time", 0, "Time at which the waves are shown.").range(-1e6, 1e6).in("s"),
       color_parameter("color0", 0, "Colour of the lowest place.").range(0, 1),
       color_parameter("color1", 1, "Colour of the highest place.").range(0, 1), seed_parameter(),
       texture_to_world_parameter()}};
  return info;
}

std::shared_ptr<const Texture> create_waves(const TextureInputs& in) {
  return std::make_shared<Waves>(in.arguments);
}

}  // namespace

TextureType waves_type() { return {waves_info(), create_waves}; }

}  // namespace kaustik
