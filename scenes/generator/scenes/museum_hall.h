#pragma once
// The building of the museum: hall, cabinet, their lamps and the daylight.

#include "kit/architecture.h"
#include "scenes/materials.h"

namespace kaustik::scenes::museum {

// The hall, and the cabinet behind the doorway in its north wall.
inline const Vec3d low(-5, -5.5, 0), high(5, 5, 4.4);
inline const Vec3d cabinet_low(1.2, 5.4, 0), cabinet_high(5, 8.4, 3.4);

inline constexpr double board_width = 0.155;
inline const BoardWood floor_wood{{0.38, 0.21, 0.11}, {0.17, 0.08, 0.035}, board_width, low, 0, 4};

// Each adds its part; materials are named as in museum.cpp.
void add_hall(SceneFolder& scene);
/// Windows' bars and sills, mouldings, the doorway's casing.
void add_joinery(SceneFolder& scene);
void add_cabinet(SceneFolder& scene);
void add_ceiling_lights(SceneFolder& scene);
void add_daylight(SceneFolder& scene);

}  // namespace kaustik::scenes::museum
