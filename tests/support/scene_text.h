#pragma once
// Scenes as text for tests: short functions for what most of them hold. Numbers are written as in
// the files, so that a test reads like one.

#include <fmt/format.h>

#include <string>

namespace kaustik::test {

/// A square picture of `size` pixels with a box filter.
inline std::string camera(const std::string& origin, const std::string& target, double fov,
                          int size = 16, const std::string& up = "0, 0, 1") {
  return fmt::format(
      R"(<sensor type="perspective"><float name="fov" value="{}"/><transform name="to_world">
      <lookat origin="{}" target="{}" up="{}"/></transform>
      <film type="hdrfilm"><integer name="width" value="{}"/><integer name="height" value="{}"/>
      <rfilter type="box"/></film></sensor>)",
      fov, origin, target, up, size, size);
}

inline std::string diffuse(const std::string& reflectance) {
  return fmt::format(R"(<bsdf type="diffuse"><rgb name="reflectance" value="{}"/></bsdf>)",
                     reflectance);
}
inline std::string mirror() { return R"(<bsdf type="twosided"><bsdf type="conductor"/></bsdf>)"; }
inline std::string glass(double ior = 1.5) {
  return fmt::format(
      R"(<bsdf type="dielectric"><float name="int_ior" value="{}"/><float name="ext_ior" value="1"/></bsdf>)",
      ior);
}
inline std::string phong(double diffuse, double specular, double exponent) {
  return fmt::format(
      R"(<bsdf type="phong"><rgb name="diffuse_reflectance" value="{}"/>
      <rgb name="specular_reflectance" value="{}"/><float name="exponent" value="{}"/></bsdf>)",
      diffuse, specular, exponent);
}
inline std::string ggx(double alpha) {
  return fmt::format(
      R"(<bsdf type="roughconductor"><string name="distribution" value="ggx"/>
      <float name="alpha" value="{}"/><string name="material" value="Al"/></bsdf>)",
      alpha);
}

inline std::string area_light(const std::string& radiance) {
  return fmt::format(R"(<emitter type="area"><rgb name="radiance" value="{}"/></emitter>)",
                     radiance);
}
inline std::string point_light(const std::string& position, double intensity) {
  return fmt::format(
      R"(<emitter type="point"><point name="position" value="{}"/><rgb name="intensity" value="{}"/></emitter>)",
      position, intensity);
}
inline std::string directional_light(const std::string& direction, double irradiance) {
  return fmt::format(
      R"(<emitter type="directional"><vector name="direction" value="{}"/><rgb name="irradiance" value="{}"/></emitter>)",
      direction, irradiance);
}
inline std::string constant_light(double radiance) {
  return fmt::format(R"(<emitter type="constant"><rgb name="radiance" value="{}"/></emitter>)",
                     radiance);
}

inline std::string sphere(const std::string& center, double radius, const std::string& inside,
                          bool inward = false) {
  return fmt::format(
      R"(<shape type="sphere"><point name="center" value="{}"/><float name="radius" value="{}"/>
      <boolean name="flip_normals" value="{}"/>{}</shape>)",
      center, radius, inward, inside);
}
inline std::string cylinder(const std::string& p0, const std::string& p1, double radius,
                            const std::string& inside) {
  return fmt::format(
      R"(<shape type="cylinder"><point name="p0" value="{}"/><point name="p1" value="{}"/>
      <float name="radius" value="{}"/>{}</shape>)",
      p0, p1, radius, inside);
}
/// `type`: rectangle or disk, both facing +z and of half size 1 before `transform`.
inline std::string flat(const std::string& type, const std::string& transform,
                        const std::string& inside) {
  return fmt::format(R"(<shape type="{}"><transform name="to_world">{}</transform>{}</shape>)",
                     type, transform, inside);
}
inline std::string scale(const std::string& factors) {
  return fmt::format(R"(<scale value="{}"/>)", factors);
}
inline std::string translate(const std::string& by) {
  return fmt::format(R"(<translate value="{}"/>)", by);
}
inline std::string rotate(const std::string& axis, double degrees) {
  return fmt::format(R"(<rotate value="{}" angle="{}"/>)", axis, degrees);
}

/// A parameter of an integrator.
inline std::string set(const std::string& name, int value) {
  return fmt::format(R"(<integer name="{}" value="{}"/>)", name, value);
}
inline std::string set(const std::string& name, double value) {
  return fmt::format(R"(<float name="{}" value="{}"/>)", name, value);
}
inline std::string set(const std::string& name, bool value) {
  return fmt::format(R"(<boolean name="{}" value="{}"/>)", name, value);
}
inline std::string set(const std::string& name, const char* value) {
  return fmt::format(R"(<string name="{}" value="{}"/>)", name, value);
}

}  // namespace kaustik::test
