#include "kaustik/volume/volume.h"

#include "kaustik/volume/volume_kinds.h"

namespace kaustik {

Spectrum Volume::factor(const Vec3f& position, const Wavelengths& wavelengths) const {
  Spectrum rgb = value_.rgb();
  if (!grid_) {
    if (!wavelengths.is_rgb()) return value_.at(wavelengths);
  } else if (grid_->channels() == 1) {
    return Spectrum(grid_->value(position, 0));
  } else {
    rgb = spectrum_from_rgb(grid_->value(position, 0), grid_->value(position, 1),
                            grid_->value(position, 2));
  }
  if (!wavelengths.is_rgb()) return lanes_from_reflectance(rgb, wavelengths);
  rgb.set(3, (rgb[0] + rgb[1] + rgb[2]) / 3);
  return rgb;
}

const std::vector<VolumeType>& volume_types() {
  static const std::vector<VolumeType> types = {constvolume_type(), gridvolume_type()};
  return types;
}

}  // namespace kaustik
