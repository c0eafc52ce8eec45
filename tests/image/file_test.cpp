#include "kaustik/base/file.h"

#include <sched.h>
#include <signal.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "kaustik/image/image_io.h"
#include "tests/image/support.h"

namespace kaustik {
namespace {

using testing::caught;
using testing::Caught;
using testing::expect_input_error;
namespace fs = std::filesystem;

class AtomicFile : public testing::FileTest {
 protected:
  static std::vector<uint8_t> bytes(size_t count, uint8_t value) {
    return std::vector<uint8_t>(count, value);
  }
};

TEST_F(AtomicFile, writes_and_reads) {
  for (const size_t size : {size_t{0}, size_t{1}, size_t{100000}}) {
    write_file_atomically(path("a"), bytes(size, 7));
    EXPECT_EQ(read_file(path("a")), bytes(size, 7));
    EXPECT_EQ(file_count(), 1u);
  }
}

TEST_F(AtomicFile, keeps_permissions_and_links) {
  put(path("a"), "old");
  ::chmod(path("a").c_str(), 0640);
  fs::create_symlink("a", path("link"));
  write_file_atomically(path("link"), bytes(3, 'n'));
  EXPECT_TRUE(fs::is_symlink(path("link")));
  EXPECT_EQ(contents(path("a")), "nnn");
  EXPECT_EQ(int(fs::status(path("a")).permissions()), 0640);
}

TEST_F(AtomicFile, new_files_follow_the_umask) {
  const mode_t before = ::umask(027);
  write_file_atomically(path("a"), bytes(1, 1));
  ::umask(before);
  EXPECT_EQ(int(fs::status(path("a")).permissions()), 0640);
}

TEST_F(AtomicFile, wrong_paths_are_input_errors) {
  put(path("file"), "x");
  fs::create_directory(path("folder"));
  const auto writes = [&](const std::string& target, const std::string& part) {
    expect_input_error([&] { check_output_path(target); }, part);
    expect_input_error([&] { write_file_atomically(target, bytes(10, 1)); }, part);
  };
  writes("", "empty");
  writes(path("missing/a.exr"), path("missing"));
  writes(path("missing/a.exr"), "mkdir -p");
  writes(path("file/a.exr"), path("file"));
  writes(path("file/below/a.exr"), path("file/below"));
  writes(path("folder"), "folder");
  writes(path(std::string(300, 'n')), "name");
  writes("/dev/null", "regular");
  EXPECT_EQ(contents(path("file")), "x");
  EXPECT_EQ(file_count(), 2u);
}

/// Runs in a child process, whose rights and limits may be spoiled; `body` returns the exit status.
int in_child(const std::function<int()>& body) {
  const pid_t child = ::fork();
  if (child == 0) ::_exit(body());
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + status;
}

enum Outcome { no_error = 10, input_error = 11, system_error = 12, cannot_prepare = 13 };
int outcome_of(const std::function<void()>& action) {
  const Caught error = caught(action);
  if (!error.is_error) return no_error;
  return error.kind == ErrorKind::input ? input_error : system_error;
}

TEST_F(AtomicFile, folders_without_permission_are_input_errors) {
  fs::create_directory(path("locked"));
  put(path("locked/old"), "old");
  ::chmod(path("locked").c_str(), 0555);
  ::chmod(folder_.c_str(), 0755);
  const int outcome = in_child([&] {
    // Root may write anywhere, so become somebody else.
    if (::geteuid() == 0 && ::setuid(65534) != 0) return int(cannot_prepare);
    return outcome_of([&] { write_file_atomically(path("locked/new"), bytes(1, 1)); });
  });
  ::chmod(path("locked").c_str(), 0755);
  EXPECT_EQ(outcome, input_error);
  EXPECT_FALSE(fs::exists(path("locked/new")));
}

TEST_F(AtomicFile, a_read_only_file_is_not_replaced) {
  fs::permissions(folder_, fs::perms::all);
  put(path("old"), "old");
  ::chmod(path("old").c_str(), 0444);
  const int outcome = in_child([&] {
    if (::geteuid() == 0 && ::setuid(65534) != 0) return int(cannot_prepare);
    return outcome_of([&] { write_file_atomically(path("old"), bytes(1, 1)); });
  });
  EXPECT_EQ(outcome, input_error);
  EXPECT_EQ(contents(path("old")), "old");
}

void limit_file_size(rlim_t size) {
  ::signal(SIGXFSZ, SIG_IGN);
  const rlimit limit = {size, size};
  ::setrlimit(RLIMIT_FSIZE, &limit);
}

TEST_F(AtomicFile, a_file_size_limit_leaves_the_old_file) {
  put(path("out"), "old contents");
  const int outcome = in_child([&] {
    limit_file_size(1000);
    return outcome_of([&] { write_file_atomically(path("out"), bytes(5000, 1)); });
  });
  EXPECT_EQ(outcome, system_error);
  EXPECT_EQ(contents(path("out")), "old contents");
  EXPECT_EQ(file_count(), 1u);
}

TEST_F(AtomicFile, every_image_format_survives_a_file_size_limit) {
  const Image image = testing::test_picture(40, 30, 2);
  for (const char* name : {"a.exr", "a.hdr", "a.pfm", "a.tif", "a.png", "a.jpg", "a.ppm"}) {
    put(path(name), "old contents");
    const int outcome = in_child([&] {
      limit_file_size(100);
      return outcome_of([&] { write_image(image, path(name)); });
    });
    EXPECT_EQ(outcome, system_error) << name;
    EXPECT_EQ(contents(path(name)), "old contents") << name;
    fs::remove(path(name));
    EXPECT_EQ(file_count(), 0u) << name;
  }
}

TEST_F(AtomicFile, a_full_disk_leaves_the_old_file) {
  const int outcome = in_child([&] {
    if (::unshare(CLONE_NEWNS) != 0 ||
        ::mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) != 0 ||
        ::mount("none", folder_.c_str(), "tmpfs", 0, "size=64k") != 0)
      return int(cannot_prepare);
    put(path("out"), "old");
    const int result =
        outcome_of([&] { write_file_atomically(path("out"), bytes(size_t{1} << 20, 1)); });
    return contents(path("out")) == "old" && file_count() == 1 ? result : 1;
  });
  if (outcome == cannot_prepare) GTEST_SKIP() << "a small disk cannot be mounted here";
  EXPECT_EQ(outcome, system_error);
}

TEST_F(AtomicFile, reading_what_is_no_file) {
  expect_input_error([&] { read_file(path("missing")); }, path("missing"));
  expect_input_error([&] { read_file(folder_.string()); }, "regular");
  ASSERT_EQ(::mkfifo(path("pipe").c_str(), 0600), 0);
  expect_input_error([&] { read_file(path("pipe")); }, "regular");
}

TEST_F(AtomicFile, check_writable_knows_extensions) {
  for (const char* name :
       {"a.exr", "a.EXR", "a.hdr", "a.pfm", "a.tif", "a.tiff", "a.png", "a.jpg", "a.jpeg", "a.ppm"})
    check_writable(path(name));
  EXPECT_EQ(file_count(), 0u);
  for (const char* name : {"a.gif", "a", "a.", ".exr", "exr"})
    expect_input_error([&] { check_writable(path(name)); }, "extension");
  expect_input_error([&] { check_writable(path("missing/a.exr")); }, path("missing"));
  const Image image(2, 2, {"R", "G", "B"});
  expect_input_error([&] { write_image(image, path("a.gif")); }, ".gif");
  expect_input_error([&] { write_image(Image(), path("a.exr")); }, "empty");
  EXPECT_EQ(file_count(), 0u);
}

}  // namespace
}  // namespace kaustik
