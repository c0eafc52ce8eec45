// Mesh files, good and hostile.

#include "kaustik/geometry/mesh_reader.h"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <ctime>
#include <map>

#include "geometry_support.h"
#include "kaustik/base/parallel.h"
#include "kaustik/base/srgb.h"
#include "kaustik/geometry/polygon_cutter.h"

namespace kaustik::test {
namespace {

TriangleMesh ply(const std::string& bytes) { return read_ply(TemporaryFile(bytes).path()).mesh; }
TriangleMesh obj(const std::string& bytes) { return read_obj(TemporaryFile(bytes).path()).mesh; }

/// The message of the Error(input) that `read` throws; "" if it throws none.
template <typename Read>
std::string error_of(const Read& read) {
  try {
    read();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::input);
    EXPECT_FALSE(error.problems()[0].remedy.empty());
    EXPECT_TRUE(error.problems()[0].place.file != nullptr || error.problems().size() == 1);
    return error.what();
  }
  return {};
}

template <typename T>
void put(std::string& out, T value, bool big_endian) {
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));
  if (big_endian) std::reverse(std::begin(raw), std::end(raw));
  out.append(raw, sizeof(T));
}

template <typename Vector>
void expect_same_bits(const Vector& a, const Vector& b, const std::string& what) {
  ASSERT_EQ(a.size(), b.size()) << what;
  if (a.empty()) return;
  EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof(a[0])), 0) << what;
}

void expect_same_mesh(const TriangleMesh& a, const TriangleMesh& b, const std::string& what) {
  expect_same_bits(a.positions, b.positions, what);
  expect_same_bits(a.normals, b.normals, what);
  expect_same_bits(a.uvs, b.uvs, what);
  expect_same_bits(a.triangles, b.triangles, what);
  ASSERT_EQ(a.attributes.size(), b.attributes.size()) << what;
  for (size_t i = 0; i < a.attributes.size(); ++i)
    expect_same_bits(a.attributes[i].values, b.attributes[i].values, what);
}

/// A quad with everything that a vertex can have, and things to be skipped.
std::string binary_ply(bool big_endian) {
  std::string out = std::string("ply\nformat binary_") + (big_endian ? "big" : "little") +
                    "_endian 1.0\ncomment made by hand\nelement camera 1\n"
                    "property double fov\nproperty list uchar short taps\n"
                    "element vertex 4\nproperty float x\nproperty float y\nproperty double z\n"
                    "property uchar red\nproperty float nx\nproperty float ny\nproperty float nz\n"
                    "property float s\nproperty float t\nelement face 1\nproperty int material\n"
                    "property list uint ushort vertex_index\nend_header\n";
  put(out, 45.0, big_endian);
  put(out, uint8_t(2), big_endian);
  put(out, int16_t(-5), big_endian);
  put(out, int16_t(7), big_endian);
  for (const auto& [x, y] : {std::pair(0.f, 0.f), {1.f, 0.f}, {1.f, 1.f}, {0.f, 1.f}}) {
    put(out, x, big_endian);
    put(out, y, big_endian);
    put(out, 2.5, big_endian);
    put(out, uint8_t(200), big_endian);
    for (const float n : {0.f, 0.f, 1.f}) put(out, n, big_endian);
    put(out, x, big_endian);
    put(out, y, big_endian);
  }
  put(out, int32_t(3), big_endian);
  put(out, uint32_t(4), big_endian);
  for (const int i : {0, 1, 2, 3}) put(out, uint16_t(i), big_endian);
  return out;
}

const std::string text_ply =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
    "property float z\nproperty float nx\nproperty float ny\nproperty float nz\n"
    "property float u\nproperty float v\nelement face 1\n"
    "property list uchar int vertex_indices\nend_header\n"
    "0 0 2.5 0 0 1 0 0\n1 0 2.5 0 0 1 1 0\n1 1 +2.5 0 0 1 1 1\n0 1 2.5e0 0 0 1 0 1\n4 0 1 2 3\n";

void expect_quad(const TriangleMesh& mesh) {
  ASSERT_EQ(mesh.positions.size(), 4u);
  ASSERT_EQ(mesh.normals.size(), 4u);
  ASSERT_EQ(mesh.uvs.size(), 4u);
  EXPECT_EQ(mesh.positions[2], Vec3f(1, 1, 2.5f));
  EXPECT_EQ(mesh.normals[3], Vec3f(0, 0, 1));
  EXPECT_EQ(mesh.uvs[1], Vec2f(1, 0));
  const TriangleList fan = {{0, 1, 2}, {0, 2, 3}};
  EXPECT_EQ(mesh.triangles, fan);
}

TEST(PlyReader, AllFormats) {
  expect_quad(ply(text_ply));
  expect_quad(ply(binary_ply(false)));
  expect_quad(ply(binary_ply(true)));
  std::string windows = text_ply;
  for (size_t i = 0; (i = windows.find('\n', i)) != windows.npos; i += 2)
    windows.replace(i, 1, "\r\n");
  expect_quad(ply(windows));
}

/// `text_ply` with one piece replaced.
std::string with(const std::string& from, const std::string& to) {
  std::string result = text_ply;
  const size_t at = result.find(from);
  EXPECT_NE(at, result.npos) << from;
  return result.replace(at, from.size(), to);
}

