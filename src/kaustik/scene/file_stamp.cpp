#include "kaustik/scene/file_stamp.h"

#include <sys/stat.h>

#include <algorithm>
#include <chrono>

namespace kaustik {

std::optional<FileStamp> stamp_of_file(const std::string& path) {
  struct stat status;
  if (::stat(path.c_str(), &status) != 0) return std::nullopt;
  const auto nanoseconds = [](const timespec& t) {
    return int64_t(t.tv_sec) * 1'000'000'000 + int64_t(t.tv_nsec);
  };
  return FileStamp{int64_t(status.st_dev), int64_t(status.st_ino), int64_t(status.st_size),
                   nanoseconds(status.st_mtim), nanoseconds(status.st_ctim)};
}

bool is_settled(const FileStamp& stamp) {
  constexpr int64_t coarsest = 2'000'000'000;
  const int64_t now = std::chrono::duration_cast<std::chrono::nanoseconds>(
                          std::chrono::system_clock::now().time_since_epoch())
                          .count();
  return std::max(stamp[3], stamp[4]) <= now - coarsest;
}

}  // namespace kaustik
