// What meshes will take, by their files.

#include "kaustik/scene/mesh_memory.h"

#include <gtest/gtest.h>

#include <fstream>

#include "kaustik/loader/mitsuba_xml.h"
#include "tests/support/temporary_folder.h"

namespace kaustik {
namespace {

std::string shape(const std::string& file) {
  return "<shape type=\"ply\"><string name=\"filename\" value=\"" + file + "\"/></shape>";
}

uint64_t memory_of(const std::string& folder, const std::string& inside) {
  return expected_mesh_memory(
      parse_mitsuba_xml("<scene version=\"3.0.0\">" + inside + "</scene>", "test.xml", folder));
}

TEST(MeshMemory, EveryFileCountsOnce) {
  const test::TemporaryFolder folder;
  std::ofstream(folder.path("a.ply")) << std::string(1000, ' ');
  std::ofstream(folder.path("b.ply")) << std::string(500, ' ');
  const std::string path = folder.path("");
  const uint64_t a = memory_of(path, shape("a.ply"));
  EXPECT_EQ(a, 7000u);
  EXPECT_EQ(memory_of(path, shape("a.ply") + shape("a.ply")), a);
  EXPECT_EQ(memory_of(path, shape("a.ply") + shape("b.ply")), a + a / 2);
}

TEST(MeshMemory, WhatIsNotThereTakesNone) {
  const test::TemporaryFolder folder;
  EXPECT_EQ(memory_of(folder.path(""), shape("none.ply")), 0u);
  EXPECT_EQ(memory_of(folder.path(""), "<shape type=\"sphere\"/>"), 0u);
}

}  // namespace
}  // namespace kaustik
