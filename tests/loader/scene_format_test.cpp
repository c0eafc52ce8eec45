// Which format a scene file is taken for: by its contents, else by its name, and packed or not.

#include "kaustik/loader/scene_format.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <fstream>

#include "kaustik/base/error.h"
#include "kaustik/base/gzip.h"
#include "tests/support/temporary_folder.h"

namespace kaustik::test {
namespace {

const std::string scene =
    "<?xml version=\"1.0\"?>\n<!-- a ball -->\n<scene version=\"3.0.0\">\n"
    "<shape type=\"sphere\"/>\n</scene>\n";

std::vector<uint8_t> packed(const std::string& text) {
  z_stream stream{};
  EXPECT_EQ(deflateInit2(&stream, 9, Z_DEFLATED, 16 + MAX_WBITS, 9, Z_DEFAULT_STRATEGY), Z_OK);
  std::vector<uint8_t> out(text.size() + 1000);
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
  stream.avail_in = uInt(text.size());
  stream.next_out = out.data();
  stream.avail_out = uInt(out.size());
  EXPECT_EQ(deflate(&stream, Z_FINISH), Z_STREAM_END);
  out.resize(out.size() - stream.avail_out);
  deflateEnd(&stream);
  return out;
}

class SceneFormats : public testing::Test {
 protected:
  template <typename Bytes>
  std::string write(const std::string& name, const Bytes& bytes) const {
    std::ofstream(folder_.path(name), std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
    return folder_.path(name);
  }
  static void expect_ball(const Description& description) {
    ASSERT_EQ(description.scene->children.size(), 1u);
    EXPECT_EQ(description.scene->children[0].object->type, "sphere");
  }
  static Problem problem_of(const std::string& path) {
    try {
      load_scene(path);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::input);
      return error.problems()[0];
    }
    ADD_FAILURE() << path << " was read";
    return {};
  }

  TemporaryFolder folder_;
};

TEST_F(SceneFormats, ContentsCountWhateverTheName) {
  for (const char* name : {"a.xml", "A.XML", "a.json", "noname", "a.ply"})
    expect_ball(load_scene(write(name, scene)));
  expect_ball(load_scene(write("marked.txt", "\xef\xbb\xbf" + scene)));
  expect_ball(parse_scene(scene, "standard input", ""));
}

TEST_F(SceneFormats, PackedFilesAreThoseThatTheyHold) {
  const std::vector<uint8_t> bytes = packed(scene);
  for (const char* name : {"a.xml.gz", "a.xml", "noname"})
    expect_ball(load_scene(write(name, bytes)));
  expect_ball(parse_scene({bytes.begin(), bytes.end()}, "standard input", ""));
  // In two members, and included.
  std::vector<uint8_t> twice = packed(scene.substr(0, 50)), rest = packed(scene.substr(50));
  twice.insert(twice.end(), rest.begin(), rest.end());
  write("inner.xml.gz", twice);
  const std::string outer = "<scene version=\"3.0.0\"><include filename=\"inner.xml.gz\"/></scene>";
  const Description included = load_scene(write("outer.xml", outer));
  expect_ball(included);
  EXPECT_EQ(included.sources.size(), 2u);
}

TEST_F(SceneFormats, DamagedPackedFilesAreErrors) {
  const std::vector<uint8_t> bytes = packed(scene);
  for (size_t length = 30; length < bytes.size(); ++length) {
    const Problem problem = problem_of(
        write("cut.xml.gz", std::vector<uint8_t>(bytes.begin(), bytes.begin() + long(length))));
    EXPECT_NE(problem.message.find("damaged"), std::string::npos) << length << problem.message;
    EXPECT_TRUE(problem.place.file);
  }
  for (size_t i = 10; i < bytes.size(); ++i) {
    std::vector<uint8_t> flipped = bytes;
    flipped[i] ^= 0x55;
    problem_of(write("flipped.xml.gz", flipped));
  }
}

TEST_F(SceneFormats, WhatGrowsOutOfProportionIsRefused) {
  const std::vector<uint8_t> bomb =
      packed("<scene version=\"3.0.0\">" + std::string(100 << 20, ' '));
  EXPECT_LT(bomb.size(), 200'000u);
  EXPECT_NE(problem_of(write("bomb.xml", bomb)).message.find("grows"), std::string::npos);
}

TEST_F(SceneFormats, UnknownFilesAreToldWhatCanBeRead) {
  for (const std::string& contents : {std::string("{\"scene\": 1}"), std::string("\x89PNG\r\n"),
                                      std::string(), std::string("<html>")}) {
    const Problem problem = problem_of(write("scene.json", contents));
    EXPECT_NE(problem.message.find("no scene in a format"), std::string::npos) << problem.message;
    EXPECT_NE(problem.remedy.find("Mitsuba XML (.xml)"), std::string::npos) << problem.remedy;
    EXPECT_EQ(*problem.place.file, folder_.path("scene.json"));
  }
  // The name says what it ought to be: its loader tells what is wrong.
  EXPECT_NE(problem_of(write("broken.xml", std::string("scene"))).message.find("XML"),
            std::string::npos);
  EXPECT_NE(problem_of(folder_.path("missing.xml")).message.find("No such file"),
            std::string::npos);
  EXPECT_NE(problem_of(folder_.path("missing")).message.find("No such file"), std::string::npos);
}

TEST_F(SceneFormats, ScenesAreKnownByNameOrByContents) {
  for (const char* name : {"a.xml", "A.XML", "folder.d/a.xml.gz", "a.Xml.GZ"})
    EXPECT_TRUE(has_scene_name(name)) << name;
  for (const char* name : {"a.exr", "xml", "a.xml.zip", "a.xml/b", ""})
    EXPECT_FALSE(has_scene_name(name)) << name;
  EXPECT_TRUE(is_scene_file(write("a", std::string("<scene version=\"3.0.0\"/>"))));
  EXPECT_TRUE(is_scene_file(write("a.xml", std::string("?"))));
  EXPECT_FALSE(is_scene_file(write("a.exr", std::string("?"))));
  EXPECT_THROW(is_scene_file(folder_.path("missing.xml")), Error);
}

TEST_F(SceneFormats, TheTableIsSearchedByContentsThenByName) {
  const auto row = [](const char* name, std::string_view extension, auto recognises) {
    return SceneFormat{name, {extension}, recognises, nullptr, nullptr};
  };
  const std::vector<SceneFormat> formats = {
      row("one", ".a", [](std::string_view head) { return head.starts_with("x"); }),
      row("two", ".b", [](std::string_view head) { return head.starts_with("x"); }),
      row("three", ".c", [](std::string_view head) { return head.starts_with("y"); })};
  const auto chosen = [&](const char* head, const char* path) {
    return std::string(choose_format(formats, head, path).name);
  };
  EXPECT_EQ(chosen("y", "f.a"), "three");
  EXPECT_EQ(chosen("x", "f.b"), "two");  // both do, and one is named so
  EXPECT_EQ(chosen("x", "f.c"), "one");
  EXPECT_EQ(chosen("z", "f.C.GZ"), "three");
  EXPECT_THROW(choose_format(formats, "z", "f.d"), Error);
}

}  // namespace
}  // namespace kaustik::test
