#pragma once
// What octrees (.oct) and compiled meshes (.rtm) of Radiance have in common: a header of lines,
// then big-endian integers, strings that end by a zero, and numbers by mantissa and exponent.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "kaustik/base/place.h"
#include "kaustik/base/vec.h"
#include "kaustik/loader/radiance/statements.h"

namespace kaustik::radiance {

/// Whether the header says that a file is of that format: "Radiance_octree", "Radiance_tmesh".
bool is_compiled(std::string_view bytes, std::string_view format);

/// Reads one after the other. All throw Error(input) where the file ends or is damaged.
class CompiledReader {
 public:
  /// Stands behind the header. `bytes` must outlive this.
  CompiledReader(std::string_view bytes, Place place);

  const Place& place() const { return place_; }
  size_t left() const { return bytes_.size() - at_; }
  /// Of 1 to 8 bytes, with its sign.
  int64_t integer(int size);
  /// How many there are: none negative, each at least `bytes_each` long.
  size_t count(int size, size_t bytes_each);
  double number();
  std::string text();
  /// The size of integers that stand for objects, by the number that begins a file: `magic` plus
  /// that size.
  void read_format(int magic);
  /// The corner and the size of the cube around all.
  void read_cube(Vec3d& corner, double& size);
  /// Of an object.
  int64_t object_number() { return integer(object_size_); }
  /// Passes over the tree of the cube.
  void skip_tree();
  /// Modifiers and surfaces in the order of their definition.
  Statements read_objects();
  [[noreturn]] void refuse() const;

 private:
  bool read_object(const std::vector<std::string>& types, Statements& found);

  std::string_view bytes_;
  Place place_;
  size_t at_ = 0;
  int object_size_ = 4;
};

/// What an octree holds: the files that it was made from, or if it is frozen their statements.
struct CompiledOctree {
  std::vector<std::string> files;
  Statements statements;
};
CompiledOctree read_octree(std::string_view bytes, const Place& place);

/// A mesh that obj2mesh made.
struct CompiledMesh {
  /// By three numbers of corners; `material` counts the statements, −1: none.
  struct Triangle {
    uint32_t corners[3] = {};
    int32_t material = -1;
  };
  struct Corner {
    Vec3f position, normal{0, 0, 0};  ///< normal zero: none
    float u = 0, v = 0;
  };
  Statements materials;
  std::vector<Corner> corners;
  std::vector<Triangle> triangles;
};
CompiledMesh read_compiled_mesh(std::string_view bytes, const Place& place);

}  // namespace kaustik::radiance
