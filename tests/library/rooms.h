#pragma once
// Scenes of programs, made as hosts make them.

#include <string>
#include <vector>

#include "kaustik/kaustik.h"

namespace kaustik::library_test {

/// The words of scene files and of programs for the same room: a floor, a glass ball, a lamp.
inline Object film(int width, int height) {
  return Object("film", "hdrfilm").set("width", width).set("height", height);
}

inline Object camera(int width, int height) {
  return Object("sensor", "perspective")
      .set("fov", 45)
      .set("to_world", Transform::look_at({0, -4, 2}, {0, 0, 0.5}, {0, 0, 1}))
      .add(film(width, height));
}

/// A square of two triangles from −1 to 1 at z = 0, which looks up.
inline Mesh square_mesh() {
  const float positions[] = {-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0};
  const uint32_t faces[] = {0, 1, 2, 0, 2, 3};
  return Mesh({.positions = {positions, 4, 0}, .faces = {faces, 2, 0}, .normals = {}, .uv = {}});
}

inline std::vector<Object> room_objects(const std::string& integrator, int width = 24,
                                        int height = 20) {
  Object method("integrator", integrator);
  if (integrator == "photonmap") method.set("caustic_photons", 4000).set("global_photons", 4000);
  return {method, camera(width, height),
          square_mesh()
              .shape("floor")
              .set("to_world", Transform::scale({3, 3, 3}))
              .add(Object("bsdf", "diffuse", "paint").set("reflectance", 0.5)),
          Object("shape", "sphere", "ball")
              .set("center", Vec3{0, 0, 0.6})
              .set("radius", 0.6)
              .add(Object("bsdf", "dielectric")),
          Object("shape", "rectangle")
              .set("to_world", Transform::translate({0, 0, 3}) * Transform::rotate({1, 0, 0}, 180) *
                                   Transform::scale({0.5, 0.5, 0.5}))
              .add(Object("emitter", "area", "lamp").set("radiance", Rgb{9, 9, 9}))};
}

inline Scene room(const std::string& integrator, int width = 24, int height = 20) {
  return Scene(room_objects(integrator, width, height));
}

/// The same as a file has it.
inline std::string room_text(const std::string& integrator, int width = 24, int height = 20) {
  const auto integer = [](const std::string& name, int value) {
    return "<integer name=\"" + name + "\" value=\"" + std::to_string(value) + "\"/>";
  };
  const std::string photons =
      integrator == "photonmap" ? integer("caustic_photons", 4000) + integer("global_photons", 4000)
                                : "";
  return "<scene version=\"3.0.0\">\n<integrator type=\"" + integrator + "\">" + photons +
         "</integrator>\n<sensor type=\"perspective\"><float name=\"fov\" value=\"45\"/>"
         "<transform name=\"to_world\"><lookat origin=\"0,-4,2\" target=\"0,0,0.5\" "
         "up=\"0,0,1\"/></transform><film type=\"hdrfilm\">" +
         integer("width", width) + integer("height", height) +
         "</film></sensor>\n<shape type=\"rectangle\"><transform name=\"to_world\"><scale "
         "value=\"3\"/></transform></shape>\n<shape type=\"sphere\" id=\"ball\"><point "
         "name=\"center\" "
         "x=\"0\" y=\"0\" z=\"0.6\"/><float name=\"radius\" value=\"0.6\"/><bsdf "
         "type=\"dielectric\"/></shape>\n<shape type=\"rectangle\"><transform "
         "name=\"to_world\"><scale value=\"0.5\"/><rotate x=\"1\" angle=\"180\"/><translate "
         "z=\"3\"/></transform><emitter type=\"area\" id=\"lamp\"><rgb name=\"radiance\" "
         "value=\"9\"/></emitter></shape>\n</scene>\n";
}

/// A square that reflects half of a sky of 1 W/(sr·m²) and fills the picture: 0.5 everywhere.
inline Scene half_sky(int width = 16, int height = 12) {
  return Scene(
      {Object("sensor", "perspective")
           .set("fov", 60)
           .set("to_world", Transform::look_at({0, 0, 1}, {0, 0, 0}, {0, 1, 0}))
           .add(film(width, height)),
       Object("emitter", "constant", "sky").set("radiance", 1),
       square_mesh().shape().add(Object("bsdf", "diffuse", "grey").set("reflectance", 0.5))});
}

inline SessionSettings passes(uint32_t count, uint32_t samples = 2, int threads = 2) {
  SessionSettings settings;
  settings.passes = count;
  settings.samples_per_pass = samples;
  settings.threads = threads;
  return settings;
}

/// Would go on for hours.
inline SessionSettings endless() { return passes(1u << 28); }

inline Picture rendered(const Scene& scene, const SessionSettings& settings) {
  Session session(scene, settings);
  session.run();
  return session.picture();
}

/// Of all channels.
inline std::vector<float> values(const Picture& picture) {
  std::vector<float> all;
  for (const std::string& channel : picture.channels()) {
    const auto plane = picture.plane(channel);
    all.insert(all.end(), plane.begin(), plane.end());
  }
  return all;
}

/// What `body` throws, which has to be an Error.
template <typename Body>
Error error_of(const Body& body) {
  try {
    body();
  } catch (const Error& error) {
    return error;
  }
  throw std::logic_error("nothing was thrown");
}

}  // namespace kaustik::library_test
