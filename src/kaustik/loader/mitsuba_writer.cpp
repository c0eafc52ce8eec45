#include "kaustik/loader/mitsuba_writer.h"

#include <fmt/format.h>

#include <filesystem>
#include <map>
#include <pugixml.hpp>
#include <set>
#include <sstream>

namespace kaustik {
namespace {

namespace fs = std::filesystem;

/// Digits by which a number is read back to the last bit.
std::string text_of(double number) { return fmt::format("{}", number); }

std::string text_of(const SpectralCurve& curve) {
  std::string text;
  for (const auto& [wavelength, value] : curve.samples)
    text += fmt::format("{}{}:{}", text.empty() ? "" : ", ", wavelength, value);
  return text;
}

std::string text_of(const Transform& transform) {
  std::string text;
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column)
      text += fmt::format("{}{}", text.empty() ? "" : " ", transform.at(row, column));
  return text;
}

class Writer {
 public:
  Writer(const TypeTables& types, fs::path folder) : types_(types), folder_(std::move(folder)) {}

  std::string text(const Object& scene, const std::string& version) {
    count(scene);
    for (const Child& child : scene.children) top_level_.insert(child.object.get());
    pugi::xml_document document;
    pugi::xml_node root = document.append_child("scene");
    root.append_attribute("version") = version.c_str();
    if (!scene.id.empty()) root.append_attribute("id") = scene.id.c_str();
    for (const Property& property : scene.properties) write(property, nullptr, root);
    for (const Child& child : scene.children) write(child, root, true);
    std::ostringstream stream;
    document.save(stream, "  ");
    return stream.str();
  }

 private:
  /// How many parents each object has, and which ids are taken.
  void count(const Object& object) {
    if (!object.id.empty()) ids_.insert(object.id);
    for (const Child& child : object.children)
      if (parents_[child.object.get()]++ == 0) count(*child.object);
  }

  /// The id by which others refer to an object.
  std::string id_of(const Object& object) {
    if (!object.id.empty() || parents_[&object] < 2) return object.id;
    std::string& id = given_ids_[&object];
    for (int number = 1; id.empty(); ++number)
      if (std::string name = fmt::format("{}_{}", object.family, number); ids_.insert(name).second)
        id = name;
    return id;
  }

  /// Whole where it stands first, at the top of the scene if it stands there; else a reference.
  void write(const Child& child, pugi::xml_node& parent, bool at_top) {
    const Object& object = *child.object;
    const bool is_whole =
        (at_top || !top_level_.contains(&object)) && written_.insert(&object).second;
    pugi::xml_node node = parent.append_child(is_whole ? object.family.c_str() : "ref");
    if (is_whole) node.append_attribute("type") = object.type.c_str();
    if (const std::string id = id_of(object); !id.empty())
      node.append_attribute("id") = escaped(id).c_str();
    if (!child.name.empty()) node.append_attribute("name") = escaped(child.name).c_str();
    if (!is_whole) return;
    const TypeInfo* info = types_.find(object.family, object.type);
    for (const Property& property : object.properties) write(property, info, node);
    for (const Child& part : object.children) write(part, node, false);
  }

  void write(const Property& property, const TypeInfo* info, pugi::xml_node& parent) {
    const auto append = [&](const char* tag, const std::string& value) {
      pugi::xml_node node = parent.append_child(tag);
      node.append_attribute("name") = escaped(property.name).c_str();
      node.append_attribute("value") = escaped(value).c_str();
    };
    struct Visitor {
      const decltype(append)& add;
      const Writer& writer;
      const Property& property;
      const TypeInfo* info;
      pugi::xml_node& parent;

      void operator()(bool value) const { add("boolean", value ? "true" : "false"); }
      void operator()(int64_t value) const { add("integer", fmt::format("{}", value)); }
      void operator()(double value) const { add("float", text_of(value)); }
      void operator()(const std::string& value) const {
        const bool is_file = !file_of(property, info).empty();
        add("string", is_file ? writer.relative(value) : value);
      }
      void operator()(const Untyped& value) const { (*this)(value.text); }
      void operator()(const Vec3d& v) const {
        add("point", fmt::format("{}, {}, {}", v.x, v.y, v.z));
      }
      void operator()(const Rgb& c) const { add("rgb", fmt::format("{}, {}, {}", c.r, c.g, c.b)); }
      void operator()(const SpectralCurve& curve) const { add("spectrum", text_of(curve)); }
      void operator()(const Transform& transform) const {
        pugi::xml_node node = parent.append_child("transform");
        node.append_attribute("name") = escaped(property.name).c_str();
        node.append_child("matrix").append_attribute("value") = text_of(transform).c_str();
      }
      void operator()(const std::shared_ptr<const Array>&) const {
        throw Error(ErrorKind::input,
                    fmt::format("'{}' is a buffer, which XML cannot hold", property.name),
                    "keep it in a file, such as a PLY file of a mesh", property.place);
      }
    };
    std::visit(Visitor{append, *this, property, info, parent}, property.value);
  }

  /// A '$' would be taken for a definition when it is read again.
  static std::string escaped(const std::string& text) {
    std::string result;
    for (const char c : text) {
      if (c == '$') result += '\\';
      result += c;
    }
    return result;
  }

  /// Of a file below the folder, and of one that was not named by its whole path.
  std::string relative(const std::string& file) const {
    std::error_code failed;
    const fs::path from_here = fs::proximate(file, folder_.empty() ? "." : folder_, failed);
    const bool is_outside = failed || (!from_here.empty() && *from_here.begin() == "..");
    return is_outside && fs::path(file).is_absolute() ? file : from_here.string();
  }

  const TypeTables& types_;
  fs::path folder_;
  std::map<const Object*, int> parents_;
  std::set<std::string> ids_;
  std::map<const Object*, std::string> given_ids_;
  std::set<const Object*> top_level_, written_;
};

}  // namespace

std::string mitsuba_xml(const Description& description, const TypeTables& types,
                        const std::string& folder, const std::string& version) {
  return Writer(types, folder).text(*description.scene, version);
}

}  // namespace kaustik
