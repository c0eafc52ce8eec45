// How fast scenes with large meshes are read on one core, beside what limits that on the same
// machine.
//
// "scene-pbrt-text" is from the text in memory to the description, whose meshes hold all vertices
// and faces. The limit is to find the values of as many numbers by the same function.
// "scene-glb" is from the file to the description, whose meshes hold the file's own arrays. The
// limit is to read the file.
//
// `scene_load_bench [MEGABYTES]`: of text, 100 if it is not told; the .glb is five times as large.
#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <functional>

#include "benchmarks/report.h"
#include "kaustik/base/decimal.h"
#include "kaustik/base/file.h"
#include "kaustik/loader/pbrt_scene.h"
#include "kaustik/loader/scene_format.h"

namespace {

using namespace kaustik;

constexpr double text_bar_mb = 100, binary_bar_mb = 500;
constexpr int repeats = 5;

/// A sheet of waves as an inline mesh, as exporters write it.
std::string sheet(double megabytes) {
  const auto side = int(std::sqrt(megabytes * 1e6 / 70)) + 2;
  std::string text = "WorldBegin\nShape \"trianglemesh\"\n\"integer indices\" [\n";
  for (int y = 0; y + 1 < side; ++y)
    for (int x = 0; x + 1 < side; ++x) {
      const int a = y * side + x, b = a + 1, c = a + side, d = c + 1;
      text += fmt::format("{} {} {} {} {} {}\n", a, b, d, a, d, c);
    }
  text += "]\n\"point3 P\" [\n";
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x)
      text += fmt::format("{:.6f} {:.6f} {:.6f}\n", 0.01 * x, 0.01 * y,
                          0.1 * std::sin(0.03 * x) * std::cos(0.05 * y));
  return text + "]\n";
}

double median_seconds(const std::function<void()>& body) {
  std::vector<double> seconds;
  for (int i = 0; i < repeats; ++i) seconds.push_back(bench::seconds_of(body));
  return bench::median(seconds);
}

/// The sum of all numbers of the text.
double sum_of_numbers(std::string_view text) {
  double sum = 0;
  while (!text.empty()) {
    double number = 0;
    if (take_decimal(text, number))
      sum += number;
    else
      text.remove_prefix(1);
  }
  return sum;
}

/// A sheet of waves with normals, in one buffer.
std::string waves_as_glb(double megabytes) {
  const auto side = uint32_t(std::sqrt(megabytes * 1e6 / 48)) + 2;
  std::vector<float> positions, normals;
  std::vector<uint32_t> faces;
  for (uint32_t y = 0; y < side; ++y)
    for (uint32_t x = 0; x < side; ++x) {
      for (const float p : {0.01f * float(x), 0.01f * float(y), 0.1f * std::sin(0.03f * float(x))})
        positions.push_back(p);
      for (const float n : {0.0f, 0.0f, 1.0f}) normals.push_back(n);
      if (x + 1 == side || y + 1 == side) continue;
      const uint32_t a = y * side + x, b = a + 1, c = a + side, d = c + 1;
      faces.insert(faces.end(), {a, b, d, a, d, c});
    }
  const auto bytes_of = [](const auto& values) {
    return std::string_view(reinterpret_cast<const char*>(values.data()),
                            values.size() * sizeof(values[0]));
  };
  const size_t of_points = bytes_of(positions).size(), of_faces = bytes_of(faces).size();
  std::string json = fmt::format(
      R"({{"asset":{{"version":"2.0"}},"buffers":[{{"byteLength":{0}}}],"bufferViews":[)"
      R"({{"buffer":0,"byteLength":{1}}},{{"buffer":0,"byteOffset":{1},"byteLength":{1}}},)"
      R"({{"buffer":0,"byteOffset":{2},"byteLength":{3}}}],"accessors":[)"
      R"({{"bufferView":0,"componentType":5126,"count":{4},"type":"VEC3"}},)"
      R"({{"bufferView":1,"componentType":5126,"count":{4},"type":"VEC3"}},)"
      R"({{"bufferView":2,"componentType":5125,"count":{5},"type":"SCALAR"}}],"nodes":[{{"mesh":0}}],)"
      R"("meshes":[{{"primitives":[{{"attributes":{{"POSITION":0,"NORMAL":1}},"indices":2}}]}}]}})",
      2 * of_points + of_faces, of_points, 2 * of_points, of_faces, positions.size() / 3,
      faces.size());
  json.resize((json.size() + 3) / 4 * 4, ' ');
  const auto word = [](size_t number) {
    const auto value = uint32_t(number);
    return std::string(reinterpret_cast<const char*>(&value), sizeof(value));
  };
  const size_t of_buffer = 2 * of_points + of_faces;
  std::string file = "glTF" + word(2) + word(12 + 8 + json.size() + 8 + of_buffer) +
                     word(json.size()) + "JSON" + json + word(of_buffer) + std::string("BIN\0", 4);
  for (const std::string_view part : {bytes_of(positions), bytes_of(normals), bytes_of(faces)})
    file += part;
  return file;
}

void measure_pbrt(double megabytes) {
  const std::string text = sheet(megabytes);
  double checked = 0;
  const double limit = median_seconds([&] { checked += sum_of_numbers(text); });
  const double seconds =
      median_seconds([&] { checked += double(parse_pbrt(text, "sheet", "").sources.size()); });
  bench::report("scene-pbrt-text", double(text.size()) / seconds / 1e6, "MB/s",
                fmt::format("{:.0f} MB/s: finding the values of its numbers ({:g})",
                            double(text.size()) / limit / 1e6, checked),
                {text_bar_mb, 2 * text_bar_mb});
}

void measure_glb(double megabytes) {
  const std::string file =
      (std::filesystem::temp_directory_path() / "kaustik_scene_load.glb").string();
  const std::string bytes = waves_as_glb(megabytes);
  write_file_atomically(file, {reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()});
  double checked = 0;
  const double limit = median_seconds([&] { checked += double(read_file(file).size()); });
  const double seconds =
      median_seconds([&] { checked += double(load_scene(file).sources.size()); });
  std::filesystem::remove(file);
  bench::report("scene-glb", double(bytes.size()) / seconds / 1e6, "MB/s",
                fmt::format("{:.0f} MB/s: reading the file ({:g})",
                            double(bytes.size()) / limit / 1e6, checked),
                {binary_bar_mb, 2 * binary_bar_mb});
}

}  // namespace

int main(int argc, char** argv) {
  const double megabytes = argc > 1 ? std::atof(argv[1]) : 100;
  if (!(megabytes >= 1)) {
    fmt::print(stderr, "usage: scene_load_bench [MEGABYTES], at least 1\n");
    return 2;
  }
  measure_pbrt(megabytes);
  measure_glb(5 * megabytes);
  return 0;
}
