// What Mitsuba 3 lacks becomes what it has.

#include "kaustik/loader/mitsuba3_terms.h"

#include <map>
#include <string>

#include "kaustik/base/daylight_units.h"
#include "kaustik/loader/mitsuba_writer.h"
#include "kaustik/scene/description_digest.h"
#include "kaustik/scene/type_tables.h"
#include "tests/loader/loader_support.h"

namespace kaustik {
namespace {

Mitsuba3Scene translated(const std::string& inside, const std::string& version = "3.0.0") {
  return in_terms_of_mitsuba3(parse(in_scene(inside, version)), scene_types());
}

const Object& first_of(const Mitsuba3Scene& scene) {
  return *scene.description.scene->children.at(0).object;
}

bool has_property(const Object& object, const std::string& name) {
  for (const Property& p : object.properties)
    if (p.name == name) return true;
  return false;
}

bool tells(const Mitsuba3Scene& scene, const std::string& text) {
  for (const std::string& remark : scene.remarks)
    if (remark.find(text) != std::string::npos) return true;
  return false;
}

TEST(Mitsuba3Terms, WhatMitsuba3HasStays) {
  const std::string text = in_scene(
      "<sensor type='perspective'><film type='hdrfilm'><integer name='width' value='8'/><rfilter "
      "type='mitchell'/></film><sampler type='stratified'/></sensor><integrator type='path'>"
      "<integer name='max_depth' value='5'/></integrator><bsdf type='roughconductor' id='metal'>"
      "<float name='alpha' value='0.2'/><boolean name='sample_visible' value='true'/></bsdf>"
      "<shape type='sphere'><ref id='metal'/></shape><shape type='disk'><ref id='metal'/></shape>");
  const Description scene = parse(text);
  const Mitsuba3Scene same = in_terms_of_mitsuba3(scene, scene_types());
  EXPECT_EQ(description_digest(same.description, scene_types()),
            description_digest(scene, scene_types()));
  EXPECT_EQ(same.version, "3.0.0");
  EXPECT_TRUE(same.remarks.empty()) << same.remarks[0];
  // Shared as before, and none of the original.
  const auto& children = same.description.scene->children;
  EXPECT_EQ(children.at(3).object->children.at(0).object,
            children.at(4).object->children.at(0).object);
  EXPECT_NE(children.at(2).object, scene.scene->children.at(2).object);
}

TEST(Mitsuba3Terms, FilmsSamplersAndIntegrators) {
  const Mitsuba3Scene scene = translated(
      "<sensor type='perspective'><film type='ldrfilm'><integer name='width' value='8'/><float "
      "name='exposure' value='2'/><boolean name='banner' value='false'/></film><sampler "
      "type='halton'><integer name='sample_count' "
      "value='4'/></sampler></sensor><integrator type='mlt'><integer name='max_depth' value='5'/>"
      "<boolean name='bidirectional' value='true'/></integrator>");
  const Object& sensor = first_of(scene);
  const Object& film = *sensor.children.at(0).object;
  EXPECT_EQ(film.type, "hdrfilm");
  EXPECT_EQ(value<int64_t>(film, "width"), 8);
  EXPECT_FALSE(has_property(film, "banner"));
  EXPECT_EQ(sensor.children.at(1).object->type, "independent");
  EXPECT_EQ(value<int64_t>(*sensor.children.at(1).object, "sample_count"), 4);
  const Object& integrator = *scene.description.scene->children.at(1).object;
  EXPECT_EQ(integrator.type, "path");
  EXPECT_EQ(value<int64_t>(integrator, "max_depth"), 5);
  EXPECT_FALSE(has_property(integrator, "bidirectional"));
  EXPECT_TRUE(tells(scene, "integrator 'mlt' becomes 'path', which misses caustics"));
  EXPECT_TRUE(tells(scene, "film 'ldrfilm' becomes 'hdrfilm'"));
  EXPECT_TRUE(tells(scene, "'banner' of film 'hdrfilm' is left out"));
  EXPECT_TRUE(tells(scene, "test.xml:2:1"));
  const Mitsuba3Scene foggy =
      translated("<integrator type='bdpt'/><medium type='homogeneous' id='fog'/>");
  EXPECT_EQ(first_of(foggy).type, "volpath");
  // There it needs them, though they have no effect here.
  const Mitsuba3Scene layers = translated(
      "<integrator type='aov'><string name='aovs' value='z:depth'/><integrator type='path'/>"
      "</integrator>");
  EXPECT_EQ(value<std::string>(first_of(layers), "aovs"), "z:depth");
}

/// Share of light that the nested grey bsdfs reflect in all.
double reflectance_of(const Object& bsdf) {
  if (bsdf.type == "diffuse") return value<double>(bsdf, "reflectance");
  EXPECT_EQ(bsdf.type, "blendbsdf");
  const double weight = value<double>(bsdf, "weight");
  return (1 - weight) * reflectance_of(*bsdf.children.at(0).object) +
         weight * reflectance_of(*bsdf.children.at(1).object);
}

TEST(Mitsuba3Terms, MixturesAreBlends) {
  const auto mixed = [](const std::string& weights, int count) {
    std::string inside =
        "<bsdf type='mixturebsdf' id='m'><string name='weights' value='" + weights + "'/>";
    for (const char* grey : {"0.8", "0.4", "0.1"})
      if (count-- > 0)
        inside += std::string("<bsdf type='diffuse'><float name='reflectance' value='") + grey +
                  "'/></bsdf>";
    return translated(inside + "</bsdf>");
  };
  EXPECT_EQ(first_of(mixed("0.25, 0.75", 2)).type, "blendbsdf");
  EXPECT_EQ(first_of(mixed("0.25, 0.75", 2)).id, "m");
  EXPECT_NEAR(reflectance_of(first_of(mixed("0.25, 0.75", 2))), 0.25 * 0.8 + 0.75 * 0.4, 1e-12);
  EXPECT_NEAR(reflectance_of(first_of(mixed("0.2 0.3 0.5", 3))), 0.16 + 0.12 + 0.05, 1e-12);
  // What weights lack of 1 is absorbed; what they are above it they are divided by.
  EXPECT_NEAR(reflectance_of(first_of(mixed("0.2 0.3", 2))), 0.16 + 0.12, 1e-12);
  EXPECT_NEAR(reflectance_of(first_of(mixed("1 3", 2))), 0.2 + 0.3, 1e-12);
  EXPECT_NEAR(reflectance_of(first_of(mixed("1", 1))), 0.8, 1e-12);
  // What is wrong stays, for those who tell.
  EXPECT_EQ(first_of(mixed("1", 2)).type, "mixturebsdf");
  EXPECT_TRUE(tells(mixed("1", 2), "Mitsuba 3 has no bsdf 'mixturebsdf'"));
}

/// How much of each g the nested phase functions have.
void add_shares(const Object& phase, double share, std::map<double, double>& shares) {
  if (phase.type == "hg") {
    shares[value<double>(phase, "g")] += share;
    return;
  }
  ASSERT_EQ(phase.type, "blendphase");
  const double weight = value<double>(phase, "weight");
  add_shares(*phase.children.at(0).object, (1 - weight) * share, shares);
  add_shares(*phase.children.at(1).object, weight * share, shares);
}

TEST(Mitsuba3Terms, MixturesOfPhaseFunctionsAreBlends) {
  const Mitsuba3Scene scene = translated(
      "<medium type='homogeneous'><phase type='mixturephase'><string name='weights' value='1, 3, "
      "4'/><phase type='hg'><float name='g' value='0.1'/></phase><phase type='hg'><float name='g' "
      "value='0.2'/></phase><phase type='hg'><float name='g' value='0.3'/></phase></phase>"
      "</medium>");
  std::map<double, double> shares;
  add_shares(*first_of(scene).children.at(0).object, 1, shares);
  EXPECT_NEAR(shares[0.1], 0.125, 1e-12);
  EXPECT_NEAR(shares[0.2], 0.375, 1e-12);
  EXPECT_NEAR(shares[0.3], 0.5, 1e-12);
  EXPECT_TRUE(scene.remarks.empty());
}

TEST(Mitsuba3Terms, WhatDoesNotShineIsMatt) {
  const std::string zero = "<rgb name='specular_reflectance' value='0'/>",
                    green = "<rgb name='diffuse_reflectance' value='0.1, 0.5, 0.1'/>";
  for (const char* type : {"phong", "ward"}) {
    const auto bsdf = [&](const std::string& inside) {
      return translated("<bsdf type='" + std::string(type) + "'>" + inside + "</bsdf>");
    };
    EXPECT_EQ(first_of(bsdf(zero + green)).type, "diffuse");
    EXPECT_EQ(value<Rgb>(first_of(bsdf(zero + green)), "reflectance"), (Rgb{0.1, 0.5, 0.1}));
    EXPECT_EQ(first_of(bsdf(zero + green)).properties.size(), 1u);
    EXPECT_EQ(first_of(bsdf(green)).type, type);
    EXPECT_EQ(first_of(bsdf("<rgb name='specular_reflectance' value='0, 0, 0.1'/>")).type, type);
    EXPECT_EQ(first_of(bsdf(zero + "<texture type='checkerboard' name='diffuse_reflectance'/>"))
                  .children.at(0)
                  .name,
              "reflectance");
    EXPECT_EQ(first_of(bsdf("<texture type='checkerboard' name='specular_reflectance'/>")).type,
              type);
  }
  const std::string smooth = "<float name='alpha' value='0'/>";
  EXPECT_EQ(first_of(translated("<bsdf type='roughdiffuse'>" + smooth + "</bsdf>")).type,
            "diffuse");
  EXPECT_EQ(first_of(translated("<bsdf type='roughdiffuse'/>")).type, "roughdiffuse");
}

// What Kaustik takes for a parameter that it knows stays one.
TEST(Mitsuba3Terms, CamelCaseBecomesSnakeCase) {
  const Mitsuba3Scene scene = translated(
      "<bsdf type='plastic'><rgb name='diffuseReflectance' value='0.3'/><float name='intIor' "
      "value='1.4'/><float name='int_ior' value='1.6'/></bsdf>");
  EXPECT_EQ(value<Rgb>(first_of(scene), "diffuse_reflectance"), (Rgb{0.3, 0.3, 0.3}));
  EXPECT_EQ(value<double>(first_of(scene), "int_ior"), 1.6);
  EXPECT_EQ(first_of(scene).properties.size(), 2u);
}

TEST(Mitsuba3Terms, SheetsAndMetals) {
  const Object sheet = first_of(translated(
      "<bsdf type='difftrans'><rgb name='transmittance' value='0.1, 0.5, 0.1'/></bsdf>"));
  EXPECT_EQ(sheet.type, "principledthin");
  EXPECT_EQ(value<Rgb>(sheet, "base_color"), (Rgb{0.1, 0.5, 0.1}));
  EXPECT_EQ(value<double>(sheet, "diff_trans"), 2);
  const auto metal = [](const std::string& outside) {
    return translated(
        "<bsdf type='conductor'><rgb name='eta' value='1, 2, 3'/><float name='k' value='4'/>" +
        outside + "</bsdf>");
  };
  const Mitsuba3Scene wet = metal("<float name='ext_eta' value='1.25'/>");
  EXPECT_EQ(value<Rgb>(first_of(wet), "eta"), (Rgb{0.8, 1.6, 2.4}));
  EXPECT_EQ(value<double>(first_of(wet), "k"), 3.2);
  EXPECT_FALSE(has_property(first_of(wet), "ext_eta"));
  EXPECT_EQ(value<double>(first_of(metal("<string name='ext_eta' value='air'/>")), "k"),
            4 / 1.000277);
  EXPECT_TRUE(tells(metal("<string name='ext_eta' value='water'/>"), "'ext_eta'"));
  EXPECT_TRUE(tells(translated("<bsdf type='conductor'><string name='material' value='Au'/><float "
                               "name='ext_eta' value='1.25'/></bsdf>"),
                    "'ext_eta'"));
  EXPECT_EQ(value<std::string>(first_of(translated("<bsdf type='roughconductor'><string "
                                                   "name='distribution' value='as'/></bsdf>")),
                               "distribution"),
            "beckmann");
}

TEST(Mitsuba3Terms, LensesOfNoWidthArePinholes) {
  const auto sensor = [](const std::string& inside) {
    return translated("<sensor type='telecentric'>" + inside + "</sensor>");
  };
  EXPECT_EQ(first_of(sensor("")).type, "orthographic");
  EXPECT_EQ(first_of(sensor("<float name='aperture_radius' value='0'/>")).type, "orthographic");
  EXPECT_EQ(first_of(sensor("<float name='aperture_radius' value='0.1'/>")).type, "telecentric");
  EXPECT_EQ(first_of(translated("<sensor type='perspective_rdist'/>")).type, "perspective");
}

TEST(Mitsuba3Terms, MediaHaveExtinctionAndAlbedo) {
  const Mitsuba3Scene scene = translated(
      "<medium type='homogeneous'><rgb name='sigma_s' value='1 2 0'/><float name='sigma_a' "
      "value='1'/></medium>");
  const Object& medium = first_of(scene);
  EXPECT_EQ(value<Rgb>(medium, "sigma_t"), (Rgb{2, 3, 1}));
  EXPECT_EQ(value<Rgb>(medium, "albedo"), (Rgb{0.5, 2.0 / 3, 0}));
  EXPECT_EQ(medium.properties.size(), 2u);
}

// The scale stays, whatever units it was given in.
TEST(Mitsuba3Terms, DaylightIsPerNanometre) {
  const std::string scale = "<float name='sky_scale' value='0.5'/>";
  const Mitsuba3Scene physical = translated("<emitter type='sky'>" + scale + "</emitter>");
  EXPECT_EQ(physical.version, "3.7.0");
  EXPECT_EQ(first_of(physical).type, "sunsky");
  EXPECT_FALSE(has_property(first_of(physical), "units"));
  EXPECT_EQ(value<double>(first_of(physical), "sun_scale"), 0);
  EXPECT_NEAR(value<double>(first_of(physical), "sky_scale") * mitsuba_daylight, 0.5, 1e-12);
  const Mitsuba3Scene old = translated("<emitter type='sunsky'/>", "0.6.0");
  EXPECT_FALSE(has_property(first_of(old), "units"));
  EXPECT_FALSE(has_property(first_of(old), "sun_scale"));
  const std::string text = mitsuba_xml(old.description, scene_types(), "", old.version);
  EXPECT_EQ(value<std::string>(*parse(text).scene->children.at(0).object, "units"), "mitsuba");
}

TEST(Mitsuba3Terms, FlattenedSquaresHaveADepth) {
  const Mitsuba3Scene scene = translated(
      "<shape type='rectangle'><transform name='to_world'><scale value='2, 3, 0'/></transform>"
      "</shape><shape type='cube'><transform name='to_world'><scale value='2, 3, 0'/></transform>"
      "</shape>");
  EXPECT_EQ(value<Transform>(first_of(scene), "to_world"), Transform::scale({2, 3, 1}));
  EXPECT_EQ(
      value<Transform>(*scene.description.scene->children.at(1).object, "to_world").dimensions(),
      2);
}

TEST(Mitsuba3Terms, WhatIsUnknownThereIsNamed) {
  const Mitsuba3Scene scene = translated(
      "<bsdf type='phong'><float name='exponent' value='5'/></bsdf><bsdf type='dielectric'>"
      "<integer name='priority' value='1'/></bsdf><bsdf type='diffuse'><float name='shine' "
      "value='5'/></bsdf>");
  EXPECT_EQ(first_of(scene).type, "phong");
  EXPECT_TRUE(has_property(first_of(scene), "exponent"));
  EXPECT_TRUE(tells(scene, "Mitsuba 3 has no bsdf 'phong'"));
  EXPECT_TRUE(tells(scene, "Mitsuba 3 has no 'priority' in bsdf 'dielectric'"));
  EXPECT_TRUE(tells(scene, "'shine' of bsdf 'diffuse' is left out"));
  EXPECT_FALSE(has_property(*scene.description.scene->children.at(2).object, "shine"));
}

const Object& shape_in(const Mitsuba3Scene& scene, size_t i) {
  return *scene.description.scene->children.at(i).object;
}

// Files are made of what parameters in camelCase say, too.
TEST(Mitsuba3Terms, MeshesOfParametersInCamelCase) {
  const auto part = [](int number) {
    return "<shape type='obj'><string name='filename' value='two.obj'/><integer name='shapeIndex' "
           "value='" +
           std::to_string(number) + "'/></shape>";
  };
  const Mitsuba3Scene parts = translated(part(0) + part(1) + part(0));
  ASSERT_EQ(parts.files.size(), 2u);
  EXPECT_EQ(value<int64_t>(*parts.files[0].source, "shape_index"), 0);
  EXPECT_EQ(value<int64_t>(*parts.files[1].source, "shape_index"), 1);
  EXPECT_EQ(value<std::string>(shape_in(parts, 0), "filename"),
            value<std::string>(shape_in(parts, 2), "filename"));
  EXPECT_NE(value<std::string>(shape_in(parts, 0), "filename"),
            value<std::string>(shape_in(parts, 1), "filename"));
  const Mitsuba3Scene field = translated(
      "<shape type='heightfield'><boolean name='shadingNormals' value='false'/><string "
      "name='filename' value='p.ppm'/></shape>");
  EXPECT_TRUE(value<bool>(first_of(field), "face_normals"));
}

TEST(Mitsuba3Terms, IntegersAreNumbers) {
  const Mitsuba3Scene sky = translated(
      "<emitter type='sky'><integer name='sky_scale' value='1'/><string name='units' "
      "value='physical'/></emitter>");
  EXPECT_NEAR(value<double>(first_of(sky), "sky_scale") * mitsuba_daylight, 1, 1e-12);
  const Mitsuba3Scene metals = translated(
      "<bsdf type='conductor'><integer name='ext_eta' value='2'/><integer name='eta' value='3'/>"
      "<float name='k' value='3'/></bsdf>");
  EXPECT_EQ(value<double>(first_of(metals), "eta"), 1.5);
  EXPECT_FALSE(has_property(first_of(metals), "ext_eta"));
  const Object attribute =
      *first_of(translated("<bsdf type='diffuse'><texture name='reflectance' type='scale'>"
                           "<float name='scale' value='0.5'/><texture type='mesh_attribute'>"
                           "<string name='name' value='vertex_color'/><integer name='scale' "
                           "value='1'/></texture></texture></bsdf>"))
           .children.at(0)
           .object;
  EXPECT_EQ(attribute.type, "mesh_attribute");
  EXPECT_EQ(value<double>(attribute, "scale"), 0.5);
  const Mitsuba3Scene pictures = translated(
      "<bsdf type='diffuse'><texture name='reflectance' type='bitmap'><string name='filename' "
      "value='p.ppm'/><integer name='gamma' value='2'/></texture></bsdf>");
  EXPECT_EQ(pictures.files.size(), 1u);
  const Mitsuba3Scene lamp = translated(
      "<emitter type='area'><integer name='radiance' value='2'/><integer name='scale' value='5'/>"
      "</emitter>");
  EXPECT_EQ(value<double>(first_of(lamp), "radiance"), 10);
  EXPECT_FALSE(has_property(first_of(lamp), "scale"));
  EXPECT_EQ(first_of(translated("<sensor type='telecentric'><integer name='aperture_radius' "
                                "value='0'/></sensor>"))
                .type,
            "orthographic");
}

// Of several children without names the texture is the one that is meant.
TEST(Mitsuba3Terms, ScalesStandWhereTheyStood) {
  const Mitsuba3Scene scene = translated(
      "<shape type='sphere'><bsdf type='diffuse'/><texture type='scale'><float name='scale' "
      "value='2'/><texture type='checkerboard'/></texture></shape>");
  ASSERT_EQ(first_of(scene).children.size(), 2u);
  EXPECT_EQ(first_of(scene).children[0].object->type, "diffuse");
  EXPECT_EQ(first_of(scene).children[1].object->type, "checkerboard");
  EXPECT_EQ(value<double>(*first_of(scene).children[1].object, "color0"), 0.8);
}

TEST(Mitsuba3Terms, NestedTexturesAreScaledOnce) {
  const auto nested = [](int levels) {
    std::string inside = "<texture type='checkerboard' id='t0'/>";
    for (int i = 1; i <= levels; ++i) {
      const std::string before = "' id='t" + std::to_string(i - 1) + "'/>";
      inside += "<texture type='checkerboard' id='t" + std::to_string(i) + "'><ref name='color0" +
                before + "<ref name='color1" + before + "</texture>";
    }
    return translated(
        "<bsdf type='diffuse'><texture type='scale' name='reflectance'><float "
        "name='scale' value='0.5'/><ref id='t" +
        std::to_string(levels) + "'/></texture></bsdf>" + inside);
  };
  const Mitsuba3Scene few = nested(3);
  const Object& texture = *first_of(few).children.at(0).object;
  EXPECT_EQ(texture.type, "checkerboard");
  EXPECT_EQ(texture.children.at(0).object, texture.children.at(1).object);
  const Object& within = *texture.children.at(0).object->children.at(1).object;
  EXPECT_EQ(value<double>(*within.children.at(0).object, "color0"), 0.2);
  // No scene is built of more than some hundreds: the scale stays.
  EXPECT_EQ(first_of(nested(7)).children.at(0).object->type, "checkerboard");
  const Mitsuba3Scene many = nested(40);
  EXPECT_EQ(first_of(many).children.at(0).object->type, "scale");
  EXPECT_TRUE(tells(many, "Mitsuba 3 has no texture 'scale'"));
}

TEST(Mitsuba3Terms, TexturesOfLampsAreTheirRadiance) {
  const auto lamp = [](const std::string& inside) {
    return first_of(
        translated("<emitter type='area'><float name='scale' value='5'/>" + inside + "</emitter>"));
  };
  for (const char* name : {"", " name='emission'", " name='radiance'"}) {
    const Object bright = lamp("<texture type='checkerboard'" + std::string(name) + "/>");
    EXPECT_TRUE(bright.properties.empty());
    ASSERT_EQ(bright.children.size(), 1u);
    EXPECT_EQ(bright.children[0].name, "radiance");
    EXPECT_EQ(value<double>(*bright.children[0].object, "color0"), 2);
  }
  EXPECT_EQ(value<double>(lamp("<texture type='scale' name='emission'><float name='value' "
                               "value='2'/></texture>"),
                          "radiance"),
            10);
}

// A reflectance above 1 would be scaled to one below.
TEST(Mitsuba3Terms, FactorsStayWithinRanges) {
  const auto scaled = [](const std::string& colour, const std::string& type = "diffuse",
                         const std::string& name = "reflectance") {
    return translated("<bsdf type='" + type + "'><texture type='scale' name='" + name +
                      "'><float name='scale' value='3'/><rgb name='value' value='" + colour +
                      "'/></texture></bsdf>");
  };
  EXPECT_EQ(value<Rgb>(first_of(scaled("0.1, 0.2, 0.25")), "reflectance").b, 0.75);
  const Mitsuba3Scene bright = scaled("0.5, 0.5, 0.2");
  ASSERT_EQ(first_of(bright).children.size(), 1u);
  EXPECT_EQ(first_of(bright).children[0].object->type, "scale");
  EXPECT_TRUE(tells(bright, "Mitsuba 3 has no texture 'scale'"));
  // What is one number is no colour.
  EXPECT_EQ(first_of(scaled("0.1, 0.2, 0.1", "roughconductor", "alpha")).children.size(), 1u);
}

TEST(Mitsuba3Terms, MixturesOfWrongWeightsStay) {
  for (const char* weights : {"0 0", "1e308 1e308", "1 -1", "1"})
    EXPECT_EQ(first_of(translated("<medium type='homogeneous'><phase type='mixturephase'><string "
                                  "name='weights' value='" +
                                  std::string(weights) +
                                  "'/><phase type='isotropic'/><phase type='hg'/></phase>"
                                  "</medium>"))
                  .children.at(0)
                  .object->type,
              "mixturephase")
        << weights;
}

}  // namespace
}  // namespace kaustik
