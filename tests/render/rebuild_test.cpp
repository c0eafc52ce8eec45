// Pictures of a scene that shares parts with one before it are those of one that was built anew.

#include <gtest/gtest.h>

#include "kaustik/integrator/make_integrator.h"
#include "kaustik/loader/mitsuba_xml.h"
#include "kaustik/render/session.h"

namespace kaustik {
namespace {

Description edited_room(const std::string& glass, const std::string& wall) {
  return parse_mitsuba_xml(
      "<scene version=\"3.0.0\"><sensor type=\"perspective\"><transform name=\"to_world\"><lookat "
      "origin=\"0,-4,2\" target=\"0,0,0.5\" up=\"0,0,1\"/></transform><film type=\"hdrfilm\">"
      "<integer name=\"width\" value=\"12\"/><integer name=\"height\" value=\"10\"/></film>"
      "</sensor><shape type=\"rectangle\"><transform name=\"to_world\"><scale value=\"3\"/>"
      "</transform><bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"" +
          wall + "\"/></bsdf></shape><shape type=\"sphere\"><point name=\"center\" value=\"0, 0, " +
          glass +
          "\"/><float name=\"radius\" value=\"0.6\"/><bsdf type=\"dielectric\"/></shape>"
          "<shape type=\"rectangle\"><transform name=\"to_world\"><scale value=\"0.5\"/>"
          "<rotate x=\"1\" angle=\"180\"/><translate z=\"3\"/></transform><emitter type=\"area\">"
          "<rgb name=\"radiance\" value=\"9\"/></emitter></shape>"
          "<emitter type=\"sky\"/><emitter type=\"point\"><point name=\"position\" value=\"1, 0, "
          "2\"/></emitter></scene>",
      "test.xml", "");
}

std::vector<float> picture_of(const Scene& scene, const std::string& type) {
  std::vector<std::string> warnings;
  const auto integrator =
      make_integrator(Object{"integrator", type, "", {}, {}, place_in("test")}, scene, warnings);
  SessionSettings settings;
  settings.passes = 2;
  settings.threads = 2;
  Session session(scene, *integrator, settings);
  session.run({}, {}, {});
  const Image image = session.film().image();
  std::vector<float> values;
  for (int c = 0; c < image.channel_count(); ++c)
    values.insert(values.end(), image.channel(c).begin(), image.channel(c).end());
  return values;
}

TEST(Rebuild, PicturesKeepTheirBits) {
  auto scene = build_scene(edited_room("0.6", "0.5"));
  for (const auto& [glass, wall, types] :
       {std::tuple("0.6", "0.2", std::vector<std::string>{"path", "photonmap"}),
        std::tuple("1.1", "0.2", std::vector<std::string>{"path", "auto"})}) {
    scene = build_scene(edited_room(glass, wall), scene);
    const auto anew = build_scene(edited_room(glass, wall));
    EXPECT_LT(scene->build_counts().shapes, anew->build_counts().shapes);
    for (const std::string& type : types)
      EXPECT_EQ(picture_of(*scene, type), picture_of(*anew, type)) << type << " " << glass << wall;
  }
}

}  // namespace
}  // namespace kaustik
