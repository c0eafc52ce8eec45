#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "kaustik/base/file.h"

namespace kaustik {

/// The bytes of a file, one after another, with little of them in memory.
class FileWindow {
 public:
  /// `file` must outlive this.
  explicit FileWindow(const InputFile& file) : file_(file) {}

  /// Of what comes next, in the file.
  uint64_t position() const { return first_ + begin_; }
  uint64_t left() const { return file_.size() - position(); }
  void move_to(uint64_t position);

  /// What comes next, at least `count` bytes of it if the file has so many; valid until the next
  /// call.
  std::span<const uint8_t> ahead(size_t count) {
    if (bytes_.size() - begin_ < count) load(count);
    return std::span<const uint8_t>(bytes_).subspan(begin_);
  }
  /// Over bytes that ahead() has shown.
  void advance(size_t count) { begin_ += count; }

 private:
  void load(size_t count);

  const InputFile& file_;
  uint64_t first_ = 0;  ///< where bytes_ begins
  std::vector<uint8_t> bytes_;
  size_t begin_ = 0;  ///< of what comes next, in bytes_
};

}  // namespace kaustik
