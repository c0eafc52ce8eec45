#pragma once
#include "kaustik/loader/gltf/gltf_file.h"

namespace kaustik::gltf {

/// Throws Error(input) for an extension that the file requires and that cannot be read; tells of
/// others that are not read.
void check_extensions(const File& file, Deviations& deviations);

}  // namespace kaustik::gltf
