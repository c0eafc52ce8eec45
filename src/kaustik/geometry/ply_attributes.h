#pragma once
// Attributes in PLY files; for the reader alone.

#include <cstddef>
#include <string>
#include <vector>

#include "kaustik/geometry/mesh_attribute.h"
#include "kaustik/geometry/mesh_reader.h"
#include "kaustik/geometry/ply_header.h"

namespace kaustik {

/// Attributes that are read from the properties of an element.
class PlyAttributes {
 public:
  /// `whose`: "vertex_" or "face_".
  PlyAttributes(const PlyElement& element, const std::string& whose);

  bool empty() const { return attributes_.empty(); }
  size_t values_of_element() const { return members_.size(); }
  /// For so many elements.
  void reserve(size_t elements);
  /// Makes them those of so many elements, to be set in any order.
  void resize(size_t elements);
  /// Sets those of one element: `number(property)` is the number of each property.
  template <typename Number>
  void set(size_t element, const Number& number) {
    auto member = members_.begin();
    for (MeshAttribute& attribute : attributes_) {
      const auto components = size_t(attribute.components);
      for (size_t i = 0; i < components; ++i, ++member)
        attribute.values[element * components + i] =
            attribute_value(number(member->property), member->largest);
    }
  }
  /// Sets those of elements from `first` on, whose properties are `fields` of records.
  void set_all(size_t first, const PlyRecords& records, const std::vector<PlyField>& fields);
  /// Sets those of one element more.
  template <typename Number>
  void add(const Number& number) {
    resize(elements_ + 1);
    set(elements_ - 1, number);
  }
  /// Moves them into the mesh; tells what is not finite.
  void finish(MeshFile& file, const std::string& path);

 private:
  struct Member {
    size_t property;
    double largest;  ///< see attribute_value()
  };
  std::vector<MeshAttribute> attributes_;
  std::vector<Member> members_;  ///< of all attributes in turn
  size_t elements_ = 0;
};

}  // namespace kaustik
