#pragma once
// A glTF 2.0 file: its JSON, and the bytes of its buffers.

#include <cstddef>
#include <filesystem>
#include <initializer_list>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kaustik/base/place.h"
#include "kaustik/loader/deviations.h"
#include "kaustik/loader/file_search.h"
#include "kaustik/loader/json_document.h"
#include "kaustik/loader/load_options.h"
#include "kaustik/loader/text_places.h"

namespace kaustik::gltf {

/// Bytes that `owner` keeps alive.
struct Bytes {
  std::span<const std::byte> bytes;
  std::shared_ptr<const void> owner;
};

/// A reference to something that is not there, where the rest of the scene can do without it.
struct MissingData {
  std::string what;  ///< "there is no file 'a.bin'"
};

class File {
 public:
  /// `bytes`: the file's, unpacked. Throws Error(input) for what is no glTF 2.0.
  File(std::vector<uint8_t> bytes, std::string name, std::filesystem::path folder,
       Deviations& deviations);

  // ---- the JSON ----

  const JsonValue& root() const { return root_; }
  /// Of a value.
  Place place(const JsonValue& value) const { return places_->at(value.offset()); }
  Place place() const { return place_in(name_); }
  [[noreturn]] void fail(const JsonValue& at, std::string message, std::string remedy) const;

  /// The list of that name in the root; empty where there is none.
  const JsonValue::Items& list(std::string_view name) const;
  /// One of them. Throws Error(input) at `at`, which refers to it, where there is none.
  const JsonValue& item(std::string_view list_name, size_t index, const JsonValue& at) const;
  /// What a member refers to by its index in a list; null: there is no such member.
  const JsonValue* referred(const JsonValue& object, std::string_view member,
                            std::string_view list_name) const;

  // Members of an object. Throw Error(input) for those of another type.
  double number(const JsonValue& object, std::string_view name, double usual) const;
  /// A whole number of at least 0.
  std::optional<size_t> count(const JsonValue& object, std::string_view name) const;
  bool boolean(const JsonValue& object, std::string_view name, bool usual) const;
  std::string text(const JsonValue& object, std::string_view name, std::string usual) const;
  /// So many numbers; `usual` where there are none.
  std::vector<double> numbers(const JsonValue& object, std::string_view name,
                              std::vector<double> usual) const;
  /// Of `extensions`; null: it has none of that name.
  const JsonValue* extension(const JsonValue& object, std::string_view name) const;
  /// "mesh 'vase'", or "mesh 3" where it has no name.
  std::string name_of(std::string_view kind, const JsonValue& object, size_t index) const;

  // ---- bytes ----

  /// Of a bufferView, unpacked where it is packed by meshopt. Throws MissingData if its buffer is
  /// not there, or packed in another way.
  Bytes view(size_t index, const JsonValue& at);
  /// What a data URI holds; nothing where it is none that can be read.
  std::optional<Bytes> data_uri(const std::string& uri, const JsonValue& at) const;
  /// The file that a URI names, if it is there, or one that stands for it.
  std::optional<std::filesystem::path> find(const std::string& uri, const JsonValue& at);

  /// Files that were read.
  const std::vector<std::string>& sources() const { return sources_; }
  /// For memory beside the file's own: bounded in proportion to it. Throws Error(input) at `at`.
  void spend(size_t bytes, const JsonValue& at);

 private:
  struct Buffer {
    std::optional<Bytes> bytes;
    std::string missing;  ///< why there are none
    bool is_read = false;
  };

  void read_container(const std::shared_ptr<const std::vector<uint8_t>>& bytes);
  void read_json(std::string_view text, bool may_be_quoted);
  const Bytes& buffer(size_t index, const JsonValue& at);
  Bytes plain_view(const JsonValue& view, size_t index);
  std::optional<Bytes> unpacked_view(const JsonValue& packed, size_t index);
  Buffer read_buffer(size_t index, const JsonValue& at);

  std::string name_;
  std::filesystem::path folder_;
  Deviations& deviations_;
  FileSearch search_;
  JsonValue root_;
  std::optional<TextPlaces> places_;
  std::optional<Bytes> binary_chunk_;
  std::vector<Buffer> buffers_;
  std::map<size_t, Bytes> unpacked_views_;
  std::vector<std::string> sources_;
  size_t allowed_bytes_ = 0, spent_bytes_ = 0;
};

/// The bytes that base64 encodes; nothing for what is none.
std::optional<std::vector<uint8_t>> from_base64(std::string_view text);
/// With %20 and the like decoded.
std::string percent_decoded(std::string_view uri);

}  // namespace kaustik::gltf
