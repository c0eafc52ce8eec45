#pragma once
#include "kaustik/scene/object_digests.h"

namespace kaustik {

/// Keys by which parts of a scene are known again in the next one: digests of what describes them.
/// Of files the stamps count (FileStamp), for reading meshes and pictures only to see whether they
/// are the same would take most of the time that is to be saved. A file that is replaced or written
/// to has another stamp, so it is read anew; one whose last change is too fresh for its stamp to be
/// relied on gets a key that no other build has.
class PartKeys {
 public:
  PartKeys();

  /// Of an object with all that it holds …
  uint64_t whole(const Object& object) { return digests_.of(object); }
  /// … or without its children.
  uint64_t own(const Object& object) { return digests_.without_children(object); }
  /// Of an emitter, for the shape of that index in the scene (−1: none).
  uint64_t light(const Object& emitter, int shape);

 private:
  ObjectDigests digests_;
};

}  // namespace kaustik
