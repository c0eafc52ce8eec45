// Meters that measure many things at once, one in each pixel: irradiances at points, radiances
// along rays.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kaustik/base/warp.h"
#include "kaustik/scene/camera_kinds.h"
#include "kaustik/scene/camera_view.h"
#include "kaustik/scene/direction_file.h"

namespace kaustik {
namespace {

/// Pixels in a row, and how many there may be in all.
constexpr size_t longest_row = 1024, most_measurements = size_t(1) << 24;

/// A place and a direction, in the world.
struct PlacedDirection {
  Vec3f place, direction;
};

/// Lists of places and of directions as arguments, or a file of both.
class DirectionList {
 public:
  /// Names of the rows.
  DirectionList(const Arguments& arguments, const char* places, const char* directions)
      : arguments_(arguments), places_(places), directions_(directions) {}

  /// As many as there are rows; without lists the origin and +z of the meter's space. Throws
  /// Error(input), with the name of what is wrong and its row.
  std::vector<PlacedDirection> read() const {
    if (arguments_.given("filename")) return read_file();
    const Array* places = arguments_.array(places_).get();
    const Array* directions = arguments_.array(directions_).get();
    if (!places != !directions)
      fail(places ? places_ : directions_,
           fmt::format("there is no '{}' beside it", places ? directions_ : places_),
           "give both lists, or neither");
    if (!places) return {placed(places_, 0, {0, 0, 0}, {0, 0, 1})};
    const size_t count = places->extents()[0];
    if (count == 0) fail(places_, "the list is empty", "give one row at least");
    if (count > most_measurements)
      fail(places_, fmt::format("the list has {} rows", count),
           fmt::format("give up to {}", most_measurements));
    if (directions->extents()[0] != count)
      fail(directions_,
           fmt::format("it has {} rows, and '{}' has {}", directions->extents()[0], places_, count),
           "give one row for each");
    const std::vector<Vec3d> at = rows_of(*places), along = rows_of(*directions);
    std::vector<PlacedDirection> list;
    list.reserve(count);
    for (size_t i = 0; i < count; ++i) list.push_back(placed(places_, i, at[i], along[i]));
    return list;
  }

 private:
  std::vector<PlacedDirection> read_file() const {
    for (const char* name : {places_, directions_})
      if (arguments_.array(name))
        fail(name, "there is a file, too", "give the lists, or 'filename'");
    std::vector<PlacedDirection> list;
    for (const DirectedPlace& row :
         read_direction_file(arguments_.text("filename"), most_measurements))
      list.push_back(placed("filename", list.size(), row.place, row.direction));
    return list;
  }
  [[noreturn]] void fail(const char* name, const std::string& what, const char* remedy) const {
    fail(name, what, std::string(remedy));
  }
  [[noreturn]] void fail(const char* name, const std::string& what,
                         const std::string& remedy) const {
    throw Error(ErrorKind::input, fmt::format("'{}': {}", name, what), remedy,
                arguments_.place_of(name));
  }
  static std::vector<Vec3d> rows_of(const Array& array) {
    std::vector<Vec3d> rows(array.extents()[0]);
    array.visit([&](auto values) {
      for (size_t i = 0; i < values.size(); ++i) rows[i / 3][int(i % 3)] = double(values[i]);
    });
    return rows;
  }
  PlacedDirection placed(const char* places, size_t row, const Vec3d& at,
                         const Vec3d& along) const {
    const auto is_finite = [](const Vec3f& v) {
      return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
    };
    const Transform& to_world = arguments_.transform("to_world");
    PlacedDirection result{to_world.point(Vec3f(at)), {0, 0, 0}};
    if (!is_finite(result.place))
      fail(places, fmt::format("row {} is not finite", row), "give numbers alone");
    // Scaled, for the squares of single numbers of usual size may be beyond all floats.
    const double scale = std::max({std::fabs(along.x), std::fabs(along.y), std::fabs(along.z)});
    if (!std::isfinite(scale))
      fail(directions_, fmt::format("row {} is not finite", row), "give numbers alone");
    const Vec3f turned = scale > 0 ? to_world.vector(Vec3f(along / scale)) : Vec3f(0, 0, 0);
    const float size = length(turned);
    if (!(size > 0) || !std::isfinite(size))
      fail(directions_, fmt::format("row {} has no direction", row),
           "give vectors of any length but zero");
    result.direction = turned * (1 / size);
    return result;
  }

  const Arguments& arguments_;
  const char *places_, *directions_;
};

/// Pixels in rows, each of which shows one of a list.
class ListOfPixels {
 public:
  explicit ListOfPixels(size_t count) : count_(count), row_(std::min(count, longest_row)) {}
  Vec2i size() const { return {int(row_), int((count_ + row_ - 1) / row_)}; }
  /// −1: the pixel shows nothing. A single one is what all pixels show.
  int at(const Vec2f& raster) const {
    if (count_ == 1) return 0;
    if (!(raster.x >= 0 && raster.y >= 0 && raster.x < float(row_))) return -1;
    const size_t number = size_t(raster.y) * row_ + size_t(raster.x);
    return number < count_ ? int(number) : -1;
  }

