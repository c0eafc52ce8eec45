#pragma once
// The entries of volume_types(), one per source file.

#include "kaustik/volume/volume.h"

namespace kaustik {

VolumeType constvolume_type();
VolumeType gridvolume_type();

}  // namespace kaustik
