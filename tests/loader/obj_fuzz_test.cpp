// Damaged OBJ and MTL files: whatever the bytes, the reader returns a description or throws
// kaustik::Error.

#include "kaustik/loader/scene_format.h"
#include "tests/loader/damage.h"
#include "tests/loader/loader_support.h"

namespace kaustik {
namespace {

const std::string whole_obj = R"(# every kind of line
mtllib scene.mtl
o body
g front side
v 0 0 0
v 2 0 0 1
v 0 2 0 .5 .5 .5
v 0 0 2e0
vt 0 0
vt 1 .5 0
vn 0 0 1
s 1
usemtl wall
f 1 2 3
f 1/1 2/2 3/1 4/2
usemtl lamp
f 1//1 2//1 4//1
s off
f -1/-1/-1 -2/-2/-1 \
-3/1/1
usemtl glass
f 2 3 4
l 1 2
p 1
curv2 1 2
)";

const std::string whole_mtl = R"(# both models
newmtl wall
Kd .8 .1 .2
Ks .1 .1 .1
Ns 50
Ka spectral no.rfl
map_Kd -s 2 2 2 -o .1 0 -clamp on no.png
map_d no.png
newmtl lamp
Ke 3 2 1
Kd xyz .1 .2 .3
illum 3
newmtl glass
Ni 1.5
Tf .5 1 1
d .3
Tr .7
illum 7
newmtl metal
Pr .25
Pm 1
Pc .5
Pcr .1
Ps .3
aniso .2
anisor .1
norm -bm .5 no.png
bump no.png
map_Ke no.png
)";

/// The scene of both files, of which one is damaged.
class DamagedObj {
 public:
  DamagedObj() {
    write_obj(whole_obj);
    write_mtl(whole_mtl);
  }
  void write_obj(const std::string& text) { path_ = folder_.write("scene.obj", text); }
  void write_mtl(const std::string& text) { folder_.write("scene.mtl", text); }
  /// False if the scene was refused as it should be.
  bool survives() const {
    return is_accepted([&] { return load_scene(path_).scene != nullptr; });
  }

 private:
  TemporaryFolder folder_;
  std::string path_;
};

const int obj_rounds = damage_rounds(1000, 200);
const Change odd_numbers = exchanged_word({"0", "-1", "1e30", "1e-320", "nan", "inf", "99999999999",
                                           "-99999999999999999999", "/", "\\", "\n", "newmtl"});

TEST(ObjFuzz, TheWholeSceneIsSound) { EXPECT_TRUE(DamagedObj().survives()); }

TEST(ObjFuzz, FlippedBytes) {
  DamagedObj damaged;
  const auto survives = [&](const std::string& text) {
    damaged.write_obj(text);
    return damaged.survives();
  };
  EXPECT_LT(count_refused(whole_obj, 1, obj_rounds, 4, flip_byte, survives), obj_rounds);
}

TEST(ObjFuzz, ExchangedPiecesAndNumbers) {
  DamagedObj damaged;
  const auto survives = [&](const std::string& text) {
    damaged.write_obj(text);
    return damaged.survives();
  };
  count_refused(whole_obj, 2, obj_rounds, 3, either(exchanged_piece(whole_obj, 7), odd_numbers),
                survives);
}

// A library says much that is left out: nothing in it is an error.
TEST(ObjFuzz, Materials) {
  DamagedObj damaged;
  const auto survives = [&](const std::string& text) {
    damaged.write_mtl(text);
    return damaged.survives();
  };
  EXPECT_EQ(count_refused(whole_mtl, 3, obj_rounds, 4, flip_byte, survives), 0);
  EXPECT_EQ(count_refused(whole_mtl, 4, obj_rounds, 3,
                          either(exchanged_piece(whole_mtl, 7), odd_numbers), survives),
            0);
}

}  // namespace
}  // namespace kaustik
