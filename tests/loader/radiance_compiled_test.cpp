// Octrees and compiled meshes of Radiance, as oconv and obj2mesh write them.
#include "radiance_support.h"

namespace kaustik::radiance_test {
namespace {

/// Writes integers, numbers and words as Radiance's portable files have them.
class CompiledWriter {
 public:
  explicit CompiledWriter(const std::string& format)
      : bytes_("#?RADIANCE\noconv thing.rad\nFORMAT=" + format + "\n\n") {}

  CompiledWriter& integer(int64_t value, int size) {
    for (int i = size - 1; i >= 0; --i) bytes_ += char(value >> (8 * i) & 0xff);
    return *this;
  }
  CompiledWriter& word(const std::string& text) {
    bytes_ += text;
    bytes_ += '\0';
    return *this;
  }
  CompiledWriter& number(double value) {
    int exponent = 0;
    const double mantissa = std::frexp(value, &exponent);
    return integer(int64_t(mantissa * 0x7fffffff), 4).integer(exponent, 1);
  }
  CompiledWriter& cube(double corner, double size) {
    for (const double value : {corner, corner, corner, size}) word(" " + std::to_string(value));
    return *this;
  }
  /// A tree with one full leaf of two objects.
  CompiledWriter& tree() {
    integer(2, 1);
    integer(1, 1).integer(2, 4).integer(0, 4).integer(1, 4);
    for (int i = 1; i < 8; ++i) integer(0, 1);
    return *this;
  }
  CompiledWriter& object(int type, int modifier, const std::string& name,
                         const std::vector<double>& reals) {
    integer(type, 1).integer(modifier, 4).word(name).integer(0, 2).integer(int(reals.size()), 2);
    for (const double real : reals) number(real);
    return *this;
  }
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

std::string frozen_ball() {
  CompiledWriter writer("Radiance_octree");
  writer.integer(283 + 4, 2).cube(-1, 2).word("").integer(2, 4).tree();
  for (const char* type : {"sphere", "plastic"}) writer.word(type);
  writer.word("");
  writer.object(1, -1, "paint", {.25, .5, .75, 0, 0}).object(0, 0, "ball", {0, 0, 0, .5});
  return writer.integer(-1, 1).bytes();
}

TEST(RadianceCompiled, FrozenOctreesHoldTheirScene) {
  TemporaryFolder folder;
  const auto scene = load_radiance(folder.write("ball.oct", frozen_ball()));
  const Object& ball = sole_object(scene, "shape");
  EXPECT_EQ(ball.type, "sphere");
  EXPECT_NEAR(value<double>(ball, "radius"), .5, 1e-8);
  expect_colour(front_bsdf(ball), "reflectance", .25, .5, .75, 1e-8);
  EXPECT_EQ(deviations_but_view(scene), 0u);
}

TEST(RadianceCompiled, OctreesArePlacedWithTheirOwnMaterialsOrAnother) {
  TemporaryFolder folder;
  folder.write("ball.oct", frozen_ball());
  const auto scene =
      load_radiance(folder.write("a.rad", grey + "void instance one 5 ball.oct -t 1 2 -s 0 0\n"
                                                 "void instance two 7 ball.oct -s 2 -t 1 2 3 0 0\n"
                                                 "grey instance three 1 ball.oct 0 0\n"));
  EXPECT_TRUE(tells(scene, DeviationKind::ignored, "instance 'one'", "transform is wrong"));
  const auto balls = rad_objects(scene, "shape");
  ASSERT_EQ(balls.size(), 2u);
  EXPECT_NEAR((value<Vec3d>(*balls[0], "center") - Vec3d(1, 2, 3)).length(), 0, 1e-9);
  EXPECT_NEAR(value<double>(*balls[0], "radius"), 1, 1e-8);
  expect_colour(front_bsdf(*balls[0]), "reflectance", .25, .5, .75, 1e-8);
  expect_colour(front_bsdf(*balls[1]), "reflectance", .5, .5, .5);
}

TEST(RadianceCompiled, OtherOctreesNameTheirFiles) {
  TemporaryFolder folder;
  folder.write("thing.rad", grey + "grey sphere s 0 0 4 0 0 0 2\n");
  const std::string octree = CompiledWriter("Radiance_octree")
                                 .integer(287, 2)
                                 .cube(0, 1)
                                 .word("thing.rad")
                                 .word("")
                                 .bytes();
  const auto scene = load_radiance(folder.write("thing.oct", octree));
  EXPECT_EQ(value<double>(sole_object(scene, "shape"), "radius"), 2);
  // One that was not handed on: its text is beside it, and knows what stands before.
  folder.write("bare.rad", "grey sphere s 0 0 4 0 0 0 3\n");
  const auto beside = load_radiance(folder.write(
      "a.rad", grey + "void instance i 1 bare.oct 0 0\nvoid instance j 1 x.oct 0 0\n"));
  EXPECT_EQ(value<double>(sole_object(beside, "shape"), "radius"), 3);
  EXPECT_TRUE(tells(beside, DeviationKind::approximated, "instance 'i'", "bare.rad"));
  EXPECT_TRUE(tells(beside, DeviationKind::missing, "instance 'j'", "no octree 'x.oct'"));
}

/// Two patches: a triangle in the first, and one that joins both.
std::string mesh_bytes() {
  CompiledWriter writer("Radiance_tmesh");
  writer.integer(319 + 4, 2).cube(0, 4).number(0).number(2).number(0).number(1);
  writer.integer(0, 1);  // no tree
  writer.word("plastic").word("").object(0, -1, "red", {.5, 0, 0, 0, 0}).integer(-1, 1);
  writer.integer(2, 4);
  const auto place = [&](double x, double y, double z) {
    for (const double value : {x, y, z}) writer.integer(int64_t(value / 4 * 4294967296.0), 4);
  };
  writer.integer(7, 1).integer(3, 2);
  place(0, 0, 1), place(2, 0, 1), place(2, 2, 1);
  for (int i = 0; i < 3; ++i)  // straight up: the larger coordinate is z
    writer.integer(8, 4);
  for (const double share : {.0, .0, .5, .0, .5, .5})
    writer.integer(int64_t(share * 4294967296.0), 4);
  writer.integer(1, 2).integer(0, 1).integer(1, 1).integer(2, 1);
  writer.integer(1, 2).integer(0, 2);  // all of the first material
  writer.integer(0, 2);                // none that joins by one corner
  writer.integer(0, 2);                // nor by two
  writer.integer(1, 1).integer(1, 2);
  place(0, 2, 1);
  writer.integer(0, 2).integer(1, 2).integer(-1, 2).integer(0, 2);
  writer.integer(1, 2).integer(0, 4).integer(2, 4).integer(0, 1).integer(0, 2);
  return writer.bytes();
}

TEST(RadianceCompiled, MeshesOfSeveralPatches) {
  TemporaryFolder folder;
  folder.write("m.rtm", mesh_bytes());
  const auto scene = load_radiance(folder.write("a.rad", "void mesh m 3 m.rtm -s 2 0 0\n"));
  const Object& mesh = sole_object(scene, "shape");
  EXPECT_EQ(rad_numbers(mesh, "faces").size(), 6u);
  EXPECT_NEAR(area_vector_of(mesh).z, 16, 1e-5);
  expect_colour(front_bsdf(mesh), "reflectance", .5, 0, 0, 1e-8);
  EXPECT_EQ(deviations_but_view(scene), 0u);
}

TEST(RadianceCompiled, MeshesHaveCoordinatesOfTheirOwn) {
  TemporaryFolder folder;
  folder.write("m.rtm", mesh_bytes());
  folder.write("p.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\nxxxx");
  const auto scene =
      load_radiance(folder.write("a.rad",
                                 "void colorpict pic 7 red green blue p.hdr . Lu Lv 0 0\n"
                                 "pic plastic paint 0 0 5 1 1 1 0 0\npaint mesh m 1 m.rtm 0 0\n"));
  const auto positions = rad_numbers(sole_object(scene, "shape"), "positions");
  const auto uvs = rad_numbers(sole_object(scene, "shape"), "uv");
  ASSERT_EQ(uvs.size() / 2, positions.size() / 3);
  for (size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(uvs[2 * i], positions[3 * i] / 2, 1e-6);
    EXPECT_NEAR(uvs[2 * i + 1], 1 - positions[3 * i + 1] / 4, 1e-6);
  }
}

TEST(RadianceCompiled, DamageIsAnError) {
  TemporaryFolder folder;
  for (const bool is_mesh : {false, true}) {
    const std::string whole = is_mesh ? mesh_bytes() : frozen_ball();
    const std::string scene =
        folder.write("a.rad", is_mesh ? "void mesh m 1 x 0 0\n" : "void instance m 1 x 0 0\n");
    const size_t header = whole.find("\n\n") + 2;
    for (size_t size = header; size < whole.size(); ++size) {
      folder.write("x", whole.substr(0, size));
      const auto problems = problems_of([&] { load_radiance(scene); });
      ASSERT_EQ(problems.size(), 1u) << size;
      EXPECT_FALSE(problems[0].remedy.empty());
    }
    for (size_t at = header; at < whole.size(); ++at)
      for (const int bit : {0, 3, 7}) {
        std::string damaged = whole;
        damaged[at] ^= char(1 << bit);
        folder.write("x", damaged);
        try {
          load_radiance(scene);
        } catch (const Error&) {
        }
      }
  }
}

}  // namespace
}  // namespace kaustik::radiance_test
