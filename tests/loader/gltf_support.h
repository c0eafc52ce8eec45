#pragma once
// Small glTF files for tests: buffers by numbers, the rest as JSON.

#include <cstring>
#include <string>
#include <vector>

#include "kaustik/loader/gltf/gltf_scene.h"
#include "kaustik/loader/object_parts.h"
#include "tests/loader/loader_support.h"

namespace kaustik::test {

inline std::string to_base64(const std::string& bytes) {
  const char* const letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (size_t i = 0; i < bytes.size(); i += 3) {
    uint32_t bits = 0;
    for (size_t k = 0; k < 3; ++k)
      bits = bits << 8 | (i + k < bytes.size() ? uint8_t(bytes[i + k]) : 0u);
    for (size_t k = 0; k < 4; ++k)
      text += i + k > bytes.size() ? '=' : letters[bits >> (18 - 6 * k) & 63];
  }
  return text;
}

/// Collects accessors of one buffer.
class GltfBuffer {
 public:
  template <typename T>
  int add(const std::vector<T>& values, const std::string& type, size_t components,
          const std::string& more = "") {
    const int code = std::is_same_v<T, float>      ? 5126
                     : std::is_same_v<T, uint32_t> ? 5125
                     : std::is_same_v<T, uint16_t> ? 5123
                     : std::is_same_v<T, int16_t>  ? 5122
                     : std::is_same_v<T, uint8_t>  ? 5121
                                                   : 5120;
    const int view =
        add_view({reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)});
    return add_accessor("\"bufferView\":" + std::to_string(view) +
                        ",\"componentType\":" + std::to_string(code) +
                        ",\"count\":" + std::to_string(values.size() / components) +
                        ",\"type\":\"" + type + "\"" + more);
  }
  int add_view(const std::string& bytes, const std::string& more = "") {
    while (bytes_.size() % 4 != 0) bytes_ += '\0';
    views_ += std::string(views_.empty() ? "" : ",") +
              "{\"buffer\":0,\"byteOffset\":" + std::to_string(bytes_.size()) +
              ",\"byteLength\":" + std::to_string(bytes.size()) + more + "}";
    bytes_ += bytes;
    return view_count_++;
  }
  int add_accessor(const std::string& members) {
    accessors_ += std::string(accessors_.empty() ? "" : ",") + "{" + members + "}";
    return accessor_count_++;
  }
  const std::string& bytes() const { return bytes_; }

  /// The members of the root that belong to the buffer; `uri` is its own, with a comma.
  std::string members(const std::string& uri) const {
    return "\"buffers\":[{" + uri + "\"byteLength\":" + std::to_string(bytes_.size()) +
           "}],\n\"bufferViews\":[" + views_ + "],\n\"accessors\":[" + accessors_ + "]";
  }
  std::string as_json(const std::string& rest) const {
    return "{\"asset\":{\"version\":\"2.0\"},\n" +
           members("\"uri\":\"data:application/octet-stream;base64," + to_base64(bytes_) + "\",") +
           (rest.empty() ? "" : ",\n" + rest) + "}\n";
  }
  std::string as_glb(const std::string& rest) const {
    std::string json = "{\"asset\":{\"version\":\"2.0\"},\n" + members("") +
                       (rest.empty() ? "" : ",\n" + rest) + "}";
    while (json.size() % 4 != 0) json += ' ';
    std::string binary = bytes_;
    while (binary.size() % 4 != 0) binary += '\0';
    const auto word = [](uint32_t value) {
      return std::string(reinterpret_cast<const char*>(&value), 4);
    };
    return "glTF" + word(2) + word(uint32_t(12 + 8 + json.size() + 8 + binary.size())) +
           word(uint32_t(json.size())) + "JSON" + json + word(uint32_t(binary.size())) +
           std::string("BIN\0", 4) + binary;
  }

 private:
  std::string bytes_, views_, accessors_;
  int view_count_ = 0, accessor_count_ = 0;
};

inline Description parse_gltf_text(const std::string& text, const LoadOptions& options = {},
                                   const std::string& folder = "") {
  return parse_gltf(text, "test.gltf", folder, options);
}

/// A file with one node that has one mesh: a triangle, or what `attributes` says.
inline std::string one_triangle(const std::string& rest = "", const std::string& primitive = "",
                                const std::string& node = "") {
  GltfBuffer buffer;
  buffer.add<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3", 3);
  buffer.add<float>({0, 1, 1, 1, 0, 0}, "VEC2", 2);
  return buffer.as_json(
      "\"nodes\":[{\"mesh\":0" + node +
      "}],\n\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"TEXCOORD_0\":1}" +
      primitive + "}]}]" + (rest.empty() ? "" : ",\n" + rest));
}

/// The objects of a family in a scene.
inline std::vector<const Object*> objects_in(const Object& parent, const std::string& family) {
  std::vector<const Object*> found;
  for (const Child& child : parent.children)
    if (child.object->family == family) found.push_back(child.object.get());
  return found;
}

inline const Object& only_in(const Object& parent, const std::string& family) {
  const auto found = objects_in(parent, family);
  if (found.empty()) throw std::runtime_error("no " + family);
  return *found[0];
}
inline const Object& child_named(const Object& parent, const std::string& name) {
  for (const Child& child : parent.children)
    if (child.name == name) return *child.object;
  throw std::runtime_error("no child " + name);
}

/// The bsdf within those that only wrap it.
inline const Object& core_of(const Object& shape) {
  const Object* bsdf = &only_in(shape, "bsdf");
  while (bsdf->type == "twosided" || bsdf->type == "mask" || bsdf->type == "normalmap" ||
         bsdf->type == "bumpmap")
    bsdf = &only_in(*bsdf, "bsdf");
  return *bsdf;
}

inline std::vector<float> floats_of(const Object& object, const std::string& name) {
  std::vector<float> numbers;
  value<std::shared_ptr<const Array>>(object, name)->visit([&](auto values) {
    for (const auto number : values) numbers.push_back(float(number));
  });
  return numbers;
}

inline bool has_deviation(const Description& description, DeviationKind kind,
                          const std::string& text) {
  for (const Deviation& deviation : description.deviations)
    if (deviation.kind == kind &&
        (deviation.object + ": " + deviation.what).find(text) != std::string::npos)
      return true;
  return false;
}

/// What the first material of one triangle becomes.
class GltfMaterial {
 public:
  explicit GltfMaterial(const std::string& members, const std::string& rest = "",
                        const LoadOptions& options = {})
      : description_(parse_gltf_text(
            one_triangle("\"materials\":[{" + members + "}]" + (rest.empty() ? "" : "," + rest),
                         ",\"material\":0"),
            options)) {}
  const Description& description() const { return description_; }
  const Object& shape() const { return only_in(*description_.scene, "shape"); }
  const Object& bsdf() const { return only_in(shape(), "bsdf"); }
  const Object& core() const { return core_of(shape()); }

 private:
  Description description_;
};

}  // namespace kaustik::test
