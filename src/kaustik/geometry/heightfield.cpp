// A picture as heights over a square, as Mitsuba 0.6's `heightfield`.

#include <fmt/format.h>

#include <cmath>

#include "kaustik/base/memory.h"
#include "kaustik/geometry/mesh_shape.h"
#include "kaustik/geometry/shape_creators.h"
#include "kaustik/geometry/shape_support.h"
#include "kaustik/image/image_io.h"
#include "kaustik/image/photometry.h"

namespace kaustik {
namespace {

/// A vertex with its normal and uv, two triangles, and what tracing rays takes for them.
constexpr int64_t kept_bytes_per_height = 200;
/// That 32 bits and memory carry.
constexpr size_t most_heights = size_t(1) << 28;

struct Heights {
  size_t columns = 0, rows = 0;
  std::vector<float> values;  ///< row by row, the picture's upper one first
};

/// The luminance of each pixel.
Heights heights_of_picture(const std::string& path) {
  ReadOptions options;
  options.whole_picture = options.only_colours = true;
  options.kept_bytes_per_pixel = kept_bytes_per_height;
  const Image image = read_image(path, options);
  const RgbView pixels = rgb_view(image);
  Heights heights{size_t(image.width()), size_t(image.height()), {}};
  heights.values.reserve(image.pixel_count());
  for (size_t i = 0; i < image.pixel_count(); ++i) heights.values.push_back(photopic(pixels[i]));
  return heights;
}

Heights heights_of_array(const Array& array) {
  Heights heights{array.extents()[1], array.extents()[0], {}};
  heights.values.reserve(array.count());
  array.visit([&](auto values) {
    for (const auto value : values) heights.values.push_back(float(value));
  });
  return heights;
}

void check_heights(const Heights& heights, const Place& place) {
  if (heights.columns < 2 || heights.rows < 2)
    throw Error(ErrorKind::input,
                fmt::format("the height field has {} x {} heights", heights.columns, heights.rows),
                "give it 2 at least along each side", place);
  if (heights.values.size() > most_heights)
    throw Error(ErrorKind::input,
                fmt::format("the height field has {} x {} heights", heights.columns, heights.rows),
                fmt::format("give it {} in all at most", most_heights), place);
  const double bytes = double(heights.values.size()) * double(kept_bytes_per_height);
  if (bytes > double(physical_memory_bytes()))
    throw Error(
        ErrorKind::system,
        fmt::format("the height field's {} x {} heights take {:.3g} GB of memory, more than "
                    "there is",
                    heights.columns, heights.rows, bytes / 1e9),
        "give it fewer heights", place);
  for (size_t i = 0; i < heights.values.size(); ++i)
    if (!std::isfinite(heights.values[i]))
      throw Error(ErrorKind::input,
                  fmt::format("the height in row {} and column {} is not finite",
                              i / heights.columns, i % heights.columns),
                  "give it finite heights alone", place);
}

/// Over the square from (−1, −1) to (1, 1), where uv are 0 and 1; the first row lies at y = −1. All
/// cells are cut along the same diagonal.
TriangleMesh mesh_of(const Heights& heights, float scale) {
  const size_t columns = heights.columns, rows = heights.rows;
  TriangleMesh mesh;
  mesh.positions.reserve(columns * rows + 1);  // see MeshShape
  mesh.uvs.reserve(columns * rows);
  for (size_t y = 0; y < rows; ++y)
    for (size_t x = 0; x < columns; ++x) {
      const Vec2f uv(float(double(x) / double(columns - 1)), float(double(y) / double(rows - 1)));
      mesh.uvs.push_back(uv);
      mesh.positions.emplace_back(2 * uv.x - 1, 2 * uv.y - 1,
                                  scale * heights.values[y * columns + x]);
    }
  mesh.triangles.reserve(2 * (columns - 1) * (rows - 1));
  for (size_t y = 0; y + 1 < rows; ++y)
    for (size_t x = 0; x + 1 < columns; ++x) {
      const auto a = uint32_t(y * columns + x), b = a + 1, c = a + uint32_t(columns), d = c + 1;
      mesh.triangles.push_back({a, b, d});
      mesh.triangles.push_back({a, d, c});
    }
  return mesh;
}

}  // namespace

const TypeInfo& heightfield_info() {
  static const TypeInfo info{
      "shape",
      "heightfield",
      "Shows a picture as heights along z over the square [-1, 1] x [-1, 1], its upper row at y = "
      "-1. Each pixel becomes a vertex of a mesh.",
      {file_parameter("filename", "Picture whose luminances are the heights.").textured(),
       array_parameter("heights", {0, 0}, "Heights as rows of numbers, instead of the picture.")
           .instead_of("filename"),
       number_parameter("scale", 1, "Factor on the heights.")
           .range(-largest_length, largest_length),
       optional(integer_parameter("width", 2,
                                  "Number of heights along u. The default is the width of a "
                                  "bitmap, and 256 for other textures.")
                    .range(2, 8192)),
       optional(
           integer_parameter("height", 2, "Number of heights along v, likewise.").range(2, 8192)),
       boolean_parameter("shading_normals", true,
                         "Smooth normals. If false, each face has its own."),
       boolean_parameter("flip_normals", false, "Turns the surface inside out."),
       to_world_parameter("Places the square in the world.").leaving(2)}};
  return info;
}

std::unique_ptr<Shape> create_heightfield(const Arguments& arguments) {
  const bool is_buffer = arguments.given("heights");
  const Place place = arguments.place_of(is_buffer ? "heights" : "filename");
  const Heights heights = is_buffer ? heights_of_array(*arguments.array("heights"))
                                    : heights_of_picture(arguments.text("filename"));
  check_heights(heights, place);
  const MeshOptions options{.to_world = affine_to_world(arguments),
                            .face_normals = !arguments.boolean("shading_normals"),
                            .flip_normals = arguments.boolean("flip_normals")};
  return std::make_unique<MeshShape>(
      prepare_mesh(mesh_of(heights, float(arguments.number("scale"))), options, place));
}

}  // namespace kaustik
