#pragma once
#include "kaustik/base/type_tables.h"

namespace kaustik {

/// The tables of all that build_scene() makes: everything but integrators.
const TypeTables& scene_types();

/// Of the shapes that only a scene knows: groups, what places them, and what is taken apart.
const TypeInfo& shapegroup_info();
const TypeInfo& instance_info();
const TypeInfo& merge_info();

}  // namespace kaustik