TEST(PlyReader, SaysWhatIsWrongAndWhere) {
  const auto message = [](const std::string& bytes) { return error_of([&] { ply(bytes); }); };
  const auto expect = [&](const std::string& bytes, const std::string& what) {
    EXPECT_NE(message(bytes).find(what), std::string::npos) << what << "\n got: " << message(bytes);
  };
  expect("", "does not start with 'ply'");
  expect("solid cube", "does not start with 'ply'");
  expect(with("1 0 2.5", "1 nan 2.5"), "vertex 1 is not finite");
  expect(with("1 0 2.5", "1 nan 2.5"), ":16: ");
  expect(with("1 0 2.5", "1 inf 2.5"), "vertex 1 is not finite");
  expect(with("1 0 2.5", "1 1e60 2.5"), "vertex 1 is not finite");
  expect(with("1 0 2.5", "1 zero 2.5"), "'zero' is no number");
  expect(with("4 0 1 2 3", "4 0 1 2 4"), "face 0 refers to vertex 4 of 4");
  expect(with("4 0 1 2 3", "4 0 1 2 -1"), "face 0 refers to vertex -1 of 4");
  expect(with("4 0 1 2 3", "4 0 1 2"), "ends too early");
  expect(with("4 0 1 2 3", "-4 0 1 2 3"), "length -4");
  expect(with("4 0 1 2 3", "2 0 1"), "no faces");
  expect(with("face 1", "face 0"), "no faces");
  expect(with("vertex 4", "vertex 4000000000"), "more than the file can hold");
  expect(with("vertex 4", "vertex 99999999999999999999"), "is no number of elements");
  expect(with("vertex 4", "vertex -4"), "is no number of elements");
  expect(with("float x", "quad x"), "unknown type 'quad'");
  expect(with("float x", "float w"), "no 'x', 'y' and 'z'");
  expect(with("vertex_indices", "triangles"), "no list 'vertex_indices'");
  expect(with("ascii", "utf8"), "unknown format 'utf8'");
  expect(with("end_header", "end_heder"), "unknown line 'end_heder'");
  EXPECT_NE(error_of([] { read_ply("/nonexistent/mesh.ply"); }), "");
  EXPECT_NE(error_of([] { read_ply("/tmp"); }), "");
}

TEST(PlyReader, HugeListsAllocateNothing) {
  std::string bytes = binary_ply(false);
  const uint32_t huge = 0xffffffff;
  std::memcpy(bytes.data() + bytes.size() - 12, &huge, 4);
  EXPECT_NE(error_of([&] { ply(bytes); }).find("ends too early"), std::string::npos);
}

void expect_sound(const TriangleMesh& mesh) {
  EXPECT_FALSE(mesh.triangles.empty());
  for (const auto& t : mesh.triangles)
    for (const uint32_t i : t) ASSERT_LT(i, mesh.positions.size());
  for (const Vec3f& p : mesh.positions) ASSERT_TRUE(is_finite(p));
  EXPECT_TRUE(mesh.normals.empty() || mesh.normals.size() == mesh.positions.size());
  EXPECT_TRUE(mesh.uvs.empty() || mesh.uvs.size() == mesh.positions.size());
  for (const MeshAttribute& attribute : mesh.attributes) {
    const size_t count = attribute.is_of_faces() ? mesh.triangles.size() : mesh.positions.size();
    EXPECT_EQ(attribute.values.size(), count * size_t(attribute.components));
    for (const float value : attribute.values) ASSERT_TRUE(std::isfinite(value));
  }
}

/// Reads damaged copies of `bytes`: cut at every offset and with bytes changed. Each gives a sound
/// mesh or an Error(input); at least `least_errors` of them the latter.
template <typename Read>
void survive_damage(const std::string& bytes, const Read& read, int least_errors) {
  int errors = 0;
  const auto attempt = [&](const std::string& damaged) {
    try {
      const TriangleMesh mesh = read(damaged);
      expect_sound(mesh);
      // What reads must also trace.
      MeshOptions options;
      const auto shape = std::make_shared<MeshShape>(prepare_mesh(mesh, options, place_in("mesh")));
      EXPECT_TRUE(std::isfinite(shape->area()));
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::input) << error.what();
      ++errors;
    }
  };
  for (size_t length = 0; length < bytes.size(); ++length) attempt(bytes.substr(0, length));
  Random random(31);
  for (int i = 0; i < 3000 / samples_divisor; ++i) {
    std::string damaged = bytes;
    const int changes = 1 + int(random.uniform() * 4);
    for (int j = 0; j < changes; ++j)
      damaged[size_t(random.uniform() * float(bytes.size()))] =
          char(uint8_t(random.uniform() * 256));
    attempt(damaged);
  }
  EXPECT_GT(errors, least_errors);
}

TEST(PlyReader, SurvivesDamage) {
  survive_damage(text_ply, ply, 500);
  survive_damage(binary_ply(false), ply, 500);
  survive_damage(binary_ply(true), ply, 500);
  // With colours of vertices and numbers of faces.
  std::string painted = with("element face 1\n", "element face 1\nproperty short heat_x\n");
  painted.replace(painted.find("4 0 1 2 3"), 0, "7 ");
  for (const auto& [normal, colour] : {std::pair("nx", "r"), {"ny", "g"}, {"nz", "b"}})
    painted.replace(painted.find(normal), 2, colour);
  EXPECT_EQ(ply(painted).attributes.size(), 2u);
  survive_damage(painted, ply, 500);
}

const std::string text_obj =
    "# a quad\nmtllib none.mtl\no quad\nv 0 0 2.5\nv 1 0 2.5\nv 1 1 2.5\nv 0 1 2.5 1.0\n"
    "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1 0\nvn 0 0 1\nusemtl x\ns off\nf 1/1/1 2/2/1 3/3/1 4/4/1\n";

