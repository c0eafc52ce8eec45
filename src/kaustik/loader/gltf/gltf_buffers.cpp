// The part of File that deals with bytes: buffers, bufferViews, URIs.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>

#include "kaustik/base/error.h"
#include "kaustik/base/file.h"
#include "kaustik/loader/gltf/gltf_file.h"
#include "kaustik/loader/gltf/gltf_meshopt.h"

namespace kaustik::gltf {
namespace {

namespace fs = std::filesystem;

/// Of the letters of base64; 64 for others.
constexpr std::array<uint8_t, 256> base64_values() {
  std::array<uint8_t, 256> values{};
  values.fill(64);
  const char* const letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  for (uint8_t i = 0; i < 64; ++i) values[uint8_t(letters[i])] = i;
  values[uint8_t('-')] = 62;  // of the alphabet for URLs
  values[uint8_t('_')] = 63;
  return values;
}

int hexadecimal(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

bool is_data_uri(std::string_view uri) { return uri.starts_with("data:"); }

/// Of what is not on this machine.
bool is_remote(std::string_view uri) {
  return uri.find("://") != std::string_view::npos && !uri.starts_with("file://");
}

bool is_file(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored);
}

Bytes owned(std::vector<uint8_t> bytes) {
  const auto owner = std::make_shared<const std::vector<uint8_t>>(std::move(bytes));
  return {std::as_bytes(std::span(*owner)), owner};
}

}  // namespace

std::optional<std::vector<uint8_t>> from_base64(std::string_view text) {
  static constexpr std::array<uint8_t, 256> values = base64_values();
  while (!text.empty() && text.back() == '=') text.remove_suffix(1);
  std::vector<uint8_t> bytes;
  bytes.reserve(text.size() / 4 * 3 + 2);
  uint32_t bits = 0;
  int count = 0;
  for (const char c : text) {
    const uint8_t value = values[uint8_t(c)];
    if (value == 64) return std::nullopt;
    bits = bits << 6 | value;
    if ((count += 6) < 8) continue;
    count -= 8;
    bytes.push_back(uint8_t(bits >> count));
  }
  return bytes;
}

std::string percent_decoded(std::string_view uri) {
  std::string text;
  for (size_t i = 0; i < uri.size(); ++i) {
    const int high = uri[i] == '%' && i + 2 < uri.size() ? hexadecimal(uri[i + 1]) : -1;
    const int low = high >= 0 ? hexadecimal(uri[i + 2]) : -1;
    text += low >= 0 ? char(high << 4 | low) : uri[i];
    if (low >= 0) i += 2;
  }
  return text;
}

std::optional<Bytes> File::data_uri(const std::string& uri, const JsonValue& at) const {
  if (!is_data_uri(uri)) return std::nullopt;
  const size_t comma = uri.find(',');
  const std::string_view head = std::string_view(uri).substr(0, comma);
  auto bytes = comma != uri.npos && head.ends_with(";base64")
                   ? from_base64(std::string_view(uri).substr(comma + 1))
                   : std::nullopt;
  if (!bytes)
    fail(at, "the data URI is damaged, or not encoded as base64",
         "begin it with data:application/octet-stream;base64,");
  return owned(std::move(*bytes));
}

std::optional<fs::path> File::find(const std::string& uri, const JsonValue& at) {
  if (uri.empty() || is_remote(uri)) return std::nullopt;
  constexpr std::string_view here = "file://";
  const std::string_view local =
      uri.starts_with(here) ? std::string_view(uri).substr(here.size()) : std::string_view(uri);
  // As it is written, too: not every program encodes blanks.
  for (const std::string& name : {percent_decoded(local), std::string(local)}) {
    if (name.find('\0') != name.npos) continue;
    if (const fs::path path = folder_ / name; is_file(path)) return path;
  }
  const auto like = search_.find_like(percent_decoded(local), {folder_});
  if (like)
    deviations_.approximated(fmt::format("file '{}'", uri.substr(0, 200)),
                             fmt::format("it is not there: '{}' stands for it", like->string()),
                             place(at));
  return like;
}

File::Buffer File::read_buffer(size_t index, const JsonValue& at) {
  const JsonValue& buffer = item("buffers", index, at);
  const std::string uri = text(buffer, "uri", "");
  if (uri.empty()) {
    if (index == 0 && binary_chunk_) return {binary_chunk_, {}, true};
    return {std::nullopt, fmt::format("buffer {} has no bytes", index), true};
  }
  if (auto bytes = data_uri(uri, buffer)) return {std::move(bytes), {}, true};
  const auto path = find(uri, buffer);
  if (!path) return {std::nullopt, fmt::format("there is no file '{}'", uri.substr(0, 200)), true};
  const size_t wanted = count(buffer, "byteLength").value_or(SIZE_MAX);
  Bytes bytes = owned(read_file_start(path->string(), wanted));
  sources_.push_back(path->string());
  allowed_bytes_ += 16 * bytes.bytes.size();
  return {std::move(bytes), {}, true};
}

const Bytes& File::buffer(size_t index, const JsonValue& at) {
  item("buffers", index, at);
  Buffer& buffer = buffers_[index];
  if (!buffer.is_read) buffer = read_buffer(index, at);
  if (!buffer.bytes) throw MissingData{buffer.missing};
  return *buffer.bytes;
}

Bytes File::view(size_t index, const JsonValue& at) {
  const JsonValue& view = item("bufferViews", index, at);
  if (const auto known = unpacked_views_.find(index); known != unpacked_views_.end())
    return known->second;
  for (const char* name : {"EXT_meshopt_compression", "KHR_meshopt_compression"})
    if (const JsonValue* packed = extension(view, name)) {
      if (auto bytes = unpacked_view(*packed, index)) return unpacked_views_[index] = *bytes;
      // Some files have the plain bytes, too.
      try {
        return plain_view(view, index);
      } catch (const MissingData&) {
        throw MissingData{
            fmt::format("bufferView {} is packed by {} in a way that is not known", index, name)};
      }
    }
  return plain_view(view, index);
}

/// Nothing for what is packed in a way that is not known.
std::optional<Bytes> File::unpacked_view(const JsonValue& packed, size_t index) {
  MeshoptLayout layout;
  const std::string mode = text(packed, "mode", ""), filter = text(packed, "filter", "NONE");
  if (mode == "TRIANGLES")
    layout.mode = MeshoptMode::triangles;
  else if (mode == "INDICES")
    layout.mode = MeshoptMode::indices;
  else if (mode != "ATTRIBUTES")
    return std::nullopt;
  if (filter == "OCTAHEDRAL")
    layout.filter = MeshoptFilter::octahedral;
  else if (filter == "QUATERNION")
    layout.filter = MeshoptFilter::quaternion;
  else if (filter == "EXPONENTIAL")
    layout.filter = MeshoptFilter::exponential;
  else if (filter != "NONE")
    return std::nullopt;
  layout.count = count(packed, "count").value_or(0);
  layout.stride = count(packed, "byteStride").value_or(0);
  const Bytes bytes = plain_view(packed, index);
  if (!layout.is_sound() || layout.count > 64 * bytes.bytes.size()) return std::nullopt;
  spend(layout.count * (layout.stride + sizeof(uint32_t)), packed);
  auto unpacked = unpacked_by_meshopt(bytes.bytes, layout);
  if (!unpacked) return std::nullopt;
  return owned(std::move(*unpacked));
}

Bytes File::plain_view(const JsonValue& view, size_t index) {
  const auto buffer_index = count(view, "buffer");
  if (!buffer_index)
    fail(view, fmt::format("bufferView {} names no buffer", index), "export the file again");
  const Bytes& all = buffer(*buffer_index, view);
  const size_t begin = count(view, "byteOffset").value_or(0);
  const size_t size = count(view, "byteLength").value_or(0);
  if (begin > all.bytes.size() || size > all.bytes.size() - begin)
    fail(view,
         fmt::format("bufferView {} takes {} bytes from byte {} on, and buffer {} has {}", index,
                     size, begin, *buffer_index, all.bytes.size()),
         "copy or export the file again: it may be cut off");
  return {all.bytes.subspan(begin, size), all.owner};
}

}  // namespace kaustik::gltf
