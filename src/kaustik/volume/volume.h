#pragma once
#include <memory>
#include <optional>
#include <variant>
#include <vector>

#include "kaustik/base/spectral_value.h"
#include "kaustik/volume/grid_volume.h"

namespace kaustik {

/// A number or a colour that varies over space, or is the same everywhere. Immutable, thread-safe.
class Volume {
 public:
  using Color = std::variant<Rgb, SpectralCurve>;
  /// The same everywhere.
  explicit Volume(Color color) : color_(std::move(color)) {
    value_ = SpectralValue::reflectance(color_);
  }
  explicit Volume(GridVolume grid) : grid_(std::move(grid)) {}

  /// Null: it is the same everywhere.
  const GridVolume* grid() const { return grid_ ? &*grid_ : nullptr; }
  /// What it is everywhere, if it is the same.
  const Color& color() const { return color_; }

  /// As a reflectance or another factor, of a volume of 1 or 3 channels; in RGB mode the lane that
  /// carries no light has the mean of the others.
  Spectrum factor(const Vec3f& position, const Wavelengths& wavelengths) const;

 private:
  Color color_;
  SpectralValue value_;
  std::optional<GridVolume> grid_;
};

struct VolumeType {
  const TypeInfo& info;
  /// Throws Error(input) for arguments that make none.
  std::shared_ptr<const Volume> (*create)(const Arguments&);
};
/// "constvolume", "gridvolume".
const std::vector<VolumeType>& volume_types();

}  // namespace kaustik
