#pragma once
// Lamps: their bodies as meshes, and where their light leaves them. Metres.

#include "kit/scene_folder.h"

namespace kaustik::scenes {

/// Lamp colours as a camera balanced for 3600 K sees them; linear Rec. 709.
inline const Vec3d warm_white(1.0, 0.80, 0.56);     ///< halogen, 2900 K
inline const Vec3d neutral_white(1.0, 0.95, 0.88);  ///< fluorescent, 3800 K
inline const Vec3d evening_sun(1.0, 0.84, 0.62);
inline const Vec3d sky_blue(0.78, 0.92, 1.15);

/// A spotlight with a deep can: the body, and the disk that glows inside.
struct CanSpot {
  Mesh body;  ///< can, joint and rod up to the ceiling
  Vec3d light, direction;
  double radius = 0;  ///< of the glowing disk
};
/// Hung below the ceiling point `mount`, aimed at `target`.
CanSpot can_spot(const Vec3d& mount, const Vec3d& target);
/// The glowing disk as a shape of `watts`.
Xml glowing_disk(const CanSpot& spot, double watts, const Vec3d& color);

/// A flat rectangular lamp, horizontal, `size` across, shining down from `center`, as a shape.
Xml glowing_rectangle(const Vec3d& center, const Vec2d& size, double watts, const Vec3d& color);

/// A lampshade: a cone of thin cloth without a wall, open at both ends, from height z0 to z1.
Mesh lampshade(double radius0, double radius1, double z0, double z1);
/// A lamp with a shade, in its parts.
struct ShadedLamp {
  Mesh metal, shade;
  Vec3d bulb;  ///< centre of the glowing ball
  double bulb_radius = 0.04;
};
/// Hangs from the ceiling point `mount`; the shade's lower rim is `drop` below it.
ShadedLamp pendant_lamp(const Vec3d& mount, double drop, double shade_radius);
/// Stands on the floor at `foot`.
ShadedLamp floor_lamp(const Vec3d& foot, double height, double shade_radius);

/// A ball that glows.
Xml glowing_ball(const Vec3d& center, double radius, double watts, const Vec3d& color);

}  // namespace kaustik::scenes
