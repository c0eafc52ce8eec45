// The digest of a description: what changes it and what does not.

#include "kaustik/scene/description_digest.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "kaustik/base/error.h"
#include "kaustik/loader/mitsuba_xml.h"
#include "kaustik/scene/overrides.h"
#include "kaustik/scene/type_tables.h"
#include "tests/support/temporary_folder.h"

namespace kaustik {
namespace {

Description described(const std::string& inside) {
  return parse_mitsuba_xml("<scene version=\"3.0.0\">" + inside + "</scene>", "test.xml", "");
}
DescriptionDigest digest_of(const std::string& inside) {
  return description_digest(described(inside), scene_types());
}

constexpr const char* ball = "<shape type=\"sphere\"><float name=\"radius\" value=\"2\"/></shape>";

TEST(DescriptionDigest, WhatMakesNoPictureMakesNoDifference) {
  EXPECT_EQ(digest_of(ball), digest_of(std::string("\n <!-- a ball -->\n  ") + ball));
}

TEST(DescriptionDigest, EveryPropertyCounts) {
  const DescriptionDigest plain = digest_of(ball);
  for (const char* other :
       {"<shape type=\"sphere\"><float name=\"radius\" value=\"2.0000000001\"/></shape>",
        "<shape type=\"sphere\"><integer name=\"radius\" value=\"2\"/></shape>",
        "<shape type=\"disk\"><float name=\"radius\" value=\"2\"/></shape>",
        "<shape type=\"sphere\"><float name=\"radius\" value=\"2\"/><bsdf "
        "type=\"diffuse\"/></shape>",
        "<shape type=\"sphere\"><transform name=\"to_world\"><scale "
        "value=\"2\"/></transform></shape>",
        "<emitter type=\"point\"><float name=\"radius\" value=\"2\"/></emitter>", ""})
    EXPECT_NE(digest_of(other).scene, plain.scene) << other;
}

TEST(DescriptionDigest, SettingsCountAsWhatTheyChange) {
  Description changed = described(ball);
  const TypeTables& types = scene_types();
  const DescriptionDigest plain = description_digest(changed, types);
  override_property(changed, "integrator.max_depth=3");
  EXPECT_EQ(description_digest(changed, types).scene, plain.scene);
  EXPECT_NE(description_digest(changed, types).integrator, plain.integrator);
  const DescriptionDigest path = digest_of(std::string(ball) + "<integrator type=\"path\"/>");
  EXPECT_EQ(path.scene, plain.scene);
  EXPECT_NE(path.integrator, plain.integrator);
}

TEST(DescriptionDigest, FilesThatChangeWhileTheyAreReadAreTold) {
  const test::TemporaryFolder folder;
  const std::string path = folder.path("mesh.obj"), text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  const auto write = [&](const std::string& to, const std::string& contents) {
    std::ofstream(to) << contents;
  };
  write(path, text);
  const Description mesh =
      described("<shape type=\"obj\"><string name=\"filename\" value=\"" + path + "\"/></shape>");
  const GuardedDigest guarded(mesh, scene_types());
  EXPECT_EQ(guarded.digest(), description_digest(mesh, scene_types()));
  EXPECT_NO_THROW(guarded.check(mesh));
  // As long as before, and put in its place as editors do.
  write(folder.path("new.obj"), "v 0 0 0\nv 2 0 0\nv 0 1 0\nf 1 2 3\n");
  std::filesystem::rename(folder.path("new.obj"), path);
  try {
    guarded.check(mesh);
    ADD_FAILURE() << "a changed file has passed";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("changed while the scene was read: '" + path + "'"),
              std::string::npos)
        << error.what();
  }
  write(path, text);  // the same once more is no change
  EXPECT_NO_THROW(guarded.check(mesh));
}

TEST(DescriptionDigest, FilesCountByTheirContents) {
  const test::TemporaryFolder folder;
  const auto mesh = [&](const std::string& name, const std::string& text) {
    std::ofstream(folder.path(name)) << text;
    return digest_of("<shape type=\"obj\"><string name=\"filename\" value=\"" + folder.path(name) +
                     "\"/></shape>");
  };
  const DescriptionDigest first = mesh("a.obj", "v 0 0 0\n");
  EXPECT_EQ(mesh("moved.obj", "v 0 0 0\n"), first);
  EXPECT_NE(mesh("a.obj", "v 0 0 1\n").scene, first.scene);
  std::filesystem::remove(folder.path("a.obj"));
  EXPECT_THROW(digest_of("<shape type=\"obj\"><string name=\"filename\" value=\"" +
                         folder.path("a.obj") + "\"/></shape>"),
               Error);
}

/// As many references as there are, every object is gone through once.
TEST(DescriptionDigest, SharedObjectsCostNothing) {
  std::string text = "<bsdf type=\"diffuse\" id=\"b0\"/>";
  for (int i = 1; i < 60; ++i)
    text += "<bsdf type=\"blendbsdf\" id=\"b" + std::to_string(i) + "\"><ref id=\"b" +
            std::to_string(i - 1) + "\"/><ref id=\"b" + std::to_string(i - 1) + "\"/></bsdf>";
  EXPECT_NE(digest_of(text).scene, 0u);
}

}  // namespace
}  // namespace kaustik
