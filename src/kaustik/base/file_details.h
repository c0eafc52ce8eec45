#pragma once
// What reading and writing files have in common.

#include <unistd.h>

#include <cstdint>
#include <span>
#include <string>
#include <utility>

#include "kaustik/base/error.h"

namespace kaustik::file_details {

/// An open file descriptor that closes itself.
class FileDescriptor {
 public:
  explicit FileDescriptor(int fd) : fd_(fd) {}
  ~FileDescriptor() {
    if (fd_ >= 0) ::close(fd_);
  }
  FileDescriptor(const FileDescriptor&) = delete;
  FileDescriptor& operator=(const FileDescriptor&) = delete;
  int get() const { return fd_; }
  bool is_open() const { return fd_ >= 0; }
  /// False (errno says why) if the system reports a write error only now, as network disks do.
  bool close() { return ::close(std::exchange(fd_, -1)) == 0; }
  /// It stays open.
  void release() { fd_ = -1; }

 private:
  int fd_;
};

/// What the system says of an error.
std::string system_error_text(int error_number);

[[noreturn]] inline void throw_input_error(const std::string& message, const std::string& remedy) {
  throw Error(ErrorKind::input, message, remedy);
}

/// How many bytes were read: fewer at the end of the file, or (errno is not 0) if it fails.
size_t read_descriptor(int descriptor, uint64_t begin, std::span<uint8_t> out);

}  // namespace kaustik::file_details
