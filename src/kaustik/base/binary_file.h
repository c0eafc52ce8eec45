#pragma once
// Files of numbers in the byte order of the machine that wrote them, in a common frame: magic
// (8 bytes), byte order mark (u32), version (u32), content, checksum of all that precedes (u64).

#include <array>
#include <cstdint>
#include <cstring>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

namespace kaustik {

class AtomicFile;
class InputFile;

/// A kind of file and what people are told of it.
struct BinaryFileKind {
  /// The first byte is over 127 and both kinds of line ends follow: that shows damage by transfers
  /// as text.
  std::array<uint8_t, 8> magic;
  uint32_t version;         ///< to be raised whenever the layout changes
  const char* name;         ///< "photon map", for messages
  const char* if_foreign;   ///< what to do about a file of another kind
  const char* if_unusable;  ///< what to do about a damaged one, or one of another version
};

/// Collects the content of a file in memory.
class BinaryWriter {
 public:
  explicit BinaryWriter(const BinaryFileKind& kind);
  template <typename T>
  void put(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    put_bytes(&value, sizeof(T));
  }
  void put_bytes(const void* data, size_t size);
  void put_text(const std::string& text);
  void reserve(size_t more) { bytes_.reserve(bytes_.size() + more + sizeof(uint64_t)); }
  /// Frame and content so far, for who writes the rest elsewhere.
  std::span<const uint8_t> bytes() const { return bytes_; }
  /// Adds the checksum and writes atomically; throws as write_file_atomically() does.
  void write_to(const std::string& path);
  /// The same, as write_file_atomically_if() does.
  bool write_to_if(const std::string& path, const std::function<bool()>& is_wanted);
  /// The same bytes, for memory or a connection. Nothing may be put after that.
  std::vector<uint8_t> finished();

 private:
  std::vector<uint8_t> bytes_;
};

/// Adds the checksum behind so many bytes of a file that was written piece by piece, which is what
/// a BinaryWriter would have collected.
void add_checksum(AtomicFile& file, uint64_t size);

/// Whether a file's bytes are compared with its checksum before they are used. Who looks at the
/// first of them only, and believes nothing, may save the time that it takes to read all.
enum class FileCheck { whole, frame_only };

/// Reads such a file; whatever is wrong with it is an Error(input) with the file as its place.
/// Nothing is allocated but in proportion to the bytes that are there. Of a file on the disk no
/// more is in memory at a time than is asked for at once.
class BinaryReader {
 public:
  /// Throws if the file is missing, of another kind, version or byte order, truncated or damaged.
  BinaryReader(const BinaryFileKind& kind, const std::string& path,
               FileCheck check = FileCheck::whole);
  /// The same of bytes from elsewhere, which messages call by `name`.
  BinaryReader(const BinaryFileKind& kind, std::vector<uint8_t> bytes, const std::string& name);
  ~BinaryReader();
  BinaryReader(const BinaryReader&) = delete;
  BinaryReader& operator=(const BinaryReader&) = delete;
  template <typename T>
  T get() {
    static_assert(std::is_trivially_copyable_v<T>);
    need(1, sizeof(T));
    load(sizeof(T));
    T value;
    std::memcpy(&value, rest_.data(), sizeof(T));
    rest_ = rest_.subspan(sizeof(T));
    return value;
  }
  template <typename T>
  std::vector<T> get_array(uint64_t count) {
    need(count, sizeof(T));
    std::vector<T> values(count);
    copy_to(reinterpret_cast<uint8_t*>(values.data()), count * sizeof(T));
    return values;
  }
  /// Until the next call.
  std::span<const uint8_t> get_bytes(uint64_t count);
  /// Some of the bytes that follow, at least so many unless fewer do; until the next call. They
  /// are still to be read.
  std::span<const uint8_t> bytes_ahead(size_t least);
  /// Of those ahead.
  void skip(size_t count) { rest_ = rest_.subspan(count); }
  std::string get_text();
  bool get_flag();
  /// A number of items of at least so many bytes each, which the rest of the file can hold.
  uint64_t get_count(size_t item_size);
  /// Throws unless everything has been read.
  void expect_end() const;

  /// Throws unless so many items of this size follow.
  void need(uint64_t count, size_t item_size) const {
    if (count > (rest_.size() + unloaded_) / item_size)
      damaged("a count in it is larger than the file");
  }
  /// "the photon map is damaged: " and why.
  [[noreturn]] void damaged(const std::string& why) const;
  const std::string& path() const { return path_; }
  /// Of a file on the disk: where the next byte to be read lies in it.
  uint64_t position() const { return size_ - sizeof(uint64_t) - unloaded_ - rest_.size(); }
  /// Goes on from there, which is not before position(). Throws if the file ends before.
  void skip_to(uint64_t position);
  /// All of a file on the disk, as InputFile::mapped().
  std::shared_ptr<const std::span<const uint8_t>> mapped() const;

 private:
  [[noreturn]] void fail(const std::string& what, const std::string& remedy) const;
  void check_frame(FileCheck check);
  /// Of all bytes but the checksum itself.
  uint64_t checksum_of_content() const;
  uint64_t stored_checksum() const;
  /// Brings so many of the bytes that follow into memory.
  void load(size_t count) {
    if (count > rest_.size()) load_from_file(count);
  }
  void load_from_file(size_t count);
  void copy_to(uint8_t* out, uint64_t count);

  const BinaryFileKind& kind_;
  std::string path_;
  std::unique_ptr<const InputFile> file_;  ///< null: all is in memory
  std::vector<uint8_t> bytes_;             ///< of the file some
  std::span<const uint8_t> rest_;          ///< of these, those that follow
  uint64_t size_ = 0;                      ///< of the file
  uint64_t unloaded_ = 0;                  ///< bytes of the file that follow `rest_`
  uint64_t unloaded_begin_ = 0;            ///< their place
};

/// Whether the file starts as one of this kind does. Throws Error(input) if it cannot be read.
bool is_of_kind(const BinaryFileKind& kind, const std::string& path);

}  // namespace kaustik
