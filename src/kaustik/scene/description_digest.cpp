#include "kaustik/scene/description_digest.h"

#include <fmt/format.h>

#include "kaustik/base/checksum.h"
#include "kaustik/base/error.h"
#include "kaustik/base/file.h"
#include "kaustik/scene/file_stamp.h"
#include "kaustik/scene/object_digests.h"
#include "kaustik/scene/scene.h"

namespace kaustik {

DescriptionDigest description_digest(const Description& description, const TypeTables& types) {
  const auto integrator = find_integrator(description);
  ObjectDigests digests(
      types,
      [](const std::string& path) {
        return fmt::format("file {:016x}", checksum(read_file(path)));
      },
      integrator.get());
  return {digests.of(*description.scene), integrator ? digests.of(*integrator) : 0};
}

std::map<std::string, FileStamp> GuardedDigest::stamps_of(const Description& description,
                                                          const TypeTables& types) {
  std::map<std::string, FileStamp> stamps;
  for (const std::string& file : named_files(description, types)) {
    // Who reads it will tell of one that is not there.
    if (const auto stamp = stamp_of_file(file)) stamps[file] = *stamp;
  }
  return stamps;
}

GuardedDigest::GuardedDigest(const Description& description, const TypeTables& types)
    : types_(&types),
      stamps_(stamps_of(description, types)),
      digest_(description_digest(description, types)) {}

void GuardedDigest::check(const Description& description) const {
  const auto now = stamps_of(description, *types_);
  if (now == stamps_ || description_digest(description, *types_) == digest_) return;
  std::string changed;
  for (const auto& [file, stamp] : stamps_)
    if (const auto found = now.find(file); found == now.end() || found->second != stamp)
      changed += (changed.empty() ? "'" : ", '") + file + "'";
  throw Error(ErrorKind::input,
              fmt::format("changed while the scene was read: {}",
                          changed.empty() ? "a file that was not there" : changed),
              "wait until nothing writes there any more, and render again");
}

}  // namespace kaustik
