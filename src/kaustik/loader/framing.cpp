#include "kaustik/loader/framing.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <set>
#include <span>
#include <string_view>
#include <vector>

#include "kaustik/base/error.h"
#include "kaustik/base/photometric_units.h"
#include "kaustik/loader/obj_scan.h"
#include "kaustik/loader/object_maker.h"
#include "kaustik/loader/object_parts.h"

namespace kaustik {
namespace {

constexpr int64_t film_side = 768;
constexpr double usual_aspect = 4.0 / 3;
constexpr double lens_degrees = 40;
constexpr double margin = 1.05;      ///< around what is framed
constexpr double lamp_distance = 4;  ///< in radii of what is shown

/// Of the points that are finite.
template <typename T>
Bounds3f of_points(std::span<const T> numbers) {
  // What is not finite makes the sum no number.
  Vec3f low(std::numeric_limits<float>::max()), high(-std::numeric_limits<float>::max());
  float sum = 0;
  for (size_t i = 0; i + 2 < numbers.size(); i += 3)
    for (int k = 0; k < 3; ++k) {
      const auto number = float(numbers[i + size_t(k)]);
      low[k] = number < low[k] ? number : low[k];
      high[k] = number > high[k] ? number : high[k];
      sum += number * 0;
    }
  if (numbers.size() < 3) return {};
  if (sum == 0) return {low, high};
  Bounds3f bounds;
  for (size_t i = 0; i + 2 < numbers.size(); i += 3) {
    const Vec3f p{float(numbers[i]), float(numbers[i + 1]), float(numbers[i + 2])};
    if (std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z)) bounds.extendBy(p);
  }
  return bounds;
}

Bounds3f box_around(std::span<const Bounds3f> boxes) {
  Bounds3f all;
  for (const Bounds3f& box : boxes) all.extendBy(box);
  return all;
}

/// Boxes of objects in their own space, each found once.
class BoundsFinder {
 public:
  explicit BoundsFinder(const std::map<std::string, Bounds3f>& files) : files_(files) {}

  /// Of shapes that are not empty, one by one.
  std::vector<Bounds3f> of_each_child(const Object& parent) {
    std::vector<Bounds3f> boxes;
    for (const Child& child : parent.children) {
      if (child.object->family != "shape" || child.object->type == "shapegroup") continue;
      const Bounds3f box = placed(*child.object);
      if (!box.isEmpty()) boxes.push_back(box);
    }
    return boxes;
  }

 private:
  Bounds3f placed(const Object& shape) {
    const Bounds3f own = of_shape(shape);
    const auto* to_world = value_in<Transform>(shape, "to_world");
    return own.isEmpty() || !to_world ? own : to_world->bounds(own);
  }

  Bounds3f of_shape(const Object& shape) {
    if (shape.type == "instance") {
      for (const Child& child : shape.children)
        if (child.object->type == "shapegroup") return of_group(*child.object);
      return {};
    }
    if (shape.type == "mesh") {
      const auto* positions = value_in<std::shared_ptr<const Array>>(shape, "positions");
      return positions ? of_positions(**positions) : Bounds3f();
    }
    if (shape.type == "obj") {
      const auto* file = value_in<std::string>(shape, "filename");
      return file ? of_obj(*file) : Bounds3f();
    }
    if (shape.type == "rectangle" || shape.type == "disk")
      return {Vec3f(-1, -1, 0), Vec3f(1, 1, 0)};
    if (shape.type == "cube") return {Vec3f(-1, -1, -1), Vec3f(1, 1, 1)};
    if (shape.type == "sphere") {
      const auto radius = float(number_in(shape, "radius").value_or(1));
      const auto* center = value_in<Vec3d>(shape, "center");
      const Vec3f middle = center ? Vec3f(*center) : Vec3f(0, 0, 0);
      return {middle - Vec3f(radius), middle + Vec3f(radius)};
    }
    if (shape.type == "cylinder") {
      const auto radius = float(number_in(shape, "radius").value_or(1));
      Bounds3f bounds;
      for (const auto& [end, usual] : {std::pair("p0", 0.f), {"p1", 1.f}}) {
        const auto* given = value_in<Vec3d>(shape, end);
        const Vec3f point = given ? Vec3f(*given) : Vec3f(0, 0, usual);
        bounds.extendBy(point - Vec3f(radius));
        bounds.extendBy(point + Vec3f(radius));
      }
      return bounds;
    }
    return {};
  }

