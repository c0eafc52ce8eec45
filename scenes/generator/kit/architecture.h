#pragma once
// Rooms and what belongs to them. Metres, z up.

#include "kit/sweep.h"

namespace kaustik::scenes {

/// A hole in a wall: from `x` to `x + width` along the wall, from `z` to `z + height`.
struct Opening {
  double x, z, width, height;
};

/// A wall in the xz plane from the origin to (length, thickness, height), its face at y = 0, with
/// openings right through it that must not overlap one another along x. Made of blocks.
Mesh wall_with_openings(double length, double height, double thickness,
                        const std::vector<Opening>& openings);

/// Solid walls around the box [low, high] on its outside, thick enough to overlap at the corners.
struct RoomShell {
  Mesh floor, ceiling;
  Mesh west, east, south, north;  ///< at low x, high x, low y, high y
};
RoomShell room_shell(const Vec3d& low, const Vec3d& high, double thickness);

/// A moulding along the walls of the rectangle [low, high], inside it, at height z. The outline's x
/// runs from the wall into the room, its y up.
Mesh moulding_around(const Curve& outline, const Vec2d& low, const Vec2d& high, double z);
/// Outlines for it.
Curve skirting_outline(double height, double depth);
Curve cornice_outline(double size);  ///< hangs below z = 0

/// A window's bars in the xz plane from the origin to (width, 0, height): an outer frame and
/// `columns` x `rows` panes, all of square bars `bar` thick, centred on y = 0.
Mesh window_bars(double width, double height, int columns, int rows, double bar);

/// Boards of a herringbone floor over [low, high] whose tops lie at z = 0, sorted at random into
/// `groups` meshes of boards along x and as many along y, for different tones and grains of wood.
/// The length must be a multiple of the width.
std::vector<Mesh> herringbone_floor(const Vec2d& low, const Vec2d& high, double board_length,
                                    double board_width, int groups, uint64_t seed);
/// Long boards along y in `groups` meshes.
std::vector<Mesh> board_floor(const Vec2d& low, const Vec2d& high, double board_length,
                              double board_width, int groups, uint64_t seed);

/// Square slabs over [low, high], tops at z = 0, in two meshes like the fields of a chessboard.
std::vector<Mesh> chequered_floor(const Vec2d& low, const Vec2d& high, double slab);

}  // namespace kaustik::scenes
