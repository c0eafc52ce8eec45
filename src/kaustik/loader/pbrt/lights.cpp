#include "kaustik/loader/pbrt/lights.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <stdexcept>

#include "kaustik/loader/near_names.h"
#include "kaustik/loader/object_parts.h"
#include "kaustik/loader/pbrt/picture_textures.h"

namespace kaustik::pbrt {
namespace {

using std::numbers::pi;

double radians(double degrees) { return degrees * pi / 180; }

/// One lamp as it is read.
struct Lamp : Subject {
  const LightTools& tools;
  const ParameterList& list;
  const Owner& owner;
  const Transform& to_world;

  /// Its light, white of luminance 1 where nothing is given, times `scale` and that factor.
  Value light(const char* name, double factor) const {
    Value value = tools.spectra.read(list, name, SpectrumUse::light, owner).value_or(1.0);
    multiply_value(value, factor * list.number("scale", 1));
    return value;
  }
  /// By how much light is to be multiplied so that a total (power, illuminance) is reached, of
  /// which light of luminance 1 has `of_one`.
  double factor_for(const char* name, double of_one) const {
    const double wanted = list.number(name, -1);
    return wanted > 0 && of_one > 0 ? wanted / of_one : 1;
  }
  /// By which pbrt-v3 multiplies a picture: the luminance of that light.
  double factor_of_picture(const char* name) const {
    const auto tint = tools.spectra.read(list, name, SpectrumUse::light, owner);
    if (!tint) return 1;
    if (const auto number = as_number(*tint)) return *number;
    if (const auto* curve = std::get_if<SpectralCurve>(&*tint)) {
      coloured(name);
      return luminance(*curve);
    }
    const auto colour = as_colour(*tint);
    if (!colour) return 1;
    if (colour->r != colour->g || colour->r != colour->b) coloured(name);
    return luminance(*colour);
  }
  void coloured(const char* name) const {
    approximated(fmt::format("{} makes its picture brighter, but does not colour it", shown(name)));
  }
};

/// From the lamp's space, where it looks along +z, to that of the file. Throws Error(input).
Transform aimed(const Vec3d& from, const Vec3d& to, const Place& place) {
  const Vec3d along = to - from;
  if (!(along.length() > 0))
    throw Error(ErrorKind::input, "'from' and 'to' are the same point", "move one of the two",
                place);
  const Vec3d z = along.normalized();
  const Vec3d up = std::fabs(z.x) > std::fabs(z.y) ? Vec3d(0, 1, 0) : Vec3d(1, 0, 0);
  return Transform::look_at(from, to, up);
}

std::shared_ptr<Object> make_point(const Lamp& lamp) {
  auto light = described("emitter", "point", lamp.place());
  set(*light, "intensity", lamp.light("I", lamp.factor_for("power", 4 * pi)));
  const Vec3d from = lamp.list.point("from").value_or(Vec3d(0, 0, 0));
  set(*light, "to_world", lamp.to_world * Transform::translate(from));
  return light;
}

std::shared_ptr<Object> make_spot(const Lamp& lamp) {
  auto light = described("emitter", "spot", lamp.place());
  const double cone = std::clamp(lamp.list.number("coneangle", 30), 0.01, 179.9);
  const double delta = std::clamp(lamp.list.number("conedeltaangle", 5), 0.0, cone);
  const double inner = std::cos(radians(cone - delta)), outer = std::cos(radians(cone));
  const double solid_angle = 2 * pi * ((1 - inner) + (inner - outer) / 2);
  set(*light, "intensity", lamp.light("I", lamp.factor_for("power", solid_angle)));
  set(*light, "cutoff_angle", cone);
  set(*light, "beam_width", cone - delta);
  // pbrt-v3 falls by the fourth power of the step that is squared here.
  const bool is_old = lamp.tools.is_old;
  if (is_old && delta > 0) lamp.approximated("toward its edge it falls off less steeply");
  set(*light, "falloff", std::string(is_old ? "square" : "smooth"));
  const Vec3d from = lamp.list.point("from").value_or(Vec3d(0, 0, 0));
  const Vec3d to = lamp.list.point("to").value_or(Vec3d(0, 0, 1));
  set(*light, "to_world", lamp.to_world * aimed(from, to, lamp.place()));
  return light;
}

std::shared_ptr<Object> make_distant(const Lamp& lamp) {
  auto light = described("emitter", "directional", lamp.place());
  set(*light, "irradiance", lamp.light("L", lamp.factor_for("illuminance", 1)));
  const Vec3d from = lamp.list.point("from").value_or(Vec3d(0, 0, 0));
  const Vec3d to = lamp.list.point("to").value_or(Vec3d(0, 0, 1));
  const Vec3d along = Vec3d(lamp.to_world.vector(Vec3f(to - from)));
  if (!(along.length() > 0))
    throw Error(ErrorKind::input, "'from' and 'to' are the same point", "move one of the two",
                lamp.place());
  set(*light, "direction", along.normalized());
  return light;
}

/// Kaustik's picture has +y at its upper edge; pbrt's spaces have z up.
Transform z_up_from_y_up() {
  const double rows[4][4] = {{1, 0, 0, 0}, {0, 0, -1, 0}, {0, 1, 0, 0}, {0, 0, 0, 1}};
  return Transform(rows);
}
/// The same for pictures of pbrt-v3, whose left edge is +x and whose columns go toward +y.
Transform old_from_y_up() {
  const double rows[4][4] = {{0, 0, -1, 0}, {1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 0, 1}};
  return Transform(rows);
}

std::shared_ptr<Object> make_infinite(const Lamp& lamp) {
  const bool is_old = lamp.list.has("mapname");
  const std::string file = lamp.list.text(is_old ? "mapname" : "filename");
  const Place& place = lamp.place();
  if (lamp.list.has("portal"))
    lamp.approximated("light comes from everywhere, not through its portal alone");
  const auto path = file.empty() ? std::nullopt : lamp.tools.files.find(file, place);
  if (!path || !is_readable_picture(path->string())) {
    if (!file.empty())
      lamp.deviations.missing(
          lamp.object,
          fmt::format("picture {} is not there: light is alike from everywhere", shown(file)),
          place, where_files_lie);
    auto light = described("emitter", "constant", place);
    set(*light, "radiance", lamp.light("L", lamp.factor_for("illuminance", pi)));
    return light;
  }
  auto light = described("emitter", "envmap", place);
  set(*light, "filename", path->string());
  double scale = lamp.list.number("scale", 1);
  if (lamp.list.number("illuminance", -1) > 0)
    lamp.approximated("'illuminance' has no effect: the picture shines with its own light");
  if (is_old)
    scale *= lamp.factor_of_picture("L");
  else
    set(*light, "projection", std::string("equalarea"));
  set(*light, "scale", std::max(scale, 0.0));
  set(*light, "to_world", lamp.to_world * (is_old ? old_from_y_up() : z_up_from_y_up()));
  return light;
}

/// A picture thrown through a pinhole: a spot whose cone just holds it, dark beside it.
std::shared_ptr<Object> make_projection(const Lamp& lamp) {
  const std::string file = lamp.list.text("filename", lamp.list.text("mapname"));
  const double fov = std::clamp(lamp.list.number("fov", lamp.tools.is_old ? 45 : 90), 1.0, 170.0);
  auto light = described("emitter", "projector", lamp.place());
  auto picture = lamp.tools.textures.picture(file, false, lamp.owner, lamp.place());
  // Its upper edge is at +y of the lamp and its right edge at +x, which is the left of Kaustik's.
  remove_property(*picture, "to_uv");
  set(*picture, "to_uv", Transform::translate({1, 0, 0}) * Transform::scale({-1, 1, 1}));
  hold(*light, "irradiance", picture);
  set(*light, "fov", fov);
  set(*light, "fov_axis", std::string("smaller"));
  set(*light, "scale", lamp.factor_of_picture("I") * lamp.list.number("scale", 1) / pi);
  set(*light, "to_world", lamp.to_world);
  if (lamp.list.number("power", -1) > 0)
    lamp.approximated("'power' has no effect: the picture shines with its own light");
  lamp.approximated("toward its edges it is as bright on a wall as in the middle");
  return light;
}

/// pbrt-v3 turns columns from +x toward +z about +y, which is the upper edge.
Transform old_goniometer_from_y_up() {
  const double rows[4][4] = {{0, 0, -1, 0}, {0, 1, 0, 0}, {1, 0, 0, 0}, {0, 0, 0, 1}};
  return Transform(rows);
}

std::shared_ptr<Object> make_goniometric(const Lamp& lamp) {
  const bool is_old = lamp.tools.is_old;
  const std::string file = lamp.list.text(lamp.list.has("mapname") ? "mapname" : "filename");
  if (file.empty()) return make_point(lamp);
  const auto path = lamp.tools.files.find(file, lamp.place());
  if (!path || !is_readable_picture(path->string())) {
    lamp.deviations.missing(
        lamp.object,
        fmt::format("picture {} is not there: it shines alike in all directions", shown(file)),
        lamp.place(), where_files_lie);
    return make_point(lamp);
  }
  auto light = described("emitter", "goniometric", lamp.place());
  set(*light, "filename", path->string());
  if (!is_old) set(*light, "projection", std::string("equalarea"));
  set(*light, "intensity", lamp.light("I", 1));
  if (const double power = lamp.list.number("power", -1); power > 0) set(*light, "power", power);
  if (is_old) lamp.approximated("its picture counts by its luminance: the colour is that of 'I'");
  set(*light, "to_world", lamp.to_world * (is_old ? old_goniometer_from_y_up() : z_up_from_y_up()));
  return light;
}

using LightMaker = std::shared_ptr<Object> (*)(const Lamp&);

const std::map<std::string_view, LightMaker>& light_makers() {
  static const std::map<std::string_view, LightMaker> rows = {
      {"distant", make_distant},   {"exinfinite", make_infinite}, {"goniometric", make_goniometric},
      {"infinite", make_infinite}, {"point", make_point},         {"projection", make_projection},
      {"spot", make_spot},
  };
  return rows;
}

}  // namespace

std::shared_ptr<Object> make_light(const LightTools& tools, const std::string& type,
                                   const ParameterList& list, const Owner& owner,
                                   const Transform& to_world) {
  const Lamp lamp{{tools.deviations, owner.object, list.place()}, tools, list, owner, to_world};
  list.accept({"nsamples", "samples"});
  const auto maker = light_makers().find(type);
  if (maker != light_makers().end()) return maker->second(lamp);
  tools.deviations.ignored(owner.object, fmt::format("there is no light {}", shown(type)),
                           list.place(), did_you_mean(type, names_in(light_makers())));
  return nullptr;
}

std::shared_ptr<Object> make_area_light(const LightTools& tools, const AreaLight& light,
                                        const Owner& owner, std::optional<double> area) {
  const ParameterList& list = light.parameters;
  const Lamp lamp{{tools.deviations, owner.object, list.place()}, tools, list, owner, {}};
  if (light.type != "diffuse" && light.type != "area")
    lamp.approximated(fmt::format("it shines as one of type 'diffuse', not {}", shown(light.type)));
  list.accept({"nsamples", "samples"});
  auto emitter = described("emitter", "area", list.place());
  const bool is_two_sided = list.flag("twosided", false);
  double factor = 1;
  const std::string file = list.text("filename");
  if (list.number("power", -1) > 0) {
    if (area && *area > 0 && file.empty())
      factor = lamp.factor_for("power", pi * *area * (is_two_sided ? 2 : 1));
    else
      lamp.approximated("'power' has no effect: it shines by 'L' and 'scale'");
  }
  if (file.empty()) {
    set(*emitter, "radiance", lamp.light("L", factor));
  } else {
    hold(*emitter, "radiance", tools.textures.picture(file, false, owner, list.place()));
    set(*emitter, "scale", std::max(list.number("scale", 1), 0.0));
  }
  if (is_two_sided) set(*emitter, "two_sided", true);
  return emitter;
}

}  // namespace kaustik::pbrt
