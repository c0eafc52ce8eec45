// genblinds and replmarks.

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "kaustik/base/error.h"
#include "kaustik/loader/radiance/angles.h"
#include "kaustik/loader/radiance/generators.h"
#include "kaustik/loader/radiance/number_text.h"
#include "kaustik/loader/radiance/primitive_writer.h"

namespace kaustik::radiance {
namespace {

constexpr size_t most_slats = 100'000;

/// The profile of a slat in the plane of depth and height, from the origin. A curved one is an arc
/// of facets of at most 3 degrees; it sags where the radius is above zero, and else it bulges.
std::vector<std::pair<double, double>> slat_profile(double depth, double angle, double radius) {
  if (radius == 0) return {{0, 0}, {depth * std::cos(angle), depth * std::sin(angle)}};
  // A depth below zero is across to the other side.
  const double r = std::fabs(radius);
  const double opening = 2 * std::asin(std::clamp(depth / (2 * r), -1.0, 1.0));
  const int facets = std::max(1, int(std::ceil(std::fabs(opening) / (3 * degree) - 1e-5)));
  const double start = (std::numbers::pi - opening) / 2 - angle;
  std::vector<std::pair<double, double>> profile;
  for (int i = 0; i <= facets; ++i) {
    const double step = opening * i / facets;
    if (radius > 0) {
      const double first = start + opening, at = first - step;
      profile.emplace_back(r * (std::cos(at) - std::cos(first)),
                           r * (std::sin(first) - std::sin(at)));
    } else {
      const double at = start + step;
      profile.emplace_back(r * (std::cos(start) - std::cos(at)),
                           r * (std::sin(at) - std::sin(start)));
    }
  }
  return profile;
}

/// What replaces a kind of marker.
struct Marker {
  std::string modifier, file, type;  ///< type: "xform", "instance" or "mesh"
  std::string new_modifier;          ///< "": as in the file
  double scale = 0;                  ///< of the marker's longest leg; 0: none
};

/// A side of a marker, directed.
struct MarkerSide {
  Vec3d from, to;
  double length() const { return (to - from).length(); }
};

/// The options of xform that put an object where a marker is: its longest side is the hypotenuse,
/// the next one x, the third one y. Nothing for what is no marker.
std::optional<std::string> marker_transform(const Primitive& marker, double scale) {
  const size_t n = marker.reals.size() / 3;
  if (marker.reals.size() % 3 != 0 || n < 3 || n > 6) return std::nullopt;
  const auto corner = [&](size_t i) {
    const double* p = &marker.reals[3 * (i % n)];
    return Vec3d(p[0], p[1], p[2]);
  };
  std::vector<MarkerSide> sides;
  for (size_t i = 0; i < n; ++i) sides.push_back({corner(i + n - 1), corner(i)});
  std::stable_sort(sides.begin(), sides.end(), [](const MarkerSide& a, const MarkerSide& b) {
    return a.length() > b.length();
  });
  MarkerSide x = sides[1], y = sides[2];
  if (x.to == y.from || x.to == y.to) std::swap(x.from, x.to);
  if (y.to == x.from) std::swap(y.from, y.to);
  if (x.from != y.from) return std::nullopt;
  const double length = x.length();
  const Vec3d i = (x.to - x.from).normalized();
  const Vec3d k = i.cross(y.to - y.from).normalized(), j = k.cross(i);
  if (!(length > 0) || k == Vec3d(0, 0, 0)) return std::nullopt;
  std::string options = scale > 0 ? fmt::format(" -s {}", length * scale) : std::string();
  // The columns i, j, k of a rotation about x, then y, then z.
  const double about_y = std::asin(std::clamp(-i.z, -1.0, 1.0));
  const bool is_upright = i.x * i.x + i.y * i.y < 1e-12;
  const double about_x = is_upright ? 0 : std::atan2(j.z, k.z);
  const double about_z = is_upright ? -std::atan2(j.x, j.y) : std::atan2(i.y, i.x);
  return options + fmt::format(" -rx {} -ry {} -rz {} -t {} {} {}", about_x / degree,
                               about_y / degree, about_z / degree, x.from.x, x.from.y, x.from.z);
}

std::vector<Marker> read_markers(CommandArguments& arguments) {
  std::vector<Marker> markers;
  Marker next;
  while (arguments.at_option()) {
    const std::string option = arguments.text();
    if (option == "-e") continue;
    const std::string value = arguments.text();
    if (option == "-m") {
      next.new_modifier = value;
    } else if (option == "-s") {
      next.scale = number_of(value).value_or(0);
    } else if (option == "-x" || option == "-i" || option == "-I") {
      next.file = value;
      next.type = option == "-x" ? "xform" : option == "-i" ? "instance" : "mesh";
    } else {
      arguments.refuse(fmt::format("'replmarks' has no option '{}'", option.substr(0, 40)));
    }
    if (next.file.empty() || arguments.at_option()) continue;
    next.modifier = arguments.text();
    markers.push_back(next);
    next.file.clear();
    next.new_modifier.clear();
  }
  if (markers.empty()) arguments.refuse("'replmarks' lacks an object to put in place of markers");
  return markers;
}

void add_replaced(PrimitiveWriter& writer, const Primitive& marker, const Marker& by,
                  const Place& place) {
  const auto transform = marker_transform(marker, by.scale);
  if (!transform)
    throw Error(ErrorKind::input, fmt::format("the marker {} shows no direction", name_of(marker)),
                "markers are triangles with sides of three lengths, whose shorter two meet at the "
                "origin of the object",
                place);
  if (by.type == "xform") {
    writer.line(fmt::format("!xform{}{} '{}'",
                            by.new_modifier.empty() ? "" : " -m '" + by.new_modifier + "'",
                            *transform, by.file));
    return;
  }
  Primitive instance;
  instance.modifier = by.new_modifier.empty() ? "void" : by.new_modifier;
  instance.type = by.type;
  instance.id = marker.id;
  instance.strings = {by.file};
  std::string_view rest = *transform;
  while (!rest.empty()) {
    rest.remove_prefix(1);
    const size_t end = std::min(rest.find(' '), rest.size());
    instance.strings.emplace_back(rest.substr(0, end));
    rest.remove_prefix(end);
  }
  writer.add(instance);
}

}  // namespace

std::string generate_blinds(const Words& words, const GeneratorContext& context) {
  CommandArguments arguments(
      words, "genblinds material name depth width height slats degrees [-r|+r radius]",
      context.place);
  const std::string modifier = arguments.text(), id = arguments.text();
  const double depth = arguments.number(), width = arguments.number(), height = arguments.number();
  const size_t slats = arguments.count(most_slats);
  const double angle = arguments.number() * degree;
  double radius = 0;
  if (!arguments.at_end()) {
    const std::string option = arguments.text();
    if (option != "-r" && option != "+r")
      arguments.refuse(fmt::format("'genblinds' has no option '{}'", option.substr(0, 40)));
    radius = (option == "-r" ? 1 : -1) * arguments.number();
  }
  const auto profile = slat_profile(depth, angle, radius);
  PrimitiveWriter writer(context.place);
  for (size_t slat = 1; slat <= slats; ++slat) {
    const double z = height * (double(slat) - 0.5) / double(slats);
    for (size_t i = 0; i + 1 < profile.size(); ++i) {
      const auto& [x0, z0] = profile[i];
      const auto& [x1, z1] = profile[i + 1];
      writer.polygon(modifier, fmt::format("{}.{}.{}", id, slat, i),
                     std::array{Vec3d(x0, 0, z + z0), Vec3d(x0, width, z + z0),
                                Vec3d(x1, width, z + z1), Vec3d(x1, 0, z + z1)});
    }
  }
  return writer.take();
}

std::string replace_marks(const Words& words, const GeneratorContext& context) {
  CommandArguments arguments(
      words, "replmarks [-s size] [-m modifier] -x object.rad marker … file.rad", context.place);
  const std::vector<Marker> markers = read_markers(arguments);
  std::string text;
  if (arguments.at_end() && context.input) text = *context.input;
  while (!arguments.at_end()) text += context.read_part(arguments.text()) + "\n";
  PrimitiveWriter writer(context.place);
  for (const Statement& statement : read_statements(text, [&](size_t) { return context.place; })) {
    const auto* primitive = std::get_if<Primitive>(&statement);
    if (!primitive) {
      writer.line("!" + std::get<Command>(statement).text);
      continue;
    }
    const auto by = std::find_if(markers.begin(), markers.end(), [&](const Marker& marker) {
      return primitive->type == "polygon" && primitive->modifier == marker.modifier;
    });
    if (by == markers.end())
      writer.add(*primitive);
    else
      add_replaced(writer, *primitive, *by, context.place);
  }
  return writer.take();
}

}  // namespace kaustik::radiance