 private:
  size_t count_, row_;
};

Vec3f middle_of(const std::vector<PlacedDirection>& list) {
  Bounds3f box;
  for (const PlacedDirection& one : list) box.extendBy(one.place);
  return center(box);
}

/// Paths begin at gauges. Whoever only asks for rays gets those that arrive there, with density
/// cos θ / π: the mean of π L is E = ∫ L cos θ dω, but for lamps that no ray meets.
class IrradiancePoints final : public Camera {
 public:
  explicit IrradiancePoints(const std::vector<PlacedDirection>& list) : pixels_(list.size()) {
    for (const PlacedDirection& one : list) gauges_.push_back({one.place, one.direction});
    traits_.position = middle_of(list);
    traits_.view =
        fmt::format("measures irradiance at {} point{}", list.size(), list.size() == 1 ? "" : "s");
    traits_.meter_unit = "lx";
    traits_.has_ways = true;
    traits_.can_connect = false;
    traits_.weight = pi;
    traits_.measures_irradiance = true;
    traits_.size_of_pixels_apart = pixels_.size();
    constexpr float half_angle = 0.005f;
    traits_.pixel_spread = half_angle;
  }

  int gauge_at(const Vec2f& raster) const override { return pixels_.at(raster); }
  CameraRay sample_ray(const Vec2f& raster, const LensNumbers& numbers) const override {
    const int number = pixels_.at(raster);
    if (number < 0) return CameraRay::none();
    const Gauge& gauge = gauges_[size_t(number)];
    const Vec3f way = Frame(gauge.normal).to_world(square_to_cosine_hemisphere(numbers.way));
    return {{gauge.position, normalize(way), infinity}, 0};
  }
  CameraConnection connect(const Vec3f&, const LensNumbers&) const override {
    return no_connection(traits_.position);
  }

 private:
  ListOfPixels pixels_;
};

class RadianceRays final : public Camera {
 public:
  explicit RadianceRays(std::vector<PlacedDirection> list)
      : rays_(std::move(list)), pixels_(rays_.size()) {
    traits_.position = middle_of(rays_);
    traits_.view = fmt::format("measures the radiance along {} ray{}", rays_.size(),
                               rays_.size() == 1 ? "" : "s");
    traits_.meter_unit = "cd/m²";
    traits_.can_connect = false;
    traits_.size_of_pixels_apart = pixels_.size();
    // As the radiancemeter's.
    constexpr float half_angle = 4e-4f;
    traits_.pixel_spread = half_angle;
  }

  CameraRay sample_ray(const Vec2f& raster, const LensNumbers&) const override {
    const int number = pixels_.at(raster);
    if (number < 0) return CameraRay::none();
    const PlacedDirection& ray = rays_[size_t(number)];
    return {{ray.place, ray.direction, infinity}, 0};
  }
  CameraConnection connect(const Vec3f&, const LensNumbers&) const override {
    return no_connection(traits_.position);
  }

 private:
  std::vector<PlacedDirection> rays_;
  ListOfPixels pixels_;
};

Parameter list_file_parameter(const std::string& sentence) {
  return optional(file_parameter("filename", sentence));
}

const TypeInfo& irradiance_points_info() {
  static const TypeInfo info = camera_info(
      "irradiancepoints",
      "Measures the irradiance, W/m², of all lamps at points in the air and on surfaces. Each "
      "point has its own pixel, in rows of 1024. Without lists there is one point.",
      {to_world_parameter("Transform from the meter's space to the world. Without lists the point "
                          "is at 0 and its normal is +z."),
       list_file_parameter("Text file with six numbers on each line: a point and its normal, x, y "
                           "and z of each."),
       array_parameter("points", {0, 3}, "Points to measure at; needs normals."),
       array_parameter("normals", {0, 3},
                       "Normals toward the measured side, of any length, one for each point.")});
  return info;
}

const TypeInfo& radiance_rays_info() {
  static const TypeInfo info =
      camera_info("radiancerays",
                  "Measures the radiance, W/(sr m²), that arrives along rays. Each ray has its own "
                  "pixel, in rows of 1024. Without lists there is one ray.",
                  {to_world_parameter("Transform from the meter's space to the world. Without "
                                      "lists the ray begins at 0 and goes along +z."),
                   list_file_parameter("Text file with six numbers on each line: the origin of a "
                                       "ray and its direction, x, y and z of each."),
                   array_parameter("origins", {0, 3}, "Origins of the rays; needs directions."),
                   array_parameter("directions", {0, 3},
                                   "Directions of the rays, of any length, one for each origin.")});
  return info;
}

}  // namespace

CameraType irradiance_points_type() {
  return {irradiance_points_info(), [](const CameraInputs& inputs) -> std::unique_ptr<Camera> {
            return std::make_unique<IrradiancePoints>(
                DirectionList(inputs.arguments, "points", "normals").read());
          }};
}

CameraType radiance_rays_type() {
  return {radiance_rays_info(), [](const CameraInputs& inputs) -> std::unique_ptr<Camera> {
            return std::make_unique<RadianceRays>(
                DirectionList(inputs.arguments, "origins", "directions").read());
          }};
}

}  // namespace kaustik
