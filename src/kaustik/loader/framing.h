#pragma once
// For formats whose files often have geometry alone: a camera and light that show it.

#include <array>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "kaustik/loader/deviations.h"
#include "kaustik/scene/description.h"

namespace kaustik {

/// A film of that width over height; of 4 : 3 where it is 0.
std::shared_ptr<Object> film_of_aspect(double aspect, const Place& place);

/// Whether something in a scene shines.
bool is_lit(const Description& description);

/// The luminance of white surfaces in the light of a studio, cd/m²: a picture without exposure
/// shows them a little darker than its white.
inline constexpr double studio_luminance = 160;

/// The direction that formats call upward.
enum class UpAxis { y, z };

/// Puts a camera and light into a scene, by the box around its shapes: meshes of buffers, spheres,
/// cylinders, cubes, rectangles and disks, through instances, and OBJ files, whose vertices are
/// read. Skies, which are shapes around all others, and far away, do not count. What it adds is
/// told as a deviation.
class Framing {
 public:
  /// `obj_bounds`: of files that have been read, by path.
  Framing(Description& description, Deviations& deviations,
          const std::map<std::string, Bounds3f>& obj_bounds = {}, UpAxis up = UpAxis::y);

  /// Gives a scene without a camera one that looks toward −z (+y where z is up), from the right and
  /// above, with 40° along the picture's shorter side. It stands as near as it can while the whole
  /// box is in the picture. Does nothing for others.
  void add_missing_camera();
  /// Even light around the scene, and a large lamp behind that camera's left shoulder, which no
  /// camera sees. White surfaces that face the lamp get about `studio_luminance`.
  void add_studio_light();

 private:
  /// World from a space where +y is up.
  Vec3d turned(const Vec3d& v) const { return up_ == UpAxis::y ? v : Vec3d(v.x, -v.z, v.y); }

  /// Where the camera stands, and what is in the middle of its picture.
  struct View {
    Vec3d origin, target;
  };
  View view_of_all() const;
  Vec3d lamp_place() const;
  /// From now on the box is what is shown.
  void show(const Bounds3f& bounds);
  /// Shows what one of the boxes surrounds, and takes that one away. False: none is so large.
  bool leave_out_shell(std::vector<Bounds3f>& boxes);
  bool stands_in(const Bounds3f& box, const Vec3d& point) const;
  std::array<Vec3d, 8> corners() const;

  Description& description_;
  Deviations& deviations_;
  UpAxis up_;
  Bounds3f bounds_;
  Vec3d middle_{0, 0, 0};
  double radius_ = 1;
};

}  // namespace kaustik
