#include "kaustik/loader/gltf/gltf_file.h"

#include <fmt/format.h>

#include <cmath>
#include <cstring>

#include "kaustik/base/error.h"

namespace kaustik::gltf {
namespace {

namespace fs = std::filesystem;

/// Beyond what is in proportion to the file.
constexpr size_t always_allowed = size_t{256} << 20;
/// Memory per byte of a file or buffer: numbers of a byte become floats, and several parts of a
/// scene may share some.
constexpr size_t per_byte = 16;

constexpr uint32_t json_chunk = 0x4e4f534a, binary_chunk = 0x004e4942;  // "JSON", "BIN\0"

uint32_t word_at(std::span<const uint8_t> bytes, size_t at) {
  return uint32_t(bytes[at]) | uint32_t(bytes[at + 1]) << 8 | uint32_t(bytes[at + 2]) << 16 |
         uint32_t(bytes[at + 3]) << 24;
}

/// "list 3" of the list "lists".
std::string singular(std::string_view list_name) {
  if (list_name == "meshes") return "mesh";
  return std::string(list_name.substr(0, list_name.size() - 1));
}

}  // namespace

File::File(std::vector<uint8_t> bytes, std::string name, fs::path folder, Deviations& deviations)
    : name_(std::move(name)),
      folder_(std::move(folder)),
      deviations_(deviations),
      sources_{name_},
      allowed_bytes_(always_allowed + per_byte * bytes.size()) {
  read_container(std::make_shared<const std::vector<uint8_t>>(std::move(bytes)));
  const JsonValue* asset = root_.find("asset");
  const std::string version = asset ? text(*asset, "version", "") : "";
  if (!version.starts_with("2."))
    fail(asset ? *asset : root_,
         version.empty() ? "this is no glTF: it has no 'asset' with a 'version'"
                         : fmt::format("this is glTF {}", version),
         "give a file of glTF 2.0: Blender and most other programs write such");
  buffers_.resize(list("buffers").size());
}

void File::read_container(const std::shared_ptr<const std::vector<uint8_t>>& bytes) {
  const std::span<const uint8_t> all = *bytes;
  const auto as_text = [&](size_t begin, size_t size) {
    return std::string_view(reinterpret_cast<const char*>(all.data()) + begin, size);
  };
  if (all.size() < 4 || std::memcmp(all.data(), "glTF", 4) != 0) {
    read_json(as_text(0, all.size()), true);
    return;
  }
  const auto refuse = [&](const std::string& message) {
    throw Error(ErrorKind::input, message, "copy or export the file again", place());
  };
  constexpr size_t header_bytes = 12, chunk_header_bytes = 8;
  if (all.size() < header_bytes + chunk_header_bytes) refuse("the .glb file ends too early");
  if (word_at(all, 4) != 2)
    throw Error(ErrorKind::input, fmt::format("this is .glb of version {}", word_at(all, 4)),
                "give a file of glTF 2.0", place());
  if (word_at(all, 8) > all.size())
    refuse(fmt::format("the .glb file ends too early: it should have {} bytes, and has {}",
                       word_at(all, 8), all.size()));
  bool has_json = false;
  for (size_t at = header_bytes; at + chunk_header_bytes <= all.size();) {
    const size_t size = word_at(all, at), begin = at + chunk_header_bytes;
    const uint32_t kind = word_at(all, at + 4);
    if (size > all.size() - begin)
      refuse(fmt::format("the .glb file ends too early: a chunk has {} bytes, and {} are left",
                         size, all.size() - begin));
    if (kind == json_chunk && !has_json) {
      read_json(as_text(begin, size), false);
      has_json = true;
    } else if (kind == binary_chunk && !binary_chunk_) {
      binary_chunk_ = Bytes{std::as_bytes(all.subspan(begin, size)), bytes};
    }
    at = begin + size;
  }
  if (!has_json) refuse("the .glb file has no JSON");
}

void File::read_json(std::string_view text, bool may_be_quoted) {
  while (!text.empty() && text.back() == '\0') text.remove_suffix(1);  // as some pad chunks
  places_.emplace(text, name_, may_be_quoted);
  try {
    root_ = parse_json(text);
  } catch (const BadJson& bad) {
    throw Error(ErrorKind::input, bad.what(), "copy or export the file again",
                places_->at(bad.offset));
  }
  if (!root_.is_object()) fail(root_, "this is no glTF: its JSON is no object", "give a glTF file");
}

void File::fail(const JsonValue& at, std::string message, std::string remedy) const {
  throw Error(ErrorKind::input, std::move(message), std::move(remedy), place(at));
}

// ---- the JSON ----

const JsonValue::Items& File::list(std::string_view name) const {
  static const JsonValue::Items none;
  const JsonValue* found = root_.find(name);
  if (!found) return none;
  if (!found->is_list())
    fail(*found, fmt::format("'{}' is no list", name), "export the file again");
  return found->items();
}

const JsonValue& File::item(std::string_view list_name, size_t index, const JsonValue& at) const {
  const JsonValue::Items& items = list(list_name);
  if (index >= items.size())
    fail(at,
         fmt::format("{} {} is named, and the file has {}", singular(list_name), index,
                     items.empty() ? "none" : fmt::format("0 to {}", items.size() - 1)),
         "export the file again");
  return items[index];
}

const JsonValue* File::referred(const JsonValue& object, std::string_view member,
                                std::string_view list_name) const {
  const auto index = count(object, member);
  return index ? &item(list_name, *index, *object.find(member)) : nullptr;
}

double File::number(const JsonValue& object, std::string_view name, double usual) const {
  const JsonValue* found = object.find(name);
  if (!found) return usual;
  const auto number = found->number();
  if (!number) fail(*found, fmt::format("'{}' is no number", name), "give a number");
  return *number;
}

std::optional<size_t> File::count(const JsonValue& object, std::string_view name) const {
  const JsonValue* found = object.find(name);
  if (!found) return std::nullopt;
  const auto number = found->number();
  constexpr double most = 9007199254740992.0;  // 2^53
  if (!number || *number < 0 || *number > most || *number != std::floor(*number))
    fail(*found, fmt::format("'{}' is no whole number of at least 0", name),
         "export the file again");
  return size_t(*number);
}

bool File::boolean(const JsonValue& object, std::string_view name, bool usual) const {
  const JsonValue* found = object.find(name);
  if (!found) return usual;
  const auto value = found->boolean();
  if (!value)
    fail(*found, fmt::format("'{}' is neither true nor false", name), "give true or false");
  return *value;
}

std::string File::text(const JsonValue& object, std::string_view name, std::string usual) const {
  const JsonValue* found = object.find(name);
  if (!found) return usual;
  if (!found->text()) fail(*found, fmt::format("'{}' is no text", name), "give a text in quotes");
  return *found->text();
}

std::vector<double> File::numbers(const JsonValue& object, std::string_view name,
                                  std::vector<double> usual) const {
  const JsonValue* found = object.find(name);
  if (!found) return usual;
  std::vector<double> result;
  for (const JsonValue& item : found->items()) {
    const auto number = item.number();
    if (number) result.push_back(*number);
  }
  if (result.size() != usual.size() || found->items().size() != usual.size())
    fail(*found, fmt::format("'{}' is no list of {} numbers", name, usual.size()),
         "export the file again");
  return result;
}

const JsonValue* File::extension(const JsonValue& object, std::string_view name) const {
  const JsonValue* all = object.find("extensions");
  return all ? all->find(name) : nullptr;
}

std::string File::name_of(std::string_view kind, const JsonValue& object, size_t index) const {
  const JsonValue* name = object.find("name");
  constexpr size_t longest = 80;
  if (name && name->text() && !name->text()->empty())
    return fmt::format("{} '{}'", kind, name->text()->substr(0, longest));
  return fmt::format("{} {}", kind, index);
}

void File::spend(size_t bytes, const JsonValue& at) {
  spent_bytes_ += std::min(bytes, allowed_bytes_ + 1);
  if (spent_bytes_ > allowed_bytes_)
    fail(at,
         fmt::format("the scene takes more than {} MiB, out of proportion to its file",
                     allowed_bytes_ >> 20),
         "let parts of the scene share meshes and accessors");
}

}  // namespace kaustik::gltf
