#pragma once
#include <cstdint>
#include <functional>
#include <map>
#include <string>

#include "kaustik/scene/description.h"

namespace kaustik {

/// Numbers that differ in all likelihood between objects that are described in different ways.
/// Places and comments make no difference, and neither does it whether an object is shared.
class ObjectDigests {
 public:
  /// What stands for a file that a property names; asked once for each path.
  using FileText = std::function<std::string(const std::string& path)>;

  /// `types` must outlive this. `left_out` counts as if it were not there.
  ObjectDigests(const TypeTables& types, FileText text_of_file, const Object* left_out = nullptr)
      : types_(types), text_of_file_(std::move(text_of_file)), left_out_(left_out) {}

  /// Of all that belongs to the object, its children included.
  uint64_t of(const Object& object);
  /// Of its type, its id and its properties alone.
  uint64_t without_children(const Object& object);

 private:
  std::string own_text(const Object& object);
  std::string value_of(const Property& property, const TypeInfo* info);

  const TypeTables& types_;
  FileText text_of_file_;
  const Object* left_out_;
  std::map<const Object*, uint64_t> objects_;  // shared ones need not be gone through again
  std::map<std::string, std::string> files_;
};

}  // namespace kaustik
