#include "file_broadcast.h"

#include <fmt/format.h>
#include <stdlib.h>

#include <cerrno>
#include <filesystem>
#include <fstream>
#include <system_error>
#include <vector>

#include "kaustik/base/bytes.h"
#include "kaustik/base/error.h"
#include "kaustik/base/file.h"

namespace kaustik::app {
namespace {

namespace fs = std::filesystem;

/// Of a file, in memory at a time.
constexpr uint64_t piece_bytes = uint64_t{16} << 20;

uint64_t pieces_of(uint64_t size) { return (size + piece_bytes - 1) / piece_bytes; }

std::string whole_path(const std::string& path) {
  return fs::absolute(path).lexically_normal().string();
}

[[noreturn]] void fail_to_write(const std::string& path, const std::error_code& why) {
  throw Error(
      ErrorKind::system, fmt::format("cannot write '{}': {}", path, why.message()),
      "files of the scene are copied to the folder for temporary files: let TMPDIR name one "
      "that has room for them");
}

std::string temporary_folder() {
  std::string folder = (fs::temp_directory_path() / "kaustik_XXXXXX").string();
  if (!::mkdtemp(folder.data())) fail_to_write(folder, {errno, std::generic_category()});
  return folder;
}

void write_pieces(Team& team, const std::string& path, uint64_t size) {
  std::error_code failed;
  fs::create_directories(fs::path(path).parent_path(), failed);
  if (failed) fail_to_write(path, failed);
  errno = 0;
  std::ofstream out(path, std::ios::binary);
  for (uint64_t piece = 0; piece < pieces_of(size); ++piece) {
    const std::vector<uint8_t> bytes = team.from_leader({});
    out.write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
  }
  out.close();
  if (!out) fail_to_write(path, {errno, std::generic_category()});
}

void read_pieces(Team& team, const InputFile& file) {
  for (uint64_t piece = 0; piece < pieces_of(file.size()); ++piece) {
    const uint64_t begin = piece * piece_bytes;
    std::vector<uint8_t> bytes(std::min(piece_bytes, file.size() - begin));
    if (file.read(begin, bytes) != bytes.size())
      throw Error(ErrorKind::input,
                  fmt::format("'{}' became shorter while it was read", file.path()),
                  "wait until nothing writes there any more, and render again");
    team.from_leader(std::move(bytes));
  }
}

}  // namespace

FileBroadcast::FileBroadcast(Team& team, const std::set<std::string>& files) {
  if (team.is_led_here())
    send(team, files);
  else
    receive(team);
}

FileBroadcast::~FileBroadcast() {
  std::error_code ignored;
  if (!folder_.empty()) fs::remove_all(folder_, ignored);
}

std::string FileBroadcast::here(const std::string& path) const {
  return fs::path(path).is_absolute() ? folder_ + whole_path(path) : path;
}

void FileBroadcast::send(Team& team, const std::set<std::string>& files) const {
  for (const std::string& path : files) {
    const InputFile file(path);
    ByteWriter header;
    header.put(true);
    header.put_text(whole_path(path));
    header.put(file.size());
    team.from_leader(header.take());
    read_pieces(team, file);
  }
  ByteWriter end;
  end.put(false);
  end.put_text(fs::current_path().string());
  team.from_leader(end.take());
}

void FileBroadcast::receive(Team& team) {
  folder_ = temporary_folder();
  while (true) {
    const std::vector<uint8_t> bytes = team.from_leader({});
    ByteReader header(bytes, "what the leading process says of a file");
    const bool is_file = header.get_flag();
    const std::string path = folder_ + header.get_text();
    if (is_file) {
      write_pieces(team, path, header.get<uint64_t>());
      continue;
    }
    std::error_code failed;
    fs::create_directories(path, failed);
    if (!failed) fs::current_path(path, failed);
    if (failed) fail_to_write(path, failed);
    return;
  }
}

}  // namespace kaustik::app
