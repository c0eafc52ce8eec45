#include "tests/fuzz/scene_grammar.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>

#include "kaustik/base/vec.h"
#include "kaustik/integrator/registry.h"
#include "kaustik/scene/camera.h"
#include "kaustik/scene/spectrum_types.h"
#include "tests/fuzz/parameter_values.h"
#include "tests/support/serialized_file.h"
#include "tests/support/vol_file.h"

namespace kaustik::fuzz {
namespace {

constexpr int deepest_nesting = 4;

/// The rows whose type fits.
template <typename Row, typename Fits>
std::vector<const Row*> rows_that(const std::vector<Row>& rows, const Fits& fits) {
  std::vector<const Row*> result;
  for (const Row& row : rows)
    if (fits(row)) result.push_back(&row);
  return result;
}

using Names = std::vector<std::string>;

bool holds(const Names& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// Shapes that nobody samples by area.
bool can_shine(const TypeInfo& shape) { return shape.name != "sdf" && shape.name != "sdfgrid"; }

/// Parameters of which a type takes either the first or the second.
const std::vector<std::pair<Names, Names>>& alternatives() {
  static const std::vector<std::pair<Names, Names>> list = {
      {{"albedo", "sigma_t"}, {"sigma_a", "sigma_s"}},
      {{"material"}, {"eta", "k"}},
      {{"material"}, {"albedo", "sigma_t", "sigma_a", "sigma_s"}},
      {{"reflectance", "edge_tint"}, {"material", "eta", "k", "ext_eta"}},
      {{"alpha"}, {"alpha_u", "alpha_v"}},
      {{"position"}, {"to_world"}},
      {{"direction"}, {"to_world"}},
      {{"intensity"}, {"power"}},
      {{"eta"}, {"specular"}},
      {{"roughness"}, {"alpha"}},
      {{"sun_direction"},
       {"latitude", "longitude", "timezone", "year", "month", "day", "hour", "minute", "second"}}};
  return list;
}

/// What cannot stand in a bsdf of this type.
const Names& misfits_in(const std::string& type) {
  static const Names none, relief = {"bumpmap", "normalmap"},
                           see_through = {"dielectric", "roughdielectric", "thindielectric",
                                          "difftrans",  "thinphong",       "mask",
                                          "null"};
  if (type == "twosided" || type == "coating" || type == "roughcoating") return see_through;
  return type == "bumpmap" || type == "normalmap" || type == "blendbsdf" || type == "mixturebsdf"
             ? relief
             : none;
}

class Grammar {
 public:
  Grammar(uint64_t seed, const std::string& files_folder)
      : draw_(seed), values_(draw_, files_folder) {
    values_.wildness = draw_.one_of({0.0, 0.005, 0.02, 0.05, 0.3});
  }

  GeneratedScene scene() {
    GeneratedScene result;
    result.begin = joined({"<scene version=\"3.0.0\">\n", sensor(), definitions(), content()});
    result.end = "</scene>\n";
    for (const IntegratorType& type : integrator_types())
      result.integrators.push_back({type.info.name, integrator(type.info)});
    return result;
  }

 private:
  std::string open(const TypeInfo& info, const std::string& name = "", const std::string& id = "") {
    return fmt::format("<{} type=\"{}\"{}{}>", info.family, info.name,
                       name.empty() ? "" : " name=\"" + name + "\"",
                       id.empty() ? "" : " id=\"" + id + "\"");
  }
  static std::string close(const TypeInfo& info) { return "</" + info.family + ">\n"; }

  /// Some of the type's parameters; textures stand for some that take them. Those that `skips`
  /// names are left out.
  std::string properties(const TypeInfo& info, Names skips = {}, int depth = 0) {
    if (draw_.chance(0.98))
      for (const auto& [first, second] : alternatives()) {
        if (!info.find(first[0]) || !info.find(second[0])) continue;
        const Names& other = draw_.chance(0.5) ? first : second;
        skips.insert(skips.end(), other.begin(), other.end());
      }
    // Of eta and k each needs the other.
    const bool both = info.find("k") && !holds(skips, "k") && draw_.chance(0.5);
    if (info.find("k") && !both) skips.insert(skips.end(), {"eta", "k"});
    std::string result;
    for (const Parameter& p : info.parameters) {
      if (holds(skips, p.name)) continue;
      const bool only_texture = p.accepts_texture && p.kind != ParameterKind::file &&
                                std::holds_alternative<std::monostate>(p.default_value);
      const bool costly = p.name.find("photons") != std::string::npos ||
                          p.name == "cache_samples" || p.name == "samples_per_pass";
      const bool needed = both && (p.name == "eta" || p.name == "k");
      if (!p.required && !only_texture && !costly && !needed && !draw_.chance(0.3)) continue;
      if (p.accepts_texture && depth < deepest_nesting && (only_texture || draw_.chance(0.3)))
        result += texture(p.name, depth + 1);
      else if (p.accepts_volume && takes_volume(info, p.name))
        result += volume(p.name);
      else if (p.kind == ParameterKind::color && draw_.chance(0.1))
        result += spectrum(p.name);
      else
        result += values_.property(info, p);
    }
    return result;
  }

  std::string texture(const std::string& name, int depth) {
    // Few shapes have what a texture may ask them for.
    const TextureType* type = &draw_.one_of(texture_types());
    if (type->asks_surface && draw_.chance(0.8)) type = &draw_.one_of(texture_types());
    return open(type->info, name) + properties(type->info, {}, depth) + close(type->info);
  }

  /// The density of what is homogeneous can be no grid.
  bool takes_volume(const TypeInfo& info, const std::string& name) {
    return draw_.chance(info.name == "homogeneous" && name == "sigma_t" ? 0.03 : 0.4);
  }
  std::string volume(const std::string& name) {
    const TypeInfo& info = draw_.one_of(volume_types()).info;
    Names skips;  // no albedo is above 1
    if (name == "albedo" && draw_.chance(0.9)) skips.emplace_back("value");
    return open(info, name) + properties(info, skips) + close(info);
  }

  std::string phase(int depth = 0) {
    const auto fitting = rows_that(phase_function_types(), [&](const PhaseFunctionType& type) {
      return type.nested == 0 || depth < deepest_nesting;
    });
    const PhaseFunctionType& type = *draw_.one_of(fitting);
    std::string result = open(type.info) + properties(type.info);
    for (size_t i = 0; i < type.nested; ++i) result += phase(depth + 1);
    return result + close(type.info);
  }

  std::string spectrum(const std::string& name) {
    const TypeInfo& info = draw_.one_of(spectrum_types()).info;
    return open(info, name) + properties(info) + close(info);
  }

  std::string bsdf(const Names& misfits = {}, int depth = 0, const std::string& id = "") {
    if (id.empty() && bsdfs_ > 0 && draw_.chance(misfits.empty() ? 0.3 : 0.02))
      return fmt::format("<ref id=\"b{}\"/>", draw_.below(bsdfs_));
    const auto fitting = rows_that(bsdf_types(), [&](const BsdfType& type) {
      if (holds(misfits, type.info.name) && !draw_.chance(0.02)) return false;
      return type.minimum_nested == 0 || depth < deepest_nesting;
    });
    const BsdfType& type = *draw_.one_of(fitting);
    // Those that take any number take a few.
    const int spare =
        depth < deepest_nesting ? std::min(2, type.maximum_nested - type.minimum_nested) : 0;
    const int nested = type.minimum_nested + (spare > 0 ? int(draw_.below(size_t(spare) + 1)) : 0);
    std::string result = open(type.info, "", id) + properties(type.info, {"weights"});
    if (type.info.find("weights") && draw_.chance(0.95)) result += weights(nested);
    Names inside = misfits_in(type.info.name);
    inside.insert(inside.end(), misfits.begin(), misfits.end());
    for (int i = 0; i < nested; ++i) result += bsdf(inside, depth + 1);
    return result + close(type.info);
  }

  std::string weights(int count) {
    std::string list;
    for (int i = 0; i < count; ++i)
      list += fmt::format("{:.3g}, ", draw_.one_of({0.0, 0.2, 0.3, 0.5, 1.0}));
    return "<string name=\"weights\" value=\"" + list + "\"/>";
  }

  std::string medium(const std::string& name, const std::string& id = "") {
    if (id.empty() && media_ > 0 && draw_.chance(0.5))
      return fmt::format("<ref{} id=\"m{}\"/>", name.empty() ? "" : " name=\"" + name + "\"",
                         draw_.below(media_));
    const TypeInfo& info = draw_.one_of(medium_types()).info;
    std::string result = open(info, name, id) + properties(info);
    if (draw_.chance(0.5)) result += phase();
    return result + close(info);
  }

  /// `of_shape`: the type of the shape that it stands in; "": none.
  std::string emitter(const std::string& of_shape) {
    // Beams are flat.
    const bool may_be_beam = of_shape == "rectangle" || of_shape == "disk" || draw_.chance(0.1);
    const auto fitting = rows_that(light_types(), [&](const LightType& type) {
      return type.needs_shape == !of_shape.empty() &&
             (may_be_beam || type.info.name != "directionalarea");
    });
    const TypeInfo& info = draw_.one_of(fitting)->info;
    std::string result = open(info) + properties(info);
    if (of_shape.empty() && draw_.chance(0.1)) result += medium("");
    return result + close(info);
  }

  std::string shape_in(const TypeInfo& info, bool shines, const std::string& placed) {
    std::string result = open(info);
    // Few files hold many meshes, or materials of a certain name.
    Names skips = {"to_world"};
    for (const char* name : {"shape_index", "material"})
      if (draw_.chance(0.9)) skips.emplace_back(name);
    result += properties(info, skips) + placed;
    if (draw_.chance(0.9)) result += bsdf(shines ? Names{"null"} : Names{});
    if (shines) result += emitter(info.name);
    for (const char* side : {"interior", "exterior"})
      if (draw_.chance(0.15)) result += medium(side);
    if (draw_.chance(0.03)) {
      const auto models =
          rows_that(integrator_types(), [](const IntegratorType& type) { return type.is_model; });
      const TypeInfo& model = draw_.one_of(models)->info;
      // These are the whole picture's.
      result += open(model) +
                properties(model, {"components", "samples_per_pass", "hide_emitters"}) +
                close(model);
    }
    return result + close(info);
  }

  std::string shape(bool shines) {
    // Text has no buffers.
    const auto types = rows_that(shape_types(), [](const ShapeType& type) {
      return std::none_of(
          type.info.parameters.begin(), type.info.parameters.end(),
          [](const Parameter& p) { return p.required && p.kind == ParameterKind::array; });
    });
    const TypeInfo& info = draw_.one_of(types)->info;
    return shape_in(info, shines && can_shine(info), values_.transform("to_world"));
  }

  /// A room around everything.
  std::string room() {
    return joined(
        {"<shape type=\"cube\"><boolean name=\"flip_normals\" value=\"true\"/>"
         "<transform name=\"to_world\"><scale value=\"4\"/></transform>",
         bsdf(), draw_.chance(0.1) ? medium("interior") : "", "</shape>\n"});
  }

  std::string group(const std::string& id) {
    std::string result = "<shape type=\"shapegroup\" id=\"" + id + "\">\n";
    for (size_t i = 1 + draw_.below(2); i > 0; --i) result += shape(draw_.chance(0.1));
    if (groups_ > 0 && draw_.chance(0.4)) result += instance();
    return result + "</shape>\n";
  }

  std::string instance() {
    return joined({fmt::format("<shape type=\"instance\"><ref id=\"g{}\"/>", draw_.below(groups_)),
                   values_.transform("to_world"), "</shape>\n"});
  }

  /// What others refer to: each may refer to those before it.
  std::string definitions() {
    std::string result;
    for (size_t count = draw_.below(4); media_ < count; ++media_)
      result += medium("", fmt::format("m{}", media_));
    for (size_t count = draw_.below(4); bsdfs_ < count; ++bsdfs_)
      result += bsdf({}, 0, fmt::format("b{}", bsdfs_));
    for (size_t count = draw_.chance(0.3) ? 1 + draw_.below(2) : 0; groups_ < count; ++groups_)
      result += group(fmt::format("g{}", groups_));
    return result;
  }

  std::string content() {
    std::string result = draw_.chance(0.4) ? room() : "";
    for (size_t i = 1 + draw_.below(4); i > 0; --i) result += shape(draw_.chance(0.3));
    if (draw_.chance(0.05))
      result += joined({"<shape type=\"merge\">", shape(false), shape(true), "</shape>\n"});
    if (groups_ > 0)
      for (size_t i = 1 + draw_.below(3); i > 0; --i) result += instance();
    for (size_t i = draw_.below(4); i > 0; --i) result += emitter("");
    return result;
  }

  std::string integrator(const TypeInfo& info) {
    return open(info) + properties(info) + close(info);
  }

  std::string sensor() {
    if (!draw_.chance(0.05)) return single_sensor();
    return joined({"<sensor type=\"batch\">", single_sensor(), single_sensor(), "</sensor>\n"});
  }

  std::string single_sensor() {
    // Few integrators know of points in the air.
    const bool may_have_gauges = draw_.chance(0.3);
    const auto types = rows_that(camera_types(), [&](const CameraType& row) {
      return may_have_gauges || row.info.name != "irradiancepoints";
    });
    const CameraType& type = *draw_.one_of(types);
    Names skips = {"to_world", "focal_length", "origin", "direction"};
    // Few cameras see nothing but what is near.
    if (draw_.chance(0.9)) skips.emplace_back("far_clip");
    std::string result = joined({open(type.info), view(type.info), properties(type.info, skips),
                                 draw_.chance(0.15) ? medium("") : ""});
    if (type.takes_shape && draw_.chance(0.3)) result += shape(false);
    result += film() + close(type.info);
    if (!type.needs_shape) return result;
    return joined({"<shape type=\"rectangle\">", values_.transform("to_world"), result,
                   draw_.chance(0.3) ? bsdf() : "", "</shape>\n"});
  }

  /// Where a camera stands and looks.
  std::string view(const TypeInfo& info) {
    if (!info.find("to_world")) return "";
    if (info.find("direction") && draw_.chance(0.5)) {
      std::string result = values_.property(info, *info.find("direction"));
      if (const Parameter* origin = info.find("origin")) result += values_.property(info, *origin);
      return result;
    }
    if (draw_.chance(values_.wildness)) return values_.transform("to_world");
    const Vec3d from{draw_.between(-1, 1), draw_.between(-1, 1), draw_.between(-3.5, -2)};
    return fmt::format(
        "<transform name=\"to_world\"><lookat origin=\"{:.3g}, {:.3g}, {:.3g}\" target=\"0, 0, 0\" "
        "up=\"0, 1, 0\"/></transform>",
        from.x, from.y, from.z);
  }

  std::string film() {
    const TypeInfo& type = draw_.one_of(film_types()).info;
    std::string result = open(type) +
                         "<integer name=\"width\" value=\"6\"/><integer name=\"height\" "
                         "value=\"6\"/>";
    if (draw_.chance(0.1)) result += "<string name=\"quantity\" value=\"irradiance\"/>";
    if (draw_.chance(0.1))
      result +=
          "<integer name=\"crop_offset_x\" value=\"2\"/><integer name=\"crop_height\" "
          "value=\"3\"/>";
    const TypeInfo& filter = draw_.one_of(filter_types()).info;
    if (draw_.chance(0.5)) result += open(filter) + properties(filter) + close(filter);
    result += close(type);
    const TypeInfo& sampler = draw_.one_of(sampler_infos());
    if (draw_.chance(0.1)) result += open(sampler) + properties(sampler) + close(sampler);
    return result;
  }

  Draw draw_;
  ParameterValues values_;
  size_t media_ = 0, bsdfs_ = 0, groups_ = 0;  ///< that may be referred to
};

/// At the nodes of a grid of 3³ over the unit cube, to a ball in its middle.
std::vector<float> distances_to_ball() {
  std::vector<float> values;
  for (int z = 0; z < 3; ++z)
    for (int y = 0; y < 3; ++y)
      for (int x = 0; x < 3; ++x)
        values.push_back(0.5f * length(Vec3f(float(x - 1), float(y - 1), float(z - 1))) - 0.4f);
  return values;
}

void write_pfm(const std::string& path, int width, int height, const std::vector<float>& pixels) {
  std::ofstream file(path, std::ios::binary);
  file << fmt::format("PF\n{} {}\n-1.0\n", width, height);
  for (int i = 0; i < 3 * width * height; ++i) {
    const float value = pixels[size_t(i) % pixels.size()];
    file.write(reinterpret_cast<const char*>(&value), sizeof(value));
  }
}

}  // namespace

GeneratedScene generate_scene(uint64_t seed, const std::string& files_folder) {
  return Grammar(seed, files_folder).scene();
}

void write_files(const std::string& folder) {
  const auto write = [&](const std::string& name, const std::string& text) {
    std::ofstream(folder + "/" + name, std::ios::binary) << text;
  };
  write("quad.obj",
        "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
        "f 1/1 2/2 3/3 4/4\n");
  write("tent.obj",
        "v -1 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 -1\nv 0 1 1 1 1 1\nvn 0 1 0\nvn 0 -1 0\n"
        "f 1//1 2//1 3//2\nf 1//2 2//1 4//1\n");
  write("flat.obj", "v 0 0 0\nv 1 1 1\nv 2 2 2\nv 0 1 0\nf 1 2 3\nf 1 2 4\nf 1 1 2\n");
  write("far.obj", "v 0 0 0\nv 1e30 0 0\nv 0 1 0\nv 1e-30 1e-30 0\nf 1 2 3\nf 1 3 4\n");
  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty "
      "float y\nproperty float z\nelement face 2\nproperty list uchar int "
      "vertex_indices\nend_header\n";
  write("pyramid.ply", ply + "0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 1 2\n3 0 3 1\n");
  write("painted.ply",
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty "
        "float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\nelement face "
        "2\nproperty list uchar int vertex_indices\nproperty float heat_x\nend_header\n"
        "0 0 0 255 0 0\n1 0 0 0 255 0\n0 1 0 0 0 255\n0 0 1 9 9 9\n3 0 1 2 -1\n3 0 3 1 1e30\n");
  write("pair.serialized",
        test::serialized_file(
            {{.flags = 0x1000, .arrays = {{0, 0, 0, 1, 0, 0, 0, 1, 0}}, .corners = {0, 1, 2}},
             {.flags = 3 | 0x2000,
              .arrays = {{-1, -1, 0, 1, -1, 0, 0, 1, 1},
                         {0, 0, 1, 0, 0, 1, 0, 0, 1},
                         {0, 0, 1, 0, 0, 1}},
              .corners = {0, 1, 2}}},
            4));
  write("cloud.vol", test::vol_file({3, 2, 2}, {0, 0.5, 1, 0.2f, 0, 0, 0.1f, 0.7f, 0, 0, 1, 0.2f}));
  write("bytes.vol", test::vol_file({2, 2, 2}, {0, 0.5, 1, 0, 1, 0, 1, 1}, {.encoding = 3}));
  write("colors.vol", test::vol_file({2, 1, 1}, {0.1f, 0.5f, 0.9f, 1, 0.5f, 0}, {.channels = 3}));
  write("flow.vol", test::vol_file({1, 1, 1}, {1, 2, 3, 4, 5, 6}, {.channels = 6}));
  write("ball.vol", test::vol_file({3, 3, 3}, distances_to_ball()));
  write("folds.vol", test::vol_file({2, 3, 2}, {1, -1, -1, 1, 0, 2, -1, 1, 1, -1, 1, -1}));
  write("packed.serialized", test::serialized_file({test::record_mesh()}));
  write("needle.ply", ply + "0 0 0\n1 0 0\n1 1e-20 0\n1e6 1e6 1e6\n3 0 1 2\n3 0 1 3\n");
  write_pfm(folder + "/colors.pfm", 8, 4, {0.1f, 0.5f, 0.9f, 0.3f, 0.7f});
  write_pfm(folder + "/one.pfm", 1, 1, {0.5f, 0.6f, 0.7f});
  write_pfm(folder + "/bright.pfm", 4, 2, {0.0f, 1e30f, 1e-30f, 1.0f, 2.0f});
  write_pfm(folder + "/black.pfm", 2, 2, {0.0f});
}

}  // namespace kaustik::fuzz
