#include "kaustik/loader/obj_materials.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <set>

#include "kaustik/base/text_lines.h"
#include "kaustik/loader/mitsuba_upgrade.h"
#include "kaustik/loader/mitsuba_values.h"
#include "kaustik/loader/mtl_file.h"
#include "kaustik/loader/object_parts.h"

namespace kaustik {
namespace {

namespace fs = std::filesystem;

/// What an OBJ file says of materials.
struct ObjMaterials {
  std::vector<std::string> used;           ///< those that faces have, in order; "": none
  std::vector<uint32_t> of_part;           ///< of the shapes in the file: indices of `used`
  std::map<std::string, Place> libraries;  ///< the lines that name them
  uint64_t file_size = 0;
};

/// For each material the file is read once: all together may be so much.
constexpr uint64_t most_bytes = uint64_t{8} << 30;
constexpr size_t most_libraries = 100;

/// What the reader has made of a name, as it does with those of parameters.
std::string name_in_scene(const std::string& material) {
  return mitsuba::upgraded_name(material, {"shape", "obj", "", {}, {}, {}}, {0, 6, 0});
}

bool has_bsdf(const Object& shape, bool with_name) {
  return std::any_of(shape.children.begin(), shape.children.end(), [&](const Child& child) {
    return child.object->family == "bsdf" && child.name.empty() != with_name;
  });
}

ObjMaterials materials_of(const std::string& path) {
  ObjMaterials found;
  TextLines lines(path);
  found.file_size = lines.file_size();
  std::string material;
  std::map<std::string, uint32_t> numbers;
  bool has_faces = false;  // the shape in the file, which ends before the next group or material
  for (std::string_view line; lines.next(line);) {
    const std::string_view keyword = next_word(line);
    if (keyword == "usemtl" || keyword == "g") {
      if (keyword == "usemtl") material = trimmed(line);
      has_faces = false;
    } else if (keyword == "mtllib") {
      if (found.libraries.size() < most_libraries)
        found.libraries.try_emplace(std::string(trimmed(line)), place_in(path, lines.number()));
    } else if (keyword == "f" && !has_faces) {
      found.of_part.push_back(
          numbers.try_emplace(material, uint32_t(numbers.size())).first->second);
      has_faces = true;
    }
  }
  std::vector<uint32_t> in_order(numbers.size());
  for (const auto& [name, number] : numbers) {
    in_order[number] = uint32_t(found.used.size());
    found.used.push_back(name);
  }
  for (uint32_t& number : found.of_part) number = in_order[number];
  return found;
}

/// Of the shape in the file that is asked for, or of all.
ObjMaterials materials_for(const Object& shape, const ObjMaterials& of_file) {
  const auto* part = value_in<int64_t>(shape, "shape_index");
  if (!part) return of_file;
  ObjMaterials selected = {{}, {}, of_file.libraries, of_file.file_size};
  if (*part >= 0 && uint64_t(*part) < of_file.of_part.size())
    selected.used = {of_file.used[of_file.of_part[size_t(*part)]]};
  return selected;
}

class MaterialUser {
 public:
  MaterialUser(Description& description, const std::set<const Object*>& shapes,
               const FindBeside& find)
      : description_(description), shapes_(shapes), find_(find) {}

  void visit(Object& parent) {
    if (!seen_.insert(&parent).second) return;
    std::vector<Child> children;
    for (Child& child : parent.children) {
      if (!shapes_.contains(child.object.get())) {
        visit(*child.object);
        children.push_back(std::move(child));
        continue;
      }
      for (const auto& part : parts_of(child.object)) children.push_back({child.name, part});
    }
    parent.children = std::move(children);
  }

 private:
  using Bsdfs = std::map<std::string, std::shared_ptr<Object>>;

  void tell_of_missing(const std::string& path, const ObjMaterials& materials, const Bsdfs& bsdfs);
  std::vector<std::shared_ptr<Object>> parts_of(const std::shared_ptr<Object>& shape);
  Bsdfs bsdfs_for(const Object& shape, const ObjMaterials& materials, bool loads_materials);
  Bsdfs library_bsdfs(const std::string& obj_path, const std::map<std::string, Place>& names);
  void add_library(const fs::path& path, Bsdfs& bsdfs);
  const ObjMaterials* known_materials(const std::string& path);

