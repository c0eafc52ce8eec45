// OBJ files, good and hostile.

#include <fmt/format.h>

#include <cctype>
#include <cmath>
#include <map>

#include "kaustik/base/parallel.h"
#include "kaustik/base/polygon_cutter.h"
#include "kaustik/base/srgb.h"
#include "mesh_file_support.h"

namespace kaustik::test {
namespace {

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
    const std::string message = reading_error([&] { obj(bytes); });
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
  EXPECT_NE(reading_error([] { read_obj("/nonexistent/mesh.obj"); }), "");
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
    return reading_error([&] { read_obj(file.path(), selection); });
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
    const std::string message = reading_error([&] { obj(text); });
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
        reading_error([&] { obj(with_line_ends("v 0 0 0 \\\n\nv 0 \\\n0 x\n", end)); });
    EXPECT_NE(message.find(":3: "), std::string::npos) << message;
  }
  EXPECT_NE(reading_error([] { obj("\xff\xfev\0 \0"); }).find("UTF-16"), std::string::npos);
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
  EXPECT_NE(reading_error([&] { obj("v 0 0 0\nv 1 0 0\nf 1 2\n"); }).find("no faces"),
            std::string::npos);
  // Round all vertices some times: no polygon.
  std::string round = "f";
  for (int i = 0; i < 20; ++i) round += " 1 2 3";
  const auto uncut = remarks(round + "\n" + round + "\n");
  ASSERT_EQ(uncut.size(), 1u);
  EXPECT_NE(uncut[0].find(":5: 2 faces were left out: to cut so many"), std::string::npos)
      << uncut[0];
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
        expect_equal_meshes(obj(file.text), file.mesh, std::to_string(threads) + " threads");
      });
  }
}

/// Whatever kind of line it is, and whichever kind is read first.
TEST(ObjReader, TellsTheFirstOfManyFaults) {
  const std::string good = LongObj(false).text;
  const auto line = 1 + std::count(good.begin(), good.end(), '\n');
  for (const std::string fault : {"v 0 0\n", "vt x\n", "f 1 2 99999999\n", "vn 0 1e99 0\n"}) {
    const std::string message = reading_error(
        [&] { obj(good + fault + "v 0 0\nvn x 0 0\nf 0\nvt\nf 1/1/1/1 2 3\n" + good); });
    EXPECT_NE(message.find(":" + std::to_string(line) + ": "), std::string::npos) << message;
  }
}

TEST(ObjReader, SurvivesDamage) {
  survive_damage(text_obj, obj, 200);
  survive_damage("v 0 0 0 1 0 1\nv 1 0 0 0 0.5 1\nv 0 1 0\nv 1 1 1 1 1 1\nf 1 2 3 4\n", obj, 50);
}

}  // namespace
}  // namespace kaustik::test
