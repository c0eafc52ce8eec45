#include "kaustik/base/file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <stdlib.h>
#include <sys/file.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <thread>
#include <vector>

#include "kaustik/base/error.h"

namespace kaustik {
namespace {

namespace fs = std::filesystem;

class Files : public ::testing::Test {
 protected:
  Files() {
    std::string pattern = (fs::temp_directory_path() / "kaustik_XXXXXX").string();
    folder_ = ::mkdtemp(pattern.data());
  }
  ~Files() override { fs::remove_all(folder_); }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  static void write(const std::string& name, const std::string& text) {
    write_file_atomically(name, {reinterpret_cast<const uint8_t*>(text.data()), text.size()});
  }
  static std::string contents(const std::string& name) {
    const auto bytes = read_file(name);
    return {bytes.begin(), bytes.end()};
  }

 private:
  fs::path folder_;
};

TEST_F(Files, LinksStayAndTheirTargetIsWritten) {
  fs::create_directory(path("sub"));
  fs::create_symlink("sub/target", path("link"));
  fs::create_symlink("link", path("chain"));
  write(path("chain"), "new");
  EXPECT_TRUE(fs::is_symlink(path("chain")) && fs::is_symlink(path("link")));
  EXPECT_EQ(contents(path("sub/target")), "new");
  write(path("link"), "newer");
  EXPECT_EQ(contents(path("sub/target")), "newer");
  EXPECT_TRUE(fs::is_symlink(path("link")));

  fs::create_symlink("nowhere/target", path("lost"));
  EXPECT_THROW(check_output_path(path("lost")), Error);
  fs::create_symlink("b", path("a"));
  fs::create_symlink("a", path("b"));
  EXPECT_THROW(write(path("a"), "never"), Error);
  EXPECT_TRUE(fs::is_symlink(path("a")));
}

TEST_F(Files, WhatIsNotWantedInTheEndIsNotWritten) {
  write(path("there"), "old");
  const std::vector<uint8_t> more{'n', 'e', 'w'};
  const auto asked = [&](bool answer) {
    return write_file_atomically_if(path("there"), more, [&] {
      EXPECT_EQ(contents(path("there")), "old");
      return answer;
    });
  };
  EXPECT_FALSE(asked(false));
  EXPECT_EQ(contents(path("there")), "old");
  EXPECT_TRUE(asked(true));
  EXPECT_EQ(contents(path("there")), "new");
  EXPECT_EQ(std::distance(fs::directory_iterator(fs::path(path("")).parent_path()), {}), 1);
}

TEST_F(Files, TwoAreNotAskedAtTheSameTime) {
  const std::vector<uint8_t> bytes{'x'};
  std::atomic<int> asked = 0;
  std::vector<std::jthread> threads;
  for (int i = 0; i < 8; ++i)
    threads.emplace_back([&, i] {
      write_file_atomically_if(path(fmt::format("file_{}", i)), bytes, [&] {
        EXPECT_EQ(++asked, 1);
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
        --asked;
        return true;
      });
    });
}

TEST_F(Files, WhatAKilledWriterLeftIsRemoved) {
  const pid_t gone = ::fork();
  if (gone == 0) ::_exit(0);
  ::waitpid(gone, nullptr, 0);
  const auto name = [&](pid_t pid) { return path(".kaustik-" + std::to_string(pid) + "-0.tmp"); };
  const std::string others = path(".kaustik-" + std::to_string(gone) + "-x.tmp");
  const std::string held = path(".kaustik-" + std::to_string(gone) + "-1.tmp");
  for (const std::string& file : {name(gone), name(::getppid()), others, held})
    std::ofstream(file) << "half";
  const int writer = ::open(held.c_str(), O_RDONLY | O_CLOEXEC);  // as on another machine
  ASSERT_EQ(::flock(writer, LOCK_SH), 0);
  write(path("a"), "whole");
  EXPECT_FALSE(fs::exists(name(gone)));
  EXPECT_TRUE(fs::exists(name(::getppid())));
  EXPECT_TRUE(fs::exists(others));
  EXPECT_TRUE(fs::exists(held));
  ::close(writer);
  write(path("a"), "again");
  EXPECT_FALSE(fs::exists(held));
}

}  // namespace
}  // namespace kaustik
