#include "kaustik/loader/radiance/views.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kaustik/base/error.h"
#include "kaustik/base/text_lines.h"
#include "kaustik/loader/radiance/angles.h"
#include "kaustik/loader/radiance/number_text.h"

namespace kaustik::radiance {
namespace {

/// The words of view options, one after the other.
class ViewReader {
 public:
  ViewReader(std::string_view text, const Place& place) : rest_(text), place_(place) {}

  std::string_view word() {
    const size_t begin = std::min(rest_.find_first_not_of(" \t\r\n"), rest_.size());
    rest_.remove_prefix(begin);
    const size_t end = std::min(rest_.find_first_of(" \t\r\n"), rest_.size());
    const std::string_view word = rest_.substr(0, end);
    rest_.remove_prefix(end);
    return word;
  }
  double number(std::string_view option) {
    const auto value = number_of(word());
    if (!value)
      throw Error(ErrorKind::input,
                  fmt::format("the view's '{}' lacks a number", option.substr(0, 20)),
                  "write as in: -vtv -vp 0 0 1.5 -vd 0 1 0 -vu 0 0 1 -vh 60 -vv 45", place_);
    return *value;
  }
  Vec3d vector(std::string_view option) {
    const double x = number(option), y = number(option);
    return {x, y, number(option)};
  }

 private:
  std::string_view rest_;
  Place place_;
};

void read_options(ViewReader& reader, View& view,
                  const std::function<std::string(const std::string& file)>& read, int depth) {
  for (auto word = reader.word(); !word.empty(); word = reader.word()) {
    if (word.size() == 4 && word.starts_with("-vt")) {
      view.type = word[3];
    } else if (word == "-vp") {
      view.point = reader.vector(word);
    } else if (word == "-vd") {
      view.direction = reader.vector(word);
    } else if (word == "-vu") {
      view.up = reader.vector(word);
    } else if (word == "-vh") {
      view.horizontal = reader.number(word);
    } else if (word == "-vv") {
      view.vertical = reader.number(word);
    } else if (word == "-vs") {
      view.shift = reader.number(word);
    } else if (word == "-vl") {
      view.lift = reader.number(word);
    } else if (word == "-vo") {
      view.fore = reader.number(word);
    } else if (word == "-va") {
      view.aft = reader.number(word);
    } else if (word == "-vf") {
      const std::string file(reader.word());
      if (depth > 5)
        throw Error(ErrorKind::input, "view files name one another without end",
                    "write the view into one file", view.place);
      const auto line = view_line_of(read(file));
      if (!line)
        throw Error(ErrorKind::input, fmt::format("'{}' holds no view", file.substr(0, 200)),
                    "a view file has a line such as: rvu -vtv -vp 0 0 1.5 -vd 0 1 0", view.place);
      ViewReader inner(*line, view.place);
      read_options(inner, view, read, depth + 1);
    }
  }
}

void check(const View& view) {
  const auto refuse = [&](const std::string& message, const std::string& remedy) {
    throw Error(ErrorKind::input, message, remedy, view.place);
  };
  if (std::string_view("vlhasc").find(view.type) == std::string_view::npos)
    refuse(fmt::format("there is no view of type '-vt{}'", view.type),
           "use -vtv, -vtl, -vth, -vta, -vts or -vtc");
  if (!(view.direction.cross(view.up).length() > 1e-9 * view.direction.length() * view.up.length()))
    refuse("the view's direction and its up vector are parallel, or zero",
           "give -vd and -vu that stand across one another");
  const double widest = view.type == 'v' ? 179.8 : view.type == 'l' ? 1e9 : 360;
  if (!(view.horizontal > 0 && view.horizontal <= widest && view.vertical > 0 &&
        view.vertical <= widest))
    refuse(fmt::format("the view's size of {} by {} is none that its type can show",
                       view.horizontal, view.vertical),
           "correct -vh and -vv");
}

/// Height over width of the picture.
double aspect_of(const View& view) {
  const double h = view.horizontal * degree, v = view.vertical * degree;
  switch (view.type) {
    case 'v':
      return std::tan(v / 2) / std::tan(h / 2);
    case 'c':
      return 2 * std::tan(std::min(v, 179 * degree) / 2) / h;
    case 'h':
      return std::sin(std::min(v, std::numbers::pi) / 2) /
             std::sin(std::min(h, std::numbers::pi) / 2);
    case 's':
      return std::tan(std::min(v, 359 * degree) / 4) / std::tan(std::min(h, 359 * degree) / 4);
    default:
      return view.vertical / view.horizontal;
  }
}

/// As large as fits with square pixels, as rpict does.
std::pair<int64_t, int64_t> size_of(const View& view, const PictureOptions& options) {
  const double aspect = aspect_of(view);
  double width = options.width, height = options.height;
  if (height > width * aspect)
    height = width * aspect;
  else
    width = height / aspect;
  const auto pixels = [](double size) {
    return int64_t(std::clamp(std::floor(size + 0.5), 1.0, 65536.0));
  };
  return {pixels(width), pixels(height)};
}

/// Fisheyes have one angle for all directions, and no shift.
void put_fisheye(Object& sensor, const View& view, Deviations& deviations) {
  const auto approximated = [&](const std::string& what) {
    deviations.approximated("view " + view.name, what, view.place);
  };
  give(sensor, "mapping",
       std::string(view.type == 'a'   ? "equidistant"
                   : view.type == 'h' ? "hemispherical"
                                      : "stereographic"));
  const double widest = view.type == 'h' ? 180 : view.type == 's' ? 359 : 360;
  // The circle is as wide as the shorter side.
  give(sensor, "fov", std::min({view.horizontal, view.vertical, widest}));
  if (std::fabs(view.horizontal - view.vertical) > 1e-6)
    approximated("it shows the smaller of its two angles in all directions");
  if (view.shift != 0 || view.lift != 0) approximated("its shift and lift are left out");
}

ObjectPointer film_of(const View& view, const PictureOptions& options) {
  const auto [width, height] = size_of(view, options);
  const ObjectPointer film = make_object("film", "hdrfilm", view.place);
  give(*film, "width", width);
  give(*film, "height", height);
  if (options.exposure_stops != 0)
    give(*film, "exposure", std::clamp(options.exposure_stops, -100.0, 100.0));
  return film;
}

}  // namespace

View read_view(std::string_view text, const Place& place,
               const std::function<std::string(const std::string& file)>& read) {
  View view;
  view.place = place;
  ViewReader reader(text, place);
  std::string_view first = trimmed(text);
  if (const std::string_view name = next_word(first); !name.starts_with('-')) view.name = name;
  read_options(reader, view, read, 0);
  check(view);
  return view;
}

std::optional<std::string> view_line_of(std::string_view text) {
  std::optional<std::string> found;
  while (!text.empty()) {
    const std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(line.size() + 1, text.size()));
    // Of a picture's header all but the pixels; the last view counts.
    const std::string_view trimmed_line = trimmed(line);
    if (trimmed_line.starts_with("#") && !trimmed_line.starts_with("#?")) continue;
    if (trimmed_line.find(" -v") != std::string_view::npos || trimmed_line.starts_with("-v") ||
        trimmed_line.starts_with("VIEW="))
      found =
          std::string(trimmed_line.starts_with("VIEW=") ? trimmed_line.substr(5) : trimmed_line);
  }
  return found;
}

