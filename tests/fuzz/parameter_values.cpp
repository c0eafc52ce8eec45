#include "tests/fuzz/parameter_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace kaustik::fuzz {
namespace {

constexpr double largest_float = 3.4e38;

std::string element(const char* tag, const std::string& name, const std::string& value) {
  return fmt::format("<{} name=\"{}\" value=\"{}\"/>", tag, name, value);
}

double default_number(const Parameter& parameter) {
  const auto* value = std::get_if<Value>(&parameter.default_value);
  if (const auto* i = value ? std::get_if<int64_t>(value) : nullptr) return double(*i);
  if (const auto* d = value ? std::get_if<double>(value) : nullptr) return *d;
  if (const auto* c = value ? std::get_if<Rgb>(value) : nullptr) return c->r;
  return 0.5;
}

/// What a parameter of this name costs grows with its value, so that its range can't be used up.
int64_t largest_affordable(const std::string& name) {
  const auto has = [&](const char* part) { return name.find(part) != std::string::npos; };
  if (has("photons")) return 300;
  if (name == "diffuse_samples" || name == "specular_samples") return 3;
  if (has("samples") || has("cells") || has("targets")) return 16;
  if (name == "rr_depth") return 12;
  if (name == "iterations") return 5;
  if (name == "count") return 40;
  if (name == "width" || name == "height") return 12;
  return int64_t(1) << 62;
}

}  // namespace

double ParameterValues::wild_number() {
  const double size = draw_.one_of({0.0,  1e-45, 1e-38, 1e-30,     1e-20, 1e-12,         1e-7,
                                    1e-3, 0.5,   1.0,   1.0000001, 3.0,   180.0,         1e4,
                                    1e6,  1e9,   1e12,  1e18,      1e30,  largest_float, 1e300});
  return draw_.chance(0.3) ? -size : size;
}

double ParameterValues::number(const Parameter& parameter) {
  const double low = std::max(parameter.minimum, -largest_float);
  const double high = std::min(parameter.maximum, largest_float);
  const double usual = default_number(parameter);
  if (!is_wild() && parameter.name == "wavelength_min") return 400;
  if (!is_wild() && parameter.name == "wavelength_max") return 700;
  if (!is_wild())
    return std::clamp(usual * draw_.one_of({1.0, 0.5, 0.8, 0.3, high > 1 ? 2.0 : 0.1}), low, high);
  const double wild = draw_.chance(0.5) ? wild_number() : draw_.one_of({low, high, usual, 0.0});
  return draw_.chance(0.9) ? std::clamp(wild, low, high) : wild;
}

int64_t ParameterValues::integer(const Parameter& parameter) {
  const double low = std::max(parameter.minimum, -0x1p62);
  const double high =
      std::min({parameter.maximum, 0x1p62, double(largest_affordable(parameter.name))});
  const auto usual = std::clamp(int64_t(default_number(parameter)), int64_t(low), int64_t(high));
  if (!is_wild())
    return draw_.chance(0.5) ? usual : std::clamp<int64_t>(usual / 2, int64_t(low), int64_t(high));
  const int64_t wild =
      draw_.one_of<int64_t>({int64_t(low), int64_t(high), usual, 0, 1, 2, -1, 3, 7});
  return draw_.chance(0.95) ? std::clamp(wild, int64_t(low), int64_t(high)) : wild;
}

std::string ParameterValues::triple(double usual) {
  const auto one = [&] { return is_wild() ? wild_number() : draw_.between(-usual, usual); };
  const double x = one(), y = one(), z = one();
  return fmt::format("{:.6g}, {:.6g}, {:.6g}", x, y, z);
}

std::string ParameterValues::point(const Parameter& parameter) {
  const bool is_vector = parameter.name == "direction" || parameter.name == "up";
  // Of this one no component may be negative.
  const bool is_factors = parameter.name == "attenuation";
  return element(is_vector ? "vector" : "point", parameter.name,
                 is_factors && !is_wild() ? "0.5, 0.1, 1" : triple(1));
}

std::string ParameterValues::color(const Parameter& parameter) {
  const auto one = [&] { return number(parameter); };
  switch (draw_.below(4)) {
    case 0:
      return element("float", parameter.name, fmt::format("{}", one()));
    case 1:
      return element(
          "spectrum", parameter.name,
          joined({fmt::format("{}:", draw_.one_of({1, 400, 500})), fmt::format("{}, ", one()),
                  fmt::format("{}:", draw_.one_of({600, 700, 100000})), fmt::format("{}", one())}));
    default:
      return element("rgb", parameter.name,
                     joined({fmt::format("{}, ", one()), fmt::format("{}, ", one()),
                             fmt::format("{}", one())}));
  }
}

