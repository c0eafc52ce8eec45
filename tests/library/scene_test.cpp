// Scenes of hosts: from files, texts and programs; their errors and edits.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <fstream>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "rooms.h"
#include "tests/support/temporary_folder.h"

namespace kaustik::library_test {
namespace {

using test::TemporaryFolder;

void write_text(const std::string& path, const std::string& text) { std::ofstream(path) << text; }

TEST(LibraryScene, ErrorsTellPlaceCauseAndRemedy) {
  const TemporaryFolder folder;
  const std::string path = folder.path("scene.xml");
  write_text(path,
             "<scene version=\"3.0.0\">\n  <shape type=\"spere\"/>\n"
             "  <shape type=\"sphere\"><float name=\"radius\" value=\"-1\"/></shape>\n</scene>\n");
  const Error error = error_of([&] { Scene::load_file(path).check(); });
  EXPECT_EQ(error.kind(), ErrorKind::input);
  ASSERT_GE(error.problems().size(), 2u) << error.what();
  EXPECT_EQ(error.file(), path);
  EXPECT_EQ(error.line(), 2);
  EXPECT_GT(error.column(), 0);
  EXPECT_NE(error.message().find("spere"), std::string::npos);
  EXPECT_NE(error.remedy().find("sphere"), std::string::npos) << error.remedy();
  EXPECT_EQ(error.problems()[1].line, 3);
  for (const Problem& problem : error.problems())
    EXPECT_NE(std::string(error.what()).find(problem.message), std::string::npos);
  EXPECT_EQ(error.cause(), nullptr);
  const std::exception& base = error;
  EXPECT_STREQ(base.what(), error.what());
  Error copy = error_of([] { Scene::load_file("nowhere.xml"); });
  EXPECT_EQ(copy.problems().size(), 1u);
  copy = error;
  EXPECT_EQ(copy.line(), 2);
}

TEST(LibraryScene, MistakesOfProgramsHaveTheirPlace) {
  std::vector<Object> objects = room_objects("path");
  objects[2].set("colour", 0.5);
  objects.push_back(Object("shape", "sphere").set("radius", "large"));
  const Error error = error_of([&] { Scene(objects).check(); });
  ASSERT_EQ(error.problems().size(), 2u) << error.what();
  EXPECT_EQ(error.file(), "program");
  EXPECT_EQ(error.line(), 0);
  EXPECT_NE(error.message().find("colour"), std::string::npos);
}

TEST(LibraryScene, DefinitionsAndStrictness) {
  const std::string text =
      "<scene version=\"3.0.0\"><default name=\"size\" value=\"8\"/>"
      "<sensor type=\"perspective\"><float name=\"lens_flare\" value=\"1\"/><film type=\"hdrfilm\">"
      "<integer name=\"width\" value=\"$size\"/><integer name=\"height\" value=\"6\"/></film>"
      "</sensor><emitter type=\"constant\"/></scene>";
  const Scene scene = Scene::load_string(text, {.definitions = {{"size", "12"}}});
  EXPECT_FALSE(scene.check().empty());
  SessionSettings settings = passes(1, 1);
  settings.integrator = "path";
  EXPECT_EQ(rendered(scene, settings).width(), 12);
  EXPECT_THROW(Scene::load_string(text, {.definitions = {}, .is_strict = true}).check(), Error);
}

// Places are what programs call things, not what the command line has.
TEST(LibraryScene, PlacesOfSettings) {
  const std::string text = "<scene version=\"3.0.0\"><emitter type=\"constant\"/></scene>";
  try {
    Scene::load_string(text, {.definitions = {{"size", "12"}}});
    ADD_FAILURE() << "a definition without use was taken";
  } catch (const Error& error) {
    EXPECT_EQ(error.file(), "LoadOptions::definitions");
    EXPECT_EQ(std::string(error.what()).find("-D"), std::string::npos) << error.what();
  }
  SessionSettings settings = passes(1, 1);
  settings.integrator = "pth";
  try {
    Session(Scene({camera(4, 4), Object("emitter", "constant")}), settings).run();
    ADD_FAILURE() << "an unknown integrator was taken";
  } catch (const Error& error) {
    EXPECT_EQ(error.file(), "SessionSettings::integrator");
    EXPECT_EQ(std::string(error.what()).find("--"), std::string::npos) << error.what();
  }
}

TEST(LibraryScene, ObjectsAreValues) {
  Object grey = Object("bsdf", "diffuse").set("reflectance", 0.5);
  Object shape = square_mesh().shape().add(grey);
  const Scene before({camera(4, 4), Object("emitter", "constant"), shape});
  grey.set("reflectance", 7);
  shape.set("no such thing", true).add(grey).add(shape);
  EXPECT_NO_THROW(before.check());
  EXPECT_THROW(Scene({camera(4, 4), shape}).check(), Error);
  // The last value counts, and a nested object in its place.
  Object twice = Object("bsdf", "diffuse").set("reflectance", 9).set("reflectance", 0.5);
  twice.add(Object("texture", "checkerboard"), "reflectance");
  EXPECT_NO_THROW(
      Scene({camera(4, 4), Object("emitter", "constant"), square_mesh().shape().add(twice)})
          .check());
}

TEST(LibraryScene, WhatWasMovedStaysWhole) {
  Object grey("bsdf", "diffuse");
  const Object taken = std::move(grey);
  grey.set("reflectance", 0.5);
  Scene scene({camera(4, 4), Object("emitter", "constant"), square_mesh().shape().add(grey)});
  const Scene other = std::move(scene);
  EXPECT_NO_THROW(scene.check());
  Picture picture = rendered(other, passes(1, 1));
  const Picture kept = std::move(picture);
  EXPECT_EQ(picture.width(), kept.width());
}

TEST(LibraryScene, EditsLeaveTheFirstAsItWas) {
  const Scene dark = half_sky();
  const Scene bright = dark.edit({{"sky.radiance", 2}, {"film.width", 8}});
  const Scene by_text = bright.edit("grey.reflectance", Value::from_text("0.25"));
  SessionSettings settings = passes(2, 64);
  settings.integrator = "path";
  const Picture a = rendered(dark, settings), b = rendered(bright, settings),
                c = rendered(by_text, settings);
  EXPECT_NEAR(a.mean().value, 0.5, 0.02);
  EXPECT_NEAR(b.mean().value, 1, 0.04);
  EXPECT_NEAR(c.mean().value, 0.5, 0.02);
  EXPECT_EQ(a.width(), 16);
  EXPECT_EQ(b.width(), 8);
  const Error error = error_of([&] { dark.edit("skies.radiance", 2); });
  EXPECT_NE(error.remedy().find("sky"), std::string::npos);
  for (const char* key : {"radiance", ".radiance", "sky.", ""})
    EXPECT_THROW(dark.edit(key, 2), Error) << key;
  EXPECT_THROW(dark.edit("sky.radians", 2).check(), Error);
  EXPECT_THROW(dark.edit("sky.radiance", "bright").check(), Error);
}

/// The numbers are changed behind the library's back, which hosts must not do: who builds the shape
/// again shows it.
TEST(LibraryScene, EditsShareWhatIsTheSame) {
  const auto positions = std::make_shared<std::vector<float>>(
      std::vector<float>{-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0});
  const uint32_t faces[] = {0, 1, 2, 0, 2, 3};
  const auto shape = [&] {
    return Object("shape", "mesh", "square")
        .set("positions", Array::borrow(positions->data(), 4, 3, positions))
        .set("faces", Array::copy(faces, 2, 3))
        .add(Object("bsdf", "diffuse").set("reflectance", 0.5));
  };
  const auto scene_with = [&](const Object& square) {
    return Scene({Object("sensor", "perspective")
                      .set("to_world", Transform::look_at({0, 0, 1}, {0, 0, 0}, {0, 1, 0}))
                      .add(film(8, 8)),
                  Object("emitter", "constant", "sky").set("radiance", 1), square});
  };
  SessionSettings settings = passes(1, 16);
  settings.integrator = "path";
  const Scene scene = scene_with(shape());
  const Picture first = rendered(scene, settings);
  const long owners = positions.use_count();
  for (size_t i = 2; i < positions->size(); i += 3) (*positions)[i] = 5;
  // Behind the camera: only the sky is seen.
  EXPECT_GT(rendered(scene_with(shape()), settings).mean().value, 0.9);
  const Scene edited = scene.edit("sky.radiance", 2);
  EXPECT_NEAR(rendered(edited, settings).mean().value, 2 * first.mean().value, 0.05);
  EXPECT_EQ(positions.use_count(), owners) << "buffers are shared, not copied";
  Session session(scene_with(shape()), settings);
  session.run();
  session.edit(edited);
  session.wait();
  EXPECT_NEAR(session.picture().mean().value, 2 * first.mean().value, 0.05);
}

TEST(LibraryScene, ArraysOfAnyStrides) {
  struct Vertex {
    float x, y, z, weight;
  };
  // Bottom up, with something between.
  const Vertex vertices[] = {{-1, 1, 0, 9}, {1, 1, 0, 9}, {1, -1, 0, 9}, {-1, -1, 0, 9}};
  const uint32_t faces[] = {0, 1, 2, 7, 0, 2, 3, 7};
  const Mesh mesh({.positions = {&vertices[3].x, 4, -ptrdiff_t(sizeof(Vertex))},
                   .faces = {faces, 2, 4 * sizeof(uint32_t)},
                   .normals = {},
                   .uv = {}});
  EXPECT_EQ(mesh.vertex_count(), 4u);
  EXPECT_EQ(mesh.face_count(), 2u);
  const auto picture_of = [](const Mesh& square) {
    return values(rendered(Scene({camera(8, 8), Object("emitter", "constant"), square.shape()}),
                           passes(1, 4)));
  };
  EXPECT_EQ(picture_of(mesh), picture_of(square_mesh()));
}

TEST(LibraryScene, WrongBuffersAreTold) {
  const float positions[] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  const uint32_t faces[] = {0, 1, 3};
  EXPECT_THROW(Mesh({.positions = {positions, 3}, .faces = {}, .normals = {}, .uv = {}}), Error);
  EXPECT_THROW(Mesh({.positions = {nullptr, 3}, .faces = {faces, 1}, .normals = {}, .uv = {}}),
               Error);
  const auto check = [](const Mesh& mesh) {
    return error_of([&] {
      Scene({camera(4, 4), Object("emitter", "constant"), mesh.shape()}).check();
    });
  };
  const Mesh beyond({.positions = {positions, 3}, .faces = {faces, 1}, .normals = {}, .uv = {}});
  EXPECT_NE(std::string(check(beyond).what()).find("3"), std::string::npos);
  const float lost[] = {0, 0, 0, 1, 0, 0, 0, std::nanf(""), 0};
  const uint32_t whole[] = {0, 1, 2};
  EXPECT_EQ(
      check(Mesh({.positions = {lost, 3}, .faces = {whole, 1}, .normals = {}, .uv = {}})).kind(),
      ErrorKind::input);
  EXPECT_THROW(Array::copy<float>(nullptr, 2, 3), Error);
  EXPECT_THROW(Array::copy(positions, SIZE_MAX / 4, 3), Error);
  EXPECT_THROW(Array::copy(positions, 3, 0), Error);
  EXPECT_THROW(
      Array::borrow(reinterpret_cast<const float*>(reinterpret_cast<const char*>(positions) + 1), 2,
                    3, nullptr),
      Error);
  EXPECT_THROW(Array::copy(positions, 3, 3).shaped({2, 2}), Error);
  EXPECT_EQ(Array::copy(positions, 3, 3).shaped({9}).count(), 9u);
}

TEST(LibraryScene, ValuesOfAllTypes) {
  constexpr uint64_t most = std::numeric_limits<uint64_t>::max();
  EXPECT_THROW(Value{most}, Error);
  EXPECT_THROW(Value{static_cast<const char*>(nullptr)}, Error);
  EXPECT_THROW(Transform::scale({0, 1, 1}), Error);
  EXPECT_THROW(Transform::look_at({0, 0, 0}, {0, 0, 0}, {0, 1, 0}), Error);
  EXPECT_THROW(Value{Transform{.matrix = {}}}, Error);
  const Transform moved = Transform::translate({1, 2, 3}) * Transform::scale({2, 2, 2});
  EXPECT_EQ(moved.matrix[0], 2);
  EXPECT_EQ(moved.matrix[3], 1);
  EXPECT_EQ(moved.matrix[11], 3);
  const Spectrum curve{{{400, 0.1}, {700, 0.9}}};
  EXPECT_NO_THROW(Scene({camera(4, 4), Object("emitter", "constant").set("radiance", 1.0f),
                         square_mesh()
                             .shape()
                             .set("face_normals", true)
                             .add(Object("bsdf", "diffuse").set("reflectance", curve))})
                      .check());
}

}  // namespace
}  // namespace kaustik::library_test
