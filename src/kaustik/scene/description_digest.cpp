#include "kaustik/scene/description_digest.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <map>

#include "kaustik/base/checksum.h"
#include "kaustik/base/error.h"
#include "kaustik/base/file.h"
#include "kaustik/scene/scene.h"

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

class Digester {
 public:
  /// `left_out` counts as if it were not there.
  Digester(const TypeTables& types, const Object* left_out) : types_(types), left_out_(left_out) {}

  uint64_t of(const Object& object) {
    const auto known = objects_.find(&object);
    if (known != objects_.end()) return known->second;
    const TypeInfo* info = types_.find(object.family, object.type);
    std::string text = text_of(object.family) + text_of(object.type) + text_of(object.id);
    for (const Property& property : object.properties)
      text += text_of(property.name) + "=" + value_of(property, info) + ";";
    for (const Child& child : object.children)
      if (child.object.get() != left_out_)
        text += fmt::format("{}:{:016x};", text_of(child.name), of(*child.object));
    return objects_[&object] = checksum_of(text);
  }

 private:
  std::string value_of(const Property& property, const TypeInfo* info) {
    const std::string file = file_of(property, info);
    if (!file.empty()) return fmt::format("file {:016x}", of_file(file));
    return std::visit([](const auto& value) { return text_of(value); }, property.value);
  }
  uint64_t of_file(const std::string& path) {
    const auto known = files_.find(path);
    if (known != files_.end()) return known->second;
    return files_[path] = checksum(read_file(path));
  }

  const TypeTables& types_;
  const Object* left_out_;
  std::map<const Object*, uint64_t> objects_;  // shared ones need not be gone through again
  std::map<std::string, uint64_t> files_;
};

}  // namespace

DescriptionDigest description_digest(const Description& description, const TypeTables& types) {
  const auto integrator = find_integrator(description);
  Digester digester(types, integrator.get());
  return {digester.of(*description.scene), integrator ? digester.of(*integrator) : 0};
}

std::map<std::string, GuardedDigest::Stamp> GuardedDigest::stamps_of(const Description& description,
                                                                     const TypeTables& types) {
  std::map<std::string, Stamp> stamps;
  for (const std::string& file : named_files(description, types)) {
    struct stat status;
    if (::stat(file.c_str(), &status) != 0) continue;  // who reads it will tell
    const auto nanoseconds = [](const timespec& t) {
      return int64_t(t.tv_sec) * 1'000'000'000 + int64_t(t.tv_nsec);
    };
    stamps[file] = {int64_t(status.st_dev), int64_t(status.st_ino), int64_t(status.st_size),
                    nanoseconds(status.st_mtim), nanoseconds(status.st_ctim)};
  }
  return stamps;
}

GuardedDigest::GuardedDigest(const Description& description, const TypeTables& types)
    : types_(&types),
      stamps_(stamps_of(description, types)),
      digest_(description_digest(description, types)) {}

void GuardedDigest::check(const Description& description) const {
  const auto now = stamps_of(description, *types_);
  if (now == stamps_ || description_digest(description, *types_) == digest_) return;
  std::string changed;
  for (const auto& [file, stamp] : stamps_)
    if (const auto found = now.find(file); found == now.end() || found->second != stamp)
      changed += (changed.empty() ? "'" : ", '") + file + "'";
  throw Error(ErrorKind::input,
              fmt::format("changed while the scene was read: {}",
                          changed.empty() ? "a file that was not there" : changed),
              "wait until nothing writes there any more, and render again");
}

}  // namespace kaustik
