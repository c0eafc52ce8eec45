// Functions, tables and pictures on the surfaces of Radiance's scenes.
#include <sstream>

#include "kaustik/loader/radiance/cal_evaluator.h"
#include "kaustik/loader/radiance/cal_functions.h"
#include "kaustik/loader/radiance/data_table.h"
#include "radiance_support.h"

namespace kaustik::radiance_test {
namespace {

using namespace radiance;

double computed(const std::string& expression, const std::string& definitions = "") {
  CalProgram program;
  program.add(cal_start());
  program.add(definitions);
  const uint32_t root = program.add_expression(expression);
  CalEvaluator evaluator(program);
  evaluator.set_function("arg", [](std::span<const double>) { return 7.0; });
  for (const char* name : {"Dx", "Dy", "Dz"}) evaluator.set(name, 0.5);
  for (const char* name : {"Nx", "Ny"}) evaluator.set(name, 0);
  evaluator.set("Nz", 1);
  evaluator.set("Px", 1);
  evaluator.set("Py", 2);
  evaluator.set("Pz", 3);
  return evaluator.value(root);
}

TEST(RadianceFunctions, Expressions) {
  EXPECT_EQ(computed("1 + 2 * 3 - 4 / 2"), 5);
  EXPECT_EQ(computed("2 ^ 3 ^ 2"), 512);
  EXPECT_EQ(computed("2 ^ -1"), 0.5);
  EXPECT_EQ(computed("-(1 - 3)"), 2);
  EXPECT_EQ(computed("{ a { nested } comment } 1e2"), 100);
  EXPECT_EQ(computed("if(-1, 2, if(1, 3, 4))"), 3);
  EXPECT_EQ(computed("select(2, 5, 6, 7)"), 6);
  EXPECT_EQ(computed("mod(-1, 3) + frac(1.25) + bound(0, 5, 1)"), 3.25);
  EXPECT_NEAR(computed("sin(PI/2) + Acos(2) + atan2(1, 1) / DEGREE"), 46, 1e-12);
  EXPECT_EQ(computed("A1 + U + V"), 10);
}

TEST(RadianceFunctions, Definitions) {
  EXPECT_EQ(computed("area(3)", "area(r) : r * r * w; w = 2;"), 18);
  EXPECT_EQ(computed("faculty(5)", "faculty(n) = if(n - 1.5, n * faculty(n - 1), 1);"), 120);
  EXPECT_EQ(computed("dot(D, v)", "v(i) = select(i, 1, 2, 3);"), 3);
  EXPECT_EQ(computed("a", "a = 1; a = 2;"), 2);
  EXPECT_EQ(computed("hide`here + 1", "hide`here = 4;"), 5);
}

void expect_bad(const std::string& expression, const std::string& definitions,
                const std::string& why) {
  try {
    computed(expression, definitions);
    FAIL() << expression;
  } catch (const CalError& error) {
    EXPECT_NE(std::string(error.what()).find(why), std::string::npos) << error.what();
  }
}

TEST(RadianceFunctions, MistakesAndEndlessWork) {
  expect_bad("1 +", "", "missing");
  expect_bad("nothing", "", "nothing defines 'nothing'");
  expect_bad("f(1)", "", "nothing defines the function 'f'");
  expect_bad("f(1)", "f(x) = f(x);", "without end");
  expect_bad("a", "a = b; b = a;", "without end");
  expect_bad("f(20)", "f(n) = if(n - .5, f(n - 1) + f(n - 1) + f(n - 1), 1);", "steps");
  expect_bad(std::string(1000, '(') + "1" + std::string(1000, ')'), "", "too deep");
}

TEST(RadianceFunctions, NoiseIsSmoothAndBounded) {
  double largest = 0;
  for (int i = 0; i < 2000; ++i) {
    const double x = 0.37 * i, here = cal_noise(0, x, 1.7, 0.3);
    largest = std::max(largest, std::fabs(here));
    EXPECT_NEAR(cal_noise(0, x + 1e-5, 1.7, 0.3) - here, 1e-5 * cal_noise(1, x, 1.7, 0.3), 1e-7);
  }
  EXPECT_GT(largest, 0.3);
  EXPECT_LE(largest, 1);
}

TEST(RadianceFunctions, TablesAreLinearBetween) {
  const DataTable table("2 0 1 2 # x\n0 2 3\n1 2 3\n11 12 13\n");
  const std::vector<double> at = {0.5, 0.5}, beyond = {9, -9};
  EXPECT_NEAR(table.at(at), 6.5, 1e-12);
  EXPECT_EQ(table.at(beyond), 11);
  const DataTable listed("1 0 0 3 0 1 10 5 6 15");
  EXPECT_NEAR(listed.at(std::vector<double>{5.5}), 10.5, 1e-12);
  EXPECT_THROW(DataTable("2 0 1 100000 0 1 100000 1 2"), CalError);
}

TEST(RadiancePatterns, ConstantsMultiplyTheColour) {
  const auto scene = with_material(
      "void brightfunc half 2 A1*2 . 0 1 .25\nvoid colorfunc tint 4 1 .5 .25 . 0 0\n"
      "half alias top half\nhalf plastic m 0 0 5 .8 .8 .8 0 0\n");
  expect_colour(front_bsdf(sole_object(scene, "shape")), "reflectance", .4, .4, .4);
  EXPECT_EQ(deviations_but_view(scene), 0u);
}

TEST(RadiancePatterns, PatternsInSpaceAreSampled) {
  const auto scene =
      with_material("void brightfunc ramp 2 Px . 0 0\nramp plastic m 0 0 5 1 .5 0 0 0\n");
  const Object& texture = *front_bsdf(sole_object(scene, "shape")).children.at(0).object;
  EXPECT_EQ(texture.type, "scale");
  const Object& volume = nested(nested(texture, "texture"), "volume");
  const auto& placed = value<Transform>(volume, "to_world");
  const auto& data = *value<std::shared_ptr<const Array>>(volume, "data");
  ASSERT_EQ(data.extents().size(), 4u);
  const size_t columns = data.extents()[2];
  EXPECT_GT(columns, 100u);
  const auto values = rad_numbers(volume, "data");
  for (size_t x = 0; x < columns; x += 17) {
    const double at = double(placed.point({(float(x) + 0.5f) / float(columns), 0.5f, 0.5f}).x);
    EXPECT_NEAR(values[3 * x], at, 1e-5);
  }
  EXPECT_TRUE(tells(scene, DeviationKind::approximated, "brightfunc 'ramp'", "sampled"));
}

TEST(RadiancePatterns, WhatDependsOnTheViewCountsByItsMean) {
  // The mean of cos over the hemisphere by cosines is 2/3.
  const auto scene =
      with_material("void brightfunc f 2 Rdot . 0 0\nf plastic m 0 0 5 .9 .9 .9 0 0\n");
  EXPECT_NEAR(colour_in(front_bsdf(sole_object(scene, "shape")), "reflectance")->r, .6, .05);
  EXPECT_TRUE(tells(scene, DeviationKind::approximated, "brightfunc 'f'", "mean"));
}

bool shines(const Object& shape) {
  return std::ranges::any_of(shape.children,
                             [](const Child& child) { return child.object->family == "emitter"; });
}

/// The intensities in cd of a luminaire's planes, from straight down in steps of 2.5°.
std::vector<double> candelas_of(const Object& luminaire, size_t planes) {
  std::istringstream text(value<std::string>(luminaire, "profile"));
  std::string line;
  for (int i = 0; i < 4; ++i) std::getline(text, line);
  std::vector<double> numbers;
  for (double number; text >> number;) numbers.push_back(number);
  EXPECT_EQ(numbers.size(), 73 + planes + 73 * planes);
  return {numbers.begin() + std::ptrdiff_t(73 + planes), numbers.end()};
}

// As ies2rad writes them: an intensity of 100 cosθ straight down, or 100 cos⁴θ, through a disk of
// 0.1 m², which itself is dark.
TEST(RadiancePatterns, LampsByTheirIntensity) {
  TemporaryFolder folder;
  for (const int power : {1, 4}) {
    std::string numbers;
    for (int i = 0; i <= 180; ++i) {
      const double cosine = std::max(0.0, std::cos(0.5 * i * pi_d / 180));
      numbers += std::to_string(100 * std::pow(cosine, power)) + "\n";
    }
    folder.write("x.dat", "1\n0 90 181\n" + numbers);
    const auto scene = load_radiance(
        folder.write("a.rad",
                     "void brightdata x 4 flatcorr x.dat source.cal src_theta 0 1 10\n"
                     "x light l 0 0 3 1 .5 1\nl ring r 0 0 8 0 0 3 0 0 -1 0 .178412\n"));
    EXPECT_FALSE(shines(sole_object(scene, "shape")));
    const Object& emitter = sole_object(scene, "emitter");
    EXPECT_EQ(emitter.type, "goniometric");
    expect_colour(emitter, "intensity", 1, .5, 1);
    EXPECT_NEAR(value<Transform>(emitter, "to_world").vector(Vec3f(0, 0, 1)).z, -1, 1e-6);
    const auto candelas = candelas_of(emitter, 1);
    for (const int row : {0, 10, 20, 35}) {
      const double expected = 179 * 100 * std::pow(std::cos(2.5 * row * pi_d / 180), power);
      EXPECT_NEAR(candelas[size_t(row)], expected, 1e-3 * expected) << row;
    }
    EXPECT_EQ(candelas[40], 0);
    EXPECT_TRUE(tells(scene, DeviationKind::approximated, "brightdata 'x'", "from a point"));
  }
}

// C 0 of the file is +x of the luminaire, C 90 is +y.
TEST(RadiancePatterns, LuminairesKeepTheirAxes) {
  const auto scene = with_material(
      "void brightfunc f 2 if(-Dx-.5,8,if(-Dy-.5,4,1)) . 0 0\nf light m 0 0 3 1 1 1\n");
  const Object& emitter = sole_object(scene, "emitter");
  const auto candelas = candelas_of(emitter, 72);
  const double one = 179 * std::sqrt(.5);  // of 1 m² at 135°
  EXPECT_NEAR(candelas[54], 8 * one, .1);
  EXPECT_NEAR(candelas[18 * 73 + 54], 4 * one, .1);
  EXPECT_NEAR(candelas[36 * 73 + 54], one, .1);
}

// A tube is neither flat nor a sphere: it shines by its mean.
TEST(RadiancePatterns, OtherLampsShineByTheirMean) {
  const auto scene = parse_rad(
      "void brightfunc f 2 Dz*Dz . 0 0\nf light l 0 0 3 1 1 1\n"
      "l cylinder c 0 0 7 0 0 0 0 0 1 .1\n");
  EXPECT_TRUE(shines(sole_object(scene, "shape")));
  EXPECT_TRUE(tells(scene, DeviationKind::approximated, "brightfunc 'f'", "by its mean"));
}

TEST(RadiancePatterns, PicturesLieByTheirFunctions) {
  TemporaryFolder folder;
  // 4 wide and 2 high: its shorter side is 1 long.
  folder.write("p.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 4\n" + std::string(32, 'x'));
  const auto loaded = load_radiance(folder.write(
      "b.rad",
      "void colorpict pic 11 red green blue p.hdr picture.cal pic_u pic_v -t 1 0 0 0 0\n"
      "pic plastic m 0 0 5 .5 .5 .5 0 0\nm polygon p 0 0 12 1 0 0 3 0 0 3 1 0 1 1 0\n"));
  const Object& shape = sole_object(loaded, "shape");
  const auto uvs = rad_numbers(shape, "uv");
  const std::vector<double> expected = {0, 1, 1, 1, 1, 0, 0, 0};  // v from the upper edge
  for (size_t i = 0; i < 8; ++i) EXPECT_NEAR(uvs[i], expected[i], 1e-6) << i;
  const Object& scaled = *front_bsdf(shape).children.at(0).object;
  EXPECT_EQ(value<std::string>(nested(scaled, "texture"), "filename"), folder / "p.hdr");
  EXPECT_EQ(deviations_but_view(loaded), 0u);
}

TEST(RadiancePatterns, MissingFilesAreSeen) {
  const auto scene = with_material(
      "void colorpict pic 7 red green blue none.hdr picture.cal pic_u pic_v 0 0\n"
      "pic plastic m 0 0 5 1 1 1 0 0\n");
  EXPECT_TRUE(tells(scene, DeviationKind::missing, "colorpict 'pic'", "none.hdr"));
  const Object& checker = *front_bsdf(sole_object(scene, "shape")).children.at(0).object;
  EXPECT_EQ(checker.type, "checkerboard");
  expect_colour(checker, "color0", .8, 0, .8);
  const auto function =
      with_material("void brightfunc f 2 x none.cal 0 0\nf plastic m 0 0 5 .5 .5 .5 0 0\n");
  EXPECT_TRUE(tells(function, DeviationKind::missing, "brightfunc 'f'", "none.cal"));
  const auto data =
      with_material("void brightdata d 4 noop none.dat . Px 0 0\nd plastic m 0 0 5 .5 .5 .5 0 0\n");
  EXPECT_TRUE(tells(data, DeviationKind::missing, "brightdata 'd'", "none.dat"));
  const auto spectrum =
      with_material("void specfile s 1 none.spd 0 0\ns plastic m 0 0 5 .5 .5 .5 0 0\n");
  EXPECT_TRUE(tells(spectrum, DeviationKind::missing, "specfile 's'", "none.spd"));
}

TEST(RadiancePatterns, FunctionsOfFiles) {
  TemporaryFolder folder;
  folder.write("f.cal", "{ half of the first argument } half = A1 / 2;");
  folder.write("d.dat", "1\n0 10 2\n.2 .4\n");
  const auto scene = load_radiance(
      folder.write("a.rad",
                   "void brightfunc f 2 half f.cal 0 1 .5\nf brightdata g 4 noop d.dat . 5 0 0\n"
                   "g plastic m 0 0 5 1 1 1 0 0\nm polygon p 0 0 9 0 0 0 1 0 0 1 1 0\n"));
  expect_colour(front_bsdf(sole_object(scene, "shape")), "reflectance", .075, .075, .075, 1e-6);
}

}  // namespace
}  // namespace kaustik::radiance_test
