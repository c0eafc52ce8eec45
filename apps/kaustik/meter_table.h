#pragma once
#include <string>
#include <vector>

#include "kaustik/render/checkpoint.h"
#include "kaustik/render/measurements.h"
#include "kaustik/scene/scene.h"

namespace kaustik::app {

/// What a meter shows, as a file: one row of comma-separated values for each of its points or rays.

/// Whether an output is such a table, by its extension.
bool is_table(const std::string& file);
/// Throws Error(input) if there is a table among the outputs, and the scene's camera is no meter.
void check_tables(const OutputPlan& outputs, const Scene& scene);

/// Columns: x, y, z of the meter, m; its value; half the width of the 95 % interval, empty
/// where that is unknown; the unit. Throws Error.
void write_table(const std::vector<Measurement>& list, const std::string& unit,
                 const std::string& file);

}  // namespace kaustik::app
