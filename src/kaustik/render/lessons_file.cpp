// docs/reference/checkpoint_file.md describes the file; what is put and got here is that, in its
// order.
#include "kaustik/render/lessons_file.h"

#include <algorithm>

#include "kaustik/base/checksum.h"

namespace kaustik {
namespace {

constexpr BinaryFileKind lessons_kind = {
    {0x89, 'K', 'L', 'N', '\r', '\n', 0x1a, '\n'},
    12,
    "file of lessons",
    "give a .kln file, of lessons that Kaustik has learned of a scene",
    "learn again with this version of Kaustik"};

}  // namespace

void put_lessons(BinaryWriter& writer, const Lessons& lessons) {
  writer.put(lessons.passes);
  writer.put(uint64_t(lessons.bytes.size()));
  writer.put_bytes(lessons.bytes.data(), lessons.bytes.size());
}

Lessons get_lessons(BinaryReader& reader) {
  Lessons lessons;
  lessons.passes = reader.get<uint32_t>();
  const auto size = reader.get<uint64_t>();
  lessons.bytes = reader.get_array<uint8_t>(size);
  return lessons;
}

void write_lessons(const std::string& path, const StoredLessons& stored) {
  BinaryWriter writer(lessons_kind);
  for (const std::string* text : {&stored.program, &stored.scene, &stored.integrator})
    writer.put_text(*text);
  writer.put(stored.digest.scene);
  writer.put(stored.digest.integrator);
  writer.put(stored.seed);
  writer.put(stored.samples_per_pass);
  put_lessons(writer, stored.lessons);
  writer.write_to(path);
}

StoredLessons read_lessons(const std::string& path) {
  BinaryReader reader(lessons_kind, path);
  StoredLessons stored;
  for (std::string* text : {&stored.program, &stored.scene, &stored.integrator})
    *text = reader.get_text();
  stored.digest.scene = reader.get<uint64_t>();
  stored.digest.integrator = reader.get<uint64_t>();
  stored.seed = reader.get<uint64_t>();
  stored.samples_per_pass = reader.get<uint32_t>();
  stored.lessons = get_lessons(reader);
  reader.expect_end();
  if (stored.samples_per_pass == 0 || stored.samples_per_pass > most_samples_per_pass)
    reader.damaged("the samples of its passes are not valid");
  if (stored.lessons.empty() || stored.lessons.passes == 0) reader.damaged("it holds no lesson");
  return stored;
}

bool is_lessons_file(const std::string& path) { return is_of_kind(lessons_kind, path); }

uint64_t digest_of(const Lessons& lessons) {
  return std::max<uint64_t>(1, checksum(lessons.bytes));
}

}  // namespace kaustik
