#pragma once
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "kaustik/loader/file_search.h"
#include "kaustik/scene/description.h"

namespace kaustik {

/// What the materials of an MTL file become.
struct MtlFile {
  std::map<std::string, std::shared_ptr<Object>> bsdfs;  ///< by their names
  std::vector<std::string> remarks;                      ///< what was left out, a sentence each
};

/// Reads Wavefront's MTL. Kd, Ks and Ns become `diffuse` or `phong`, a picture stands for Kd
/// (`map_Kd`); Ni and Tf a `dielectric` where `illum` says so, or the material is seen through; the
/// illumination models 3 and 5 add a mirror; d, Tr and map_d a `mask`. All else is left out, lines
/// that are wrong among it. Pictures are found by `find`. Throws Error(input) if the file cannot be
/// read; quotes nothing of it, which may be any that a scene names.
MtlFile read_mtl(const std::string& path, const FindBeside& find);

}  // namespace kaustik
