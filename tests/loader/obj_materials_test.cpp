// What Mitsuba 0.6 takes from MTL files.
#include <algorithm>
#include <cstring>

#include "kaustik/loader/mtl_file.h"
#include "loader_support.h"

namespace kaustik {
namespace {

const std::string two_materials =
    "mtllib scene.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n"
    "usemtl RedWall\nf 1 2 3\nusemtl Glass\nf 1 2 4\nusemtl RedWall\nf 2 3 4\n";
const std::string library =
    "# by hand\nnewmtl RedWall\nKd 0.8 0.1 0.2\nNs 10\n\nnewmtl Glass\nKd 0 0 0\nNi 1.33\n"
    "Tf 0.5 1 1\nillum 7\nnewmtl unused\nKd 1 1 1\n";

class ObjMaterials : public testing::Test {
 protected:
  ObjMaterials() {
    folder_.write("scene.obj", two_materials);
    folder_.write("scene.mtl", library);
  }
  /// The shape shines, or the scene would get a light of its own.
  Description load(const std::string& given, const std::string& version = "0.6.0",
                   bool is_strict = false, const std::string& searched = "") {
    const std::string lamp = "<emitter type=\"area\"/>";
    const std::string inside = given.find(lamp) == std::string::npos ? given + lamp : given;
    LoadOptions options;
    options.is_strict = is_strict;
    const std::string path = searched.empty() ? "" : "<path value=\"" + searched + "\"/>";
    return parse_mitsuba_xml(
        in_scene(
            path + "<shape type=\"obj\" id=\"o\"><string name=\"filename\" value=\"scene.obj\"/>" +
                inside + "</shape>",
            version),
        "test.xml", folder_ / "", options);
  }
  TemporaryFolder folder_;
};

const Object* bsdf_under(const Object& shape) {
  for (const Child& child : shape.children)
    if (child.object->family == "bsdf") return child.object.get();
  return nullptr;
}

TEST_F(ObjMaterials, MakeAShapeOfEach) {
  const Description description = load("<emitter type=\"area\"/>");
  ASSERT_EQ(description.scene->children.size(), 2u);
  const Object& glass = *description.scene->children[0].object;
  const Object& wall = *description.scene->children[1].object;
  EXPECT_EQ(value<std::string>(glass, "material"), "Glass");
  EXPECT_EQ(value<std::string>(wall, "material"), "RedWall");
  EXPECT_EQ(glass.id, "o");
  EXPECT_EQ(wall.id, "o:RedWall");
  ASSERT_TRUE(bsdf_under(wall) && bsdf_under(glass));
  EXPECT_EQ(bsdf_under(wall)->type, "diffuse");
  EXPECT_EQ(value<Rgb>(*bsdf_under(wall), "reflectance"), (Rgb{0.8, 0.1, 0.2}));
  EXPECT_EQ(bsdf_under(wall)->place.line, 2);
  EXPECT_EQ(bsdf_under(glass)->type, "dielectric");
  EXPECT_EQ(value<double>(*bsdf_under(glass), "int_ior"), 1.33);
  EXPECT_EQ(value<Rgb>(*bsdf_under(glass), "specular_transmittance"), (Rgb{0.5, 1, 1}));
  // The lamp shines from both.
  for (const Object* shape : {&glass, &wall}) EXPECT_EQ(shape->children.size(), 2u);
  EXPECT_TRUE(description.warnings.empty());
  EXPECT_NE(
      std::find(description.sources.begin(), description.sources.end(), folder_ / "scene.mtl"),
      description.sources.end());
}

TEST_F(ObjMaterials, AreLeftAloneByOthers) {
  const std::string own = "<bsdf type=\"plastic\"/>";
  const std::string off = "<boolean name=\"loadMaterials\" value=\"false\"/>";
  for (const auto& [inside, version] : {std::pair(std::string(), "3.0.0"),
                                        {std::string(), "2.1.0"},
                                        {own, "0.6.0"},
                                        {off, "0.6.0"}}) {
    const Description description = load(inside, version);
    ASSERT_EQ(description.scene->children.size(), 1u) << inside << version;
    const Object& shape = *description.scene->children[0].object;
    EXPECT_EQ(shape.properties.size(), 1u) << inside << version;
    EXPECT_EQ(bsdf_under(shape) != nullptr, inside == own);
  }
}

/// A bsdf by the name of a material stands for it, with or without others.
TEST_F(ObjMaterials, AreReplacedByName) {
  const std::string plastic = "<bsdf type=\"plastic\" name=\"RedWall\"/>";
  const Description replaced = load(plastic);
  ASSERT_EQ(replaced.scene->children.size(), 2u);
  EXPECT_EQ(bsdf_under(*replaced.scene->children[0].object)->type, "dielectric");
  EXPECT_EQ(bsdf_under(*replaced.scene->children[1].object)->type, "plastic");
  const Description with_other = load(plastic + "<bsdf type=\"diffuse\"/>");
  ASSERT_EQ(with_other.scene->children.size(), 2u);
  EXPECT_EQ(bsdf_under(*with_other.scene->children[0].object)->type, "diffuse");
  EXPECT_EQ(bsdf_under(*with_other.scene->children[1].object)->type, "plastic");
  // Any other name means the whole shape.
  const Description named = load("<bsdf type=\"plastic\" name=\"bsdf\"/>");
  ASSERT_EQ(named.scene->children.size(), 1u);
  EXPECT_EQ(bsdf_under(*named.scene->children[0].object)->type, "plastic");
}

TEST_F(ObjMaterials, ThatAreMissingAreTold) {
  folder_.write("scene.obj", "mtllib nowhere.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n");
  const Description description = load("");
  EXPECT_EQ(description.scene->children.size(), 1u);
  ASSERT_EQ(description.warnings.size(), 1u);
  EXPECT_NE(description.warnings[0].find("is not there"), std::string::npos);
  folder_.write("scene.obj", "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n");
  folder_.write("a.mtl", "newmtl b\nKd 1 0 0\n");
  const Description lacking = load("");
  ASSERT_EQ(lacking.warnings.size(), 1u);
  EXPECT_NE(lacking.warnings[0].find("its file of materials lacks 'a'"), std::string::npos);
  std::filesystem::remove(folder_ / "scene.obj");
  EXPECT_EQ(load("").scene->children.size(), 1u);  // the reader of the mesh tells
}

// The search for files of a scene is that for the files that its files name.
TEST_F(ObjMaterials, AreFoundByNamesOfOtherComputers) {
  folder_.write("scene.obj",
                "mtllib C:\\work\\SCENE.MTL\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n");
  folder_.write("scene.mtl", "newmtl a\nmap_Kd -s 2 2 /home/me/Maps/Wood.tga\n");
  folder_.write("wood.PNG", "");
  const Description description = load("");
  ASSERT_EQ(description.scene->children.size(), 1u);
  const Object* bsdf = bsdf_under(*description.scene->children[0].object);
  ASSERT_TRUE(bsdf);
  ASSERT_EQ(bsdf->children.size(), 1u);
  EXPECT_EQ(value<std::string>(*bsdf->children[0].object, "filename"), folder_ / "wood.PNG");
  EXPECT_EQ(
      description.warnings,
      (std::vector<std::string>{(folder_ / "scene.obj") + ":1: there is no file of that name: '" +
                                    (folder_ / "scene.mtl") + "' stands for it",
                                (folder_ / "scene.mtl") + ":2: there is no file of that name: '" +
                                    (folder_ / "wood.PNG") + "' stands for it"}));
  EXPECT_EQ(load("", "0.6.0", true).scene->children[0].object->children.size(), 1u);
}

/// Those beside the scene as well.
TEST_F(ObjMaterials, AreLookedForBesideTheScene) {
  folder_.write("scene.obj", "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n");
  folder_.write("mtl/a.mtl", "newmtl a\nKd 1 0 0\n");
  const Description description = load("<emitter type=\"area\"/>", "0.6.0", false, "mtl");
  EXPECT_TRUE(description.warnings.empty());
  ASSERT_TRUE(bsdf_under(*description.scene->children[0].object));
}

/// Only the file of just that name, if there is one.
std::optional<std::filesystem::path> as_it_is(const std::string& name,
                                              const std::filesystem::path& folder, const Place&) {
  std::string with_slashes = name;
  std::replace(with_slashes.begin(), with_slashes.end(), '\\', '/');
  const std::filesystem::path path = folder / with_slashes;
  return !name.empty() && std::filesystem::is_regular_file(path) ? std::optional(path)
                                                                 : std::nullopt;
}

class Mtl : public testing::Test {
 protected:
  std::shared_ptr<Object> material(const std::string& lines) {
    const MtlFile file = read_mtl(folder_.write("a.mtl", "newmtl a\n" + lines), as_it_is);
    remarks_ = file.remarks.size();
    return file.bsdfs.at("a");
  }
  TemporaryFolder folder_;
  size_t remarks_ = 0;
};

TEST_F(Mtl, HighlightsMirrorsAndHoles) {
  const auto glossy = material("Kd 0.9 0.5 0.1\nKs 0.6 0.6 0.6\nNs 50\n");
  EXPECT_EQ(glossy->type, "phong");
  EXPECT_EQ(value<double>(*glossy, "exponent"), 50);
  // Scaled so that no more comes back than arrives.
  EXPECT_NEAR(
      value<Rgb>(*glossy, "diffuse_reflectance").r + value<Rgb>(*glossy, "specular_reflectance").r,
      1, 1e-12);
  EXPECT_EQ(material("Kd .5 .5 .5\nKs 0.01 0 0\n")->type, "diffuse");

  // The blend reflects Kd evenly and Ks as a mirror.
  const auto mirror = material("Kd 0.3 0.3 0.3\nKs 0.6 0.4 0.2\nillum 3\n");
  ASSERT_EQ(mirror->type, "blendbsdf");
  const double share = value<double>(*mirror, "weight");
  const Object &plain = *mirror->children.at(0).object, &metal = *mirror->children.at(1).object;
  EXPECT_NEAR(value<Rgb>(plain, "reflectance").g * (1 - share), 0.3, 1e-12);
  EXPECT_NEAR(value<Rgb>(metal, "specular_reflectance").g * share, 0.4, 1e-12);
  EXPECT_EQ(material("Kd 0 0 0\nKs 0.8 0.8 0.8\nillum 5\n")->type, "conductor");

  EXPECT_EQ(value<double>(*material("d 0.25\n"), "opacity"), 0.25);
  EXPECT_EQ(value<double>(*material("Tr 0.75\n"), "opacity"), 0.25);
  EXPECT_EQ(material("Tr 1\n")->type, "diffuse");  // writers that mean d
  EXPECT_EQ(material("d 0.5\nTr 0.1\n")->type, "mask");
  EXPECT_EQ(material("Ni 1.5\nTf 1 1 1\nillum 2\n")->type, "diffuse");
  EXPECT_EQ(material("Ni 1.5\nd 0.5\n")->type, "dielectric");
}

TEST_F(Mtl, Pictures) {
  folder_.write("maps/a wall.png", "");
  const auto wall = material("Kd 1 0 0\nmap_Kd -s 2 3 1 -o .5 0.25 -clamp on maps\\a wall.png\n");
  ASSERT_EQ(wall->children.size(), 1u);
  EXPECT_EQ(wall->children[0].name, "reflectance");
  const Object& picture = *wall->children[0].object;
  EXPECT_EQ(value<std::string>(picture, "filename"), folder_ / "maps/a wall.png");
  EXPECT_EQ(value<std::string>(picture, "wrap_mode"), "clamp");
  // Upside down u, 1 − v become 2 u + ½, 1 − (3 v + ¼).
  const Vec3f at = value<Transform>(picture, "to_uv").point({0.5f, 1 - 0.2f, 0});
  EXPECT_NEAR(at.x, 1.5f, 1e-6f);
  EXPECT_NEAR(at.y, 1 - 0.85f, 1e-6f);
  EXPECT_EQ(remarks_, 0u);
  const auto missing = material("Kd 1 0 0\nmap_Kd none.png\nmap_d none.png\n");
  EXPECT_EQ(remarks_, 2u);
  EXPECT_EQ(value<Rgb>(*missing, "reflectance"), (Rgb{1, 0, 0}));
}

TEST_F(Mtl, LinesThatAreWrongAreToldOnce) {
  const auto plain = material("Kd 1 x 0\nNs\nNi nan\nd -halo 0.5\nKd spectral a.rfl\nillum 99\n");
  EXPECT_EQ(plain->type, "mask");
  EXPECT_EQ(remarks_, 1u);
}

/// Materials, or an error, whatever the bytes are.
TEST_F(Mtl, OfAnyBytes) {
  const std::string good = library + "map_Kd -s 1 2 3 a.png\nd -halo 0.5\n";
  for (size_t at = 0; at < good.size(); ++at)
    for (const int bits : {0x01, 0x10, 0x80, 0xff}) {
      std::string flipped = good;
      flipped[at] = char(flipped[at] ^ bits);
      EXPECT_LE(read_mtl(folder_.write("a.mtl", flipped), as_it_is).bsdfs.size(), 4u);
      if (bits == 1) read_mtl(folder_.write("a.mtl", good.substr(0, at)), as_it_is);
    }
}

// Each shape of a file has the materials of its own faces.
TEST_F(ObjMaterials, OfOneShapeOfTheFile) {
  folder_.write("scene.obj",
                "mtllib scene.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\ng a\nusemtl RedWall\n"
                "f 1 2 3\ng b\nusemtl Glass\nf 1 2 4\ng c\nf 1 3 4\nusemtl RedWall\nf 2 3 4\n");
  const auto parts = [&](int index) {
    return load("<integer name=\"shapeIndex\" value=\"" + std::to_string(index) + "\"/>")
        .scene->children;
  };
  const char* types[] = {"diffuse", "dielectric", "dielectric", "diffuse"};
  for (int i = 0; i < 4; ++i) {
    const auto shapes = parts(i);
    ASSERT_EQ(shapes.size(), 1u);
    EXPECT_EQ(bsdf_under(*shapes[0].object)->type, types[i]) << i;
    EXPECT_THROW(property(*shapes[0].object, "material"), std::runtime_error);
  }
}

}  // namespace
}  // namespace kaustik
