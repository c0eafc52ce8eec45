#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <filesystem>
#include <optional>
#include <string_view>
#include <system_error>

#include "kaustik/base/file.h"
#include "kaustik/base/file_details.h"

namespace kaustik {
namespace {

using namespace file_details;
namespace fs = std::filesystem;

std::string folder_of(const std::string& path) {
  const std::string folder = fs::path(path).parent_path().string();
  return folder.empty() ? "." : folder;
}

/// `path` is what was asked for, `target` what its links lead to.
std::string in_words(const std::string& path, const std::string& target) {
  return target == path ? fmt::format("'{}'", path)
                        : fmt::format("'{}' (a link to '{}')", path, target);
}

void check_folder(const std::string& path) {
  const std::string target = output_target(path), folder = folder_of(target);
  const std::string named = in_words(path, target);
  struct stat status;
  if (::stat(folder.c_str(), &status) != 0) {
    const int reason = errno;
    throw_input_error(
        fmt::format("cannot write {}: folder '{}': {}", named, folder, system_error_text(reason)),
        reason == ENOENT ? fmt::format("create it (mkdir -p '{}') or choose another", folder)
                         : "choose a path in a folder that exists");
  }
  if (!S_ISDIR(status.st_mode))
    throw_input_error(fmt::format("cannot write {}: '{}' is a file, not a folder", named, folder),
                      "choose a path in a folder");
  if (::access(folder.c_str(), W_OK | X_OK) != 0)
    throw_input_error(
        fmt::format("cannot write {}: folder '{}': {}", named, folder, system_error_text(errno)),
        "choose a folder that you may write to, or change its permissions");
}

void check_what_stands_there(const std::string& path) {
  struct stat status;
  if (::stat(path.c_str(), &status) != 0) {
    if (errno == ENAMETOOLONG)
      throw_input_error(fmt::format("cannot write '{}': {}", path, system_error_text(ENAMETOOLONG)),
                        "choose a shorter name");
    return;
  }
  if (S_ISDIR(status.st_mode))
    throw_input_error(fmt::format("cannot write '{}': it is a folder", path),
                      "give the name of a file in it");
  if (!S_ISREG(status.st_mode))
    throw_input_error(fmt::format("cannot write '{}': it is not a regular file", path),
                      "give the name of a regular file");
  if (::access(path.c_str(), W_OK) != 0)
    throw_input_error(fmt::format("cannot replace '{}': {}", path, system_error_text(errno)),
                      "choose another name, or make that file writable");
}

/// The process that a temporary file of this name belongs to; 0: it is no such name.
int writer_of(const std::string& name) {
  constexpr std::string_view start = ".kaustik-", end = ".tmp";
  if (!name.starts_with(start)) return 0;
  int pid = 0, number = 0;
  const char* const last = name.data() + name.size();
  const auto [dash, code] = std::from_chars(name.data() + start.size(), last, pid);
  if (code != std::errc{} || dash == last || *dash != '-') return 0;
  const auto [rest, number_code] = std::from_chars(dash + 1, last, number);
  const bool is_whole = number_code == std::errc{} && std::string_view(rest, last) == end;
  return is_whole && number >= 0 ? pid : 0;
}

/// Removes what a writer that was killed has left in the folder of `target`, as far as that is
/// certain: its process is gone, and nobody holds the lock of a writer, who may be on another
/// machine.
void remove_leftovers(const std::string& target) {
  std::error_code failed;
  for (fs::directory_iterator entry(folder_of(target), failed), end; !failed && entry != end;
       entry.increment(failed)) {
    const int pid = writer_of(entry->path().filename().string());
    if (pid <= 0) continue;
    if (pid != ::getpid() && (::kill(pid, 0) == 0 || errno != ESRCH)) continue;
    const FileDescriptor file(
        ::open(entry->path().c_str(), O_RDWR | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK));
    struct stat status, named;
    if (!file.is_open() || ::fstat(file.get(), &status) != 0 || !S_ISREG(status.st_mode) ||
        ::flock(file.get(), LOCK_EX | LOCK_NB) != 0)
      continue;
    // Of another file that has got the name meanwhile the lock says nothing.
    if (::lstat(entry->path().c_str(), &named) == 0 && named.st_dev == status.st_dev &&
        named.st_ino == status.st_ino)
      ::unlink(entry->path().c_str());
  }
}

/// False (errno says why) if not all was written.
bool write_all(int descriptor, uint64_t begin, std::span<const uint8_t> bytes) {
  // Some systems refuse more than 2 GiB in one call.
  constexpr size_t most_at_once = size_t{1} << 30;
  while (!bytes.empty()) {
    const ssize_t written =
        ::pwrite(descriptor, bytes.data(), std::min(bytes.size(), most_at_once), off_t(begin));
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return false;
    bytes = bytes.subspan(size_t(written));
    begin += uint64_t(written);
  }
  return true;
}

/// A new file beside the target; it removes itself unless it has been renamed.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& target) : target_(target) {
    const fs::path folder = folder_of(target);
    for (int i = 0; i < attempts && !file_; ++i) {
      path_ = (folder / fmt::format(".kaustik-{}-{}.tmp", ::getpid(), i)).string();
      // Network disks lock only what may be read, too.
      const int fd = ::open(path_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
      if (fd < 0 && errno != EEXIST) fail(errno);
      if (fd < 0) continue;
      file_.emplace(fd);
      if (is_taken_for_leftover()) file_.reset();
    }
    if (!file_) fail(EEXIST);
  }
  ~TemporaryFile() {
    if (!is_renamed_) ::unlink(path_.c_str());
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  void write(uint64_t begin, std::span<const uint8_t> bytes) {
    if (!write_all(file_->get(), begin, bytes)) fail(errno);
  }
  void read(uint64_t begin, std::span<uint8_t> out) const {
    if (read_descriptor(file_->get(), begin, out) != out.size())
      throw Error(ErrorKind::system, fmt::format("cannot read '{}' again", path_),
                  "check the disk and write it again");
  }

  /// Makes it safe on the disk, with the target's permissions if there is one.
  void finish() {
    struct stat status;
    if (::stat(target_.c_str(), &status) == 0 &&
        ::fchmod(file_->get(), status.st_mode & 07777) != 0)
      fail(errno);
    if (::fsync(file_->get()) != 0) fail(errno);
  }

  /// Puts it in the target's place.
  void replace_target() {
    // Closing it first would give up the lock while it still has the name of a leftover.
    if (::rename(path_.c_str(), target_.c_str()) != 0) fail(errno);
    is_renamed_ = true;
    if (!file_->close())
      throw Error(ErrorKind::system,
                  fmt::format("cannot write '{}': {}", target_, system_error_text(errno)),
                  "check the disk and write it again");
    // The name itself is safe only when the folder is on the disk too; not every file system can.
    const FileDescriptor folder(
        ::open(folder_of(target_).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    if (folder.is_open()) ::fsync(folder.get());
  }

 private:
  static constexpr int attempts = 1000;

  /// Takes the lock, which is held as long as this writes: see remove_leftovers(). True if another
  /// program was just about to remove the file.
  bool is_taken_for_leftover() const {
    if (::flock(file_->get(), LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK) return true;
    struct stat status;
    return ::fstat(file_->get(), &status) == 0 && status.st_nlink == 0;
  }

  [[noreturn]] void fail(int error_number) const {
    throw Error(ErrorKind::system,
                fmt::format("cannot write '{}': {}", target_, system_error_text(error_number)),
                "free some space or choose another folder; what was there before is unchanged");
  }

  std::string target_, path_;
  std::optional<FileDescriptor> file_;
  bool is_renamed_ = false;
};

/// Keeps others out who lock the folder, where the file system can; goes with the process that
/// holds it.
class FolderLock {
 public:
  explicit FolderLock(const std::string& folder)
      : folder_(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
    if (!folder_.is_open()) return;
    while (::flock(folder_.get(), LOCK_EX) != 0 && errno == EINTR) {
    }
  }

 private:
  FileDescriptor folder_;
};

/// The target of what is to be written, in a folder without leftovers. Throws as
/// check_output_path().
std::string prepared_target(const std::string& path) {
  check_output_path(path);
  std::string target = output_target(path);
  remove_leftovers(target);
  return target;
}

}  // namespace

std::string output_target(const std::string& path) {
  constexpr int most_links = 40;  // as the system
  fs::path target = path;
  for (int i = 0; i < most_links; ++i) {
    std::error_code failed;
    if (!fs::is_symlink(fs::symlink_status(target, failed))) return target.string();
    const fs::path next = fs::read_symlink(target, failed);
    if (failed) return target.string();
    target = next.is_absolute() ? next : target.parent_path() / next;
  }
  throw_input_error(fmt::format("cannot write '{}': its links lead in a circle", path),
                    "choose another name, or remove the links");
}

void check_output_path(const std::string& path) {
  if (path.empty()) throw_input_error("the name of the output file is empty", "give a file name");
  check_folder(path);
  check_what_stands_there(path);
}

void write_file_atomically(const std::string& path, std::span<const uint8_t> bytes) {
  const std::string target = prepared_target(path);
  TemporaryFile file(target);
  file.write(0, bytes);
  file.finish();
  file.replace_target();
}

bool write_file_atomically_if(const std::string& path, std::span<const uint8_t> bytes,
                              const std::function<bool()>& is_wanted) {
  const std::string target = prepared_target(path);
  TemporaryFile file(target);
  file.write(0, bytes);
  file.finish();
  const FolderLock lock(folder_of(target));
  if (!is_wanted()) return false;
  file.replace_target();
  return true;
}

class AtomicFile::File : public TemporaryFile {
 public:
  using TemporaryFile::TemporaryFile;
};

AtomicFile::AtomicFile(const std::string& path)
    : file_(std::make_unique<File>(prepared_target(path))) {}

AtomicFile::~AtomicFile() = default;

void AtomicFile::write(uint64_t begin, std::span<const uint8_t> bytes) {
  file_->write(begin, bytes);
}

void AtomicFile::read(uint64_t begin, std::span<uint8_t> out) const { file_->read(begin, out); }

void AtomicFile::finish() {
  file_->finish();
  file_->replace_target();
}

ScratchFile::ScratchFile(const std::string& path) : path_(prepared_target(path)) {
  const std::string folder = folder_of(path_);
  descriptor_ = ::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
  if (descriptor_ < 0) {
    // Not every file system has files without a name.
    std::string name = folder + "/.kaustik-XXXXXX";
    descriptor_ = ::mkostemp(name.data(), O_CLOEXEC);
    if (descriptor_ >= 0) ::unlink(name.c_str());
  }
  if (descriptor_ < 0)
    throw Error(ErrorKind::system,
                fmt::format("cannot write to folder '{}': {}", folder, system_error_text(errno)),
                "choose another folder");
}

ScratchFile::~ScratchFile() { ::close(descriptor_); }

void ScratchFile::append(std::span<const uint8_t> bytes) {
  if (!write_all(descriptor_, size_, bytes))
    throw Error(
        ErrorKind::system,
        fmt::format("cannot write to the folder of '{}': {}", path_, system_error_text(errno)),
        "free some space: photons that do not fit into memory are kept there meanwhile");
  size_ += bytes.size();
}

void ScratchFile::read(uint64_t begin, std::span<uint8_t> out) const {
  if (read_descriptor(descriptor_, begin, out) != out.size())
    throw Error(ErrorKind::system,
                fmt::format("cannot read what was kept in the folder of '{}'", path_),
                "check the disk");
}

void write_text_atomically(const std::string& path, std::string_view text) {
  write_file_atomically(path, {reinterpret_cast<const uint8_t*>(text.data()), text.size()});
}

}  // namespace kaustik
