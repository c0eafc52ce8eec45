#include "kaustik/loader/gltf/gltf_accessor.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <type_traits>

namespace kaustik::gltf {
namespace {

enum ComponentType { int8 = 5120, uint8, int16, uint16, uint32 = 5125, float32 };

size_t bytes_of_component(int type) {
  switch (type) {
    case int8:
    case uint8:
      return 1;
    case int16:
    case uint16:
      return 2;
    case uint32:
    case float32:
      return 4;
  }
  return 0;
}

struct ElementKind {
  const char* name;
  size_t rows, columns;
};
constexpr ElementKind element_kinds[] = {{"SCALAR", 1, 1}, {"VEC2", 2, 1}, {"VEC3", 3, 1},
                                         {"VEC4", 4, 1},   {"MAT2", 2, 2}, {"MAT3", 3, 3},
                                         {"MAT4", 4, 4}};

template <typename T>
T read_as(const std::byte* at) {
  T value;
  std::memcpy(&value, at, sizeof(T));
  return value;
}

/// Calls `use` with a zero of the type.
template <typename Use>
void with_type(int component_type, const Use& use) {
  switch (component_type) {
    case int8:
      return use(int8_t{});
    case uint8:
      return use(uint8_t{});
    case int16:
      return use(int16_t{});
    case uint16:
      return use(uint16_t{});
    case uint32:
      return use(uint32_t{});
    default:
      return use(float{});
  }
}

/// Of a normalised integer: the smallest one stands for −1, too.
template <typename T>
float number_of(T value, bool is_normalised) {
  if constexpr (std::is_floating_point_v<T>) {
    return value;
  } else {
    if (!is_normalised) return float(value);
    return std::max(float(double(value) / double(std::numeric_limits<T>::max())), -1.0f);
  }
}

}  // namespace

Accessors::Layout Accessors::layout_of(const JsonValue& accessor, size_t index) const {
  Layout layout;
  const std::string type = file_.text(accessor, "type", "");
  for (const ElementKind& kind : element_kinds)
    if (type == kind.name) {
      layout.row_components = kind.rows;
      layout.columns = kind.columns;
    }
  layout.component_type = int(std::min<size_t>(file_.count(accessor, "componentType").value_or(0),
                                               std::numeric_limits<int>::max()));
  layout.component_bytes = bytes_of_component(layout.component_type);
  if (layout.row_components == 0 || layout.component_bytes == 0)
    file_.fail(accessor,
               fmt::format("accessor {} has no 'type' and 'componentType' that glTF knows", index),
               "export the file again");
  layout.count = file_.count(accessor, "count").value_or(0);
  layout.is_normalised = file_.boolean(accessor, "normalized", false);
  // Columns of matrices begin at whole words.
  layout.column_bytes = layout.component_bytes * layout.row_components;
  if (layout.columns > 1) layout.column_bytes = (layout.column_bytes + 3) / 4 * 4;
  layout.element_bytes = layout.column_bytes * layout.columns;
  layout.stride = layout.element_bytes;
  constexpr size_t most = size_t{1} << 40;
  if (layout.count > most)
    file_.fail(accessor, fmt::format("accessor {} is too large", index), "export the file again");
  return layout;
}

AccessorShape Accessors::shape(size_t index, const JsonValue& at) const {
  const Layout layout = layout_of(file_.item("accessors", index, at), index);
  AccessorShape shape{layout.count, layout.components()};
  with_type(layout.component_type, [&]<typename T>(T) {
    if constexpr (std::is_integral_v<T>)
      if (layout.is_normalised) shape.scale = 1 / float(std::numeric_limits<T>::max());
  });
  return shape;
}

Bytes Accessors::checked_part(size_t view, size_t offset, size_t wanted, const JsonValue& at,
                              const std::string& who) {
  Bytes bytes = file_.view(view, at);
  if (offset > bytes.bytes.size() || wanted > bytes.bytes.size() - offset)
    file_.fail(at,
               fmt::format("{} takes {} bytes from byte {} of bufferView {} on, which has {}", who,
                           wanted, offset, view, bytes.bytes.size()),
               "copy or export the file again: it may be cut off");
  bytes.bytes = bytes.bytes.subspan(offset, wanted);
  return bytes;
}

/// Nothing: they are zeros. `layout.stride` is to be that of the view.
std::optional<Bytes> Accessors::bytes_of(const JsonValue& accessor, const Layout& layout,
                                         size_t index) {
  const auto view = file_.count(accessor, "bufferView");
  if (!view || layout.count == 0) return std::nullopt;
  return checked_part(*view, file_.count(accessor, "byteOffset").value_or(0),
                      layout.stride * (layout.count - 1) + layout.element_bytes, accessor,
                      fmt::format("accessor {}", index));
}

std::optional<Accessors::Sparse> Accessors::sparse_of(const JsonValue& accessor,
                                                      const Layout& layout, size_t index) {
  const JsonValue* sparse = accessor.find("sparse");
  if (!sparse) return std::nullopt;
  const std::string who = fmt::format("the sparse part of accessor {}", index);
  const JsonValue *places = sparse->find("indices"), *values = sparse->find("values");
  const size_t count = file_.count(*sparse, "count").value_or(0);
  const auto refuse = [&] { file_.fail(*sparse, who + " is wrong", "export the file again"); };
  if (!places || !values || count > layout.count) refuse();
  const auto place_view = file_.count(*places, "bufferView");
  const auto value_view = file_.count(*values, "bufferView");
  const size_t type = file_.count(*places, "componentType").value_or(0);
  if (!place_view || !value_view || (type != uint8 && type != uint16 && type != uint32)) refuse();
  const size_t place_bytes = bytes_of_component(int(type));
  Sparse result;
  const Bytes bytes = checked_part(*place_view, file_.count(*places, "byteOffset").value_or(0),
                                   count * place_bytes, *places, who);
  result.values = checked_part(*value_view, file_.count(*values, "byteOffset").value_or(0),
                               count * layout.element_bytes, *values, who);
  file_.spend(count * sizeof(size_t), *sparse);
  result.places.reserve(count);
  with_type(int(type), [&](auto zero) {
    for (size_t i = 0; i < count; ++i)
      result.places.push_back(size_t(read_as<decltype(zero)>(&bytes.bytes[i * place_bytes])));
  });
  for (const size_t place : result.places)
    if (place >= layout.count) refuse();
  return result;
}

std::shared_ptr<const Array> Accessors::floats(size_t index, const JsonValue& at) {
  const JsonValue& accessor = file_.item("accessors", index, at);
  auto& known = known_[{index, true}];
  if (!known) known = read_floats(accessor, index);
  return known;
}

std::shared_ptr<const Array> Accessors::indices(size_t index, const JsonValue& at) {
  const JsonValue& accessor = file_.item("accessors", index, at);
  auto& known = known_[{index, false}];
  if (!known) known = read_indices(accessor, index);
  return known;
}

std::shared_ptr<const Array> Accessors::read_floats(const JsonValue& accessor, size_t index) {
  Layout layout = layout_of(accessor, index);
  if (const JsonValue* view = file_.referred(accessor, "bufferView", "bufferViews"))
    if (const auto stride = file_.count(*view, "byteStride")) layout.stride = *stride;
  if (layout.stride < layout.element_bytes || layout.stride > 65536)
    file_.fail(accessor, fmt::format("elements of accessor {} overlap", index),
               "export the file again");
  const std::optional<Bytes> bytes = bytes_of(accessor, layout, index);
  const std::optional<Sparse> sparse = sparse_of(accessor, layout, index);
  const size_t components = layout.components();
  const bool is_as_needed = layout.component_type == float32 &&
                            layout.stride == layout.element_bytes && bytes && !sparse &&
                            reinterpret_cast<uintptr_t>(bytes->bytes.data()) % alignof(float) == 0;
  if (is_as_needed)
    return Array::borrow(ElementType::float32, {layout.count, components}, bytes->bytes,
                         bytes->owner);
  file_.spend(layout.count * components * sizeof(float), accessor);
  std::vector<float> values(layout.count * components);
  const auto put_element = [&]<typename T>(T, size_t element, const std::byte* from) {
    float* to = &values[element * components];
    for (size_t column = 0; column < layout.columns; ++column)
      for (size_t row = 0; row < layout.row_components; ++row)
        *to++ = number_of(read_as<T>(from + column * layout.column_bytes + row * sizeof(T)),
                          layout.is_normalised);
  };
  with_type(layout.component_type, [&](auto zero) {
    if (bytes)
      for (size_t i = 0; i < layout.count; ++i)
        put_element(zero, i, bytes->bytes.data() + i * layout.stride);
    if (sparse)
      for (size_t i = 0; i < sparse->places.size(); ++i)
        put_element(zero, sparse->places[i],
                    sparse->values.bytes.data() + i * layout.element_bytes);
  });
  return Array::of<float>({layout.count, components}, std::move(values));
}

std::shared_ptr<const Array> Accessors::read_indices(const JsonValue& accessor, size_t index) {
  const Layout layout = layout_of(accessor, index);
  const int type = layout.component_type;
  if (layout.components() != 1 || (type != uint8 && type != uint16 && type != uint32))
    file_.fail(accessor, fmt::format("accessor {} holds no indices", index),
               "indices are SCALAR, of 5121, 5123 or 5125");
  const std::optional<Bytes> bytes = bytes_of(accessor, layout, index);
  const std::optional<Sparse> sparse = sparse_of(accessor, layout, index);
  const bool is_aligned =
      bytes && reinterpret_cast<uintptr_t>(bytes->bytes.data()) % layout.component_bytes == 0;
  if (is_aligned && !sparse) {
    const ElementType element = type == uint8    ? ElementType::uint8
                                : type == uint16 ? ElementType::uint16
                                                 : ElementType::uint32;
    return Array::borrow(element, {layout.count}, bytes->bytes, bytes->owner);
  }
  file_.spend(layout.count * sizeof(uint32_t), accessor);
  std::vector<uint32_t> values(layout.count);
  with_type(type, [&]<typename T>(T) {
    if (bytes)
      for (size_t i = 0; i < layout.count; ++i)
        values[i] = uint32_t(read_as<T>(&bytes->bytes[i * sizeof(T)]));
    if (sparse)
      for (size_t i = 0; i < sparse->places.size(); ++i)
        values[sparse->places[i]] = uint32_t(read_as<T>(&sparse->values.bytes[i * sizeof(T)]));
  });
  return Array::of<uint32_t>({layout.count}, std::move(values));
}

std::optional<Bounds3f> Accessors::told_bounds(size_t index, const JsonValue& at) const {
  const JsonValue& accessor = file_.item("accessors", index, at);
  if (!accessor.find("min") || !accessor.find("max")) return std::nullopt;
  const std::vector<double> low = file_.numbers(accessor, "min", {0, 0, 0});
  const std::vector<double> high = file_.numbers(accessor, "max", {0, 0, 0});
  Bounds3f bounds;
  bounds.extendBy(Vec3f(float(low[0]), float(low[1]), float(low[2])));
  bounds.extendBy(Vec3f(float(high[0]), float(high[1]), float(high[2])));
  return bounds;
}

}  // namespace kaustik::gltf
