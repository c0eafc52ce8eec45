// Meshes and pictures that Mitsuba 3 would read otherwise become files of their own, and textures
// that scale others become colours, or such pictures.

#include "kaustik/loader/mitsuba3_terms.h"
#include "kaustik/scene/type_tables.h"
#include "tests/loader/loader_support.h"

namespace kaustik {
namespace {

Mitsuba3Scene converted(const std::string& inside, const std::string& version = "3.0.0") {
  return in_terms_of_mitsuba3(parse(in_scene(inside, version)), scene_types(), "out/room.xml");
}

const Object& object_at(const Mitsuba3Scene& scene, size_t index) {
  return *scene.description.scene->children.at(index).object;
}

bool has_any(const Object& object, const std::string& name) {
  return std::ranges::find(object.properties, name, &Property::name) != object.properties.end();
}

std::string shape(const std::string& type, const std::string& inside) {
  return "<shape type='" + type + "'><string name='filename' value='a b." + type + "'/>" + inside +
         "</shape>";
}

TEST(Mitsuba3Files, MeshesOfItsOwnReadingStay) {
  const Mitsuba3Scene scene = converted(
      shape("obj", "<boolean name='face_normals' value='true'/>") + shape("ply", "") +
      shape("serialized", "<integer name='shape_index' value='2'/>") +
      shape("obj", "<integer name='shape_index' value='-1'/>") +
      shape("ply",
            "<bsdf type='diffuse'><texture type='mesh_attribute' name='reflectance'><string "
            "name='name' value='vertex_color'/></texture></bsdf>"));
  EXPECT_TRUE(scene.files.empty());
  EXPECT_TRUE(scene.remarks.empty());
  EXPECT_EQ(object_at(scene, 0).type, "obj");
}

TEST(Mitsuba3Files, MeshesOfOtherReadingsBecomePly) {
  const std::string smooth = "<float name='max_smooth_angle' value='30'/>";
  for (const std::string& given :
       {shape("obj", "<string name='material' value='red'/>"),
        shape("obj", "<integer name='shape_index' value='0'/>"), shape("ply", smooth),
        shape("serialized", "<boolean name='flip_tex_coords' value='true'/>"),
        shape("heightfield", "<float name='scale' value='2'/>"),
        shape("obj",
              "<bsdf type='twosided'><bsdf type='diffuse'><texture type='mesh_attribute' "
              "name='reflectance'><string name='name' value='vertex_color'/></texture>"
              "</bsdf></bsdf>")}) {
    const Mitsuba3Scene scene = converted(given);
    ASSERT_EQ(scene.files.size(), 1u) << given;
    const FileToWrite& file = scene.files[0];
    EXPECT_TRUE(file.is_mesh());
    EXPECT_TRUE(file.path.starts_with("out/room_a_b") && file.path.ends_with(".ply")) << file.path;
    const Object& ply = object_at(scene, 0);
    EXPECT_EQ(ply.type, "ply");
    EXPECT_EQ(value<std::string>(ply, "filename"), file.path);
    EXPECT_NE(file.source->type + given, "ply");
    for (const char* name :
         {"material", "shape_index", "max_smooth_angle", "flip_tex_coords", "scale"})
      EXPECT_FALSE(has_any(ply, name)) << name;
    EXPECT_TRUE(scene.remarks.empty()) << scene.remarks[0];
  }
}

// Creases are those in the world, where the mesh is written; flat meshes have none.
TEST(Mitsuba3Files, PlacementGoesIntoMeshesWithCreases) {
  const std::string turned =
      "<transform name='to_world'><translate x='1'/></transform><boolean name='flip_normals' "
      "value='true'/>";
  const std::string smooth = "<float name='max_smooth_angle' value='30'/>";
  const Mitsuba3Scene scene =
      converted(shape("ply", turned + smooth) +
                shape("ply", turned + smooth + "<boolean name='face_normals' value='true'/>") +
                shape("obj", turned + "<string name='material' value=''/>"));
  EXPECT_FALSE(has_any(object_at(scene, 0), "to_world"));
  EXPECT_TRUE(has_any(object_at(scene, 1), "to_world"));
  EXPECT_TRUE(has_any(object_at(scene, 1), "face_normals"));
  EXPECT_TRUE(has_any(object_at(scene, 2), "to_world"));
  for (size_t i = 0; i < 3; ++i) EXPECT_TRUE(has_any(object_at(scene, i), "flip_normals"));
  EXPECT_EQ(scene.files.size(), 3u);
}

TEST(Mitsuba3Files, TheSameMeshIsOneFile) {
  const auto part = [](const std::string& material, const std::string& x) {
    return shape("obj", "<string name='material' value='" + material +
                            "'/><transform name='to_world'><translate x='" + x + "'/></transform>");
  };
  const Mitsuba3Scene scene =
      converted(part("red", "1") + part("red/", "1") + part("red", "2") + part("red?", "3"));
  ASSERT_EQ(scene.files.size(), 3u);
  EXPECT_EQ(scene.files[0].users.size(), 2u);
  EXPECT_EQ(scene.files[0].path, "out/room_a_b_red.ply");
  // Names differ, whatever becomes of their letters.
  EXPECT_EQ(scene.files[1].path, "out/room_a_b_red_.ply");
  EXPECT_EQ(scene.files[2].path, "out/room_a_b_red__2.ply");
}

std::string bitmap(const std::string& name, const std::string& inside = "") {
  return "<texture type='bitmap'" + (name.empty() ? "" : " name='" + name + "'") +
         "><string name='filename' value='pic.png'/>" + inside + "</texture>";
}

std::string scaled(const std::string& name, const std::string& factor, const std::string& what) {
  return "<texture type='scale'" + (name.empty() ? "" : " name='" + name + "'") + ">" + factor +
         what + "</texture>";
}

const std::string half = "<float name='scale' value='0.5'/>",
                  tint = "<rgb name='scale' value='0.5, 0.25, 1'/>";

std::string matt(const std::string& texture) {
  return "<bsdf type='diffuse'>" + texture + "</bsdf>";
}

TEST(Mitsuba3Textures, ScaledColoursAreColours) {
  const Mitsuba3Scene scene = converted(
      matt(scaled("reflectance", half, "<rgb name='value' value='0.8, 0.4, 0.2'/>")) +
      matt(scaled("reflectance", half, scaled("", tint, "<float name='value' value='0.8'/>"))) +
      matt(scaled("reflectance", half,
                  "<texture type='checkerboard'><rgb name='color1' value='0.8, 0.4, 0.2'/>"
                  "</texture>")));
  EXPECT_EQ(value<Rgb>(object_at(scene, 0), "reflectance"), (Rgb{0.4, 0.2, 0.1}));
  EXPECT_TRUE(object_at(scene, 0).children.empty());
  EXPECT_EQ(value<Rgb>(object_at(scene, 1), "reflectance"), (Rgb{0.2, 0.1, 0.4}));
  const Object& board = *object_at(scene, 2).children.at(0).object;
  EXPECT_EQ(board.type, "checkerboard");
  EXPECT_EQ(value<double>(board, "color0"), 0.2);  // half of what it is where none is given
  EXPECT_EQ(value<Rgb>(board, "color1"), (Rgb{0.4, 0.2, 0.1}));
  EXPECT_TRUE(scene.files.empty() && scene.remarks.empty());
}

TEST(Mitsuba3Textures, ScaledPicturesAreWrittenAnew) {
  const Mitsuba3Scene scene =
      converted(matt(scaled("reflectance", half, bitmap(""))) +
                matt(scaled("reflectance", half, scaled("", tint, bitmap("")))) +
                matt(bitmap("reflectance")) +
                matt(bitmap("reflectance", "<string name='channel' value='r'/>")) +
                matt(bitmap("reflectance", "<float name='gamma' value='2'/>")) +
                matt(scaled("reflectance", half, bitmap(""))));
  ASSERT_EQ(scene.files.size(), 4u);
  EXPECT_EQ(scene.files[0].factor, (Rgb{0.5, 0.5, 0.5}));
  EXPECT_EQ(scene.files[0].users.size(), 2u);
  EXPECT_EQ(scene.files[1].factor, (Rgb{0.25, 0.125, 0.5}));
  EXPECT_EQ(scene.files[2].factor, (Rgb{1, 1, 1}));
  EXPECT_EQ(scene.files[0].path, "out/room_pic.exr");
  const auto picture = [&](size_t i) -> const Object& {
    return *object_at(scene, i).children.at(0).object;
  };
  for (size_t i = 0; i < 6; ++i) EXPECT_EQ(picture(i).type, "bitmap");
  EXPECT_EQ(value<std::string>(picture(2), "filename"), "pic.png");
  EXPECT_EQ(value<std::string>(picture(3), "filename"), scene.files[2].path);
  EXPECT_FALSE(has_any(picture(3), "channel"));
  EXPECT_TRUE(has_any(*scene.files[2].source, "channel"));
  EXPECT_FALSE(has_any(picture(4), "gamma"));
  EXPECT_TRUE(scene.remarks.empty()) << scene.remarks[0];
}

TEST(Mitsuba3Textures, FactorsFindTheirPlace) {
  const Mitsuba3Scene scene = converted(
      "<bsdf type='bumpmap'>" + scaled("", half, bitmap("")) +
      "<float name='scale' value='3'/><bsdf type='diffuse'/></bsdf>"
      "<shape type='sphere'><emitter type='area'><rgb name='radiance' value='1, 2, 3'/><float "
      "name='scale' value='2'/></emitter></shape><shape type='sphere'><emitter type='area'>" +
      bitmap("radiance") + "<float name='scale' value='2'/></emitter></shape>" +
      matt(bitmap("reflectance", "<float name='gamma' value='1'/>")) +
      matt(scaled("reflectance", half,
                  "<texture type='mesh_attribute'><string name='name' value='vertex_color'/>"
                  "</texture>")));
  EXPECT_EQ(value<double>(object_at(scene, 0), "scale"), 1.5);
  EXPECT_EQ(object_at(scene, 0).children.at(0).object->type, "bitmap");
  const Object& lamp = *object_at(scene, 1).children.at(0).object;
  EXPECT_EQ(value<Rgb>(lamp, "radiance"), (Rgb{2, 4, 6}));
  EXPECT_FALSE(has_any(lamp, "scale"));
  ASSERT_EQ(scene.files.size(), 1u);
  EXPECT_EQ(scene.files[0].factor, (Rgb{2, 2, 2}));
  EXPECT_FALSE(has_any(*object_at(scene, 2).children.at(0).object, "scale"));
  EXPECT_EQ(value<bool>(*object_at(scene, 3).children.at(0).object, "raw"), true);
  EXPECT_EQ(value<double>(*object_at(scene, 4).children.at(0).object, "scale"), 0.5);
  EXPECT_TRUE(scene.remarks.empty()) << scene.remarks[0];
}

// What cannot be told otherwise stays, and is named.
TEST(Mitsuba3Textures, WhatHasNoOtherTermsStays) {
  const Mitsuba3Scene scene =
      converted(matt(scaled("reflectance", half, "<texture type='gridtexture'/>")) +
                matt(bitmap("reflectance", "<string name='wrap_mode_u' value='clamp'/>")) +
                matt(bitmap("reflectance", "<string name='wrap_mode' value='zero'/>")) +
                matt(bitmap("reflectance", "<string name='wrap_mode' value='mirror'/>")));
  EXPECT_EQ(object_at(scene, 0).children.at(0).object->type, "scale");
  ASSERT_EQ(scene.remarks.size(), 4u);
  EXPECT_NE(scene.remarks[0].find("no texture 'scale'"), std::string::npos);
  EXPECT_NE(scene.remarks[1].find("no texture 'gridtexture'"), std::string::npos);
  EXPECT_NE(scene.remarks[2].find("no 'wrap_mode_u' in"), std::string::npos);
  EXPECT_NE(scene.remarks[3].find("no 'wrap_mode' 'zero' in"), std::string::npos);
}

}  // namespace
}  // namespace kaustik
