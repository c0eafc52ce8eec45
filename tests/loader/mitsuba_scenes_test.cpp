// Whole scenes as users write them: they load, and what is in them arrives.

#include <map>

#include "tests/loader/loader_support.h"

namespace kaustik {
namespace {

const std::string sensor = R"(
  <default name="spp" value="64"/>
  <integrator type="path">
    <integer name="max_depth" value="25"/>
    <integer name="rr_depth" value="5"/>
  </integrator>
  <sensor type="perspective">
    <string name="fov_axis" value="x"/>
    <float name="fov" value="19.5"/>
    <float name="near_clip" value="0.001"/>
    <transform name="to_world"><lookat origin="0, 1, 6.8" target="0, 1, 0" up="0, 1, 0"/></transform>
    <sampler type="independent"><integer name="sample_count" value="$spp"/></sampler>
    <film type="hdrfilm">
      <integer name="width" value="256"/>
      <integer name="height" value="256"/>
      <string name="pixel_format" value="rgb"/>
      <rfilter type="box"/>
    </film>
  </sensor>
  <bsdf type="diffuse" id="_black"><rgb name="reflectance" value="0, 0, 0"/></bsdf>
)";

const std::string box_light = R"(
  <shape type="rectangle">
    <transform name="to_world"><matrix value="0.25 0 0 0 0 0 -1 1.98 0 0.2 0 -0.02 0 0 0 1"/></transform>
    <ref id="_black"/>
    <emitter type="area"><rgb name="radiance" value="14, 14, 14"/></emitter>
  </shape>
)";

std::string twosided(const std::string& id, const std::string& rgb) {
  return "<bsdf type=\"twosided\" id=\"" + id + "\">\n  <bsdf type=\"diffuse\"><rgb " +
         "name=\"reflectance\" value=\"" + rgb + "\"/></bsdf>\n</bsdf>\n";
}

std::string mesh(const std::string& name, const std::string& bsdf) {
  return "<!-- " + name + " -->\n<shape type=\"ply\">\n  <string name=\"filename\" " +
         "value=\"meshes/" + name +
         ".ply\"/>\n  <boolean name=\"face_normals\" value=\"true\"/>\n" + "  <ref id=\"" + bsdf +
         "\"/>\n</shape>\n";
}

std::string ball(const std::string& center, const std::string& bsdf, const std::string& emitter) {
  return "<shape type=\"sphere\"><point name=\"center\" " + center +
         "/><float name=\"radius\" value=\"0.4\"/><ref id=\"" + bsdf + "\"/>" + emitter +
         "</shape>\n";
}

const std::string glass = R"(
  <bsdf type="dielectric" id="glass">
    <float name="int_ior" value="1.5"/>
    <float name="ext_ior" value="1"/>
  </bsdf>
)";
const std::string metal = R"(
  <bsdf type="conductor" id="metal">
    <string name="material" value="none"/>
    <rgb name="specular_reflectance" value="0.9, 0.8, 0.6"/>
  </bsdf>
)";

std::string pool(const std::string& origin) {
  std::string text = sensor;
  text.replace(text.find("0, 1, 6.8"), 9, origin);
  return text + twosided("basin", "0.55, 0.72, 0.8") + twosided("deck", "0.6, 0.6, 0.6") + glass +
         mesh("basin", "basin") + mesh("deck", "deck") + mesh("water", "glass") +
         R"(<shape type="disk">
  <transform name="to_world"><matrix value="0 0.3 0 0.7 0 0 -0.3 7.6 -0.3 0 0 -0.5 0 0 0 1"/></transform>
  <ref id="_black"/>
  <emitter type="area"><rgb name="radiance" value="300, 300, 300"/></emitter>
</shape>)" +
         box_light;
}

const std::map<std::string, std::string>& scenes() {
  static const std::map<std::string, std::string> all = {
      {"cornell", sensor + twosided("white", "0.73, 0.73, 0.73") +
                      twosided("red", "0.63, 0.07, 0.05") + mesh("walls", "white") +
                      mesh("red_wall", "red") + box_light + mesh("tall_box", "white")},
      {"cornell_glass", sensor + twosided("white", "0.73, 0.73, 0.73") + metal + glass +
                            mesh("walls", "white") + box_light +
                            ball("x=\"-0.42\" y=\"0.401\" z=\"-0.3\"", "metal", "") +
                            ball("x=\"0.44\" y=\"0.401\" z=\"0.28\"", "glass", "")},
      {"hidden_light", sensor + twosided("wall", "0.73, 0.73, 0.73") +
                           twosided("wood", "0.52, 0.42, 0.3") + mesh("walls", "wall") +
                           mesh("baffle", "wall") + box_light + mesh("table", "wood")},
      {"pool_above", pool("0, 6.6, 4.6")},
      {"pool_below", pool("-1.9, 0.55, 2")},
      {"ring",
       sensor + twosided("floor", "0.7, 0.7, 0.7") + metal + mesh("floor", "floor") +
           mesh("ring", "metal") +
           ball("x=\"-3.4\" y=\"3.1\" z=\"2\"", "_black",
                "<emitter type=\"area\"><rgb name=\"radiance\" value=\"2000\"/></emitter>")}};
  return all;
}

size_t count(const Object& scene, const std::string& family) {
  size_t n = 0;
  for (const Child& child : scene.children) n += child.object->family == family ? 1 : 0;
  return n;
}

/// Every object has a known file and line, and no child is missing.
void expect_complete(const Object& object) {
  EXPECT_TRUE(object.place.file);
  EXPECT_GT(object.place.line, 0);
  for (const Property& p : object.properties) EXPECT_GT(p.place.line, 0) << p.name;
  for (const Child& child : object.children) {
    ASSERT_TRUE(child.object);
    expect_complete(*child.object);
  }
}

TEST(MitsubaScenes, AllLoad) {
  const std::map<std::string, size_t> shapes = {{"cornell", 4},      {"cornell_glass", 4},
                                                {"hidden_light", 4}, {"pool_above", 5},
                                                {"pool_below", 5},   {"ring", 3}};
  for (const auto& [name, text] : scenes()) {
    SCOPED_TRACE(name);
    const auto scene = parse_inside(text, {{{"spp", "9"}}}).scene;
    expect_complete(*scene);
    EXPECT_EQ(count(*scene, "shape"), shapes.at(name));
    EXPECT_EQ(count(*scene, "integrator"), 1u);
    ASSERT_EQ(count(*scene, "sensor"), 1u);
    const Object& camera = *scene->children.at(1).object;
    EXPECT_EQ(value<int64_t>(*camera.children.at(0).object, "sample_count"), 9);
    EXPECT_EQ(camera.children.at(1).object->children.at(0).object->family, "rfilter");
  }
}

TEST(MitsubaScenes, DetailsOfTheGlassBox) {
  const auto scene = parse_inside(scenes().at("cornell_glass")).scene;
  const Object& last = *scene->children.back().object;
  EXPECT_EQ(value<Vec3d>(last, "center"), Vec3d(0.44, 0.401, 0.28));
  EXPECT_EQ(value<double>(*last.children.at(0).object, "int_ior"), 1.5);
  const Transform& to_world =
      value<Transform>(*scene->children.at(scene->children.size() - 3).object, "to_world");
  EXPECT_EQ(to_world.at(1, 2), -1);
  EXPECT_EQ(to_world.at(2, 3), -0.02);
}

}  // namespace
}  // namespace kaustik
