// Properties of every kind: from elements to values.

#include <cmath>

#include "tests/loader/loader_support.h"

namespace kaustik {
namespace {

void expect_near(const Transform& t, const double (&rows)[4][4]) {
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) EXPECT_NEAR(t.at(i, j), rows[i][j], 1e-12) << i << ',' << j;
}

Transform transform(const std::string& operations) {
  return value_in_shape<Transform>("<transform name=\"x\">" + operations + "</transform>");
}

TEST(MitsubaValues, Numbers) {
  EXPECT_EQ(value_in_shape<double>("<float name='x' value=' -1.5e-3 '/>"), -1.5e-3);
  EXPECT_EQ(value_in_shape<double>("<float name='x' value='+2'/>"), 2.0);
  EXPECT_EQ(value_in_shape<double>("<float name='x' value='.5'/>"), 0.5);
  EXPECT_EQ(value_in_shape<double>("<float name='x' value='0.1f'/>"), 0.1);
  EXPECT_EQ(value_in_shape<int64_t>("<integer name='x' value=' 42 '/>"), 42);
  EXPECT_EQ(value_in_shape<int64_t>("<integer name='x' value='-9223372036854775808'/>"), INT64_MIN);
}

TEST(MitsubaValues, BooleansAndStrings) {
  EXPECT_TRUE(value_in_shape<bool>("<boolean name='x' value='True'/>"));
  EXPECT_FALSE(value_in_shape<bool>("<boolean name='x' value='false'/>"));
  EXPECT_EQ(value_in_shape<std::string>("<string name='x' value=' a &lt;b&gt; ü '/>"), " a <b> ü ");
}

TEST(MitsubaValues, PointsAndVectors) {
  EXPECT_EQ(value_in_shape<Vec3d>("<point name='x' value='1, 2.5,-3'/>"), Vec3d(1, 2.5, -3));
  EXPECT_EQ(value_in_shape<Vec3d>("<vector name='x' value='1 2 3'/>"), Vec3d(1, 2, 3));
  EXPECT_EQ(value_in_shape<Vec3d>("<vector name='x' value='7'/>"), Vec3d(7, 7, 7));
  EXPECT_EQ(value_in_shape<Vec3d>("<point name='x' x='1' y='2' z='3'/>"), Vec3d(1, 2, 3));
}

TEST(MitsubaValues, Colors) {
  EXPECT_EQ(value_in_shape<Rgb>("<rgb name='x' value='0.1, 0.2, 0.3'/>"), (Rgb{0.1, 0.2, 0.3}));
  EXPECT_EQ(value_in_shape<Rgb>("<rgb name='x' value='0.5'/>"), (Rgb{0.5, 0.5, 0.5}));
  const Rgb orange = value_in_shape<Rgb>("<rgb name='x' value='#FF8000'/>");
  EXPECT_DOUBLE_EQ(orange.r, 1.0);
  EXPECT_NEAR(orange.g, 0.21586050011389926, 1e-12);  // 128/255 by IEC 61966-2-1
  EXPECT_EQ(orange.b, 0.0);
  // Mitsuba 0.6 means sRGB by <srgb> only.
  EXPECT_EQ(value_in_shape<Rgb>("<rgb name='x' value='#FF8000' intent='reflectance'/>", "0.6.0"),
            (Rgb{1, 128 / 255.0, 0}));
  EXPECT_EQ(value_in_shape<Rgb>("<srgb name='x' value='#FF8000'/>", "0.6.0"), orange);
  // The linear part of the curve.
  EXPECT_NEAR(value_in_shape<Rgb>("<rgb name='x' value='#010101'/>").r, 1 / 255.0 / 12.92, 1e-15);
}

TEST(MitsubaValues, Spectra) {
  EXPECT_EQ(value_in_shape<double>("<spectrum name='x' value='0.5'/>"), 0.5);
  const auto curve =
      value_in_shape<SpectralCurve>("<spectrum name='x' value='400:0.1, 500.5:0.2 700:3'/>");
  EXPECT_EQ(curve, (SpectralCurve{{{400, 0.1}, {500.5, 0.2}, {700, 3}}}));
}

/// A number stands for light of equal energy in files of version 2 and later, for white light
/// before.
TEST(MitsubaValues, SpectraOfLamps) {
  const std::string lamp = "<emitter type='point'><spectrum name='intensity' value='2'/></emitter>";
  EXPECT_EQ(value<SpectralCurve>(*parse_inside(lamp).scene->children[0].object, "intensity"),
            (SpectralCurve{{{360, 2}, {830, 2}}}));
  const auto old = [](const std::string& inside) {
    return parse("<scene version='0.6.0'><emitter type='point'>" + inside + "</emitter></scene>")
        .scene->children.at(0)
        .object;
  };
  EXPECT_EQ(value<double>(*old("<spectrum name='intensity' value='2'/>"), "intensity"), 2.0);
  EXPECT_EQ(value<Rgb>(*old("<spectrum name='intensity' value='1, 2, 3'/>"), "intensity"),
            (Rgb{1, 2, 3}));
  const auto hot = old("<blackbody name='intensity' temperature='4500K' scale='0.1'/>");
  const Child& child = hot->children.at(0);
  EXPECT_EQ(child.name, "intensity");
  EXPECT_EQ(child.object->family, "texture");
  EXPECT_EQ(child.object->type, "blackbody");
  EXPECT_EQ(value<double>(*child.object, "temperature"), 4500.0);
  EXPECT_EQ(value<double>(*child.object, "scale"), 0.1);
}

/// In 0.6 the zenith is +y, north −z, east +x.
TEST(MitsubaValues, OldSkies) {
  const auto sky = [](const std::string& type, const std::string& inside,
                      const std::string& version = "0.6.0") {
    return parse("<scene version='" + version + "'><emitter type='" + type + "'>" + inside +
                 "</emitter></scene>")
        .scene->children.at(0)
        .object;
  };
  const auto expect_axes = [](const Transform& t, const Vec3f& south, const Vec3f& west,
                              const Vec3f& zenith) {
    EXPECT_EQ(t.vector({1, 0, 0}), south);
    EXPECT_EQ(t.vector({0, 1, 0}), west);
    EXPECT_EQ(t.vector({0, 0, 1}), zenith);
  };
  expect_axes(value<Transform>(*sky("sky", ""), "to_world"), {0, 0, 1}, {-1, 0, 0}, {0, 1, 0});
  // A scene that has its zenith at +z turned the sky upright: y became z.
  const std::string upright = "<transform name='toWorld'><rotate x='1' angle='90'/></transform>";
  const Transform turned = value<Transform>(*sky("sunsky", upright), "to_world");
  EXPECT_NEAR(turned.vector({0, 0, 1}).z, 1, 1e-6);
  EXPECT_NEAR(turned.vector({1, 0, 0}).y, -1, 1e-6);
  const auto scaled = sky("sunsky",
                          "<float name='scale' value='2'/><float name='sunScale' "
                          "value='3'/><float name='sunRadiusScale' value='10'/>");
  EXPECT_EQ(value<double>(*scaled, "sun_scale"), 6.0);
  EXPECT_EQ(value<double>(*scaled, "sky_scale"), 2.0);
  EXPECT_NEAR(value<double>(*scaled, "sun_aperture"), 5.358, 1e-9);
  EXPECT_EQ(value<double>(*sky("sky", "<float name='scale' value='2'/>"), "sky_scale"), 2.0);
  EXPECT_TRUE(sky("sky", "", "2.0.0")->properties.empty());
  EXPECT_TRUE(sky("constant", "")->properties.empty());
}

// Mitsuba's daylight is per nanometre. It had none from 2.0 to 3.6: such scenes are Kaustik's,
// whose daylight is in W/(sr·m²).
TEST(MitsubaValues, UnitsOfDaylight) {
  const auto scene_with = [](const std::string& inside, const std::string& version) {
    return parse(in_scene("<emitter type='sunsky'>" + inside + "</emitter>", version));
  };
  const auto units_of = [](const Description& scene) {
    for (const Property& property : scene.scene->children.at(0).object->properties)
      if (property.name == "units") return std::get<std::string>(property.value);
    return std::string();
  };
  for (const std::string version : {"0.6.0", "0.4.0", "3.7.0", "3.8.1", "4.0.0"}) {
    SCOPED_TRACE(version);
    const Description scene = scene_with("", version);
    EXPECT_EQ(units_of(scene), "mitsuba");
    ASSERT_EQ(scene.warnings.size(), 1u);
    EXPECT_NE(scene.warnings[0].find("test.xml:2:1: 'sunsky' is per nanometre"), std::string::npos)
        << scene.warnings[0];
  }
  const std::string own = "<string name='units' value='physical'/>";
  for (const std::string version : {"0.6.0", "3.7.0"}) {
    EXPECT_EQ(units_of(scene_with(own, version)), "physical");
    EXPECT_TRUE(scene_with(own, version).warnings.empty());
  }
  const std::string lamp = "</emitter><emitter type='point'>";
  for (const std::string version : {"2.0.0", "3.0.0", "3.6.4"}) {
    SCOPED_TRACE(version);
    EXPECT_EQ(units_of(scene_with("", version)), "");
    EXPECT_TRUE(scene_with("", version).warnings.empty());
    // What the sky is compared with makes the difference.
    const Description two = scene_with(lamp, version);
    ASSERT_EQ(two.warnings.size(), 1u);
    EXPECT_NE(two.warnings[0].find("408 times as bright"), std::string::npos) << two.warnings[0];
    EXPECT_TRUE(scene_with(own + lamp, version).warnings.empty());
  }
}

TEST(MitsubaValues, BlackbodiesHadAMultiplier) {
  const auto scale_of = [](const std::string& attribute, const std::string& version) {
    const auto scene =
        parse(in_scene("<emitter type='point'><blackbody name='intensity' temperature='4000' " +
                           attribute + "='0.25'/></emitter>",
                       version))
            .scene;
    return value<double>(*scene->children.at(0).object->children.at(0).object, "scale");
  };
  EXPECT_EQ(scale_of("multiplier", "0.3.0"), 0.25);
  EXPECT_EQ(scale_of("scale", "0.4.0"), 0.25);
}

TEST(MitsubaValues, SpectrumFromFile) {
  const TemporaryFolder folder;
  folder.write("spectra/lamp.spd", "# nm  value\n400 0.25\r\n\n500\t0.5 # green\n600, 1");
  const std::string path = folder.write(
      "scene.xml",
      in_scene("<emitter type='point'><spectrum name='x' filename='spectra/lamp.spd'/></emitter>"));
  const auto scene = load_mitsuba_xml(path).scene;
  EXPECT_EQ(value<SpectralCurve>(*scene->children[0].object, "x"),
            (SpectralCurve{{{400, 0.25}, {500, 0.5}, {600, 1}}}));
}

TEST(MitsubaValues, SpectrumWithTypeIsATexture) {
  const auto scene =
      parse_inside("<emitter type='area'><spectrum type='d65' name='radiance'/></emitter>").scene;
  const Child& child = scene->children[0].object->children.at(0);
  EXPECT_EQ(child.name, "radiance");
  EXPECT_EQ(child.object->family, "texture");
  EXPECT_EQ(child.object->type, "d65");
}

TEST(MitsubaValues, SingleTransforms) {
  expect_near(transform(""), {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}});
  expect_near(transform("<translate x='1' z='3'/>"),
              {{1, 0, 0, 1}, {0, 1, 0, 0}, {0, 0, 1, 3}, {0, 0, 0, 1}});
  expect_near(transform("<translate value='1, 2, 3'/>"),
              {{1, 0, 0, 1}, {0, 1, 0, 2}, {0, 0, 1, 3}, {0, 0, 0, 1}});
  expect_near(transform("<scale value='2'/>"),
              {{2, 0, 0, 0}, {0, 2, 0, 0}, {0, 0, 2, 0}, {0, 0, 0, 1}});
  expect_near(transform("<scale y='2'/>"),
              {{1, 0, 0, 0}, {0, 2, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}});
  expect_near(transform("<rotate z='1' angle='90'/>"),
              {{0, -1, 0, 0}, {1, 0, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}});
  expect_near(transform("<matrix value='1 2 3 4  0 1 5 6\n 0 0 1 7, 0 0 0 1'/>"),
              {{1, 2, 3, 4}, {0, 1, 5, 6}, {0, 0, 1, 7}, {0, 0, 0, 1}});
  expect_near(transform("<matrix value='0 1 0 -1 0 0 0 0 2'/>"),
              {{0, 1, 0, 0}, {-1, 0, 0, 0}, {0, 0, 2, 0}, {0, 0, 0, 1}});
}

TEST(MitsubaValues, LookAt) {
  // Seen from +z toward the origin, the camera's +x points to the left, which is world -x.
  expect_near(transform("<lookat origin='0, 0, 5' target='0, 0, 0' up='0, 1, 0'/>"),
              {{-1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, -1, 5}, {0, 0, 0, 1}});
  const Transform free = transform("<lookat origin='1, 2, 3' target='4, 6, 3'/>");
  EXPECT_NEAR(free.at(0, 2), 0.6, 1e-12);
  EXPECT_NEAR(free.at(1, 2), 0.8, 1e-12);
  EXPECT_NEAR(free.determinant3(), 1.0, 1e-12);
}

TEST(MitsubaValues, LaterTransformsAreAppliedLater) {
  // The point (1, 0, 0) is moved to (2, 0, 0), then turned to (0, 2, 0), then stretched.
  const Transform t =
      transform("<translate x='1'/><rotate z='1' angle='90'/><scale value='1, 3, 1'/>");
  const Vec3f p = t.point({1, 0, 0});
  EXPECT_NEAR(p.x, 0, 1e-6);
  EXPECT_NEAR(p.y, 6, 1e-6);
}

}  // namespace
}  // namespace kaustik
