// Surfaces of Radiance, and where commands place them.
#include "radiance_support.h"

namespace kaustik::radiance_test {
namespace {

Description surface(const std::string& text) { return parse_rad(grey + "grey " + text + "\n"); }

TEST(RadianceSurfaces, ConcavePolygonsAndHolesBySeams) {
  // An L, and a square with a square hole that a seam leads to.
  const auto corner = surface("polygon p 0 0 18 0 0 0 2 0 0 2 1 0 1 1 0 1 2 0 0 2 0");
  EXPECT_NEAR(area_of(sole_object(corner, "shape")), 3, 1e-6);
  EXPECT_NEAR(area_vector_of(sole_object(corner, "shape")).z, 3, 1e-6);
  const auto hole =
      surface("polygon p 0 0 30 0 0 0 4 0 0 4 4 0 0 4 0 0 0 0 1 1 0 1 3 0 3 3 0 3 1 0 1 1 0");
  EXPECT_NEAR(area_of(sole_object(hole, "shape")), 12, 1e-5);
  EXPECT_NEAR(area_vector_of(sole_object(hole, "shape")).z, 12, 1e-5);
}

TEST(RadianceSurfaces, Rings) {
  const auto disk = surface("ring r 0 0 8 1 2 3 0 0 2 0 .5");
  const Object& shape = sole_object(disk, "shape");
  EXPECT_EQ(shape.type, "disk");
  const auto& placed = value<Transform>(shape, "to_world");
  EXPECT_NEAR((placed.point({0, 0, 0}) - Vec3f(1, 2, 3)).length(), 0, 1e-6);
  EXPECT_NEAR(placed.vector({1, 0, 0}).length(), 0.5, 1e-6);
  EXPECT_GT(placed.normal({0, 0, 1}).z, 0);
  const auto ring = surface("ring r 0 0 8 0 0 1 0 0 -1 .5 1");
  EXPECT_NEAR(area_vector_of(sole_object(ring, "shape")).z, -pi_d * 0.75, 1e-4);
  EXPECT_TRUE(tells(ring, DeviationKind::approximated, "rings"));
}

TEST(RadianceSurfaces, CylindersConesAndWhatFacesInward) {
  EXPECT_FALSE(find_property(sole_object(surface("cylinder c 0 0 7 0 0 0 0 0 2 .5"), "shape"),
                             "flip_normals"));
  EXPECT_TRUE(
      value<bool>(sole_object(surface("tube c 0 0 7 0 0 0 0 0 2 .5"), "shape"), "flip_normals"));
  EXPECT_TRUE(value<bool>(sole_object(surface("bubble c 0 0 4 0 0 0 2"), "shape"), "flip_normals"));
  // Its base lies around the origin, and adds nothing to the volume.
  const auto cone = surface("cone c 0 0 8 0 0 0 0 0 3 1 0");
  EXPECT_NEAR(volume_of(sole_object(cone, "shape")), pi_d, 0.01);
  const auto cup = surface("cup c 0 0 8 0 0 0 0 0 3 1 0");
  EXPECT_NEAR(volume_of(sole_object(cup, "shape")), -pi_d, 0.01);
  const auto normals = rad_numbers(sole_object(cone, "shape"), "normals");
  EXPECT_NEAR(normals[2], 1 / std::sqrt(10.0), 1e-5);
}

TEST(RadianceSurfaces, XformFromLeftToRight) {
  TemporaryFolder folder;
  folder.write("ball.rad", "grey sphere s 0 0 4 1 0 0 .5\n");
  const std::string scene = folder.write(
      "a.rad", grey + "!xform -s 2 -rz 90 -t 0 0 5 ball.rad\n!xform -t 0 0 5 -s 2 ball.rad\n");
  const Description description = load_radiance(scene);
  const auto balls = rad_objects(description, "shape");
  ASSERT_EQ(balls.size(), 2u);
  const auto centre = value<Vec3d>(*balls[0], "center");
  EXPECT_NEAR((centre - Vec3d(0, 2, 5)).length(), 0, 1e-12);
  EXPECT_NEAR(value<double>(*balls[0], "radius"), 1, 1e-12);
  EXPECT_NEAR((value<Vec3d>(*balls[1], "center") - Vec3d(2, 0, 10)).length(), 0, 1e-12);
}

TEST(RadianceSurfaces, ArraysMirrorsAndOtherModifiers) {
  TemporaryFolder folder;
  folder.write("tile.rad", square);
  const std::string scene =
      folder.write("a.rad", grey +
                                "void metal shiny 0 0 5 .9 .9 .9 1 0\n"
                                "!xform -m shiny -a 3 -t 2 0 0 -a 2 -t 0 3 0 tile.rad\n"
                                "!xform -mx tile.rad\n!xform -I tile.rad\n");
  const auto loaded = load_radiance(scene);
  const auto meshes = rad_objects(loaded, "shape");
  ASSERT_EQ(meshes.size(), 2u);
  EXPECT_NEAR(area_of(*meshes[0]), 6, 1e-6);
  EXPECT_EQ(front_bsdf(*meshes[0]).type, "conductor");
  const auto t = triangles_of(*meshes[0]);
  Vec3d high(0, 0, 0);
  for (const Vec3d& p : t) high = {std::max(high.x, p.x), std::max(high.y, p.y), 0};
  EXPECT_EQ(high, Vec3d(5, 4, 0));
  // A mirrored polygon still faces up, an inverted one down.
  EXPECT_NEAR(area_vector_of(*meshes[1]).z, 0, 1e-6);
  EXPECT_NEAR(area_of(*meshes[1]), 2, 1e-6);
}

TEST(RadianceSurfaces, CopiesShareTheirMaterial) {
  TemporaryFolder folder;
  folder.write("tile.rad", grey + square);
  const auto scene = load_radiance(folder.write("a.rad", "!xform -a 5 -t 2 0 0 tile.rad\n"));
  EXPECT_NEAR(area_of(sole_object(scene, "shape")), 5, 1e-6);
}

TEST(RadianceSurfaces, ProgramsThatWriteForOneAnother) {
  const auto scene = parse_rad(grey + "!genbox grey box 1 2 3 | xform -t 1 0 0 | xform -s 2\n");
  const auto t = triangles_of(sole_object(scene, "shape"));
  Vec3d low = t[0], high = t[0];
  for (const Vec3d& p : t)
    for (int i = 0; i < 3; ++i) low[i] = std::min(low[i], p[i]), high[i] = std::max(high[i], p[i]);
  EXPECT_EQ(low, Vec3d(2, 0, 0));
  EXPECT_EQ(high, Vec3d(4, 4, 6));
  EXPECT_NEAR(volume_of(sole_object(scene, "shape")), 48, 1e-4);
}

TEST(RadianceSurfaces, WhatIsLeftOutIsTold) {
  EXPECT_TRUE(tells(parse_rad("void sphere s 0 0 4 0 0 0 1\n"), DeviationKind::ignored,
                    "sphere 's'", "void"));
  EXPECT_TRUE(tells(surface("instance i 1 no.oct 0 0"), DeviationKind::missing, "instance 'i'"));
  EXPECT_TRUE(tells(surface("mesh i 1 no.rtm 0 0"), DeviationKind::missing, "mesh 'i'"));
  EXPECT_TRUE(tells(surface("polygon p 0 0 9 0 0 0 1 0 0 2 0 0"), DeviationKind::ignored,
                    "polygon 'p'", "no area"));
}

// Generators: closed bodies have the volume that they should, and face outward.
TEST(RadianceGenerators, ClosedBodies) {
  const auto volume = [](const std::string& command) {
    return volume_of(sole_object(parse_rad(grey + "!" + command + "\n"), "shape"));
  };
  EXPECT_NEAR(volume("genbox grey b 1 2 3"), 6, 1e-5);
  EXPECT_NEAR(volume("genbox grey b 1 2 3 -i"), -6, 1e-5);
  // Bevels cut 12 edges by b²/2 along what is left of them, and 8 corners by 5 b³/6.
  const double b = 0.1;
  EXPECT_NEAR(volume("genbox grey b 1 2 3 -b .1"),
              6 - 4 * (6 - 6 * b) * b * b / 2 - 8 * 5 * b * b * b / 6, 1e-5);
  EXPECT_NEAR(volume("genprism grey p 4 0 0 0 1 1 1 1 0 -l 0 0 2"), 2, 1e-5);
  EXPECT_NEAR(volume("genprism grey p 3 0 0 0 1 1 0 -l .5 .5 2"), 1, 1e-5);
  // A ball by a function of two parameters.
  EXPECT_NEAR(volume("gensurf grey s 'sin(PI*s)*cos(2*PI*t)' 'sin(PI*s)*sin(2*PI*t)' "
                     "'cos(PI*s)' 60 120"),
              4 * pi_d / 3, 0.02);
}

TEST(RadianceGenerators, SmoothSurfacesHaveNormals) {
  const auto scene =
      parse_rad(grey + "!gensurf grey s s t 'bump(s)' 4 4 -s -e 'bump(x) = x * x'\n");
  const auto normals = rad_numbers(sole_object(scene, "shape"), "normals");
  EXPECT_EQ(normals.size(), rad_numbers(sole_object(scene, "shape"), "positions").size());
  // At s = 0.5 the slope is 1.
  const auto positions = rad_numbers(sole_object(scene, "shape"), "positions");
  for (size_t i = 0; i < positions.size(); i += 3)
    if (positions[i] == 0.5) {
      EXPECT_NEAR(normals[i], -std::sqrt(0.5), 1e-6);
      EXPECT_NEAR(normals[i + 2], std::sqrt(0.5), 1e-6);
    }
}

TEST(RadianceSurfaces, FacetsAreSmoothBySurfCal) {
  // Bent by 0.5 u along x, u the coordinate behind the axis z: x.
  const auto scene = parse_rad(
      grey +
      "grey texfunc Phong 4 surf_dx surf_dy surf_dz surf.cal 0 13 2 0 0 0 .5 0 0 0 0 0 0 0 0\n"
      "Phong polygon p 0 0 12 0 0 0 1 0 0 1 1 0 0 1 0\n");
  const Object& mesh = sole_object(scene, "shape");
  const auto positions = rad_numbers(mesh, "positions"), normals = rad_numbers(mesh, "normals");
  for (size_t i = 0; i < positions.size(); i += 3) {
    EXPECT_NEAR(normals[i] / normals[i + 2], 0.5 * positions[i], 1e-6);
    EXPECT_GT(normals[i + 2], 0);
  }
  EXPECT_EQ(deviations_but_view(scene), 0u);
}

// As obj2rad writes them: the normal of a ball about the origin is linear; older files have the
// barycentric coordinates and three normals.
TEST(RadianceSurfaces, FacetsAreSmoothByTmeshCal) {
  const std::string facet = "T polygon p 0 0 9 1 0 0 0 1 0 0 0 1\n";
  for (const std::string texture :
       {"10 2 1 0 0 0 1 0 -1 -1 1", "16 2 1 0 0 0 1 0 1 0 0 0 1 0 0 0 1"}) {
    SCOPED_TRACE(texture);
    const auto scene =
        parse_rad(grey + "grey texfunc T 4 dx dy dz tmesh.cal 0 " + texture + "\n" + facet);
    const Object& mesh = sole_object(scene, "shape");
    const auto positions = rad_numbers(mesh, "positions"), normals = rad_numbers(mesh, "normals");
    for (size_t i = 0; i < positions.size(); ++i) EXPECT_NEAR(normals[i], positions[i], 1e-6);
    EXPECT_EQ(deviations_but_view(scene), 0u);
  }
}

TEST(RadianceGenerators, WormsRevolutionsAndBlinds) {
  const auto worm = parse_rad(grey + "!genworm grey w 't' '0' '0' '.1+.1*t' 2\n");
  EXPECT_EQ(rad_objects(worm, "shape").size(), 4u);  // three balls, and a mesh of two cones
  const auto rev = parse_rad(grey + "!genrev grey r 't' '1' 3\n");
  EXPECT_EQ(rad_objects(rev, "shape").size(), 3u);
  const auto blinds = parse_rad(grey + "!genblinds grey b .1 2 3 10 30\n");
  EXPECT_NEAR(area_of(sole_object(blinds, "shape")), 10 * 0.1 * 2, 1e-5);
  const auto curved = parse_rad(grey + "!genblinds grey b .1 2 3 10 0 -r .08\n");
  EXPECT_NEAR(area_of(sole_object(curved, "shape")), 10 * 2 * 0.16 * std::asin(0.625), 0.002);
  // To the other side, and as deep as a slat of that radius can be.
  const auto other = parse_rad(grey + "!genblinds grey b -9 2 3 10 0 -r .08\n");
  EXPECT_NEAR(area_of(sole_object(other, "shape")), 10 * 2 * 0.08 * pi_d, 0.002);
}

// A short command could fill the memory.
TEST(RadianceGenerators, ManyPartsWithLongNamesAreRefused) {
  const std::string name(100'000, 'n');
  for (const std::string& command :
       {"genrev grey " + name + " t 1+t 10000", "genblinds grey " + name + " .1 1 1 10000 0",
        "genworm grey " + name + " t t t .1 10000", "gensurf grey " + name + " s t 0 100 100"})
    try {
      parse_rad(grey + "!" + command + "\n");
      FAIL() << command.substr(0, 20);
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find("writes more than 32 MiB"), std::string::npos);
    }
}

TEST(RadianceGenerators, DebianCallsGenboxByAnotherName) {
  EXPECT_EQ(
      rad_numbers(sole_object(parse_rad(grey + "!genrbox grey b 1 2 3\n"), "shape"), "positions"),
      rad_numbers(sole_object(parse_rad(grey + "!genbox grey b 1 2 3\n"), "shape"), "positions"));
}

TEST(RadianceGenerators, MarkersAreReplaced) {
  TemporaryFolder folder;
  folder.write("thing.rad", "grey sphere s 0 0 4 1 0 0 .25\n");
  // Legs of 2 along y (x of the object) and 1 along z (its y), from (3, 0, 0).
  folder.write("marks.rad", "mark polygon m 0 0 9 3 2 0 3 0 0 3 0 1\n");
  const auto scene =
      load_radiance(folder.write("a.rad", grey + "!replmarks -s .5 -x thing.rad mark marks.rad\n"));
  const Object& ball = sole_object(scene, "shape");
  EXPECT_NEAR((value<Vec3d>(ball, "center") - Vec3d(3, 1, 0)).length(), 0, 1e-9);
}

TEST(RadianceGenerators, MarksThatAreNotThereAreTold) {
  TemporaryFolder folder;
  const auto scene =
      load_radiance(folder.write("a.rad", grey + "grey sphere s 0 0 4 1 0 0 .25\n"
                                                 "!replmarks -x thing.rad mark no.rad\n"));
  EXPECT_EQ(rad_objects(scene, "shape").size(), 1u);
  EXPECT_TRUE(tells(scene, DeviationKind::missing, "no.rad", ""));
}

}  // namespace
}  // namespace kaustik::radiance_test
