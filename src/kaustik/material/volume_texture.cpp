#include "kaustik/material/bsdf_kinds.h"

namespace kaustik {
namespace {

/// What a grid of values is at the points of a surface. Of footprints the middle counts alone.
class VolumeTexture final : public Texture {
 public:
  /// `volume` is a grid of 1 or 3 channels, nowhere negative.
  explicit VolumeTexture(std::shared_ptr<const Volume> volume)
      : volume_(std::move(volume)), grid_(*volume_->grid()) {}

  Spectrum eval(const TextureCoordinates& at, const Wavelengths& wavelengths) const override {
    return lanes_from_reflectance(rgb(at.position), wavelengths);
  }
  float scalar(const TextureCoordinates& at) const override {
    return luminance_of(rgb(at.position));
  }
  float maximum() const override { return grid_.largest(); }
  Spectrum mean() const override {
    return of_channels([&](int channel) { return grid_.mean(channel); });
  }
  /// By differences over one cell, as `bitmap` has it over one texel.
  HeightGradient height_gradient(const TextureCoordinates& at) const override {
    const float step = 0.5f * grid_.cell_size();
    HeightGradient result;
    for (int axis = 0; axis < 3; ++axis) {
      Vec3f before = at.position, after = at.position;
      before[axis] -= step;
      after[axis] += step;
      // Far from the origin floats have no place between the two.
      const float distance = after[axis] - before[axis];
      if (distance > 0)
        result.position[axis] = (luminance_of(rgb(after)) - luminance_of(rgb(before))) / distance;
    }
    return result;
  }

 private:
  Spectrum rgb(const Vec3f& position) const {
    return of_channels([&](int channel) { return grid_.value(position, channel); });
  }
  template <typename OfChannel>
  Spectrum of_channels(const OfChannel& of) const {
    const float first = of(0);
    return grid_.channels() == 1 ? spectrum_from_rgb(first, first, first)
                                 : spectrum_from_rgb(first, of(1), of(2));
  }

  std::shared_ptr<const Volume> volume_;
  const GridVolume& grid_;
};

const TypeInfo& volume_texture_info() {
  static const TypeInfo info{
      "texture",
      "volume",
      "Value of a volume at the points of the surface, for shapes without uv and for patterns that "
      "go through solids.",
      {color_parameter("volume", 0.75, "Volume with 1 or 3 channels, or one value for all points.")
           .range(0, 1e6)
           .or_volume()}};
  return info;
}

void check_grid_of_texture(const GridVolume& grid, const Arguments& arguments) {
  if (grid.channels() != 1 && grid.channels() != 3)
    throw Error(ErrorKind::input, "the volume of a texture has six channels",
                "give it one channel, or three of linear Rec. 709", arguments.place());
  if (grid.least() < 0)
    throw Error(ErrorKind::input, "the volume of a texture has negative values",
                "give it values from zero on", arguments.place());
}

std::shared_ptr<const Texture> create_volume_texture(const TextureInputs& in) {
  const std::shared_ptr<const Volume> volume = in.volume("volume");
  if (!volume)
    return make_constant_texture(SpectralValue::reflectance(in.arguments.color("volume")));
  if (in.arguments.given("volume"))
    throw Error(ErrorKind::input, "the texture has 'volume' both as a value and as a volume",
                "keep one", in.arguments.place_of("volume"));
  if (!volume->grid()) return make_constant_texture(SpectralValue::reflectance(volume->color()));
  check_grid_of_texture(*volume->grid(), in.arguments);
  return std::make_shared<VolumeTexture>(volume);
}

}  // namespace

TextureType volume_texture_type() { return {volume_texture_info(), create_volume_texture}; }

}  // namespace kaustik
