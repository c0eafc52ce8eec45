#include "kaustik/base/file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <limits>
#include <new>
#include <system_error>

#include "kaustik/base/file_details.h"
#include "kaustik/base/gzip.h"
#include "kaustik/base/memory.h"

namespace kaustik {

namespace file_details {

std::string system_error_text(int error_number) {
  return std::error_code(error_number, std::generic_category()).message();
}

size_t read_descriptor(int descriptor, uint64_t begin, std::span<uint8_t> out) {
  errno = 0;
  size_t filled = 0;
  while (filled < out.size()) {
    const ssize_t count =
        ::pread(descriptor, out.data() + filled, out.size() - filled, off_t(begin + filled));
    if (count < 0 && errno == EINTR) {
      errno = 0;
      continue;
    }
    if (count <= 0) break;
    filled += size_t(count);
  }
  return filled;
}

}  // namespace file_details

using namespace file_details;

std::vector<uint8_t> read_file(const std::string& path) {
  return read_file_start(path, std::numeric_limits<size_t>::max());
}

std::vector<uint8_t> read_file_start(const std::string& path, size_t most) {
  return read_file_part(path, 0, most).bytes;
}

FilePart read_file_part(const std::string& path, uint64_t begin, size_t most) {
  const InputFile file(path);
  if (begin >= file.size()) return {{}, file.size()};
  try {
    std::vector<uint8_t> bytes;
    const auto count = size_t(std::min<uint64_t>(most, file.size() - begin));
    reserve_large(bytes, count);
    bytes.resize(count);
    bytes.resize(file.read(begin, bytes));
    return {std::move(bytes), file.size()};
  } catch (const std::bad_alloc&) {
    throw Error(ErrorKind::system, fmt::format("cannot read '{}': not enough memory", path),
                "the file is larger than this machine can hold");
  }
}

InputFile::InputFile(const std::string& path)
    // Without O_NONBLOCK a named pipe would be waited for.
    : path_(path), descriptor_(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)) {
  FileDescriptor closer(descriptor_);
  struct stat status;
  if (!closer.is_open() || ::fstat(descriptor_, &status) != 0)
    throw_input_error(fmt::format("cannot read '{}': {}", path, system_error_text(errno)),
                      "check the name and the permissions");
  if (!S_ISREG(status.st_mode))
    throw_input_error(fmt::format("cannot read '{}': it is not a regular file", path),
                      "give the name of a file");
  size_ = uint64_t(status.st_size);
  closer.release();
}

InputFile::InputFile(const std::string& path, MayBePacked) : InputFile(path) {
  uint8_t mark[2];
  if (!is_gzip({mark, read(0, mark)})) return;
  std::vector<uint8_t> packed(size_);
  packed.resize(read(0, packed));
  unpacked_ =
      kaustik::unpacked(std::move(packed), std::numeric_limits<size_t>::max() - 1, place_in(path));
  size_ = unpacked_.size();
}

InputFile InputFile::unpacked(const std::string& path) { return InputFile(path, MayBePacked()); }

InputFile::~InputFile() { ::close(descriptor_); }

size_t InputFile::read(uint64_t begin, std::span<uint8_t> out) const {
  if (!unpacked_.empty()) {
    const auto from = unpacked_.begin() + std::ptrdiff_t(std::min(begin, size_));
    const size_t count = std::min(out.size(), size_t(unpacked_.end() - from));
    std::copy_n(from, count, out.begin());
    return count;
  }
  const size_t filled = read_descriptor(descriptor_, begin, out);
  if (filled < out.size() && errno != 0)
    throw Error(ErrorKind::system,
                fmt::format("cannot read '{}': {}", path_, system_error_text(errno)),
                "check the disk");
  return filled;
}

std::shared_ptr<const std::span<const uint8_t>> InputFile::mapped() const {
  if (size_ == 0) return std::make_shared<const std::span<const uint8_t>>();
  void* const begin = ::mmap(nullptr, size_, PROT_READ, MAP_SHARED, descriptor_, 0);
  if (begin == MAP_FAILED)
    throw Error(ErrorKind::system,
                fmt::format("cannot map '{}' into memory: {}", path_, system_error_text(errno)),
                "copy it to a local disk");
  const size_t size = size_;
  try {
    return {new std::span<const uint8_t>(static_cast<const uint8_t*>(begin), size),
            [](const std::span<const uint8_t>* bytes) {
              ::munmap(const_cast<uint8_t*>(bytes->data()), bytes->size());
              delete bytes;
            }};
  } catch (...) {
    ::munmap(begin, size);
    throw;
  }
}

}  // namespace kaustik
