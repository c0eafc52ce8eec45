#include "kaustik/base/bytes.h"

#include <gtest/gtest.h>

#include "kaustik/base/error.h"

namespace kaustik {
namespace {

TEST(Bytes, ComeBack) {
  ByteWriter writer;
  writer.put(uint32_t(7));
  writer.put_array(std::vector<double>{0.5, -1});
  writer.put_text("lamp");
  writer.put(uint8_t(1));
  const std::vector<uint8_t> bytes = writer.take();
  ByteReader reader(bytes, "the note");
  EXPECT_EQ(reader.get<uint32_t>(), 7u);
  EXPECT_EQ(reader.get_array<double>(), (std::vector<double>{0.5, -1}));
  EXPECT_EQ(reader.get_text(), "lamp");
  EXPECT_TRUE(reader.get_flag());
  reader.expect_end();
}

TEST(Bytes, DamageIsTold) {
  ByteWriter writer;
  writer.put(uint64_t(1) << 60);
  writer.put(uint8_t(2));
  const std::vector<uint8_t> bytes = writer.take();
  EXPECT_THROW(ByteReader(bytes, "it").get_array<double>(), Error);
  EXPECT_THROW(ByteReader(bytes, "it").get_text(), Error);
  EXPECT_THROW(ByteReader(bytes, "it").get_array<uint8_t>(3), Error);
  ByteReader reader(bytes, "the note");
  reader.get<uint64_t>();
  EXPECT_THROW(reader.expect_end(), Error);
  EXPECT_THROW(reader.get_flag(), Error);
  try {
    reader.get<double>();
    FAIL();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "the note is damaged: it ends too early");
  }
}

}  // namespace
}  // namespace kaustik
