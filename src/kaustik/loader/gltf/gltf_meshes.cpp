#include "kaustik/loader/gltf/gltf_meshes.h"

#include <fmt/format.h>

#include <algorithm>

#include "kaustik/loader/closed_mesh.h"
#include "kaustik/loader/gltf/gltf_packed_primitive.h"
#include "kaustik/loader/gltf/gltf_triangles.h"
#include "kaustik/loader/object_maker.h"
#include "kaustik/loader/stand_ins.h"

namespace kaustik::gltf {
namespace {

/// The variant of KHR_materials_variants that is asked for.
std::optional<size_t> variant_index(const File& file, const Options& options,
                                    Deviations& deviations) {
  const JsonValue* extension = file.extension(file.root(), "KHR_materials_variants");
  const JsonValue* variants = extension ? extension->find("variants") : nullptr;
  if (!variants) return std::nullopt;
  std::vector<std::string> names;
  for (const JsonValue& variant : variants->items())
    names.push_back(file.text(variant, "name", ""));
  for (size_t i = 0; i < names.size(); ++i)
    if (!options.variant.empty() && names[i] == options.variant) return i;
  if (!options.variant.empty())
    file.fail(*variants, fmt::format("there is no variant '{}'", options.variant),
              suggest(options.variant, names));
  deviations.ignored("variants of materials",
                     fmt::format("the first look is shown; gltf.variant chooses one of: {}",
                                 fmt::join(names, ", ")),
                     file.place(*variants));
  return std::nullopt;
}

}  // namespace

Meshes::Meshes(File& file, Accessors& accessors, Materials& materials, const Options& options,
               Deviations& deviations)
    : file_(file),
      accessors_(accessors),
      materials_(materials),
      deviations_(deviations),
      variant_(variant_index(file, options, deviations)) {}

const Meshes::Shapes& Meshes::shapes(size_t mesh, const JsonValue& at) {
  const auto [entry, is_new] = known_.try_emplace(mesh);
  if (is_new) entry->second = make(mesh, {}, at);
  return entry->second;
}

Meshes::Shapes Meshes::deformed_shapes(size_t mesh, const Deformation& deformation,
                                       const JsonValue& at) {
  return make(mesh, deformation, at);
}

Meshes::Shapes Meshes::make(size_t index, const Deformation& deformation, const JsonValue& at) {
  const JsonValue& mesh = file_.item("meshes", index, at);
  const JsonValue* primitives = mesh.find("primitives");
  Shapes shapes;
  if (!primitives) return shapes;
  for (const JsonValue& primitive : primitives->items()) {
    const JsonValue* attributes = primitive.find("attributes");
    const std::string name = file_.name_of("mesh", mesh, index);
    if (!attributes || !attributes->find("POSITION")) {
      deviations_.ignored(name, "it has no POSITION", file_.place(primitive));
      continue;
    }
    const Part part = {primitive, *attributes, name, material_of(primitive),
                       file_.place(primitive)};
    file_.spend(sizeof(Object), primitive);
    if (auto shape = shape_of(part, deformation)) shapes.push_back(std::move(shape));
  }
  return shapes;
}

std::optional<size_t> Meshes::material_of(const JsonValue& primitive) const {
  std::optional<size_t> material = file_.count(primitive, "material");
  const JsonValue* variants = file_.extension(primitive, "KHR_materials_variants");
  const JsonValue* mappings = variants && variant_ ? variants->find("mappings") : nullptr;
  if (mappings)
    for (const JsonValue& mapping : mappings->items())
      if (const JsonValue* list = mapping.find("variants"))
        for (const JsonValue& item : list->items())
          if (item.number() == double(*variant_)) material = file_.count(mapping, "material");
  if (material) file_.item("materials", *material, primitive);
  return material;
}

std::shared_ptr<Object> Meshes::shape_of(const Part& part, const Deformation& deformation) {
  const size_t mode = file_.count(part.primitive, "mode").value_or(4);
  if (mode < 4 || mode > 6) {
    deviations_.ignored(part.name, "its points or lines are left out", part.place);
    return nullptr;
  }
  const size_t position = *file_.count(part.attributes, "POSITION");
  const size_t vertices = accessors_.shape(position, part.attributes).count;
  try {
    supply_unpacked(file_, accessors_, part.primitive);
    const auto positions = attribute(part, "POSITION", vertices, 3, 3);
    const auto faces = faces_of(part, vertices);
    if (vertices == 0 || faces->count() == 0) {
      deviations_.ignored(part.name, "it has no triangles", part.place);
      return nullptr;
    }
    auto shape = make_object("shape", "mesh", part.place);
    give(*shape, "positions",
         deformed(file_, accessors_, part.primitive, "POSITION", positions, deformation));
    give(*shape, "faces", faces);
    if (const auto normals = attribute(part, "NORMAL", vertices, 3, 3))
      give(*shape, "normals",
           deformed(file_, accessors_, part.primitive, "NORMAL", normals, deformation));
    else
      give(*shape, "face_normals", true);
    SurfaceUse use;
    give_uvs(part, vertices, *shape);
    give_colors(part, vertices, *shape, use);
    if (materials_.asks_if_closed(part.material)) {
      file_.spend(12 * (positions->count() + faces->count()), part.primitive);
      use.is_closed = is_closed(*positions, *faces);
    }
    give_surface(part, use, *shape);
    return shape;
  } catch (const MissingData& missing) {
    return stand_in(part, missing.what);
  }
}

std::shared_ptr<Object> Meshes::stand_in(const Part& part, const std::string& why) {
  const auto box =
      accessors_.told_bounds(*file_.count(part.attributes, "POSITION"), part.attributes);
  deviations_.missing(part.name, why + (box ? ": its box stands for it" : ""), part.place);
  return box ? missing_mesh(*box, Transform(), part.place) : nullptr;
}

std::shared_ptr<const Array> Meshes::attribute(const Part& part, const std::string& name,
                                               size_t vertices, size_t least, size_t most) {
  const auto index = file_.count(part.attributes, name);
  if (!index) return nullptr;
  const AccessorShape shape = accessors_.shape(*index, part.attributes);
  if (shape.count != vertices || shape.components < least || shape.components > most)
    file_.fail(*part.attributes.find(name),
               fmt::format("{} has {} elements of {} numbers, and there are {} vertices", name,
                           shape.count, shape.components, vertices),
               "export the file again");
  return accessors_.floats(*index, part.attributes);
}

std::shared_ptr<const Array> Meshes::faces_of(const Part& part, size_t vertices) {
  const auto topology = Topology(file_.count(part.primitive, "mode").value_or(4));
  const auto index = file_.count(part.primitive, "indices");
  const auto indices = index ? accessors_.indices(*index, part.primitive) : nullptr;
  const size_t count = indices ? indices->count() : vertices;
  if (!indices || topology != Topology::triangles)
    file_.spend(3 * count * sizeof(uint32_t), part.primitive);
  if (topology == Topology::triangles && count % 3 != 0)
    deviations_.ignored(part.name, "its last triangle lacks corners", part.place);
  return triangles_of(indices, vertices, topology);
}

void Meshes::give_uvs(const Part& part, size_t vertices, Object& shape) {
  const size_t set = materials_.uv_set(part.material);
  if (auto uvs = attribute(part, fmt::format("TEXCOORD_{}", set), vertices, 2, 2))
    give(shape, "uv", std::move(uvs));
}

bool Meshes::needs_opacity(const Part& part) const {
  return part.material && file_.text(file_.item("materials", *part.material, part.primitive),
                                     "alphaMode", "OPAQUE") != "OPAQUE";
}

/// COLOR_0, of three numbers or four; beyond 1 it is 1.
void Meshes::give_colors(const Part& part, size_t vertices, Object& shape, SurfaceUse& use) {
  const auto given = attribute(part, "COLOR_0", vertices, 3, 4);
  if (!given) return;
  file_.spend(vertices, part.primitive);  // time, for primitives may share their colours
  const std::span<const float> numbers = floats_in(*given);
  const size_t components = given->extents()[1];
  const bool is_within = std::all_of(numbers.begin(), numbers.end(),
                                     [](float number) { return number >= 0 && number <= 1; });
  if (!is_within)
    deviations_.approximated(part.name, "colours of its vertices beyond 1 are taken as 1",
                             part.place);
  use.has_colors = true;
  if (components == 3 && is_within) {
    give(shape, "vertex_color", given);
    return;
  }
  file_.spend(4 * vertices * sizeof(float), part.primitive);
  std::vector<float> colors, opacities;
  const auto within = [](float number) { return number >= 0 ? std::min(number, 1.0f) : 0.0f; };
  for (size_t i = 0; i < vertices; ++i) {
    for (size_t k = 0; k < 3; ++k) colors.push_back(within(numbers[i * components + k]));
    opacities.push_back(components == 4 ? within(numbers[i * components + 3]) : 1.0f);
  }
  give(shape, "vertex_color", Array::of<float>({vertices, 3}, std::move(colors)));
  const bool is_opaque =
      std::all_of(opacities.begin(), opacities.end(), [](float opacity) { return opacity == 1; });
  if (is_opaque || !needs_opacity(part)) return;
  give(shape, "vertex_value", Array::of<float>({vertices}, std::move(opacities)));
  use.has_opacities = true;
}

void Meshes::give_surface(const Part& part, const SurfaceUse& use, Object& shape) {
  const Surface& surface = materials_.surface(part.material, use);
  put(shape, "", surface.bsdf);
  if (surface.interior) put(shape, "interior", surface.interior);
  // Each lamp is one of its own; they share the texture.
  if (surface.emitter) put(shape, "", std::make_shared<Object>(*surface.emitter));
}

}  // namespace kaustik::gltf