  Bounds3f of_group(const Object& group) {
    const auto [entry, is_new] = groups_.try_emplace(&group);
    if (is_new) entry->second = box_around(of_each_child(group));
    return entry->second;
  }

  Bounds3f of_obj(const std::string& path) {
    const auto [entry, is_new] = files_.try_emplace(path);
    if (is_new) entry->second = scan_obj(path).bounds;
    return entry->second;
  }

  Bounds3f of_positions(const Array& positions) {
    const auto [entry, is_new] = meshes_.try_emplace(&positions);
    Bounds3f& bounds = entry->second;
    if (is_new) positions.visit([&](auto values) { bounds = of_points(values); });
    return bounds;
  }

  std::map<const Object*, Bounds3f> groups_;
  std::map<const Array*, Bounds3f> meshes_;
  std::map<std::string, Bounds3f> files_;
};

/// From the middle of what is shown to the camera.
Vec3d direction_to_camera() { return Vec3d(1, 0.6, 1.6).normalized(); }

bool has_any(const Object& object, std::string_view family) {
  return std::any_of(object.children.begin(), object.children.end(),
                     [&](const Child& child) { return child.object->family == family; });
}

/// Whether something within an object shines.
bool shines(const Object& object, std::set<const Object*>& seen) {
  if (!seen.insert(&object).second) return false;
  return std::any_of(object.children.begin(), object.children.end(), [&](const Child& child) {
    const std::string& family = child.object->family;
    if (family == "emitter") return child.object->type != "background";
    return family == "shape" && shines(*child.object, seen);
  });
}

std::string text_of_point(const Vec3d& p) {
  return fmt::format("({:.4g}, {:.4g}, {:.4g})", p.x, p.y, p.z);
}

}  // namespace

std::shared_ptr<Object> film_of_aspect(double aspect, const Place& place) {
  constexpr double least = 1.0 / 16;
  const double ratio = aspect > 0 ? std::clamp(aspect, least, 1 / least) : usual_aspect;
  const auto side = [](double share) {
    return std::max<int64_t>(1, std::llround(double(film_side) * std::min(1.0, share)));
  };
  auto film = make_object("film", "hdrfilm", place);
  give(*film, "width", side(ratio));
  give(*film, "height", side(1 / ratio));
  return film;
}

Framing::Framing(Description& description, Deviations& deviations,
                 const std::map<std::string, Bounds3f>& obj_bounds, UpAxis up)
    : description_(description), deviations_(deviations), up_(up) {
  std::vector<Bounds3f> boxes = BoundsFinder(obj_bounds).of_each_child(*description.scene);
  show(box_around(boxes));
  while (leave_out_shell(boxes)) {
  }
}

void Framing::show(const Bounds3f& bounds) {
  if (bounds.isEmpty()) return;
  const double radius = double(bounding_radius(bounds));
  middle_ = Vec3d(center(bounds));
  // A single point shows nothing; what is out of all bounds is refused where it is built.
  if (!(radius > 0) || !std::isfinite(radius)) return;
  radius_ = radius;
  bounds_ = bounds;
}

/// A sky is a shape around all others, so large that camera and lamp for those stand within it.
bool Framing::leave_out_shell(std::vector<Bounds3f>& boxes) {
  const auto shell = std::ranges::find_if(boxes, [&](const Bounds3f& box) {
    return box.intersects(bounds_.min) && box.intersects(bounds_.max);
  });
  if (shell == boxes.end() || boxes.size() < 2) return false;
  const Bounds3f around = *shell;
  Framing others = *this;
  std::vector<Bounds3f> rest = boxes;
  rest.erase(rest.begin() + (shell - boxes.begin()));
  others.show(box_around(rest));
  if (!stands_in(around, others.view_of_all().origin) || !stands_in(around, others.lamp_place()))
    return false;
  boxes = std::move(rest);
  show(box_around(boxes));
  return true;
}

/// Of a sphere or a dome that fills the box: as far from its edges as such a one may be.
bool Framing::stands_in(const Bounds3f& box, const Vec3d& point) const {
  constexpr double inner = 0.45;
  const Vec3d half = Vec3d(box.max - box.min) / 2, off = point - Vec3d(center(box));
  const int up = up_ == UpAxis::y ? 1 : 2;
  for (int k = 0; k < 3; ++k)
    if (off[k] > inner * half[k] || off[k] < -(k == up ? 1 : inner) * half[k]) return false;
  return true;
}

