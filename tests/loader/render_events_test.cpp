// Lines of JSON that a render has left.

#include "kaustik/loader/render_events.h"

#include <cmath>

#include "tests/loader/loader_support.h"

namespace kaustik {
namespace {

TEST(RenderEvents, HoldWhatMetersShow) {
  const TemporaryFolder folder;
  const auto events = read_render_events(folder.write(
      "a.jsonl",
      "{\"event\":\"start\"}\n"
      "{\"event\":\"measured\",\"x\":1,\"y\":2,\"z\":3,\"value\":500,\"half_width\":4,\"unit\":"
      "\"lx\"}\n"
      "{\"event\":\"measured\",\"x\":1,\"y\":2,\"z\":4,\"value\":510,\"half_width\":null,\"unit\":"
      "\"lx\"}\n"
      "{\"event\":\"progr"
      "\n{\"event\":\"end\",\"exit_code\":0,\"passes\":16,\"samples_per_pixel\":64,\"elapsed_s\":"
      "2.5,\"mean\":7,\"mean_half_width\":1,\"unit\":\"lx\"}\n"));
  ASSERT_TRUE(events);
  EXPECT_EQ(events->exit_code, 0);
  EXPECT_EQ(events->passes, 16);
  EXPECT_EQ(events->samples_per_pixel, 64);
  EXPECT_EQ(events->seconds, 2.5);
  ASSERT_EQ(events->values.size(), 2u);  // not the mean over them
  EXPECT_EQ(events->values[0].position, Vec3d(1, 2, 3));
  EXPECT_EQ(events->values[0].value, 500);
  EXPECT_EQ(events->values[0].half_width, 4);
  EXPECT_TRUE(std::isnan(events->values[1].half_width));
}

TEST(RenderEvents, HoldTheMeanOfAPicture) {
  const TemporaryFolder folder;
  const auto events = read_render_events(
      folder.write("a.jsonl",
                   "{\"event\":\"end\",\"exit_code\":75,\"mean\":7,\"mean_half_width\":1,\"unit\":"
                   "\"cd/m²\"}\n"));
  ASSERT_TRUE(events);
  EXPECT_EQ(events->exit_code, 75);
  ASSERT_EQ(events->values.size(), 1u);
  EXPECT_FALSE(events->values[0].position);
  EXPECT_EQ(events->values[0].unit, "cd/m²");
}

TEST(RenderEvents, MayBeMissing) {
  const TemporaryFolder folder;
  EXPECT_FALSE(read_render_events(folder / "a.jsonl"));
  EXPECT_FALSE(read_render_events(folder.write("a.jsonl", ""))->exit_code);
}

}  // namespace
}  // namespace kaustik
