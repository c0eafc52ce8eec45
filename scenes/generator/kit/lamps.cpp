#include "kit/lamps.h"

#include "kit/surface.h"
#include "kit/sweep.h"

namespace kaustik::scenes {
namespace {

constexpr double can_radius = 0.045, can_length = 0.16, wall = 0.003, recess = 0.10;

/// Turns +z into `direction`.
Mesh turned_toward(Mesh mesh, const Vec3d& direction) {
  const Vec3d z(0, 0, 1);
  const Vec3d axis = z.cross(direction);
  if (axis.length2() < 1e-12)
    return direction.z > 0 ? mesh : turned(std::move(mesh), {1, 0, 0}, 180);
  const double angle = std::atan2(axis.length(), direction.z);
  return turned(std::move(mesh), axis, angle * 180 / pi_d);
}

}  // namespace

CanSpot can_spot(const Vec3d& mount, const Vec3d& target) {
  CanSpot spot;
  const Vec3d joint = mount - Vec3d(0, 0, 0.16);
  spot.direction = (target - joint).normalized();
  // The can opens along +z; its back is at -0.07.
  constexpr double back = -0.06, front = back + can_length;
  Mesh can = revolved({{0, back},
                       {0.8 * can_radius, back},
                       {can_radius, back + 0.02},
                       {can_radius, front},
                       {can_radius - wall, front},
                       {can_radius - wall, front - recess},
                       {0, front - recess}},
                      16);
  spot.body = moved(turned_toward(std::move(can), spot.direction), joint);
  spot.body.append(tube(0.006, {joint + Vec3d(0, 0, 0.03), mount - Vec3d(0, 0, 0.01)}, 8));
  spot.body.append(moved(cylinder(0.035, -0.018, 0, 20), mount));
  spot.light = joint + spot.direction * (front - recess + 0.002);
  spot.radius = can_radius - 2 * wall;
  return spot;
}

Xml glowing_disk(const CanSpot& spot, double watts, const Vec3d& color) {
  const double area = pi_d * spot.radius * spot.radius;
  const Vec3d up = std::fabs(spot.direction.z) > 0.99 ? Vec3d(0, 1, 0) : Vec3d(0, 0, 1);
  Xml disk = object("shape", "disk");
  disk.add(transform({scale({spot.radius, spot.radius, 1}),
                      look_at(spot.light, spot.light + spot.direction, up)}));
  disk.add(ref("black"));
  disk.add(object("emitter", "area", {rgb("radiance", lamp_radiance(watts, area, color))}));
  return disk;
}

Xml glowing_rectangle(const Vec3d& center, const Vec2d& size, double watts, const Vec3d& color) {
  Xml shape = object("shape", "rectangle");
  shape.add(transform(
      {scale({0.5 * size.x, 0.5 * size.y, 1}), rotate({1, 0, 0}, 180), translate(center)}));
  shape.add(ref("black"));
  shape.add(
      object("emitter", "area", {rgb("radiance", lamp_radiance(watts, size.x * size.y, color))}));
  return shape;
}

Mesh lampshade(double radius0, double radius1, double z0, double z1) {
  return sheet(48, 1, [=](double u, double v) {
    const double angle = u == 1 ? 0 : 2 * pi_d * u, radius = radius0 + (radius1 - radius0) * v;
    return Vec3d(radius * std::cos(angle), radius * std::sin(angle), z0 + (z1 - z0) * v);
  });
}

ShadedLamp pendant_lamp(const Vec3d& mount, double drop, double shade_radius) {
  const double rim = mount.z - drop, height = 0.75 * shade_radius;
  ShadedLamp lamp;
  lamp.shade =
      moved(lampshade(shade_radius, 0.45 * shade_radius, rim, rim + height), {mount.x, mount.y, 0});
  lamp.metal = moved(cone(0.06, 0.03, -0.03, 0, 24), mount);
  lamp.metal = moved(turned(moved(lamp.metal, -mount), {1, 0, 0}, 180), mount - Vec3d(0, 0, 0.03));
  const Vec3d socket(mount.x, mount.y, rim + 0.62 * height);
  lamp.metal.append(tube(0.004, {mount - Vec3d(0, 0, 0.02), socket}, 8));
  lamp.metal.append(moved(cylinder(0.018, -0.05, 0.02, 20), socket));
  for (int i = 0; i < 3; ++i) {  // spokes that carry the shade
    const double a = 2 * pi_d * i / 3, radius = 0.452 * shade_radius;
    lamp.metal.append(tube(
        0.002,
        {socket,
         {mount.x + radius * std::cos(a), mount.y + radius * std::sin(a), rim + 0.995 * height}},
        6));
  }
  lamp.bulb = socket - Vec3d(0, 0, 0.05 + lamp.bulb_radius + 0.001);
  return lamp;
}

ShadedLamp floor_lamp(const Vec3d& foot, double height, double shade_radius) {
  ShadedLamp lamp;
  const double shade_height = 1.1 * shade_radius, rim = height - shade_height;
  const Curve stand = {{0, 0},
                       {0.15, 0},
                       {0.15, 0.015},
                       {0.06, 0.03},
                       {0.018, 0.06},
                       {0.012, 0.10},
                       {0.012, 0.60 * rim},
                       {0.022, 0.605 * rim},
                       {0.022, 0.62 * rim},
                       {0.011, 0.625 * rim},
                       {0.011, rim},
                       {0.02, rim + 0.01},
                       {0.02, rim + 0.06},
                       {0, rim + 0.06}};
  lamp.metal = moved(revolved(stand, 32), foot);
  lamp.bulb = foot + Vec3d(0, 0, rim + 0.06 + lamp.bulb_radius + 0.001);
  const double ring = rim + 0.75 * shade_height;
  for (int i = 0; i < 3; ++i) {
    const double a = 2 * pi_d * i / 3, radius = shade_radius * 0.80;
    lamp.metal.append(tube(0.002,
                           {foot + Vec3d(0, 0, rim + 0.02),
                            foot + Vec3d(radius * std::cos(a), radius * std::sin(a), rim + 0.03),
                            foot + Vec3d(radius * std::cos(a), radius * std::sin(a), ring)},
                           6));
  }
  lamp.shade = moved(lampshade(shade_radius, 0.82 * shade_radius, rim, height), foot);
  return lamp;
}

Xml glowing_ball(const Vec3d& center, double radius, double watts, const Vec3d& color) {
  Xml shape = object("shape", "sphere", {point("center", center), number("radius", radius)});
  shape.add(ref("black"));
  shape.add(object("emitter", "area",
                   {rgb("radiance", lamp_radiance(watts, 4 * pi_d * radius * radius, color))}));
  return shape;
}

}  // namespace kaustik::scenes
