#include "kaustik/scene/object_digests.h"

#include <fmt/format.h>

#include "kaustik/base/checksum.h"

namespace kaustik {
namespace {

uint64_t checksum_of(const std::string& text) {
  return checksum({reinterpret_cast<const uint8_t*>(text.data()), text.size()});
}

// Numbers are written so that they can be read back to the last bit; the letter tells apart types
// that look alike. Texts come with their length, so that no two lists of texts look the same.
std::string text_of(const std::string& text) { return fmt::format("{}'{}'", text.size(), text); }
std::string text_of(bool value) { return value ? "yes" : "no"; }
std::string text_of(int64_t value) { return fmt::format("i{}", value); }
std::string text_of(double value) { return fmt::format("f{}", value); }
std::string text_of(const Vec3d& v) { return fmt::format("v{} {} {}", v.x, v.y, v.z); }
std::string text_of(const Rgb& c) { return fmt::format("c{} {} {}", c.r, c.g, c.b); }
std::string text_of(const Untyped& value) { return "u" + text_of(value.text); }
std::string text_of(const SpectralCurve& curve) {
  std::string text = "s";
  for (const auto& [wavelength, value] : curve.samples)
    text += fmt::format("{}:{} ", wavelength, value);
  return text;
}
std::string text_of(const std::shared_ptr<const Array>& array) {
  return array ? fmt::format("a{:016x}", array->digest()) : "a";
}
std::string text_of(const Transform& transform) {
  std::string text = "t";
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column)
      text += fmt::format("{} ", transform.at(row, column));
  return text;
}

}  // namespace

std::string ObjectDigests::own_text(const Object& object) {
  const TypeInfo* info = types_.find(object.family, object.type);
  std::string text = text_of(object.family) + text_of(object.type) + text_of(object.id);
  for (const Property& property : object.properties)
    text += text_of(property.name) + "=" + value_of(property, info) + ";";
  return text;
}

uint64_t ObjectDigests::without_children(const Object& object) {
  return checksum_of(own_text(object));
}

uint64_t ObjectDigests::of(const Object& object) {
  const auto known = objects_.find(&object);
  if (known != objects_.end()) return known->second;
  std::string text = own_text(object);
  for (const Child& child : object.children)
    if (child.object.get() != left_out_)
      text += fmt::format("{}:{:016x};", text_of(child.name), of(*child.object));
  return objects_[&object] = checksum_of(text);
}

std::string ObjectDigests::value_of(const Property& property, const TypeInfo* info) {
  const std::string file = file_of(property, info);
  if (file.empty())
    return std::visit([](const auto& value) { return text_of(value); }, property.value);
  const auto known = files_.find(file);
  if (known != files_.end()) return known->second;
  return files_[file] = text_of_file_(file);
}

}  // namespace kaustik
