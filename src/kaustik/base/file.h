#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace kaustik {

/// Contents of a file as a whole. Throws Error(input) if it is missing, a folder or not readable.
std::vector<uint8_t> read_file(const std::string& path);
/// The same of its first bytes, at most so many.
std::vector<uint8_t> read_file_start(const std::string& path, size_t most);

/// Some bytes of a file, and how many it has in all.
struct FilePart {
  std::vector<uint8_t> bytes;
  uint64_t file_size = 0;
};
/// The same of at most so many bytes from `begin` on; none where the file ends before.
FilePart read_file_part(const std::string& path, uint64_t begin, size_t most);

/// A file that stays open while parts of it are read, by several threads at once if they like.
class InputFile {
 public:
  /// Throws as read_file() does.
  explicit InputFile(const std::string& path);
  /// The same of what gzip has packed into the file, if it has, which is then in memory. Throws
  /// Error(input) for packed data that are damaged, incomplete, or grow out of all proportion.
  static InputFile unpacked(const std::string& path);
  ~InputFile();
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  const std::string& path() const { return path_; }
  /// When it was opened; unpacked.
  uint64_t size() const { return size_; }
  /// Fills `out` with what there is from `begin` on; returns how many bytes that are: fewer only
  /// where the file ends. Throws Error(system).
  size_t read(uint64_t begin, std::span<uint8_t> out) const;
  /// All bytes, of a file that is not packed, read by the system when they are looked at. They
  /// outlive this. Nobody may write to the file meanwhile; it may be replaced or removed. Throws
  /// Error(system).
  std::shared_ptr<const std::span<const uint8_t>> mapped() const;

 private:
  struct MayBePacked {};
  InputFile(const std::string& path, MayBePacked);

  std::string path_;
  int descriptor_;
  uint64_t size_ = 0;
  std::vector<uint8_t> unpacked_;  ///< of a packed file; else empty
};

/// Puts `bytes` at `path` as a whole or not at all: written to a temporary file in the same folder,
/// flushed to the disk, renamed over the target. Whatever goes wrong, a file that was there before
/// stays as it was and the temporary one is removed; if the program is killed, by the next one that
/// writes to that folder. A symbolic link stays, and the file that it leads to is written, there or
/// not. Throws Error(input) for what check_output_path() finds, Error(system) when writing fails
/// (disk full, file size limit, …). The caller must have SIGXFSZ ignored if a file size limit may
/// be set.
void write_file_atomically(const std::string& path, std::span<const uint8_t> bytes);
void write_text_atomically(const std::string& path, std::string_view text);

/// The same, unless `is_wanted`, which is asked right before the file is put in its place, says no:
/// then what is there stays, and this returns false. From the question on until the file is in its
/// place no other caller of this function has an answer for that folder, if the file system can
/// lock folders: local ones can, some network disks cannot.
bool write_file_atomically_if(const std::string& path, std::span<const uint8_t> bytes,
                              const std::function<bool()>& is_wanted);

/// A file that is written piece by piece, and is at its path as a whole or not at all, as
/// write_file_atomically() has it: where all of it would not fit into memory.
class AtomicFile {
 public:
  /// Throws as check_output_path() does.
  explicit AtomicFile(const std::string& path);
  /// Nothing is left unless it was finished.
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  /// Puts bytes from `begin` on. Throws Error(system) if that fails.
  void write(uint64_t begin, std::span<const uint8_t> bytes);
  /// Fills `out` with what was written from `begin` on.
  void read(uint64_t begin, std::span<uint8_t> out) const;
  /// Puts it at its path, safe on the disk.
  void finish();

 private:
  class File;
  std::unique_ptr<File> file_;
};

/// A file beside `path` that has no name, for what does not fit into memory: it is gone with the
/// program, however that ends.
class ScratchFile {
 public:
  /// Throws as check_output_path() of `path`, which need not be there.
  explicit ScratchFile(const std::string& path);
  ~ScratchFile();
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;
  /// Throws Error(system) if that fails.
  void append(std::span<const uint8_t> bytes);
  void read(uint64_t begin, std::span<uint8_t> out) const;

 private:
  std::string path_;
  int descriptor_;
  uint64_t size_ = 0;
};

/// The file that a chain of symbolic links leads to, there or not: what is written to a link.
/// Throws Error(input) where they lead in a circle.
std::string output_target(const std::string& path);

/// Throws Error(input) if no file can be written at `path`: empty, the folder is missing, not a
/// folder or not writable, or something that is not a writable regular file stands there. For the
/// time before long work.
void check_output_path(const std::string& path);

}  // namespace kaustik