std::string ParameterValues::file(const TypeInfo& info) {
  const std::string name =
      info.name == "obj"
          ? draw_.one_of({"quad.obj", "tent.obj", "flat.obj", is_wild() ? "far.obj" : "quad.obj"})
      : info.name == "ply"        ? draw_.one_of({"pyramid.ply", "needle.ply", "painted.ply"})
      : info.name == "serialized" ? "pair.serialized"
      : info.name == "sdfgrid"
          ? draw_.one_of({"ball.vol", "ball.vol", "folds.vol", is_wild() ? "flow.vol" : "ball.vol"})
      : info.name == "gridvolume"
          ? draw_.one_of({"cloud.vol", "bytes.vol", is_wild() ? "colors.vol" : "cloud.vol",
                          is_wild() ? "flow.vol" : "bytes.vol"})
          : draw_.one_of({"colors.pfm", "one.pfm", "bright.pfm", "black.pfm"});
  return files_folder_ + "/" + name;
}

std::string ParameterValues::text(const TypeInfo& info, const Parameter& parameter) {
  if (parameter.name == "components")
    return draw_.one_of({"all", "direct", "emission,caustic", "indirect,specular,volume"});
  if (parameter.name == "wavelengths" || parameter.name == "values")
    return is_wild() ? draw_.one_of({"1", "400, 400", "", "1e-30 1e30 nan", "-1, 1e300"})
                     : draw_.one_of({"0.1, 0.5", "300, 500"});
  if (parameter.name == "focal_length")
    return is_wild() ? draw_.one_of({"0mm", "1e-30mm", "1e30mm", "mm"}) : "35mm";
  if (parameter.name == "name") return draw_.one_of({"vertex_color", "vertex_color", "face_heat"});
  if (parameter.name == "channel") return draw_.one_of({"", "", "r", "b", "a"});
  if (parameter.kind == ParameterKind::file) return file(info);
  if (info.name == "tabphase")
    return is_wild() ? draw_.one_of({"1", "0, 0", "-1, 2", "nan, 1", "1e308, 1e308"})
                     : draw_.one_of({"1, 1", "1, 0.5, 2", "0, 0, 1"});
  return draw_.chance(0.9) ? default_text(parameter) : "?";
}

std::string ParameterValues::transform_step() {
  switch (draw_.below(3)) {
    case 0:
      return fmt::format("<translate value=\"{}\"/>", triple(1));
    case 1:
      return joined({fmt::format("<rotate value=\"{}\"", triple(1)),
                     fmt::format(" angle=\"{:.6g}\"/>", draw_.between(-180, 180))});
    default:
      return fmt::format("<scale value=\"{:.6g}\"/>", draw_.between(0.2, 1.5));
  }
}

std::string ParameterValues::wild_transform_step() {
  switch (draw_.below(4)) {
    case 0: {
      const auto one = [&] {
        return draw_.chance(0.1) ? wild_number()
                                 : draw_.one_of({0.5, 1.0, 2.0, -1.0, 0.001, 50.0, 0.0});
      };
      const double x = one(), y = one(), z = one();
      return fmt::format("<scale value=\"{:.6g}, {:.6g}, {:.6g}\"/>", x, y, z);
    }
    case 1:
      return fmt::format("<scale value=\"{}\"/>",
                         draw_.one_of({1e-20, 1e-6, 1e-4, 0.01, -1.0, 30.0, 1e4, 1e6, 1e12}));
    case 2: {
      std::string rows;
      for (int i = 0; i < 12; ++i)
        rows += fmt::format("{} ", draw_.one_of({0.0, 1.0, 1.0, -1.0, 0.5, 2.0, 1e5, 1e-5}));
      return "<matrix value=\"" + rows + (draw_.chance(0.8) ? "0 0 0 1" : "0 1e-6 0 2") + "\"/>";
    }
    default:
      return joined({fmt::format("<lookat origin=\"{}\"", triple(3)),
                     fmt::format(" target=\"{}\" up=\"0, 1, 0\"/>", triple(3))});
  }
}

std::string ParameterValues::transform(const std::string& name) {
  std::string steps;
  for (size_t i = draw_.below(4); i > 0; --i)
    steps += is_wild() ? wild_transform_step() : transform_step();
  return "<transform name=\"" + name + "\">" + steps + "</transform>";
}

std::string ParameterValues::property(const TypeInfo& info, const Parameter& p) {
  if (p.no_effect || p.name == "photon_map") return "";
  switch (p.kind) {
    case ParameterKind::boolean:
      return element("boolean", p.name, draw_.chance(0.5) ? "true" : "false");
    case ParameterKind::integer:
      return element("integer", p.name, fmt::format("{}", integer(p)));
    case ParameterKind::number:
      return element("float", p.name, fmt::format("{}", number(p)));
    case ParameterKind::number_or_name:
      if (draw_.chance(0.5)) return element("string", p.name, draw_.one_of(p.choices));
      return element("float", p.name, fmt::format("{}", number(p)));
    case ParameterKind::choice:
      return element("string", p.name, draw_.one_of(p.choices));
    case ParameterKind::text:
    case ParameterKind::file:
      return element("string", p.name, text(info, p));
    case ParameterKind::point:
      return point(p);
    case ParameterKind::color:
      return color(p);
    case ParameterKind::transform:
      return transform(p.name);
    case ParameterKind::array:
      break;  // text has none
  }
  return "";
}

}  // namespace kaustik::fuzz