TEST(ObjReader, Quad) {
  expect_quad(obj(text_obj));
  const TriangleMesh relative = obj("v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1 # a comment\n");
  EXPECT_EQ(relative.triangles.size(), 1u);
  EXPECT_TRUE(relative.uvs.empty());
  EXPECT_TRUE(relative.normals.empty());
  EXPECT_EQ(obj("v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nf 1//1 2//1 3//1").normals.size(), 3u);
}

TEST(ObjReader, SplitsVerticesOnlyWhereTheyDiffer) {
  // Two triangles that share an edge: with one normal it stays shared, with two it is split.
  const std::string positions = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 1\nvn 0 0 1\nvn 0 1 0\n";
  EXPECT_EQ(obj(positions + "f 1//1 2//1 3//1\nf 1//1 3//1 4//1\n").positions.size(), 4u);
  EXPECT_EQ(obj(positions + "f 1//1 2//1 3//1\nf 1//2 3//2 4//2\n").positions.size(), 6u);
}

TEST(ObjReader, SaysWhatIsWrongAndWhere) {
  const std::string start = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  const auto expect = [&](const std::string& bytes, const std::string& what) {
    const std::string message = error_of([&] { obj(bytes); });
    EXPECT_NE(message.find(what), std::string::npos) << what << "\n got: " << message;
  };
  expect("", "no faces");
  expect(start, "no faces");
  expect(start + "f 1 2 4\n", "face 1 refers to vertex 4 of 3");
  expect(start + "f 1 2 4\n", ":4: ");
  expect(start + "f 1 2 0\n", "face 1 refers to vertex 0 of 3");
  expect(start + "f 1 2 -4\n", "face 1 refers to vertex -4 of 3");
  expect(start + "f 1 2 x\n", "'x' is no index");
  expect(start + "f 1/1 2/1 3/1\n", "refers to texture coordinate 1 of 0");
  expect(start + "f 1//1 2//1 3//1\n", "refers to normal 1 of 0");
  expect("v 0 nan 0\n", "vertex 1 is not finite");
  expect("v 0 1e99 0\n", "vertex 1 is not finite");
  // A scene may name any file: words are shown once something was as it should be.
  expect("v 0 1\n", "'…' is no number");
  expect("v 0 one 0\n", "'…' is no number");
  expect(start + "v 0 one 0\n", "'one' is no number");
  EXPECT_NE(error_of([] { read_obj("/nonexistent/mesh.obj"); }), "");
}

TEST(ObjReader, ReadsPartsAlone) {
  const std::string text =
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\ng one\nusemtl a b \nf 1 2 4\nf 1 3 4\n"
      "g two\ng three\no other\nf 2 3 4\nusemtl c\nusemtl a b\nf 4 3 2\n";
  const TemporaryFile file(text);
  const auto triangles = [&](const ObjSelection& selection) {
    return read_obj(file.path(), selection).mesh.triangles.size();
  };
  EXPECT_EQ(triangles({}), 5u);
  EXPECT_EQ(triangles({.shape_index = 0}), 1u);
  EXPECT_EQ(triangles({.shape_index = 1}), 2u);
  EXPECT_EQ(triangles({.shape_index = 3}), 1u);
  EXPECT_EQ(triangles({.material = ""}), 1u);
  EXPECT_EQ(triangles({.material = "a b"}), 4u);
  EXPECT_EQ(read_obj(file.path(), {.shape_index = 3}).mesh.positions[0], Vec3f(0, 0, 1));
  const auto message = [&](const ObjSelection& selection) {
    return error_of([&] { read_obj(file.path(), selection); });
  };
  EXPECT_NE(message({.shape_index = 4}).find("there is no shape 4"), std::string::npos);
  EXPECT_NE(message({.material = "c"}).find("no face has the material 'c'"), std::string::npos);
  const auto index_shape = [&](int64_t index) {
    return make_shape("obj", {{"filename", file.path(), {}}, {"shape_index", index, {}}})
        ->mesh()
        ->triangles.size();
  };
  EXPECT_EQ(index_shape(-1), 5u);
  EXPECT_EQ(index_shape(1), 2u);
}

/// More corners of one position than are looked through one after another.
TEST(ObjReader, TellsManyCornersOfOnePositionApart) {
  std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  const int corners = 100;
  for (int i = 0; i < corners; ++i) text += "vt " + std::to_string(i) + " 0\n";
  for (int round = 0; round < 2; ++round)
    for (int i = 1; i <= corners; ++i) text += "f 1/" + std::to_string(i) + " 2/1 3/1\n";
  const TriangleMesh mesh = obj(text);
  ASSERT_EQ(mesh.positions.size(), size_t(corners) + 2);
  for (int i = 0; i < 2 * corners; ++i)
    EXPECT_EQ(mesh.uvs[mesh.triangles[size_t(i)][0]].x, float(i % corners));
}

/// Lines that lie on the borders of the pieces that are read.
TEST(ObjReader, LongFilesAreReadInPieces) {
  for (const std::string end : {"\n", "\r\n", "\r"}) {
    std::string text = "v 0 0 0" + end + "v 1 0 0" + end + "v 0 1 0" + end;
    const std::string face = "f 1 \\" + end + " 2 3" + end;
    int faces = 0;
    for (; text.size() < 2'500'000; ++faces) text += face;
    text += "v 0 x 0";
    const std::string message = error_of([&] { obj(text); });
    EXPECT_NE(message.find(":" + std::to_string(4 + 2 * faces) + ": "), std::string::npos)
        << message;
    EXPECT_EQ(obj(text.substr(0, text.size() - 7)).triangles.size(), size_t(faces));
  }
}

