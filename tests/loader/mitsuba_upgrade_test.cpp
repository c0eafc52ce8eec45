// Scenes of Mitsuba 0.x and 2 in terms of 3: types, names, cameras, media, what was left out.

#include "tests/loader/loader_support.h"

namespace kaustik {
namespace {

TEST(MitsubaUpgrade, OldVersionsAreUpgraded) {
  const auto scene = parse(in_scene("<camera type='perspective'>\n"
                                    "<string name='fovAxis' value='smaller'/>\n"
                                    "<float name='nearClip' value='0.1'/>\n"
                                    "<transform name='toWorld'><lookAt origin='0,0,1' "
                                    "target='0,0,0' up='0,1,0'/></transform>\n"
                                    "<sampler type='independent'><integer name='sampleCount' "
                                    "value='4'/></sampler></camera>\n"
                                    "<bsdf type='dielectric'><float name='intIOR' value='1.5'/>"
                                    "<float name='extIOR' value='1'/></bsdf>\n"
                                    "<bsdf type='diffuse'><texture type='bitmap' "
                                    "name='diffuseReflectance'/></bsdf>\n"
                                    "<bsdf type='phong'><rgb name='diffuseReflectance' value='1'/>"
                                    "<srgb name='specularReflectance' value='#ffffff'/></bsdf>\n"
                                    "<luminaire type='point'/>",
                                    "0.6.0"))
                         .scene;
  const Object& sensor = *scene->children.at(0).object;
  EXPECT_EQ(sensor.family, "sensor");
  EXPECT_EQ(value<std::string>(sensor, "fov_axis"), "smaller");
  EXPECT_EQ(value<double>(sensor, "near_clip"), 0.1);
  EXPECT_EQ(value<Transform>(sensor, "to_world").at(2, 3), 1);
  EXPECT_EQ(value<int64_t>(*sensor.children.at(0).object, "sample_count"), 4);
  EXPECT_EQ(value<double>(*scene->children[1].object, "int_ior"), 1.5);
  EXPECT_EQ(value<double>(*scene->children[1].object, "ext_ior"), 1);
  EXPECT_EQ(scene->children[2].object->children.at(0).name, "reflectance");
  // Together they reflect 0.99.
  EXPECT_EQ(value<Rgb>(*scene->children[3].object, "diffuse_reflectance").g, 0.495);
  EXPECT_EQ(value<Rgb>(*scene->children[3].object, "specular_reflectance").b, 0.495);
  EXPECT_EQ(scene->children[4].object->family, "emitter");
}

TEST(MitsubaUpgrade, OldTexturePlacementBecomesATransform) {
  const std::string texture =
      "<texture type='bitmap'><float name='uoffset' value='0.5'/><float name='vscale' value='4'/>"
      "<float name='uscale' value='2'/></texture>";
  const auto old = parse(in_scene(texture, "0.5.0")).scene->children.at(0).object;
  ASSERT_EQ(old->properties.size(), 1u);
  const Transform& to_uv = value<Transform>(*old, "to_uv");
  EXPECT_EQ(to_uv.at(0, 0), 2);
  EXPECT_EQ(to_uv.at(1, 1), 4);
  EXPECT_EQ(to_uv.at(0, 3), 0.5);  // the offset is not scaled
  EXPECT_EQ(parse(in_scene(texture, "2.0.0")).scene->children.at(0).object->properties.size(), 3u);
}

TEST(MitsubaUpgrade, OldTexturesAreBroughtUpToDate) {
  const std::string texture =
      "<texture type='bitmap'><float name='uvscale' value='3'/><float name='voffset' value='1'/>"
      "<string name='filterType' value='trilinear'/><string name='wrapModeU' value='black'/>"
      "<string name='wrapModeV' value='mirror'/><float name='gamma' value='1'/></texture>"
      "<texture type='vertexcolors'/>"
      "<bsdf type='x'><string name='wrapMode' value='white'/></bsdf>";
  const auto old = parse(in_scene(texture, "0.6.0")).scene;
  const Object& bitmap = *old->children.at(0).object;
  const Transform& to_uv = value<Transform>(bitmap, "to_uv");
  EXPECT_EQ(to_uv.at(0, 0), 3);
  EXPECT_EQ(to_uv.at(1, 1), 3);
  EXPECT_EQ(to_uv.at(1, 3), 1);
  EXPECT_EQ(value<std::string>(bitmap, "filter_type"), "bilinear");
  EXPECT_EQ(value<std::string>(bitmap, "wrap_mode_u"), "zero");
  EXPECT_EQ(value<std::string>(bitmap, "wrap_mode_v"), "mirror");
  EXPECT_EQ(value<double>(bitmap, "gamma"), 1);
  EXPECT_EQ(old->children.at(1).object->type, "mesh_attribute");
  EXPECT_EQ(value<std::string>(*old->children.at(1).object, "name"), "vertex_color");
  EXPECT_EQ(value<std::string>(*old->children.at(2).object, "wrap_mode"), "white");
  const auto present = parse(in_scene(texture, "3.0.0")).scene;
  EXPECT_EQ(value<std::string>(*present->children.at(0).object, "wrapModeU"), "black");
  EXPECT_EQ(present->children.at(1).object->type, "vertexcolors");
}

// What no metal was named of was copper before version 2, and is a perfect mirror since.
TEST(MitsubaUpgrade, OldConductorsAreOfCopper) {
  const auto conductor = [](const std::string& inside, const std::string& version) {
    return parse(in_scene("<bsdf type='roughconductor'>" + inside + "</bsdf>", version))
        .scene->children.at(0)
        .object;
  };
  const std::string rough = "<float name='alpha' value='0.2'/>",
                    index = "<spectrum name='eta' value='0.2'/><spectrum name='k' value='3'/>";
  EXPECT_EQ(value<std::string>(*conductor(rough, "0.6.0"), "material"), "cu");
  EXPECT_EQ(conductor(rough, "2.0.0")->properties.size(), 1u);
  EXPECT_EQ(conductor(index, "0.5.0")->properties.size(), 2u);
  const std::string gold = "<string name='material' value='Au'/>";
  EXPECT_EQ(value<std::string>(*conductor(gold, "0.6.0"), "material"), "Au");
}

TEST(MitsubaUpgrade, NewVersionsAreNotUpgraded) {
  for (const std::string version : {"2.0.0", "2.2.1", "3.0.0", "3.7.1"}) {
    const auto scene =
        parse(in_scene("<shape type='s'><float name='toWorld' value='1'/></shape>", version)).scene;
    EXPECT_EQ(scene->children.at(0).object->properties.at(0).name, "toWorld");
  }
}

TEST(MitsubaUpgrade, EachFileHasItsOwnVersion) {
  const TemporaryFolder folder;
  folder.write("old.xml",
               in_scene("<shape type='s'><float name='aB' value='1'/></shape>", "0.6.0"));
  const std::string path =
      folder.write("new.xml", in_scene("<include filename='old.xml'/><shape type='s'>"
                                       "<float name='aB' value='1'/></shape>"));
  const auto scene = load_mitsuba_xml(path).scene;
  EXPECT_EQ(scene->children.at(0).object->properties.at(0).name, "a_b");
  EXPECT_EQ(scene->children.at(1).object->properties.at(0).name, "aB");
}

TEST(MitsubaUpgrade, OldTypesAndNamesAreUpgraded) {
  const auto old = [](const std::string& inside, const std::string& version) {
    return parse(in_scene(inside, version)).scene->children.at(0).object;
  };
  EXPECT_EQ(old("<bsdf type='bump'/>", "0.4.4")->type, "bumpmap");
  EXPECT_EQ(old("<bsdf type='bump'/>", "0.5.0")->type, "bumpmap");
  const auto glass =
      old("<bsdf type='roughglass'><float name='alphaX' value='1'/></bsdf>", "0.2.1");
  EXPECT_EQ(glass->type, "roughdielectric");
  EXPECT_EQ(glass->properties.at(0).name, "alpha_u");
  const std::string lamp =
      "<luminaire type='directional'><float name='intensity' value='1'/>"
      "</luminaire>";
  EXPECT_EQ(old(lamp, "0.3.0")->properties.at(0).name, "irradiance");
  EXPECT_EQ(old(lamp, "0.4.0")->properties.at(0).name, "intensity");
  const std::string pipe =
      "<shape type='cylinder'><point name='p1' value='1,2,3'/>"
      "<point name='p2' value='4,5,6'/></shape>";
  EXPECT_EQ(value<Vec3d>(*old(pipe, "0.2.0"), "p1"), Vec3d(4, 5, 6));
  EXPECT_EQ(value<Vec3d>(*old(pipe, "0.2.0"), "p0"), Vec3d(1, 2, 3));
  EXPECT_EQ(value<Vec3d>(*old(pipe, "0.6.0"), "p1"), Vec3d(1, 2, 3));
}

TEST(MitsubaUpgrade, OldCamerasTellOfTheSmallerSide) {
  const auto axis = [](const std::string& inside, const std::string& version) {
    const auto scene =
        parse(in_scene("<camera type='perspective'>" + inside + "</camera>", version)).scene;
    const Object& camera = *scene->children.at(0).object;
    return camera.properties.empty() ? "" : value<std::string>(camera, "fov_axis");
  };
  EXPECT_EQ(axis("", "0.3.0"), "smaller");
  EXPECT_EQ(axis("<boolean name='mapSmallerSide' value='false'/>", "0.3.0"), "larger");
  EXPECT_EQ(axis("<string name='fovAxis' value='y'/>", "0.3.0"), "y");
  EXPECT_EQ(axis("", "0.4.0"), "");
}

TEST(MitsubaUpgrade, OfMotionTheStartHolds) {
  const std::string shape =
      "<shape type='sphere'><animation name='to_world'>"
      "<transform time='0'><translate x='1'/></transform>"
      "<transform time='1'><translate x='2'/></transform></animation></shape>";
  const Description description = parse_inside(shape + shape);
  EXPECT_EQ(value<Transform>(*description.scene->children.at(1).object, "to_world"),
            Transform::translate({1, 0, 0}));
  ASSERT_EQ(description.warnings.size(), 1u);
  EXPECT_NE(description.warnings[0].find("test.xml:2:22: motion comes later"), std::string::npos)
      << description.warnings[0];
  EXPECT_NE(description.warnings[0].find("1 more like it"), std::string::npos);
  expect_problem(problems_in(in_scene("<shape type='s'><animation name='to_world'/></shape>")),
                 "test.xml:2:17", "without a transform", "transform time");
  expect_problem(problems_in(in_scene("<shape type='s'><animation name='to_world'><transform/>"
                                      "</animation></shape>")),
                 "test.xml:2:44", "<transform> lacks the attribute 'time'", "time");
  expect_problem(problems_in(in_scene("<shape type='s'><animation name='to_world'><rotate x='1' "
                                      "angle='1'/></animation></shape>")),
                 "test.xml:2:44", "<rotate> cannot stand in <animation>", "transform time");
}

TEST(MitsubaUpgrade, SubsurfaceScatteringIsLeftOut) {
  const std::string shape = "<shape type='sphere'><subsurface type='dipole'/></shape>";
  const Description description = parse_inside(shape);
  ASSERT_EQ(description.warnings.size(), 1u);
  EXPECT_NE(description.warnings[0].find("subsurface scattering comes later"), std::string::npos);
  LoadOptions strict;
  strict.is_strict = true;
  EXPECT_EQ(problems_in(in_scene(shape), strict).at(0).message, "unknown element <subsurface>");
}

TEST(MitsubaUpgrade, VersionsMayBeShortOrMissing) {
  const auto name = [](const std::string& version) {
    const auto scene =
        parse("<scene" + version + "><shape type='s'><float name='aB' value='1'/></shape></scene>");
    return scene.scene->children.at(0).object->properties.at(0).name;
  };
  EXPECT_EQ(name(" version='3'"), "aB");
  EXPECT_EQ(name(" version='0.6'"), "a_b");
  EXPECT_EQ(name(""), "a_b");
  EXPECT_NE(lenient_warning("<scene><emitter type='point'/></scene>")
                .find("lacks its version: it is read as one of Mitsuba 0.2"),
            std::string::npos);
}

TEST(MitsubaUpgrade, OldShapesWithAMediumAreBoundaries) {
  const auto bsdf_of = [](const std::string& inside, const std::string& version) {
    const auto scene = parse(in_scene("<medium type='homogeneous' id='fog'/><shape type='sphere'>" +
                                          inside + "</shape>",
                                      version))
                           .scene;
    for (const Child& child : scene->children.at(1).object->children)
      if (child.object->family == "bsdf") return child.object->type;
    return std::string("none");
  };
  const std::string fog = "<ref name='interior' id='fog'/>";
  EXPECT_EQ(bsdf_of(fog, "0.6.0"), "null");
  EXPECT_EQ(bsdf_of(fog, "2.0.0"), "none");
  EXPECT_EQ(bsdf_of("", "0.6.0"), "none");
  EXPECT_EQ(bsdf_of(fog + "<bsdf type='dielectric'/>", "0.6.0"), "dielectric");
  EXPECT_EQ(bsdf_of(fog + "<emitter type='area'/>", "0.6.0"), "none");
}

TEST(MitsubaUpgrade, NamesOfDialects) {
  const auto bsdf = parse_inside("<bsdf type='roughconductorGGX'/>").scene->children.at(0).object;
  EXPECT_EQ(bsdf->type, "roughconductor");
  EXPECT_EQ(value<std::string>(*bsdf, "distribution"), "ggx");
  EXPECT_EQ(
      parse(in_scene("<shape type='Rectangle'/>", "0.6.0")).scene->children.at(0).object->type,
      "rectangle");
  EXPECT_EQ(parse_inside("<shape type='Rectangle'/>").scene->children.at(0).object->type,
            "Rectangle");
  const Description metals = parse_inside(
      "<bsdf type='disneymetal'><float name='eta' value='1.5'/>"
      "<float name='specular' value='0.5'/></bsdf>");
  ASSERT_EQ(metals.warnings.size(), 1u);
  EXPECT_NE(metals.warnings[0].find("'specular' is left out"), std::string::npos);
  const auto metal = metals.scene->children.at(0).object;
  EXPECT_EQ(metal->type, "principled");
  EXPECT_EQ(metal->properties.size(), 2u);
  EXPECT_EQ(value<double>(*metal, "metallic"), 1);
  EXPECT_EQ(parse_inside("<bsdf type='mirror'/>").scene->children.at(0).object->type, "conductor");
  const auto sky = parse_inside("<background><rgb name='radiance' value='1'/></background>")
                       .scene->children.at(0)
                       .object;
  EXPECT_EQ(sky->family, "emitter");
  EXPECT_EQ(sky->type, "constant");
}

// As Mitsuba 0.6 does it: together they reflect at most 0.99.
TEST(MitsubaUpgrade, OldReflectancesThatMakeLightAreScaled) {
  const std::string phong =
      "<bsdf type='phong'><rgb name='diffuseReflectance' value='0.8, 0.2, 0.1'/>"
      "<rgb name='specularReflectance' value='0.4, 0, 0'/></bsdf>";
  const Description old = parse(in_scene(phong + "<emitter type='point'/>", "0.6.0"));
  EXPECT_EQ(old.warnings.size(), 1u);
  const Object& bsdf = *old.scene->children.at(0).object;
  EXPECT_NEAR(value<Rgb>(bsdf, "diffuse_reflectance").r, 0.8 * 0.99 / 1.2, 1e-12);
  EXPECT_NEAR(value<Rgb>(bsdf, "specular_reflectance").r, 0.4 * 0.99 / 1.2, 1e-12);
  EXPECT_NEAR(value<Rgb>(bsdf, "diffuse_reflectance").b, 0.1 * 0.99 / 1.2, 1e-12);
}

TEST(MitsubaUpgrade, OfTwoValuesInOldFilesTheLastHolds) {
  const std::string twice =
      "<shape type='s'><float name='x' value='1'/><float name='x' value='2'/>"
      "</shape>";
  const Description old = parse(in_scene(twice + "<emitter type='point'/>", "0.6.0"));
  EXPECT_EQ(value<double>(*old.scene->children.at(0).object, "x"), 2);
  EXPECT_EQ(old.warnings.size(), 1u);
  expect_problem(problems_in(in_scene(twice)), "test.xml:2:44", "'x' is given twice", "keep one");
}

/// Mitsuba 0.6 rendered the last one, later versions the first.
TEST(MitsubaUpgrade, OldScenesWithoutEmittersAreNotDark) {
  const std::string shape =
      "<shape type='s' id='a'/><shape type='shapegroup'><ref id='a'/></shape>";
  for (const std::string version : {"2.0.0", "3.0.0"})
    EXPECT_EQ(parse(in_scene(shape, version)).scene->children.size(), 2u);
  for (const std::string version : {"0.6.0", "0.4.0", "0.3.0"}) {
    const Description lit = parse(in_scene(shape, version));
    ASSERT_EQ(lit.scene->children.size(), 3u);
    const Object& emitter = *lit.scene->children[2].object;
    EXPECT_EQ(emitter.family, "emitter");
    EXPECT_EQ(emitter.type, version == "0.3.0" ? "constant" : "sunsky");
    ASSERT_EQ(lit.warnings.size(), 1u);
    EXPECT_NE(lit.warnings[0].find("test.xml:1:1: the scene has no emitter: a '" + emitter.type),
              std::string::npos)
        << lit.warnings[0];
    expect_problem(problems_in(in_scene(shape, version), LoadOptions{{}, true}), "test.xml:1:1",
                   "has no emitter", "add one");
  }
  const auto scene = parse(in_scene(shape, "0.6.0")).scene;
  const Object& sky = *scene->children[2].object;
  EXPECT_EQ(value<double>(sky, "sun_scale"), 2);
  EXPECT_EQ(value<double>(sky, "sky_scale"), 2);
  EXPECT_NEAR(value<double>(sky, "sun_aperture"), 15 * 0.5358, 1e-12);
  // The zenith is up, and what would be south, which is +z, is turned by -120 degrees about it.
  const Vec3f up = value<Transform>(sky, "to_world").vector({0, 0, 1});
  const Vec3f south = value<Transform>(sky, "to_world").vector({1, 0, 0});
  EXPECT_LT(length(up - Vec3f(0, 1, 0)), 1e-6f);
  EXPECT_LT(length(south - Vec3f(-0.8660254f, 0, -0.5f)), 1e-6f);
  // One that shapes of a group have is enough.
  const std::string lamp =
      "<shape type='shapegroup'><shape type='s'><emitter type='area'/></shape></shape>";
  EXPECT_EQ(parse(in_scene(lamp, "0.6.0")).scene->children.size(), 1u);
}

// What coefficients a medium of 0.6 does not give are those of skin; those of materials are a
// hundred times what the table says.
TEST(MitsubaUpgrade, OldMedia) {
  const auto medium_of = [](const std::string& inside, const std::string& version = "0.6.0") {
    return parse(in_scene("<medium type='homogeneous'>" + inside + "</medium>", version))
        .scene->children.at(0)
        .object;
  };
  const auto expect_material = [](const Object& medium, const std::string& name, double scale) {
    EXPECT_EQ(medium.properties.size(), 2u);
    EXPECT_EQ(value<std::string>(medium, "material"), name);
    EXPECT_EQ(value<double>(medium, "scale"), scale);
  };
  expect_material(*medium_of(""), "skin1", 100);
  expect_material(*medium_of("<float name='scale' value='0.5'/>"), "skin1", 50);
  expect_material(*medium_of("<string name='material' value='Regular Milk'/>"), "regular milk",
                  100);
  const std::string in_lower_case = "<string name='material' value='skin2'/>";
  EXPECT_EQ(medium_of(in_lower_case, "3.0.0")->properties.size(), 1u);
  EXPECT_EQ(medium_of("", "3.0.0")->properties.size(), 0u);
  const auto scattering = medium_of("<rgb name='sigmaS' value='1 2 3'/>");
  EXPECT_EQ(value<Rgb>(*scattering, "sigma_s"), (Rgb{1, 2, 3}));
  EXPECT_EQ(value<Rgb>(*scattering, "sigma_a"), (Rgb{3.2, 17, 48}));
  EXPECT_EQ(scattering->properties.size(), 2u);
  EXPECT_EQ(value<Rgb>(*medium_of("<rgb name='sigmaA' value='1 2 3'/>"), "sigma_s").g, 88);
  EXPECT_EQ(value<Rgb>(*medium_of("<rgb name='albedo' value='0'/>"), "sigma_t").r, 77.2);
  EXPECT_NEAR(value<Rgb>(*medium_of("<rgb name='sigmaT' value='0'/>"), "albedo").b, 101.0 / 149,
              1e-12);
}

// Before 0.4 the left of a <camera>'s picture was the right, and before 0.3 a lookAt by numbers
// exchanged them once more.
TEST(MitsubaUpgrade, OldCamerasAreMirrored) {
  const auto left_of = [](const std::string& tag, const std::string& look_at,
                          const std::string& version) {
    const std::string name = version < "2" ? "toWorld" : "to_world";
    const auto scene = parse(in_scene("<" + tag + " type='perspective'><transform name='" + name +
                                          "'>" + look_at + "</transform></" + tag + ">",
                                      version))
                           .scene;
    const Transform to_world = value<Transform>(*scene->children.at(0).object, "to_world");
    EXPECT_LT(length(to_world.point({0, 0, 0}) - Vec3f(0, 0, 4)), 1e-6f);
    EXPECT_LT(length(to_world.vector({0, 0, 1}) - Vec3f(0, 0, -1)), 1e-6f);
    EXPECT_LT(length(to_world.vector({0, 1, 0}) - Vec3f(0, 1, 0)), 1e-6f);
    return to_world.vector({1, 0, 0}).x;
  };
  const std::string texts = "<lookAt origin='0,0,4' target='0,0,0' up='0,1,0'/>";
  const std::string numbers =
      "<lookAt ox='0' oy='0' oz='4' tx='0' ty='0' tz='0' ux='0' uy='1' uz='0'/>";
  const float left = left_of("sensor", texts, "0.6.0");
  EXPECT_NEAR(std::abs(left), 1, 1e-6);
  EXPECT_NEAR(left_of("camera", texts, "0.4.0"), left, 1e-6);
  EXPECT_NEAR(left_of("sensor", texts, "0.3.0"), left, 1e-6);
  EXPECT_NEAR(left_of("camera", texts, "0.3.0"), -left, 1e-6);
  EXPECT_NEAR(left_of("camera", texts, "0.2.0"), -left, 1e-6);
  EXPECT_NEAR(left_of("camera", numbers, "0.2.0"), left, 1e-6);
  EXPECT_NEAR(left_of("sensor", numbers, "0.2.0"), -left, 1e-6);
  // Later versions do not know it.
  EXPECT_FALSE(problems_in(in_scene("<sensor type='perspective'><transform name='toWorld'>" +
                                        numbers + "</transform></sensor>",
                                    "0.3.0"))
                   .empty());
}

// Before 0.3 amounts multiplied reflectances.
TEST(MitsubaUpgrade, AmountsOfOldBsdfs) {
  const auto bsdf_of = [](const std::string& type, const std::string& inside,
                          const std::string& version = "0.2.0") {
    return parse(in_scene("<texture type='bitmap' id='t'/><bsdf type='" + type + "'>" + inside +
                              "</bsdf>",
                          version))
        .scene->children.at(1)
        .object;
  };
  const std::string half = "<float name='diffuseAmount' value='0.5'/>";
  const auto plain = bsdf_of("phong", "");
  EXPECT_EQ(value<double>(*plain, "diffuse_reflectance"), 0.5);
  EXPECT_EQ(value<double>(*plain, "specular_reflectance"), 0.2);
  EXPECT_EQ(value<double>(*bsdf_of("ward", half), "diffuse_reflectance"), 0.25);
  const auto microfacet = bsdf_of("microfacet", half);
  EXPECT_EQ(microfacet->type, "roughplastic");
  EXPECT_EQ(value<double>(*microfacet, "diffuse_reflectance"), 0);
  EXPECT_EQ(value<double>(*microfacet, "specular_reflectance"), 1);
  const auto coloured =
      bsdf_of("phong", half + "<rgb name='diffuseReflectance' value='.2 .4 .6'/>");
  EXPECT_EQ(value<Rgb>(*coloured, "diffuse_reflectance"), (Rgb{0.1, 0.2, 0.3}));
  EXPECT_EQ(coloured->properties.size(), 2u);
  const auto expect_scaled = [](const Object& bsdf) {
    const Child& child = bsdf.children.at(0);
    EXPECT_EQ(child.name, "diffuse_reflectance");
    EXPECT_EQ(child.object->type, "scale");
    EXPECT_EQ(value<double>(*child.object, "scale"), 0.5);
    EXPECT_EQ(child.object->children.at(0).object->type, "bitmap");
    for (const Property& property : bsdf.properties)
      EXPECT_EQ(property.name, "specular_reflectance");
  };
  expect_scaled(*bsdf_of("phong", half + "<texture type='bitmap' name='diffuseReflectance'/>"));
  expect_scaled(*bsdf_of("phong", half + "<ref id='t' name='diffuseReflectance'/>"));
  // Without an amount a texture is what it is.
  EXPECT_EQ(
      bsdf_of("phong", "<ref id='t' name='diffuseReflectance'/>")->children.at(0).object->type,
      "bitmap");
  EXPECT_TRUE(bsdf_of("phong", "", "0.3.0")->properties.empty());
}

TEST(MitsubaUpgrade, WhatShapesAndMirrorsWereBefore03) {
  const auto first = [](const std::string& inside, const std::string& version) {
    return parse(in_scene(inside + "<emitter type='point'/>", version))
        .scene->children.at(0)
        .object;
  };
  const std::string lamp = "<shape type='s'><luminaire type='area'/></shape>";
  EXPECT_EQ(first(lamp, "0.2.0")->children.at(1).object->type, "diffuse");
  EXPECT_EQ(first(lamp, "0.3.0")->children.size(), 1u);
  EXPECT_EQ(first("<shape type='s'><bsdf type='b'/></shape>", "0.2.0")->children.size(), 1u);
  EXPECT_EQ(value<std::string>(*first("<bsdf type='mirror'/>", "0.2.0"), "material"), "cr");
  EXPECT_TRUE(first("<bsdf type='mirror'/>", "0.3.0")->properties.empty());
  EXPECT_EQ(
      value<double>(*first("<bsdf type='roughmetal'><float name='ior' value='2'/></bsdf>", "0.2.0"),
                    "eta"),
      2);
}

// In 0.6 nested bsdfs count in the order of the file, later by their names.
TEST(MitsubaUpgrade, NamesOfBsdfsInOldBlends) {
  const std::string blend =
      "<bsdf type='d' id='x'/><bsdf type='blendbsdf'><ref name='b' id='x'/><bsdf name='a' "
      "type='d'/></bsdf>";
  const auto names = [&](const std::string& version) {
    const auto scene = parse(in_scene(blend, version)).scene;
    std::string result;
    for (const Child& child : scene->children.at(1).object->children) result += child.name + ",";
    return result;
  };
  EXPECT_EQ(names("0.6.0"), ",,");
  EXPECT_EQ(names("3.0.0"), "b,a,");
}

}  // namespace
}  // namespace kaustik
