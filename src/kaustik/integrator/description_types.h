#pragma once
#include "kaustik/base/type_tables.h"

namespace kaustik {

/// The tables of all that a scene's description may hold: integrators, and what scenes are made of.
const TypeTables& description_types();

}  // namespace kaustik
