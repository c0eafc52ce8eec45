#include "kaustik/geometry/shape_creators.h"

namespace kaustik {

const std::vector<ShapeType>& shape_types() {
  static const std::vector<ShapeType> types = {
      {obj_info(), create_obj},
      {ply_info(), create_ply},
      {serialized_info(), create_serialized},
      {mesh_info(), create_mesh},
      {heightfield_info(), create_heightfield},
      {rectangle_info(), create_rectangle},
      {cube_info(), create_cube},
      {disk_info(), create_disk},
      {sphere_info(), create_sphere},
      {cylinder_info(), create_cylinder},
      {sdf_info(), create_sdf},
      {sdfgrid_info(), create_sdfgrid},
  };
  return types;
}

}  // namespace kaustik
