#include "kaustik/render/part_picture.h"

#include <cmath>

#include "kaustik/image/photometry.h"

namespace kaustik {
namespace {

// The numbers of a pixel: [picture 3][component][lane], [albedo 3, normal 3, depth 1, lamps 1],
// [bias 3].
constexpr int lanes_of_part = 3;
constexpr int components = lanes_of_part, albedo = components + component_count * lanes_of_part;
constexpr int normal = albedo + 3, depth = normal + 3, lamps = depth + 1;
constexpr int bias = lamps + 1, number_count = bias + 3;

// No numbers of a pass:
constexpr int scaled_error = -2;  ///< falls with the passes
constexpr int odd_share = -3;     ///< "odd.share"
/// Less a component: of its luminance the mean over odd replicates.
constexpr int odd_luminance = -4;

std::array<float, number_count> numbers_of(const PassPixel& pixel) {
  std::array<float, number_count> numbers{};
  for (int lane = 0; lane < lanes_of_part; ++lane) {
    for (int c = 0; c < component_count; ++c) {
      const float value = pixel.radiance[size_t(c)][lane];
      numbers[size_t(components + c * lanes_of_part + lane)] = value;
      numbers[size_t(lane)] += value;
    }
    numbers[size_t(albedo + lane)] = pixel.first_hit.albedo[lane];
    numbers[size_t(normal + lane)] = pixel.first_hit.normal[lane];
    numbers[size_t(bias + lane)] = pixel.bias[lane];
  }
  numbers[size_t(depth)] = pixel.first_hit.depth;
  numbers[size_t(lamps)] = pixel.first_hit.lamps;
  return numbers;
}

float luminance_of(const PassPixel& pixel, int component) {
  const Spectrum& radiance = pixel.radiance[size_t(component)];
  return photopic({radiance[0], radiance[1], radiance[2]});
}

/// Which number the channel shows: "R", "caustic.G", "N.X" …
int source_of(const std::string& channel) {
  const size_t dot = channel.rfind('.');
  const std::string layer = dot == std::string::npos ? "" : channel.substr(0, dot);
  const char last = channel.back();
  if (layer == "depth") return depth;
  if (layer == "error" || layer == "noise") return scaled_error;
  if (channel == "odd.share") return odd_share;
  if (layer == "odd") {
    for (int c = 0; c < component_count; ++c)
      if (channel.substr(dot + 1) == component_names[size_t(c)]) return odd_luminance - c;
    return -1;
  }
  if (layer == "N") return normal + (last - 'X');
  if (channel == "emission.A") return lamps;
  const int lane = last == 'R' ? 0 : last == 'G' ? 1 : 2;
  if (layer.empty()) return lane;
  if (layer == "albedo") return albedo + lane;
  if (layer == "bias") return bias + lane;
  for (int c = 0; c < component_count; ++c)
    if (layer == component_names[size_t(c)]) return components + c * lanes_of_part + lane;
  return -1;
}

}  // namespace

PartPicture::PartPicture(Image& image, double share, uint32_t replicate)
    : image_(image), share_(share), is_odd_(replicate % 2 == 1) {
  odd_share_ = image.find_channel("odd.share");
  for (const std::string& channel : image.channel_names()) sources_.push_back(source_of(channel));
}

void PartPicture::put(int x, int y, const PassPixel& mean, double passes) {
  const std::array<float, number_count> numbers = numbers_of(mean);
  const auto error_scale = float(std::sqrt(passes / (passes + share_)));
  const double odd = odd_share_ < 0 ? 0 : passes * double(image_.at(x, y, odd_share_));
  for (int channel = 0; channel < image_.channel_count(); ++channel) {
    const int source = sources_[size_t(channel)];
    float& value = image_.at(x, y, channel);
    if (source == scaled_error) value *= error_scale;
    if (source == odd_share) value = float((odd + (is_odd_ ? share_ : 0)) / (passes + share_));
    if (source <= odd_luminance && is_odd_)
      value = float(
          (odd * double(value) + share_ * double(luminance_of(mean, odd_luminance - source))) /
          (odd + share_));
    if (source >= 0)
      value = float((passes * double(value) + share_ * double(numbers[size_t(source)])) /
                    (passes + share_));
  }
}

void PartPicture::copy(int x, int y, int from_x, int from_y) {
  for (int channel = 0; channel < image_.channel_count(); ++channel)
    image_.at(x, y, channel) = image_.at(from_x, from_y, channel);
}

}  // namespace kaustik
