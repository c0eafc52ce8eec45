#include "kaustik/scene/pixel_filter.h"

#include "kaustik/scene/filter_kinds.h"

namespace kaustik {

PixelFilter::PixelFilter() {
  static const PixelFilter one_pixel = box_filter(0.5f);
  *this = one_pixel;
}

const std::vector<FilterType>& filter_types() {
  static const std::vector<FilterType> types = {box_filter_type(),         tent_filter_type(),
                                                gaussian_filter_type(),    mitchell_filter_type(),
                                                catmull_rom_filter_type(), lanczos_filter_type()};
  return types;
}

}  // namespace kaustik