ObjectPointer camera_of(const View& view, const PictureOptions& options, Deviations& deviations) {
  const Vec3d direction = view.direction.normalized();
  const bool has_lens = options.lens_diameter > 0 && view.type == 'v';
  const char* type = view.type == 'v'   ? has_lens ? "thinlens" : "perspective"
                     : view.type == 'l' ? "orthographic"
                     : view.type == 'c' ? "cylinder"
                                        : "fisheye";
  const ObjectPointer sensor = make_object("sensor", type, view.place);
  sensor->id = view.name;
  Transform to_world = Transform::look_at(view.point, view.point + direction, view.up);
  if (view.type == 'v') {
    give(*sensor, "fov", view.horizontal);
    give(*sensor, "fov_axis", std::string("x"));
    if (view.shift != 0) give(*sensor, "principal_point_offset_x", view.shift);
    if (view.lift != 0) give(*sensor, "principal_point_offset_y", -view.lift);
    if (has_lens) {
      give(*sensor, "aperture_radius", options.lens_diameter / 2);
      give(*sensor, "focus_distance", view.direction.length());
    }
  } else if (view.type == 'l') {
    // +x points to the left.
    const double half = view.horizontal / 2;
    to_world = to_world *
               Transform::translate({-view.shift * view.horizontal, view.lift * view.vertical, 0}) *
               Transform::scale({half, half, 1});
  } else if (view.type == 'c') {
    give(*sensor, "fov", std::min(view.horizontal, 360.0));
    if (view.shift != 0 || view.lift != 0)
      deviations.approximated("view " + view.name, "its shift and lift are left out", view.place);
  } else {
    put_fisheye(*sensor, view, deviations);
  }
  give(*sensor, "to_world", to_world);
  if (view.fore > 0) give(*sensor, "near_clip", view.fore);
  if (view.aft > 0) give(*sensor, "far_clip", view.aft);
  nest(*sensor, film_of(view, options));
  return sensor;
}

}  // namespace kaustik::radiance