  Description& description_;
  const std::set<const Object*>& shapes_;
  const FindBeside& find_;
  std::set<const Object*> seen_;
  std::map<std::string, std::optional<ObjMaterials>> materials_;  ///< by path; none: unreadable
  std::map<std::string, MtlFile> libraries_;                      ///< by path
  std::set<std::string> told_;  ///< files with materials that are missing
};

/// Each file is read once, however many shapes name it.
const ObjMaterials* MaterialUser::known_materials(const std::string& path) {
  const auto [entry, is_new] = materials_.try_emplace(path);
  if (is_new) {
    try {
      entry->second = materials_of(path);
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::input) throw;
    }
  }
  return entry->second ? &*entry->second : nullptr;
}

void MaterialUser::add_library(const fs::path& path, Bsdfs& bsdfs) {
  const auto [entry, is_new] = libraries_.try_emplace(path.string());
  if (is_new) {
    entry->second = read_mtl(path.string(), find_);
    description_.sources.push_back(path.string());
    for (const std::string& remark : entry->second.remarks) description_.warnings.push_back(remark);
  }
  for (const auto& [name, bsdf] : entry->second.bsdfs) bsdfs.try_emplace(name, bsdf);
}

MaterialUser::Bsdfs MaterialUser::library_bsdfs(const std::string& obj_path,
                                                const std::map<std::string, Place>& names) {
  Bsdfs bsdfs;
  const fs::path folder = fs::path(obj_path).parent_path();
  bool is_missing = false;
  for (const auto& entry : names) {
    const std::string& line = entry.first;
    const auto take = [&](std::string_view name) {
      const std::optional<fs::path> found = find_(std::string(name), folder, entry.second);
      if (found) add_library(*found, bsdfs);
      return found.has_value();
    };
    // One name with blanks, or several names.
    bool any = take(line);
    std::string_view rest = any ? std::string_view() : line;
    for (std::string_view name = next_word(rest); !name.empty(); name = next_word(rest))
      any |= take(name);
    is_missing |= !any;
  }
  if (is_missing)
    description_.warnings.push_back(
        fmt::format("{}: a file of materials that it names is not there", obj_path));
  return bsdfs;
}

/// What each of the file's materials becomes; those that are left out get none.
MaterialUser::Bsdfs MaterialUser::bsdfs_for(const Object& shape, const ObjMaterials& materials,
                                            bool loads_materials) {
  Bsdfs bsdfs;
  std::shared_ptr<Object> of_all;
  for (const Child& child : shape.children) {
    if (child.object->family != "bsdf") continue;
    bool is_named = false;
    for (const std::string& material : materials.used)
      if (!material.empty() && child.name == name_in_scene(material)) {
        bsdfs[material] = child.object;
        is_named = true;
      }
    if (!is_named) of_all = child.object;
  }
  if (of_all && bsdfs.empty()) return {};
  for (const std::string& material : materials.used)
    if (of_all) bsdfs.try_emplace(material, of_all);
  if (of_all || !loads_materials) return bsdfs;
  for (const auto& [name, bsdf] :
       library_bsdfs(*value_in<std::string>(shape, "filename"), materials.libraries))
    if (std::binary_search(materials.used.begin(), materials.used.end(), name))
      bsdfs.try_emplace(name, bsdf);
  tell_of_missing(*value_in<std::string>(shape, "filename"), materials, bsdfs);
  return bsdfs;
}

/// Once for each file.
void MaterialUser::tell_of_missing(const std::string& path, const ObjMaterials& materials,
                                   const Bsdfs& bsdfs) {
  std::string first;
  size_t count = 0;
  for (const std::string& material : materials.used) {
    if (material.empty() || bsdfs.contains(material)) continue;
    if (count++ == 0) first = material;
  }
  // Where no file of materials was read, that has been told.
  if (count == 0 || libraries_.empty() || !told_.insert(path).second) return;
  description_.warnings.push_back(fmt::format(
      "{}: its file of materials lacks {}{}: what has it is matt and grey", path,
      mitsuba::in_quotes(first), count > 1 ? fmt::format(" and {} more", count - 1) : ""));
}

std::vector<std::shared_ptr<Object>> MaterialUser::parts_of(const std::shared_ptr<Object>& shape) {
  const auto* loads = value_in<bool>(*shape, "load_materials");
  const bool loads_materials = !loads || *loads;
  std::erase_if(shape->properties, [](const Property& p) { return p.name == "load_materials"; });
  const auto* file = value_in<std::string>(*shape, "filename");
  if (!file || (has_bsdf(*shape, false) && !has_bsdf(*shape, true))) return {shape};
  const ObjMaterials* of_file = known_materials(*file);
  if (!of_file) return {shape};
  const ObjMaterials materials = materials_for(*shape, *of_file);
  const Bsdfs bsdfs = bsdfs_for(*shape, materials, loads_materials);
  if (bsdfs.empty()) return {shape};
  if (materials.used.size() > most_bytes / std::max<uint64_t>(1, materials.file_size)) {
    description_.warnings.push_back(
        fmt::format("{}: its {} materials take too long to be told apart: they are left out", *file,
                    materials.used.size()));
    return {shape};
  }

  std::vector<std::shared_ptr<Object>> parts;
  for (const std::string& material : materials.used) {
    auto part = std::make_shared<Object>(*shape);
    if (!parts.empty() && !part->id.empty()) part->id += ":" + material;
    std::erase_if(part->children, [](const Child& c) { return c.object->family == "bsdf"; });
    if (const auto found = bsdfs.find(material); found != bsdfs.end())
      part->children.push_back({"", found->second});
    if (materials.used.size() > 1) part->properties.push_back({"material", material, shape->place});
    parts.push_back(std::move(part));
  }
  return parts;
}

}  // namespace

void use_obj_materials(Description& description, const std::set<const Object*>& shapes,
                       const FindBeside& find) {
  if (!shapes.empty()) MaterialUser(description, shapes, find).visit(*description.scene);
}

}  // namespace kaustik
