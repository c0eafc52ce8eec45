#pragma once
// What each shape's file gives to the registry.

#include "kaustik/geometry/shape.h"

namespace kaustik {

const TypeInfo& obj_info();
std::unique_ptr<Shape> create_obj(const Arguments& arguments);
const TypeInfo& ply_info();
std::unique_ptr<Shape> create_ply(const Arguments& arguments);
const TypeInfo& serialized_info();
std::unique_ptr<Shape> create_serialized(const Arguments& arguments);
const TypeInfo& heightfield_info();
std::unique_ptr<Shape> create_heightfield(const Arguments& arguments);
const TypeInfo& mesh_info();
std::unique_ptr<Shape> create_mesh(const Arguments& arguments);
const TypeInfo& rectangle_info();
std::unique_ptr<Shape> create_rectangle(const Arguments& arguments);
const TypeInfo& cube_info();
std::unique_ptr<Shape> create_cube(const Arguments& arguments);
const TypeInfo& disk_info();
std::unique_ptr<Shape> create_disk(const Arguments& arguments);
const TypeInfo& sphere_info();
std::unique_ptr<Shape> create_sphere(const Arguments& arguments);
const TypeInfo& cylinder_info();
std::unique_ptr<Shape> create_cylinder(const Arguments& arguments);
const TypeInfo& sdf_info();
std::unique_ptr<Shape> create_sdf(const Arguments& arguments);
const TypeInfo& sdfgrid_info();
std::unique_ptr<Shape> create_sdfgrid(const Arguments& arguments);

}  // namespace kaustik