/// Read as it should be, whatever program wrote it.
TEST(ObjReader, MarksLineEndsCapitalsAndContinuedLines) {
  const auto with_line_ends = [](std::string text, const std::string& end) {
    for (size_t i = 0; (i = text.find('\n', i)) != text.npos; i += end.size())
      text.replace(i, 1, end);
    return text;
  };
  expect_quad(obj("\xef\xbb\xbf" + text_obj.substr(text_obj.find('v'))));
  expect_quad(obj(with_line_ends(text_obj, "\r")));
  expect_quad(obj(with_line_ends(text_obj, "\r\n")));
  std::string capitals = text_obj;
  for (char& c : capitals) c = char(std::toupper(c));
  expect_quad(obj(capitals));
  for (const std::string end : {"\n", "\r", "\r\n"}) {
    std::string continued = text_obj;
    continued.replace(continued.find(" 3/3"), 1, " \\\n \\\n");
    continued.replace(continued.find("1 0 2.5"), 2, "1 \\\n");
    expect_quad(obj(with_line_ends(continued, end)));
    // Lines count as they stand in the file.
    const std::string message =
        error_of([&] { obj(with_line_ends("v 0 0 0 \\\n\nv 0 \\\n0 x\n", end)); });
    EXPECT_NE(message.find(":3: "), std::string::npos) << message;
  }
  EXPECT_NE(error_of([] { obj("\xff\xfev\0 \0"); }).find("UTF-16"), std::string::npos);
  EXPECT_THROW(obj("v 0 0 0\nv 1 0 0\nv 0 1 0\n\\\nf 1 2\\"), Error);
}

TEST(ObjReader, TellsWhatItLeavesOutOnce) {
  const std::string start = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  const auto remarks = [&](const std::string& more) {
    return read_obj(TemporaryFile(start + more).path()).remarks;
  };
  EXPECT_TRUE(remarks("# l\ng a\no b\ns 1\nusemtl m\nmtllib m.mtl\nl 1 2\np 1\nvp 0\n\n").empty());
  const auto unknown = remarks("vertex 1 2 3\nvertex 2 3 4\ncurv 0 1 2\n");
  ASSERT_EQ(unknown.size(), 2u);
  EXPECT_NE(unknown[0].find(":5: lines that begin with 'vertex'"), std::string::npos) << unknown[0];
  EXPECT_NE(unknown[1].find("'curv'"), std::string::npos) << unknown[1];
  EXPECT_EQ(remarks("a\nb\nc\nd\ne\nf 1 2 3\nh\ni\n").size(), 5u);
  const auto small = remarks("f 1 2\nf 1\nf\n");
  ASSERT_EQ(small.size(), 1u);
  EXPECT_NE(small[0].find("3 faces were left out"), std::string::npos) << small[0];
  EXPECT_NE(error_of([&] { obj("v 0 0 0\nv 1 0 0\nf 1 2\n"); }).find("no faces"),
            std::string::npos);
}

/// A file of some pieces, with all that its reader has to keep in order, and the mesh that it is.
struct LongObj {
  std::string text;
  TriangleMesh mesh;

  explicit LongObj(bool with_colours) {
    Random random(17);
    std::vector<Vec3f> positions, normals, colours;
    std::vector<Vec2f> uvs;
    std::map<std::array<int, 3>, uint32_t> known;
    const auto number = [&] { return std::round(double(random.uniform(-1000, 1000)) * 1e4) / 1e4; };
    const auto pick = [&](size_t count) {  // mostly one of the last
      const float share = random.uniform() * random.uniform() * random.uniform();
      return int(count) - 1 - int(share * float(count));
    };
    const auto add_vertex = [&](const std::array<int, 3>& key) {
      const auto [found, is_new] = known.try_emplace(key, uint32_t(known.size()));
      if (is_new) {
        mesh.positions.push_back(positions[size_t(key[0])]);
        mesh.uvs.push_back(key[1] < 0 ? Vec2f(0) : uvs[size_t(key[1])]);
        mesh.normals.push_back(key[2] < 0 ? Vec3f(0) : normals[size_t(key[2])]);
        if (with_colours) colours.push_back(colour_of_position_[size_t(key[0])]);
      }
      return found->second;
    };
    while (text.size() < 1'500'000) {
      for (int i = 0; i < 20; ++i) {
        const double x = number(), y = number(), z = number();
        text += fmt::format("v {} {:+} {:e}", x, y, z);
        const bool has_colour = with_colours && random.uniform() < 0.3f;
        if (has_colour) text += " 0.5 1 0";
        colour_of_position_.push_back(has_colour ? Vec3f(linear_from_srgb(0.5f), 1, 0) : Vec3f(1));
        text += random.uniform() < 0.1f ? " # a remark\r\n" : "\n";
        positions.emplace_back(float(x), float(y), float(z));
      }
      for (int i = 0; i < 7; ++i) {
        const double x = number(), y = number(), z = number();
        text += fmt::format("vn {} {} \\\n{}\n", x, y, z);
        normals.emplace_back(float(x), float(y), float(z));
        text += i < 3 ? fmt::format("vt {}\n", x) : fmt::format("vt {:.2f} {}\r\n", x, y);
        uvs.emplace_back(i < 3 ? float(x) : float(std::stod(fmt::format("{:.2f}", x))),
                         i < 3 ? 0.0f : float(y));
      }
      text += "g part\nusemtl shiny\n\n";
      for (int i = 0; i < 30; ++i) {
        text += "f";
        std::vector<uint32_t> corners;
        const int count = 2 + int(random.uniform() * 3);  // two are no face
        for (int corner = 0; corner < count; ++corner) {
          std::array<int, 3> key = {pick(positions.size()), pick(uvs.size()), pick(normals.size())};
          const float form = random.uniform();
          if (form < 0.1f) key[2] = -1;
          if (form < 0.2f) key[1] = -1;
          const auto index = [&](int from_zero, size_t size) {
            return random.uniform() < 0.1f ? from_zero - int(size) : from_zero + 1;
          };
          text += fmt::format(" {}", index(key[0], positions.size()));
          if (key[1] >= 0) text += fmt::format("/{}", index(key[1], uvs.size()));
          if (key[1] < 0 && key[2] >= 0) text += "/";
          if (key[2] >= 0) text += fmt::format("/{}", index(key[2], normals.size()));
          corners.push_back(add_vertex(key));
        }
        text += "\n";
        if (count < 3) continue;
        EXPECT_TRUE(PolygonCutter(1000).cut(mesh.positions, corners, corners, mesh.triangles));
      }
    }
    if (!with_colours) return;
    MeshAttribute attribute{"vertex_color", 3};
    for (const Vec3f& colour : colours)
      attribute.values.insert(attribute.values.end(), {colour.x, colour.y, colour.z});
    mesh.attributes.push_back(std::move(attribute));
  }

