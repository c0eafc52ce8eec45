#pragma once
#include <cstdint>
#include <map>
#include <string>

#include "kaustik/scene/description.h"
#include "kaustik/scene/file_stamp.h"

namespace kaustik {

/// Numbers that differ in all likelihood between descriptions whose pictures differ.
struct DescriptionDigest {
  uint64_t scene = 0;       ///< of all but the scene's integrator
  uint64_t integrator = 0;  ///< of that
  friend bool operator==(const DescriptionDigest&, const DescriptionDigest&) = default;
};

/// Of every object, its type, id, properties and children in their order, and of the bytes of the
/// files and buffers that properties name, as `types` tell; where those lie makes no difference,
/// nor do comments and spaces in the scene file. Throws Error if such a file cannot be read.
DescriptionDigest description_digest(const Description& description, const TypeTables& types);

/// A digest, and whether it still is that of the files when all of them have been read again: one
/// that somebody writes meanwhile must not pass for another.
class GuardedDigest {
 public:
  /// `types` must outlive this.
  GuardedDigest(const Description& description, const TypeTables& types);
  const DescriptionDigest& digest() const { return digest_; }
  /// Throws Error(input) if a file has other contents than those of the digest.
  void check(const Description& description) const;

 private:
  static std::map<std::string, FileStamp> stamps_of(const Description& description,
                                                    const TypeTables& types);

  const TypeTables* types_;
  std::map<std::string, FileStamp> stamps_;  ///< what the system tells of the files, by path
  DescriptionDigest digest_;
};

}  // namespace kaustik
