// Pictures: their channels, files, and how they get onto a display.

#include <cstring>

#include "bind.h"
#include "kaustik/image/denoise.h"
#include "kaustik/image/image_io.h"
#include "kaustik/image/metrics.h"
#include "kaustik/image/tone_mapping.h"

namespace kaustik::python {
namespace {

using ToneSettings = std::vector<std::string>;

Buffer buffer_of(std::vector<size_t> extents, std::vector<float> values) {
  return {Array::of<float>(std::move(extents), std::move(values))};
}

std::vector<size_t> rows_and_columns(const Image& image) {
  return {size_t(image.height()), size_t(image.width())};
}

Buffer channel(const Image& image, const std::string& name) {
  const int index = image.find_channel(name);
  if (index < 0) throw py::key_error(name);
  const auto values = image.channel(index);
  return buffer_of(rows_and_columns(image), {values.begin(), values.end()});
}

/// [row][column][r, g, b] of a layer, "" for the picture itself.
Buffer rgb(const Image& image, const std::string& layer) {
  const RgbView view = rgb_view(image, layer);
  std::vector<float> values(3 * image.pixel_count());
  for (size_t pixel = 0; pixel < image.pixel_count(); ++pixel)
    for (size_t lane = 0; lane < 3; ++lane) values[3 * pixel + lane] = view.planes[lane][pixel];
  std::vector<size_t> extents = rows_and_columns(image);
  extents.push_back(3);
  return buffer_of(std::move(extents), std::move(values));
}

py::dict metadata(const Image& image) {
  py::dict result;
  for (const auto& [key, value] : image.metadata())
    result[py::str(key)] = std::visit([](const auto& v) { return py::cast(v); }, value);
  return result;
}

/// All channels, one after the other, for pickle.
py::bytes channel_bytes(const Image& image) {
  std::string bytes;
  for (int c = 0; c < image.channel_count(); ++c) {
    const auto values = image.channel(c);
    bytes.append(reinterpret_cast<const char*>(values.data()), values.size_bytes());
  }
  return bytes;
}

Image from_parts(int width, int height, const std::vector<std::string>& names,
                 const py::bytes& bytes, const py::dict& facts, const std::array<int, 4>& frame) {
  Image image(width, height, names);
  const std::string_view view = bytes;
  const size_t size = image.pixel_count() * sizeof(float);
  if (view.size() != size * names.size()) throw py::value_error("a picture of another size");
  for (size_t c = 0; c < names.size(); ++c)
    std::memcpy(image.channel(int(c)).data(), view.data() + c * size, size);
  for (const auto& [key, value] : facts)
    image.set_metadata(key.cast<std::string>(), value.cast<MetadataValue>());
  image.set_frame({frame[0], frame[1], frame[2], frame[3]});
  return image;
}

WriteOptions write_options(const std::string& tone, const ToneSettings& settings,
                           const std::string& layer, bool half, int quality) {
  WriteOptions options;
  options.exr_half = half;
  options.tone = make_tone_operator(tone, settings);
  options.layer = layer;
  options.jpeg_quality = quality;
  return options;
}

void write_picture(const Image& image, const std::string& path, const std::string& tone,
                   const ToneSettings& settings, const std::string& layer, bool half, int quality) {
  const WriteOptions options = write_options(tone, settings, layer, half, quality);
  const py::gil_scoped_release released;
  check_writable(path);
  write_image(image, path, options);
}

py::bytes encode(const Image& image, const std::string& name, const std::string& tone,
                 const ToneSettings& settings, const std::string& layer, bool half, int quality) {
  const WriteOptions options = write_options(tone, settings, layer, half, quality);
  std::vector<uint8_t> bytes;
  {
    const py::gil_scoped_release released;
    bytes = encode_image(image, name, options);
  }
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// [row][column][r, g, b] in sRGB.
Buffer tone_mapped(const Image& image, const std::string& tone, const ToneSettings& settings,
                   const std::string& layer) {
  const auto tone_operator = make_tone_operator(tone, settings);
  const py::gil_scoped_release released;
  const Image displayed = tone_map(image, *tone_operator, layer);
  std::vector<uint8_t> bytes = srgb_bytes(displayed);
  return {Array::of<uint8_t>({size_t(displayed.height()), size_t(displayed.width()), 3},
                             std::move(bytes))};
}

Image denoised(const Image& image) {
  const py::gil_scoped_release released;
  return denoise(image);
}

py::dict compared(const Image& given, const Image& wanted, const std::string& layer) {
  ImageComparison found;
  py::object noise = py::none();
  {
    const py::gil_scoped_release released;
    const auto [image, reference] = same_pixels(given, wanted);
    found = compare_images(image, reference, layer);
    if (layer.empty() && reference.find_channel("error.R") >= 0) {
      const double own = own_relative_mse(reference);
      const py::gil_scoped_acquire acquired;
      noise = py::float_(own);
    }
  }
  py::dict facts;
  facts["mse"] = found.mse;
  facts["relative_mse"] = found.relative_mse;
  facts["relative_mse_trimmed"] = found.relative_mse_trimmed;
  facts["mean_ratio"] = py::make_tuple(found.mean_ratio.x, found.mean_ratio.y, found.mean_ratio.z);
  facts["reference_noise"] = noise;
  facts["pixel_count"] = found.pixel_count;
  facts["non_finite_pixels"] = found.non_finite_pixels;
  return facts;
}

/// [row][column][r, g, b] in sRGB.
Buffer difference(const Image& given, const Image& wanted, float scale, const std::string& layer) {
  const py::gil_scoped_release released;
  const auto [image, reference] = same_pixels(given, wanted);
  const Image colours = difference_image(image, reference, scale, layer);
  std::vector<uint8_t> bytes = srgb_bytes(colours);
  return {
      Array::of<uint8_t>({size_t(colours.height()), size_t(colours.width()), 3}, std::move(bytes))};
}

Image read_picture(const std::string& path) {
  const py::gil_scoped_release released;
  return read_image(path);
}

}  // namespace

void bind_images(py::module_& module) {
  py::class_<Image>(module, "Image")
      .def_property_readonly("width", &Image::width)
      .def_property_readonly("height", &Image::height)
      .def_property_readonly("channels", &Image::channel_names)
      .def_property_readonly("metadata", &metadata)
      .def("channel", &channel)
      .def("rgb", &rgb)
      .def("write", &write_picture)
      .def("encode", &encode)
      .def("shown", &tone_mapped)
      .def("denoised", &denoised)
      .def(py::pickle(
          [](const Image& i) {
            const PictureFrame& f = i.frame();
            return py::make_tuple(i.width(), i.height(), i.channel_names(), channel_bytes(i),
                                  metadata(i), std::array<int, 4>{f.width, f.height, f.x, f.y});
          },
          [](const py::tuple& s) {
            return from_parts(s[0].cast<int>(), s[1].cast<int>(),
                              s[2].cast<std::vector<std::string>>(), s[3].cast<py::bytes>(),
                              s[4].cast<py::dict>(), s[5].cast<std::array<int, 4>>());
          }));
  module.def("compared", &compared);
  module.def("difference", &difference);
  module.def("read_image", &read_picture);
  module.def("check_writable", &check_writable);
}

}  // namespace kaustik::python