/// The picture's edges along each axis are two planes that lean on the box. They cross where the
/// camera is to stand: the farther one of both axes holds.
Framing::View Framing::view_of_all() const {
  const Vec3d back = turned(direction_to_camera());
  const Vec3d right = turned({0, 1, 0}).cross(back).normalized();
  const Vec3d axes[] = {right, back.cross(right)};
  const double tangent = std::tan(lens_degrees / 2 * std::numbers::pi / 180) / margin;
  const double tangents[] = {tangent * usual_aspect, tangent};
  Vec3d aside(0, 0, 0);
  double distance = 0;
  for (int axis = 0; axis < 2; ++axis) {
    double least = std::numeric_limits<double>::max(), most = -least;
    for (const Vec3d& corner : corners()) {
      const double along = corner.dot(axes[axis]), toward = corner.dot(back) * tangents[axis];
      least = std::min(least, along - toward);
      most = std::max(most, along + toward);
    }
    aside += axes[axis] * ((least + most) / 2);
    distance = std::max(distance, (most - least) / (2 * tangents[axis]));
  }
  return {middle_ + aside + back * distance, middle_ + aside};
}

/// Of the box, from its middle; of one of radius_ where there is none.
std::array<Vec3d, 8> Framing::corners() const {
  const Vec3d half = bounds_.isEmpty() ? Vec3d(radius_) : Vec3d(bounds_.max) - middle_;
  std::array<Vec3d, 8> all;
  for (size_t i = 0; i < all.size(); ++i)
    for (int k = 0; k < 3; ++k) all[i][k] = i >> k & 1 ? half[k] : -half[k];
  return all;
}

void Framing::add_missing_camera() {
  Object& scene = *description_.scene;
  if (has_any(scene, "sensor")) return;
  const View view = view_of_all();
  auto sensor = make_object("sensor", "perspective", scene.place);
  give(*sensor, "to_world", Transform::look_at(view.origin, view.target, turned({0, 1, 0})));
  give(*sensor, "fov", lens_degrees);
  give(*sensor, "fov_axis", "smaller");
  put(*sensor, "", film_of_aspect(0, scene.place));
  put(scene, "", sensor);
  deviations_.missing("camera",
                      fmt::format("the file has none: it is seen from {} toward {}",
                                  text_of_point(view.origin), text_of_point(view.target)),
                      scene.place);
}

bool is_lit(const Description& description) {
  std::set<const Object*> seen;
  return shines(*description.scene, seen);
}

Vec3d Framing::lamp_place() const {
  const Vec3d to_camera = direction_to_camera();
  const Vec3d right = Vec3d(0, 1, 0).cross(to_camera).normalized();
  const Vec3d to_lamp = turned((to_camera - right * 0.6 + Vec3d(0, 0.8, 0)).normalized());
  return middle_ + to_lamp * (lamp_distance * radius_);
}

void Framing::add_studio_light() {
  Object& scene = *description_.scene;
  // Of the white: that of the even light, and the irradiance from the lamp over π.
  constexpr double white = studio_luminance / lumens_per_watt_white;
  constexpr double even = 0.5, half_side = 2.5;
  // Irradiance over radiance of a square that a surface faces, in front of its middle.
  const double sine = half_side / std::hypot(half_side, lamp_distance);
  const double form_factor = 4 * sine * std::atan(sine);
  auto around = make_object("emitter", "constant", scene.place);
  give(*around, "radiance", even * white);
  put(scene, "", around);
  auto lamp = make_object("shape", "rectangle", scene.place);
  const double side = half_side * radius_;
  give(*lamp, "to_world",
       Transform::look_at(lamp_place(), middle_, turned({0, 1, 0})) *
           Transform::scale({side, side, 1}));
  auto area = make_object("emitter", "area", scene.place);
  give(*area, "radiance", (1 - even) * white * std::numbers::pi / form_factor);
  give(*area, "visible", false);
  put(*lamp, "", area);
  put(scene, "", lamp);
  deviations_.missing("light",
                      "the file has none: even light around it and a large lamp behind the "
                      "camera's left shoulder stand for it",
                      scene.place);
}

}  // namespace kaustik
