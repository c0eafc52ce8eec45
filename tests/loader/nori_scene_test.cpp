// What scenes of Nori become: cameras, meshes, materials, light, integrators.

#include <numbers>

#include "kaustik/loader/object_parts.h"
#include "kaustik/loader/scene_format.h"
#include "tests/loader/nori_support.h"

namespace kaustik::nori {
namespace {

std::string format_of(const std::string& text) {
  return choose_format(scene_formats(), text, "scene.xml").name;
}

TEST(NoriFormat, IsToldFromMitsubas) {
  const std::string mesh = "<mesh type=\"obj\"/>";
  EXPECT_EQ(format_of("<scene>" + mesh + "</scene>"), "Nori XML");
  EXPECT_EQ(format_of("\xef\xbb\xbf<?xml version='1.0'?>\n<!-- a <ref/> --><scene>" + mesh),
            "Nori XML");
  EXPECT_EQ(format_of("<scene><shape type=\"sphere\"/><camera type=\"perspective\"/>"), "Nori XML");
  EXPECT_EQ(format_of("<test type=\"ttest\">"), "Nori XML");
  // A version, or something that only Mitsuba has.
  EXPECT_EQ(format_of("<scene version=\"3.0.0\">" + mesh), "Mitsuba XML");
  EXPECT_EQ(format_of("<scene><shape type=\"sphere\"/></scene>"), "Mitsuba XML");
  EXPECT_EQ(format_of("<scene><camera type=\"perspective\"><film type=\"exrfilm\"/></camera>"),
            "Mitsuba XML");
  EXPECT_EQ(format_of("<scene><!-- <mesh/> --><shape type=\"obj\"/></scene>"), "Mitsuba XML");
}

TEST(NoriCamera, HasTheRightOfThePictureAlongX) {
  const Description scene = parse_nori_text(
      "<scene><camera type=\"perspective\"><transform name=\"toWorld\">"
      "<translate value=\"1 2 3\"/></transform></camera><mesh type=\"sphere\"/></scene>");
  const Object& sensor = only(scene, "sensor");
  expect_same(value<Transform>(sensor, "to_world"),
              Transform::translate({1, 2, 3}) * Transform::scale({-1, 1, 1}));
  EXPECT_EQ(number_in(sensor, "fov"), 30);
  const Object& film = only(sensor, "film");
  EXPECT_EQ(number_in(film, "width"), 1280);
  EXPECT_EQ(number_in(film, "height"), 720);
  EXPECT_EQ(only(film, "rfilter").type, "gaussian");
  EXPECT_EQ(number_in(only(sensor, "sampler"), "sample_count"), 1);
}

TEST(NoriCamera, HasLensesOfForks) {
  const Description scene = parse_nori_text(
      "<scene><camera type=\"thinlens\"><float name=\"lensRadius\" value=\"0.1\"/>"
      "<float name=\"focalDistance\" value=\"7\"/><float name=\"fstop\" value=\"2\"/></camera>"
      "</scene>");
  const Object& sensor = only(scene, "sensor");
  EXPECT_EQ(sensor.type, "thinlens");
  EXPECT_EQ(number_in(sensor, "aperture_radius"), 0.1);
  EXPECT_EQ(number_in(sensor, "focus_distance"), 7);
  EXPECT_TRUE(is_ignored(scene, "camera", "'fstop'"));
}

TEST(NoriMeshes, HaveTheNormalsOfTheirFileOrFlatFaces) {
  const TemporaryFolder folder;
  folder.write("flat.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  folder.write("smooth.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nf 1//1 2//1 3//1\n");
  const auto face_normals = [&](const std::string& name) {
    const Description scene = parse_nori_text(
        "<scene>" + nori_camera + "<mesh type=\"obj\"><string name=\"filename\" value=\"" + name +
            "\"/></mesh></scene>",
        folder / "");
    return find_property(only(scene, "shape"), "face_normals") != nullptr;
  };
  EXPECT_TRUE(face_normals("flat.obj"));
  EXPECT_FALSE(face_normals("smooth.obj"));
}

TEST(NoriMeshes, WithoutABsdfAreGrey) {
  expect_rgb(value<Rgb>(*nori_bsdf(""), "reflectance"), 0.5, 0.5, 0.5);
  const Description fog = parse_in_nori("<mesh type=\"sphere\"><medium type=\"homog\"/></mesh>");
  EXPECT_EQ(bsdf_of(fog)->type, "null");
  EXPECT_TRUE(is_ignored(fog, "medium 'homog' on line 2", "not rendered"));
}

TEST(NoriMaterials, MicrofacetIsTheSumOfBothParts) {
  const auto blend = nori_bsdf("<bsdf type=\"microfacet\"/>");
  // kd = 1/2: half of a white base, and half of the facets.
  EXPECT_EQ(blend->type, "blendbsdf");
  EXPECT_EQ(number_in(*blend, "weight"), 0.5);
  expect_rgb(value<Rgb>(*blend->children.at(0).object, "reflectance"), 1, 1, 1);
  const Object& facets = *blend->children.at(1).object;
  EXPECT_EQ(facets.type, "roughconductor");
  EXPECT_EQ(number_in(facets, "alpha"), 0.1);
  expect_rgb(value<Rgb>(facets, "eta"), 1.504183, 1.504183, 1.504183, 1e-6);
  expect_rgb(value<Rgb>(facets, "k"), 0, 0, 0);
  const auto kd = [](const std::string& colour) {
    return nori_bsdf("<bsdf type=\"microfacet\"><color name=\"kd\" value=\"" + colour +
                     "\"/></bsdf>");
  };
  EXPECT_EQ(kd("0")->type, "roughconductor");
  EXPECT_EQ(kd("1 .5 0")->type, "diffuse");
}

TEST(NoriMaterials, OfForks) {
  const auto disney = nori_bsdf(
      "<bsdf type=\"disney\"><color name=\"baseColor\" value=\".1 .2 .3\"/>"
      "<float name=\"specularTint\" value=\".4\"/></bsdf>");
  EXPECT_EQ(disney->type, "principled");
  expect_rgb(value<Rgb>(*disney, "base_color"), 0.1, 0.2, 0.3);
  EXPECT_EQ(number_in(*disney, "spec_tint"), 0.4);
  const Description odd = parse_in_nori(
      "<mesh type=\"sphere\"><bsdf type=\"velvet\"><color name=\"albedo\" value=\".3\"/>"
      "<float name=\"fuzz\" value=\"2\"/></bsdf></mesh>");
  EXPECT_EQ(bsdf_of(odd)->type, "diffuse");
  expect_rgb(value<Rgb>(*bsdf_of(odd), "reflectance"), 0.3, 0.3, 0.3);
  EXPECT_TRUE(is_approximated(odd, "bsdf 'velvet' on line 2", "matt"));
  EXPECT_TRUE(is_ignored(odd, "bsdf 'velvet'", "'fuzz' has no meaning here"));
}

TEST(NoriMaterials, SquaresOfCheckerboards) {
  const auto bsdf = nori_bsdf(
      "<bsdf type=\"diffuse\"><texture type=\"checkerboard_color\" name=\"albedo\">"
      "<point name=\"delta\" value=\"1, 3\"/><vector name=\"scale\" value=\".1, .2\"/></texture>"
      "</bsdf>");
  const Transform to_uv = value<Transform>(child(*bsdf, "reflectance"), "to_uv");
  // The corner of a square: uv = scale·(1 + delta, 1 + delta) is half a unit here.
  EXPECT_NEAR(double(to_uv.point({0.2f, 0.8f, 0}).x), 0.5, 1e-6);
  EXPECT_NEAR(double(to_uv.point({0.2f, 0.8f, 0}).y), 0.5, 1e-6);
}

TEST(NoriLights, PowerIsThatOfAllDirections) {
  const Description scene = parse_in_nori(
      "<emitter type=\"point\"><color name=\"power\" value=\"12.566370614359172\"/></emitter>"
      "<emitter type=\"distantdisk\"><float name=\"thetaA\" value=\"180\"/>"
      "<color name=\"radiance\" value=\".6 .5 .4\"/></emitter>"
      "<emitter type=\"laser\"/>");
  const auto lamps = objects_of(scene, "emitter");
  ASSERT_EQ(lamps.size(), 2u);
  expect_rgb(value<Rgb>(*lamps[0], "intensity"), 1, 1, 1);
  EXPECT_EQ(lamps[1]->type, "constant");
  expect_rgb(value<Rgb>(*lamps[1], "radiance"), 0.6, 0.5, 0.4);
  EXPECT_TRUE(is_ignored(scene, "emitter 'laser' on line 2", "no such light"));
}

TEST(NoriLights, SpotsHaveTheirPower) {
  const Description scene = parse_in_nori(
      "<emitter type=\"spot\"><point name=\"origin\" value=\"0 1 0\"/>"
      "<point name=\"lookat\" value=\"0 0 0\"/><color name=\"power\" value=\"3.141592653589793\"/>"
      "<float name=\"TotalWidth\" value=\"60\"/><float name=\"FallOffStart\" value=\"60\"/>"
      "</emitter>");
  const Object& spot = only(scene, "emitter");
  // π W through the solid angle 2π(1 − cos 60°) = π sr.
  expect_rgb(value<Rgb>(spot, "intensity"), 1, 1, 1);
  EXPECT_NEAR(double(value<Transform>(spot, "to_world").vector({0, 0, 1}).y), -1, 1e-6);
}

TEST(NoriLights, SurroundingsOfAMeshTakeItsPlace) {
  const TemporaryFolder folder;
  folder.write("sky.exr", "");
  const Description scene = parse_nori_text(
      "<scene>" + nori_camera +
          "<mesh type=\"sphere\"><float name=\"radius\" value=\"10000\"/>"
          "<emitter type=\"environment\"><string name=\"filename\" value=\"sky.exr\"/>"
          "<float name=\"strength\" value=\".5\"/></emitter></mesh></scene>",
      folder / "");
  EXPECT_TRUE(objects_of(scene, "shape").empty());
  EXPECT_EQ(only(scene, "emitter").type, "envmap");
  EXPECT_EQ(number_in(only(scene, "emitter"), "scale"), 0.5);
}

std::string nori_method(const std::string& type) {
  const Object method = only(parse_in_nori("<integrator type=\"" + type + "\"/>"), "integrator");
  const auto depth = number_in(method, "max_depth");
  return method.type + (depth ? " " + std::to_string(int(*depth)) : "");
}

TEST(NoriIntegrators, BecomeTheSameMethod) {
  for (const char* type : {"path", "path_ems", "path_mats", "path_mis", "path_vol_mats"})
    EXPECT_EQ(nori_method(type), "path") << type;
  for (const char* type : {"direct", "direct_ems", "direct_mats", "direct_mis"})
    EXPECT_EQ(nori_method(type), "path 2") << type;
  EXPECT_EQ(nori_method("whitted"), "raytracing");
  EXPECT_EQ(nori_method("photonmapper"), "photonmap");
  EXPECT_EQ(nori_method("progressivephotonmapper"), "ppm");
  const Description odd = parse_in_nori("<integrator type=\"npr\"/>");
  EXPECT_TRUE(objects_of(odd, "integrator").empty());
  EXPECT_TRUE(is_approximated(odd, "integrator 'npr'", "default renders"));
}

TEST(NoriIntegrators, WithoutMaterialsSeeWhiteSurfaces) {
  const std::string mesh =
      "<mesh type=\"sphere\"><bsdf type=\"mirror\"/><emitter type=\"area\"/></mesh>";
  for (const char* type : {"ao", "simple"}) {
    const Description scene =
        parse_in_nori(mesh + "<integrator type=\"" + std::string(type) +
                      "\"><color name=\"energy\" value=\"12.566370614359172\"/></integrator>");
    const Object& ball = only(scene, "shape");
    EXPECT_EQ(ball.children.size(), 1u);
    expect_rgb(value<Rgb>(only(ball, "bsdf"), "reflectance"), 1, 1, 1);
    EXPECT_EQ(number_in(only(scene, "integrator"), "max_depth"), 2);
    const Object& light = only(scene, "emitter");
    EXPECT_EQ(light.type, type == std::string("ao") ? "constant" : "point");
    if (light.type == "point") {
      expect_rgb(value<Rgb>(light, "intensity"), 1, 1, 1);
    } else {
      EXPECT_FALSE(value<bool>(light, "visible"));
    }
  }
}

TEST(NoriErrors, HaveAPlaceAndARemedy) {
  const auto problems = [](const std::string& text) {
    return problems_of([&] { parse_nori_text(text); });
  };
  expect_problem(problems("<scene>\n<mesh type=\"obj\"/></scene>"), "test.xml:2:1", "names no file",
                 "filename");
  expect_problem(problems("<scene><mesh type=\"sphere\"/></scene>"), "test.xml:1:1",
                 "has no camera", "<camera");
  expect_problem(problems("<scene><camera type=\"perspective\">\n<float name=\"fov\"/></camera>"
                          "</scene>"),
                 "test.xml:2:1", "lacks the attribute 'value'", "<float");
  expect_problem(problems("<scene><camera type=\"perspective\"><transform name=\"toWorld\">\n"
                          "<turn value=\"1\"/></transform></camera></scene>"),
                 "test.xml:2:1", "no part of a transform", "lookat");
  expect_problem(problems("<test type=\"ttest\"/>"), "test.xml:1:1", "holds tests", "kaustik test");
  std::string deep = "<scene>";
  for (int i = 0; i < 2000; ++i) deep += "<bsdf type=\"x\">";
  for (int i = 0; i < 2000; ++i) deep += "</bsdf>";
  EXPECT_NE(problems(deep + "</scene>")[0].message.find("nest more than"), std::string::npos);
}

/// The picture is made of what is there.
TEST(NoriMissing, FilesLeaveStandIns) {
  const std::string inside =
      "<mesh type=\"obj\"><string name=\"filename\" value=\"no.obj\"/></mesh>"
      "<mesh type=\"sphere\"><bsdf type=\"diffuse\"><texture type=\"image\" name=\"albedo\">"
      "<string name=\"filename\" value=\"no.png\"/></texture></bsdf></mesh>"
      "<emitter type=\"envmap\"><string name=\"filename\" value=\"no.exr\"/></emitter>";
  const Description scene = parse_in_nori(inside);
  EXPECT_EQ(only(scene, "shape").type, "sphere");
  EXPECT_EQ(only(only(only(scene, "shape"), "bsdf"), "texture").type, "checkerboard");
  EXPECT_TRUE(is_missing(scene, "file 'no.obj'", "the mesh is left out"));
  EXPECT_TRUE(is_missing(scene, "file 'no.png'", "a magenta checker stands for it"));
  EXPECT_TRUE(is_missing(scene, "file 'no.exr'", "it gives no light"));
  EXPECT_THROW(parse_nori_text("<scene>" + nori_camera + inside + "</scene>", "", true), Error);
}

TEST(NoriErrors, StrictReadingRefusesDeviations) {
  const std::string text = "<scene>" + nori_camera + "<emitter type=\"laser\"/></scene>";
  EXPECT_EQ(parse_nori_text(text).deviations.size(), 1u);
  EXPECT_EQ(problems_of([&] { parse_nori_text(text, "", true); }).size(), 1u);
}

TEST(NoriErrors, FilesThatAreNoScenesAreNotQuoted) {
  const TemporaryFolder folder;
  const std::string secret = folder.write("a.xml", "<secret>word</secre>");
  const auto problems = problems_of([&] { load_nori(secret); });
  EXPECT_EQ(problems[0].message.find("word"), std::string::npos);
  EXPECT_EQ(problems[0].place.column, 0);
}

}  // namespace
}  // namespace kaustik::nori
