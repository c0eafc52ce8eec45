// Damaged scenes of pbrt: whatever the bytes, the reader returns a description or throws
// kaustik::Error.

#include "tests/loader/damage.h"
#include "tests/loader/pbrt_support.h"

namespace kaustik::pbrt {
namespace {

const std::string whole_pbrt = R"(# every kind of directive
Option "disablepixeljitter" true
LookAt 0 1 5  0 0 0  0 1 0
Camera "perspective" "float fov" 40 "float lensradius" .1 "float screenwindow" [-1 1 -1 1]
Film "rgb" "integer xresolution" [20] "integer yresolution" 10 "float cropwindow" [0 1 0 1]
Sampler "stratified" "integer xsamples" 2
Integrator "volpath" "integer maxdepth" 7
PixelFilter "mitchell" "float B" .5
ColorSpace "rec2020"
WorldBegin
AttributeBegin
  Attribute "shape" "float radius" .5
  MakeNamedMedium "fog" "string type" "uniformgrid" "integer nx" 2 "float density" [0 1] "float g" .1
  MediumInterface "fog" ""
  Material "subsurface" "rgb mfp" [1 2 3]
  Shape "sphere" "float alpha" .5
AttributeEnd
Texture "c" "spectrum" "checkerboard" "rgb tex1" [.1 .2 .3] "float uscale" 8
Texture "m" "spectrum" "mix" "texture tex1" "c" "spectrum tex2" [400 .1 700 .9]
Texture "b" "float" "bilerp" "float v00" .5
MakeNamedMaterial "paint" "string type" "coateddiffuse" "texture reflectance" "m" "texture roughness" "b"
NamedMaterial "paint"
TransformBegin Scale 2 2 2 Rotate 45 0 1 0 TransformEnd
ObjectBegin "o" Shape "disk" "float innerradius" .2 Shape "cylinder" "float phimax" 90 ObjectEnd
ObjectInstance "o"
ConcatTransform [1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1]
AreaLightSource "diffuse" "blackbody L" 3000 "float power" 5
Texture "p" "spectrum" "checkerboard" "string mapping" "spherical"
Material "diffuse" "texture reflectance" "p"
Shape "trianglemesh" "integer indices" [0 1 2] "point3 P" [0 0 0 1 0 0 0 1 0] "point2 uv" [0 0 1 0 1 1]
Shape "bilinearmesh" "point3 P" [0 0 0 1 0 0 0 1 0 1 1 1]
Shape "curve" "point3 P" [0 0 0 1 0 0 2 0 0 3 0 1] "float width0" .1
Shape "loopsubdiv" "integer levels" 2 "integer indices" [0 1 2 2 1 3] "point3 P" [0 0 0 1 0 0 0 1 0 1 1 0]
LightSource "spot" "rgb I" [1 1 1] "float coneangle" 20
LightSource "distant" "spectrum L" "stdillum-A" "float illuminance" 100
CoordinateSystem "here" CoordSysTransform "camera" ReverseOrientation
ActiveTransform EndTime Translate 1 2 3 ActiveTransform All
)";

/// False if the text was refused as it should be.
bool survives_pbrt(const std::string& text) {
  return is_accepted([&] { return parse_scene_of_pbrt(text).scene != nullptr; });
}

TEST(PbrtFuzz, TheWholeSceneIsSound) { EXPECT_TRUE(survives_pbrt(whole_pbrt)); }

TEST(PbrtFuzz, TruncatedAtEveryByte) {
  for (size_t size = 0; size < whole_pbrt.size(); ++size) survives_pbrt(whole_pbrt.substr(0, size));
}

const int pbrt_rounds = damage_rounds(3000, 500);

TEST(PbrtFuzz, FlippedBytes) {
  const int refused = count_refused(whole_pbrt, 1, pbrt_rounds, 4, flip_byte, survives_pbrt);
  EXPECT_GT(refused, pbrt_rounds / 10);
  EXPECT_LT(refused, pbrt_rounds);
}

TEST(PbrtFuzz, ExchangedPiecesAndNumbers) {
  const Change numbers =
      exchanged_word({"0", "-1", "1e30", "1e-30", "nan", "99999999999", ".5", "\"\"", "["});
  count_refused(whole_pbrt, 2, pbrt_rounds, 3, either(exchanged_piece(whole_pbrt, 7), numbers),
                survives_pbrt);
}

TEST(PbrtFuzz, OtherNumbersEverywhere) {
  const std::string others[] = {"0", "-1", "1e30", "-1e-30", "99999999999", "181", "7"};
  const auto change = [&](std::string& text, std::mt19937& random) {
    std::string changed;
    bool in_number = false;
    for (const char c : text) {
      const bool is_digit = (c >= '0' && c <= '9') || c == '.';
      if (is_digit && !in_number && random() % 40 == 0) {
        changed += others[random() % std::size(others)] + " ";
        in_number = true;
        continue;
      }
      if (in_number && is_digit) continue;
      in_number = false;
      changed += c;
    }
    text = changed;
  };
  count_refused(whole_pbrt, 3, pbrt_rounds, 1, change, survives_pbrt);
}

}  // namespace
}  // namespace kaustik::pbrt
