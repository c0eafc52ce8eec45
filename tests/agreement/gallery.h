#pragma once
// The scenes of docs/gallery, one for each type, as regression tests: what `path` made of them
// once.

#include <string>
#include <vector>

#include "tests/agreement/block_samples.h"

namespace kaustik::agreement {

/// "bsdf_phong", …: of all scenes in docs/gallery, sorted.
std::vector<std::string> gallery_scenes();
/// What their references are made by …
BlockRender gallery_reference(const std::string& scene);
/// … and what is compared with them.
BlockRender gallery_render(const std::string& scene, const std::string& integrator);
/// The reference's file.
std::string gallery_path(const std::string& scene);

}  // namespace kaustik::agreement
