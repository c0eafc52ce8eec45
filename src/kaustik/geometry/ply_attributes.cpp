#include "kaustik/geometry/ply_attributes.h"

#include <utility>

#include "kaustik/base/memory.h"
#include "kaustik/geometry/attribute_groups.h"

namespace kaustik {

PlyAttributes::PlyAttributes(const PlyElement& element, const std::string& whose) {
  std::vector<std::string> names;
  for (const PlyProperty& property : element.properties)
    names.push_back(property.is_list ? std::string() : property.name);
  for (const AttributeGroup& group : attribute_groups(names)) {
    attributes_.push_back({whose + group.name, int(group.members.size())});
    for (const size_t i : group.members)
      members_.push_back({i, largest_of(element.properties[i].type)});
  }
}

void PlyAttributes::reserve(size_t elements) {
  for (MeshAttribute& attribute : attributes_)
    reserve_large(attribute.values, elements * size_t(attribute.components));
}

void PlyAttributes::resize(size_t elements) {
  for (MeshAttribute& attribute : attributes_)
    attribute.values.resize(elements * size_t(attribute.components));
  elements_ = elements;
}

void PlyAttributes::set_all(size_t first, const PlyRecords& records,
                            const std::vector<PlyField>& fields) {
  if (empty()) return;
  for (size_t i = 0; i < records.size(); ++i)
    set(first + i, [&](size_t property) {
      const PlyField& field = fields[property];
      return value_at(records[i] + field.offset, field.type, records.big_endian);
    });
}

void PlyAttributes::finish(MeshFile& file, const std::string& path) {
  for (MeshAttribute& attribute : attributes_) {
    if (const size_t count = make_finite(attribute); count > 0)
      file.remarks.push_back(remark_on_attribute(attribute.name, count, path));
    file.mesh.attributes.push_back(std::move(attribute));
  }
  attributes_.clear();
}

}  // namespace kaustik