 private:
  std::vector<Vec3f> colour_of_position_;
};

/// By any number of threads: to the bit what faces make one after the other.
TEST(ObjReader, PiecesAreTheMeshOfTheWhole) {
  for (const bool with_colours : {false, true}) {
    const LongObj file(with_colours);
    for (const int threads : {1, 2})
      with_threads(threads, [&] {
        expect_same_mesh(obj(file.text), file.mesh, std::to_string(threads) + " threads");
      });
  }
}

/// Whatever kind of line it is, and whichever kind is read first.
TEST(ObjReader, TellsTheFirstOfManyFaults) {
  const std::string good = LongObj(false).text;
  const auto line = 1 + std::count(good.begin(), good.end(), '\n');
  for (const std::string fault : {"v 0 0\n", "vt x\n", "f 1 2 99999999\n", "vn 0 1e99 0\n"}) {
    const std::string message =
        error_of([&] { obj(good + fault + "v 0 0\nvn x 0 0\nf 0\nvt\nf 1/1/1/1 2 3\n" + good); });
    EXPECT_NE(message.find(":" + std::to_string(line) + ": "), std::string::npos) << message;
  }
}

TEST(PlyReader, MarksAndLineEnds) {
  expect_quad(ply("\xef\xbb\xbf" + text_ply));
  std::string old = text_ply;
  std::replace(old.begin(), old.end(), '\n', '\r');
  expect_quad(ply(old));
  EXPECT_NE(error_of([&] { ply(old.substr(0, old.size() - 3)); }).find(":19: "), std::string::npos);
  std::string binary = binary_ply(false);
  std::replace(binary.begin(), binary.begin() + std::ptrdiff_t(binary.find("end_header") + 11),
               '\n', '\r');
  expect_quad(ply(binary));
}

/// A strip of triangles, packed: of many pieces that are read side by side.
std::string packed_strip(uint32_t vertices, const std::string& index_type) {
  std::string out = "ply\nformat binary_little_endian 1.0\nelement vertex " +
                    std::to_string(vertices) +
                    "\nproperty float x\nproperty float y\nproperty float z\nproperty float nx\n"
                    "property float ny\nproperty float nz\nproperty double u\nproperty double v\n"
                    "element face " +
                    std::to_string(vertices - 2) + "\nproperty list uchar " + index_type +
                    " vertex_indices\nproperty uchar flag\nend_header\n";
  for (uint32_t i = 0; i < vertices; ++i) {
    for (const float value : {float(i / 2), float(i % 2), 0.5f, 0.f, 0.f, 1.f})
      put(out, value, false);
    for (const double value : {double(i), -double(i)}) put(out, value, false);
  }
  for (uint32_t i = 0; i + 2 < vertices; ++i) {
    put(out, uint8_t(3), false);
    for (uint32_t corner = 0; corner < 3; ++corner)
      if (index_type == "float")
        put(out, float(i + corner), false);
      else
        put(out, i + corner, false);
    put(out, uint8_t(7), false);
  }
  return out;
}

TEST(PlyReader, ReadsLargeMeshesPieceByPiece) {
  const uint32_t count = 100'000;
  for (const char* type : {"int", "float"}) {
    const TriangleMesh mesh = ply(packed_strip(count, type));
    ASSERT_EQ(mesh.positions.size(), count);
    ASSERT_EQ(mesh.triangles.size(), count - 2);
    for (uint32_t i = 0; i < count; ++i) {
      ASSERT_EQ(mesh.positions[i], Vec3f(float(i / 2), float(i % 2), 0.5f));
      ASSERT_EQ(mesh.normals[i], Vec3f(0, 0, 1));
      ASSERT_EQ(mesh.uvs[i], Vec2f(float(i), -float(i)));
    }
    for (uint32_t i = 0; i + 2 < count; ++i)
      ASSERT_EQ(mesh.triangles[i], (std::array<uint32_t, 3>{i, i + 1, i + 2}));
  }
}

