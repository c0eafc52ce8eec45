#include "kaustik/loader/nanovdb_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "kaustik/base/error.h"
#include "kaustik/base/gzip.h"
#include "kaustik/base/inflate.h"
#include "kaustik/loader/nanovdb_tree.h"

namespace kaustik {
namespace {

constexpr uint64_t file_header_bytes = 16, metadata_bytes = 176;  ///< of a part of a file

/// "NanoVDB0", or 1 and 2 of later programs.
bool begins_by_magic(const NanoVdbBytes& bytes, uint64_t begin) {
  const auto magic = bytes.part(begin, 8);
  return std::memcmp(magic.data(), "NanoVDB", 7) == 0 && magic[7] >= '0' && magic[7] <= '2';
}

enum class Codec : uint16_t { none, zip, blosc };

/// Where a grid lies in a file.
struct Entry {
  uint64_t grid_size = 0, begin = 0, bytes = 0;
  Codec codec = Codec::none;
};

/// The first one of the name.
Entry find_grid(const NanoVdbBytes& file, const std::string& name) {
  std::string names;
  for (uint64_t segment = 0; segment < file.size();) {
    if (!begins_by_magic(file, segment)) file.damaged("a part does not begin as it should");
    const auto version = file.at<uint32_t>(segment + 8);
    if (version >> 21 != 32)
      file.refuse(fmt::format("the NanoVDB file has version {}", version >> 21),
                  "write it anew with version 32");
    const auto count = file.at<uint16_t>(segment + 12);
    uint64_t at = segment + file_header_bytes;
    std::vector<Entry> entries;
    std::vector<bool> is_wanted;
    for (uint16_t i = 0; i < count; ++i) {
      const auto name_size = file.at<uint32_t>(at + 136);
      const auto text = file.part(at + metadata_bytes, name_size);
      const std::string found(text.begin(), std::find(text.begin(), text.end(), 0));
      entries.push_back(
          {file.at<uint64_t>(at), 0, file.at<uint64_t>(at + 8), file.at<Codec>(at + 168)});
      is_wanted.push_back(found == name);
      if (names.size() < 200 && found.size() < 64) names += (names.empty() ? "" : ", ") + found;
      at += metadata_bytes + name_size;
    }
    for (size_t i = 0; i < entries.size(); ++i) {
      entries[i].begin = at;
      (void)file.part(at, entries[i].bytes);
      if (is_wanted[i]) return entries[i];
      at += entries[i].bytes;
    }
    segment = at;
  }
  file.refuse(fmt::format("the NanoVDB file has no grid of the wanted name; it has: {}", names),
              "name one of them: gridname");
}

/// The grid's bytes; `unpacked` keeps them where they are not the file's own.
std::span<const uint8_t> bytes_of(const NanoVdbBytes& file, const Entry& entry,
                                  std::vector<uint8_t>& unpacked) {
  const auto stored = file.part(entry.begin, entry.bytes);
  if (entry.codec == Codec::none) return stored;
  if (entry.codec != Codec::zip)
    file.refuse("the NanoVDB file is packed by Blosc, which is not read",
                "write it without compression, or packed by zlib");
  if (stored.size() < 8) file.damaged("it is truncated");
  const uint64_t most = always_allowed_growth + usual_growth * file.size();
  if (entry.grid_size > most) file.damaged("it grows out of all proportion");
  Inflater inflater(stored.subspan(8), Packing::zlib);
  inflater.unpack(unpacked, size_t(entry.grid_size));
  if (inflater.is_damaged() || unpacked.size() != entry.grid_size)
    file.damaged("what zlib has packed cannot be unpacked");
  return unpacked;
}

}  // namespace

bool is_nanovdb(std::span<const uint8_t> file) {
  const Place nowhere;
  return file.size() >= file_header_bytes && begins_by_magic(NanoVdbBytes(file, nowhere), 0);
}

DenseGrid read_nanovdb(std::span<const uint8_t> file, const std::string& grid, size_t most_samples,
                       const Place& place) {
  const NanoVdbBytes bytes(file, place);
  if (!is_nanovdb(file))
    bytes.refuse("this is no file of NanoVDB", "convert OpenVDB files with nanovdb_convert");
  std::vector<uint8_t> unpacked;
  const NanoVdbBytes tree(bytes_of(bytes, find_grid(bytes, grid), unpacked), place);
  return dense_grid_of(tree, most_samples);
}

}  // namespace kaustik
