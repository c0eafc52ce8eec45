#include "tests/agreement/block_samples.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <sstream>

#include "kaustik/base/error.h"
#include "kaustik/image/image_io.h"
#include "kaustik/integrator/override_integrator.h"
#include "kaustik/loader/scene_format.h"
#include "kaustik/render/session.h"
#include "kaustik/scene/overrides.h"
#include "kaustik/scene/scene.h"

namespace kaustik::agreement {
namespace {

double luminance_of(const Vec3f& value) {
  return 0.2126 * double(value.x) + 0.7152 * double(value.y) + 0.0722 * double(value.z);
}

std::vector<float> pixel_luminances(const Image& image, const std::string& component) {
  const RgbView rgb = rgb_view(image, component);
  std::vector<float> values(image.pixel_count());
  for (size_t i = 0; i < values.size(); ++i) values[i] = float(luminance_of(rgb[i]));
  return values;
}

std::vector<float> block_luminances(const Image& image, const std::string& component) {
  const RgbView rgb = rgb_view(image, component);
  const int columns = image.width() / block_pixels, rows = image.height() / block_pixels;
  std::vector<double> sums(size_t(columns) * size_t(rows));
  for (int y = 0; y < rows * block_pixels; ++y)
    for (int x = 0; x < columns * block_pixels; ++x)
      sums[size_t(y / block_pixels) * size_t(columns) + size_t(x / block_pixels)] +=
          luminance_of(rgb[size_t(y) * size_t(image.width()) + size_t(x)]);
  std::vector<float> means;
  for (const double sum : sums) means.push_back(float(sum / (block_pixels * block_pixels)));
  return means;
}

std::string layer_of(const std::string& component) {
  return component == whole_picture ? "" : component;
}

std::string scene_file(const std::string& scene) {
  const std::string root = std::string(KAUSTIK_SOURCE_DIR) + "/";
  return root + (scene.ends_with(".xml") ? scene : "scenes/" + scene + "/" + scene + ".xml");
}

std::vector<std::string> split(const std::string& list) {
  std::vector<std::string> parts;
  std::istringstream stream(list);
  for (std::string part; std::getline(stream, part, ',');) parts.push_back(part);
  return parts;
}

std::string channel_name(const std::string& component, int replicate) {
  char number[8];
  std::snprintf(number, sizeof number, "%02d", replicate);
  return component + "." + number;
}

}  // namespace

Rendered render_replicates(const BlockRender& render) {
  Description description = load_scene(scene_file(render.scene));
  override_integrator(description, render.integrator);
  override_property(description, "film.width=" + std::to_string(render.size));
  override_property(description, "film.height=" + std::to_string(render.size));
  if (render.components != whole_picture)
    override_property(description, "integrator.components=" + render.components);
  if (!render.setting.empty()) override_property(description, render.setting);
  const auto scene = build_scene(description);
  if (render.radius_share > 0)
    override_property(
        description,
        "integrator.radius=" + std::to_string(render.radius_share *
                                              double(bounding_radius(scene->tracer().bounds()))));
  std::vector<std::string> warnings;
  const auto integrator = make_integrator(description, *scene, warnings);
  Rendered found;
  for (int replicate = 0; replicate < replicate_total; ++replicate) {
    SessionSettings settings;
    settings.seed = render.first_seed + uint64_t(replicate);
    settings.passes = render.passes;
    settings.samples_per_pass = render.samples;
    Session session(*scene, *integrator, settings);
    session.run();
    const Image image = session.image();
    for (const std::string& component : split(render.components)) {
      found.blocks[component].push_back(block_luminances(image, layer_of(component)));
      found.pixels[component].push_back(pixel_luminances(image, layer_of(component)));
    }
    if (integrator->traits().estimates_bias)
      found.blocks[bias_layer].push_back(block_luminances(image, bias_layer));
  }
  return found;
}

Components render_blocks(const BlockRender& render) {
  Components blocks = render_replicates(render).blocks;
  blocks.erase(bias_layer);
  return blocks;
}

void write_blocks(const Components& components, const std::string& path) {
  const size_t blocks = components.begin()->second.at(0).size();
  const int columns = int(std::lround(std::sqrt(double(blocks))));
  Image image(columns, columns, {});
  for (const auto& [component, replicates] : components) {
    const std::vector<double> means = mean_of_renders(replicates);
    const int of_means = image.add_channel(component);
    image.set_keeps_floats(of_means);
    std::copy(means.begin(), means.end(), image.channel(of_means).begin());
    for (int r = 0; r < replicate_total; ++r) {
      const auto shares = image.channel(image.add_channel(channel_name(component, r)));
      for (size_t b = 0; b < blocks; ++b)
        shares[b] = means[b] > 0 ? float(double(replicates[size_t(r)][b]) / means[b] - 1) : 0.0f;
    }
  }
  write_image(image, path);
}

Components read_blocks(const std::string& path) {
  const Image image = read_image(path);
  const auto channel = [&](const std::string& name) {
    const int index = image.find_channel(name);
    if (index < 0)
      throw Error(ErrorKind::input, path + " has no channel " + name,
                  "make it anew: make_block_references");
    return image.channel(index);
  };
  Components components;
  for (const std::string& name : image.channel_names()) {
    const std::string component = name.substr(0, name.find('.'));
    if (components.contains(component)) continue;
    const auto means = channel(component);
    for (int r = 0; r < replicate_total; ++r) {
      const auto shares = channel(channel_name(component, r));
      std::vector<float>& row = components[component].emplace_back();
      for (size_t b = 0; b < means.size(); ++b)
        row.push_back(float(double(means[b]) * (1 + double(shares[b]))));
    }
  }
  return components;
}

Replicates coarser(const Replicates& blocks, int columns, int factor) {
  Replicates result;
  for (const std::vector<float>& row : blocks) {
    const int coarse_columns = columns / factor, rows = int(row.size()) / columns / factor;
    std::vector<float> means(size_t(coarse_columns) * size_t(rows));
    for (int y = 0; y < rows * factor; ++y)
      for (int x = 0; x < coarse_columns * factor; ++x)
        means[size_t(y / factor) * size_t(coarse_columns) + size_t(x / factor)] +=
            row[size_t(y) * size_t(columns) + size_t(x)] / float(factor * factor);
    result.push_back(std::move(means));
  }
  return result;
}

std::vector<double> mean_of_renders(const Replicates& replicates) {
  std::vector<double> means(replicates.at(0).size());
  for (const std::vector<float>& row : replicates)
    for (size_t b = 0; b < means.size(); ++b)
      means[b] += double(row[b]) / double(replicates.size());
  return means;
}

}  // namespace kaustik::agreement