TEST(PlyReader, FindsTheFirstFaultOfALargeMesh) {
  const uint32_t count = 100'000;
  const std::string good = packed_strip(count, "int");
  const size_t vertices = good.find("end_header\n") + 11, faces = vertices + 40 * size_t(count);
  const auto damaged = [&](size_t at, auto value) {
    std::string bytes = good;
    std::memcpy(bytes.data() + at, &value, sizeof(value));
    return bytes;
  };
  const auto message = [](const std::string& bytes) { return error_of([&] { ply(bytes); }); };
  std::string twice = damaged(vertices + 40 * 70'001 + 4, std::nanf(""));
  std::memcpy(twice.data() + vertices + 40 * 90'000, "\xff\xff\xff\xff", 4);
  EXPECT_NE(message(twice).find("vertex 70001 is not finite"), std::string::npos);
  EXPECT_NE(
      message(damaged(faces + 14 * 60'000 + 1, int32_t(-5))).find("face 60000 refers to vertex -5"),
      std::string::npos);
  EXPECT_NE(
      message(damaged(faces + 14 * 60'000 + 5, count)).find("face 60000 refers to vertex 100000"),
      std::string::npos);
  EXPECT_NE(message(good.substr(0, good.size() - 1)).find("ends too early"), std::string::npos);
  // A polygon among the triangles: all are read one by one.
  std::string quad = good;
  quad.insert(faces + 14 * 50'000 + 13, std::string("\0\0\0\0", 4));
  quad[faces + 14 * 50'000] = 4;
  EXPECT_EQ(ply(quad).triangles.size(), count - 1);
}

/// How a PLY file writes a mesh.
struct PlyForm {
  std::string format, number = "float", length = "uchar", index = "int";
  bool shuffled = false;   ///< numbers of a vertex that do not stand side by side
  bool with_list = false;  ///< one by one: records differ in size
};

/// Vertices with all that they can have, and random triangles.
std::string written(const PlyForm& form, uint32_t vertices, uint32_t faces) {
  std::vector<std::string> names = {"x", "y", "z", "nx", "ny", "nz", "u", "v"};
  if (form.shuffled) names = {"v", "nz", "y", "u", "z", "x", "ny", "nx"};
  std::string out =
      "ply\nformat " + form.format + " 1.0\nelement vertex " + std::to_string(vertices) + "\n";
  for (const std::string& name : names) out += "property " + form.number + " " + name + "\n";
  if (form.with_list) out += "property list uchar uchar none\n";
  out += "element face " + std::to_string(faces) + "\nproperty list " + form.length + " " +
         form.index + " vertex_indices\nend_header\n";
  const auto add = [&](const std::string& type, double value) {
    const bool big_endian = form.format == "binary_big_endian";
    if (form.format == "ascii")
      out += fmt::format("{} ", value);
    else if (type == "float")
      put(out, float(value), big_endian);
    else if (type == "double")
      put(out, value, big_endian);
    else if (type == "uchar")
      put(out, uint8_t(value), big_endian);
    else
      put(out, uint32_t(value), big_endian);
  };
  Random random(11);
  for (uint32_t i = 0; i < vertices; ++i) {
    std::map<std::string, float> vertex;
    for (const char* name : {"x", "y", "z", "nx", "ny", "nz", "u", "v"})
      vertex[name] = random.uniform(-1, 1) * random.magnitude(-20, 20);
    for (const std::string& name : names) add(form.number, double(vertex[name]));
    if (form.with_list) add("uchar", 0);
  }
  for (uint32_t i = 0; i < faces; ++i) {
    add(form.length, 3);
    for (int corner = 0; corner < 3; ++corner)
      add(form.index, std::floor(double(random.uniform()) * double(vertices)));
  }
  return out;
}

/// What is copied as it stands is what is read number by number.
TEST(PlyReader, AllFormsAreTheSameMesh) {
  const std::string little = "binary_little_endian", big = "binary_big_endian";
  const uint32_t vertices = 20'000, faces = 50'000;
  const TriangleMesh plain = ply(written({.format = little}, vertices, faces));
  ASSERT_EQ(plain.positions.size(), vertices);
  ASSERT_EQ(plain.triangles.size(), faces);
  ASSERT_EQ(plain.normals.size(), vertices);
  ASSERT_EQ(plain.uvs.size(), vertices);
  const PlyForm forms[] = {{.format = "ascii"},
                           {.format = big},
                           {.format = big, .number = "double", .shuffled = true},
                           {.format = little, .shuffled = true},
                           {.format = little, .number = "double", .length = "uint"},
                           {.format = little, .index = "uint", .with_list = true},
                           {.format = little, .index = "double"}};
  for (const PlyForm& form : forms)
    expect_same_mesh(ply(written(form, vertices, faces)), plain,
                     form.format + " " + form.number + " " + form.index);
  // A single bit tells.
  std::string flipped = written({.format = little}, vertices, faces);
  flipped[flipped.find("end_header") + 11] ^= 1;
  EXPECT_NE(ply(flipped).positions[0], plain.positions[0]);
}

/// Many attributes of faces times one large polygon would be many times the file.
TEST(PlyReader, AttributesOfFacesAreBounded) {
  const auto file = [](int attributes, int corners) {
    std::string text =
        "ply\nformat ascii 1.0\nelement vertex 2000\nproperty float x\nproperty float y\n"
        "property float z\nelement face 1\nproperty list uint int vertex_indices\n";
    for (int i = 0; i < attributes; ++i) text += fmt::format("property uchar a{}_x\n", i);
    text += "end_header\n";
    for (int i = 0; i < 2000; ++i) text += "0 0 0\n";
    text += std::to_string(corners);
    for (int i = 0; i < corners; ++i) text += " 1";
    for (int i = 0; i < attributes; ++i) text += " 7";
    return text;
  };
  const std::string message = error_of([&] { ply(file(10'000, 2000)); });
  EXPECT_NE(message.find("the attributes of faces up to face 0"), std::string::npos) << message;
  const TriangleMesh few = ply(file(100, 2000));
  EXPECT_EQ(few.triangles.size(), 1998u);
  ASSERT_EQ(few.attributes.size(), 100u);
  EXPECT_EQ(few.attributes[99].values.size(), 1998u);
}

TEST(PlyReader, TellsSmallFaces) {
  const MeshFile file = read_ply(TemporaryFile(with("face 1", "face 2") + "2 0 1\n").path());
  expect_quad(file.mesh);
  ASSERT_EQ(file.remarks.size(), 1u);
  EXPECT_NE(file.remarks[0].find("1 face was left out"), std::string::npos) << file.remarks[0];
}

/// Both readers cut as PolygonCutter does.
TEST(MeshShape, ConcaveFacesCoverTheirArea) {
  const TemporaryFile as_obj("v 0 -0.5 0\nv 0.5 0.5 0\nv 0 0 0\nv -0.5 0.5 0\nf 2 3 4 1\n",
                             "a.obj");
  const TemporaryFile as_ply(
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
      "property float z\nelement face 1\nproperty list uchar int vertex_index\nend_header\n"
      "0 -0.5 0\n0.5 0.5 0\n0 0 0\n-0.5 0.5 0\n4 1 2 3 0\n",
      "a.ply");
  EXPECT_FLOAT_EQ(make_shape("obj", {{"filename", as_obj.path(), {}}})->area(), 0.25f);
  EXPECT_FLOAT_EQ(make_shape("ply", {{"filename", as_ply.path(), {}}})->area(), 0.25f);
}

/// Files of a megabyte that once took time with the square of what they repeat.
TEST(MeshFiles, TakeTimeInProportionToTheirSize) {
  std::string elements = "ply\nformat ascii 1.0\n";
  for (int i = 0; i < 60000; ++i) elements += "element e" + std::to_string(i) + " 0\n";
  // One face of all the corners that a byte each can name, over and over.
  std::string corners =
      "ply\nformat binary_little_endian 1.0\nelement vertex 200\nproperty char x\n"
      "property char y\nproperty char z\nelement face 1\n"
      "property list uint uchar vertex_index\nend_header\n";
  Random random(3);
  for (int i = 0; i < 600; ++i) corners += char(random.uniform() * 100);
  put(corners, uint32_t(1000000), false);
  for (int i = 0; i < 1000000; ++i) corners += char(uint8_t(random.uniform() * 200));
  std::string joined = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3 ";
  for (int i = 0; i < 300000; ++i) joined += "\\\n";
  const std::clock_t begin = std::clock();
  EXPECT_NE(error_of([&] { ply(elements); }), "");
  EXPECT_THROW(ply(corners), Error);
  EXPECT_EQ(obj(joined).triangles.size(), 1u);
  const double taken = double(std::clock() - begin) / CLOCKS_PER_SEC;
  EXPECT_LT(taken, 1.5 * samples_divisor);
}

TEST(ObjReader, SurvivesDamage) {
  survive_damage(text_obj, obj, 200);
  survive_damage("v 0 0 0 1 0 1\nv 1 0 0 0 0.5 1\nv 0 1 0\nv 1 1 1 1 1 1\nf 1 2 3 4\n", obj, 50);
}

// What `obj` and `ply` do with the file -----------------------------------------------------------

TEST(MeshShape, NormalsFollowMitsuba) {
  // A roof without normals: smooth by default, flat on request.
  const TemporaryFile file(
      "v 0 0 0\nv 0 1 0\nv 1 0 1\nv 1 1 1\nv 2 0 0\nv 2 1 0\n"
      "f 1 3 4 2\nf 3 5 6 4\n",
      "roof.obj");
  const auto smooth = make_shape("obj", {{"filename", file.path(), {}}});
  ASSERT_EQ(smooth->mesh()->normals.size(), 6u);
  EXPECT_NEAR(smooth->mesh()->normals[1].z, 1, 1e-6f);  // on the ridge
  const auto flat = make_shape("obj", {{"filename", file.path(), {}}, {"face_normals", true, {}}});
  EXPECT_TRUE(flat->mesh()->normals.empty());
  const auto flipped =
      make_shape("obj", {{"filename", file.path(), {}}, {"flip_normals", true, {}}});
  EXPECT_NEAR(flipped->mesh()->normals[1].z, -1, 1e-6f);
  Random random(1);
  for (int i = 0; i < 100; ++i) {
    EXPECT_GT(smooth->sample_area(random.square()).point.ng.z, 0);
    EXPECT_LT(flipped->sample_area(random.square()).point.ng.z, 0);
    EXPECT_LT(flipped->sample_area(random.square()).point.ns.z, 0);
  }
}

/// A face without normals in a file that has some gets smooth ones, as Mitsuba 3 makes them.
TEST(MeshShape, MissingNormalsAreMade) {
  const TemporaryFile file(
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 1\nvn 0 0.6 0.8\nf 1//1 2//1 3//1\nf 2 4 3\n", "some.obj");
  const auto shape = make_shape("obj", {{"filename", file.path(), {}}});
  const TriangleMesh& mesh = *shape->mesh();
  ASSERT_EQ(mesh.normals.size(), 6u);
  for (const uint32_t corner : mesh.triangles[0])
    EXPECT_LT(length(mesh.normals[corner] - Vec3f(0, 0.6f, 0.8f)), 1e-6f);
  const Vec3f flat = normalize(Vec3f(-1, -1, 1));
  for (const uint32_t corner : mesh.triangles[1])
    EXPECT_LT(length(mesh.normals[corner] - flat), 1e-6f);
}

/// Mitsuba 0.6's maxSmoothAngle: a roof of two quads at right angles, whose corners stand twice.
TEST(MeshShape, CreasesSplitNormals) {
  const TemporaryFile file(
      "v 0 0 0\nv 0 1 0\nv 1 0 1\nv 1 1 1\nv 2 0 0\nv 2 1 0\nv 1 0 1\nv 1 1 1\n"
      "vn 1 0 0\nf 1//1 3//1 4//1 2//1\nf 7 5 6 8\n",
      "roof.obj");
  const auto normals_at = [&](double degrees, const Vec3f& place, const Transform& to_world) {
    const auto shape = make_shape("obj", {{"filename", file.path(), {}},
                                          {"max_smooth_angle", degrees, {}},
                                          {"to_world", to_world, {}}});
    std::vector<Vec3f> normals;
    const TriangleMesh& mesh = *shape->mesh();
    for (size_t i = 0; i < mesh.positions.size(); ++i)
      if (mesh.positions[i] == to_world.point(place)) normals.push_back(mesh.normals[i]);
    return normals;
  };
  const Vec3f ridge(1, 0, 1), left = normalize(Vec3f(-1, 0, 1)), right = normalize(Vec3f(1, 0, 1));
  for (const Vec3f& n : normals_at(91, ridge, {})) EXPECT_LT(length(n - Vec3f(0, 0, 1)), 1e-6f);
  const std::vector<Vec3f> sharp = normals_at(89, ridge, {});
  ASSERT_EQ(sharp.size(), 2u);
  EXPECT_LT(std::min(length(sharp[0] - left), length(sharp[1] - left)), 1e-6f);
  EXPECT_LT(std::min(length(sharp[0] - right), length(sharp[1] - right)), 1e-6f);
  // Within a quad there is no crease, even at 0°.
  EXPECT_EQ(normals_at(0, {0, 0, 0}, {}).size(), 1u);
  // The angle counts in the world.
  EXPECT_EQ(normals_at(89, ridge, Transform::scale({1, 1, 0.5})).size(), 2u);
  for (const Vec3f& n : normals_at(89, ridge, Transform::scale({1, 1, 0.5})))
    EXPECT_LT(length(n - Vec3f(0, 0, 1)), 1e-6f);
}

/// A ball of many faces: the same normals as without a limit, however its vertices are shared.
TEST(MeshShape, WithoutCreasesNormalsAreSmooth) {
  TriangleMesh shared = make_shape("sphere")->tessellate(3);
  shared.normals.clear();
  TriangleMesh apart;
  for (const auto& corners : shared.triangles) {
    for (const uint32_t corner : corners) apart.positions.push_back(shared.positions[corner]);
    const auto n = uint32_t(apart.positions.size());
    apart.triangles.push_back({n - 3, n - 2, n - 1});
  }
  const TriangleMesh split = split_at_creases(apart, 60);
  for (size_t i = 0; i < split.positions.size(); ++i)
    EXPECT_GT(dot(split.normals[i], normalize(split.positions[i])), 0.999f);
  EXPECT_EQ(split_at_creases(shared, 60).positions.size(), shared.positions.size());
  EXPECT_EQ(split_at_creases(shared, 0).positions.size(), 3 * shared.triangles.size());
}

TEST(MeshShape, WindingFollowsVertexNormals) {
  const TemporaryFile file("v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 -1\nf 1//1 2//1 3//1\n", "down.obj");
  const auto shape = make_shape("obj", {{"filename", file.path(), {}}});
  EXPECT_LT(shape->sample_area({0.5f, 0.5f}).point.ng.z, 0);
}

TEST(MeshShape, TextureCoordinatesFlip) {
  const TemporaryFile as_obj(text_obj, "quad.obj"), as_ply(text_ply, "quad.ply");
  const auto v_of_second = [](const char* type, const TemporaryFile& file,
                              std::vector<Property> extra) {
    extra.push_back({"filename", file.path(), {}});
    return make_shape(type, extra)->mesh()->uvs[1].y;
  };
  EXPECT_EQ(v_of_second("obj", as_obj, {}), 1);  // Mitsuba's default for OBJ
  EXPECT_EQ(v_of_second("obj", as_obj, {{"flip_tex_coords", false, {}}}), 0);
  EXPECT_EQ(v_of_second("ply", as_ply, {}), 0);
  EXPECT_EQ(v_of_second("ply", as_ply, {{"flip_tex_coords", true, {}}}), 1);
}

TEST(MeshShape, TooFarIsAnError) {
  const TemporaryFile file(text_ply, "far.ply");
  EXPECT_THROW(make_shape("ply", {{"filename", file.path(), {}},
                                  {"to_world", Transform::scale({1e20, 1, 1}), {}}}),
               Error);
}

}  // namespace
}  // namespace kaustik::test
