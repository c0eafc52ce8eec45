// How fast files of meshes become shapes, beside reading the same bytes out of the page cache one
// after another, and what that takes in memory beside the mesh that stays.
// `mesh_load_bench [MEGABYTES]`: of the packed PLY file, 200 if it is not told; the other files
// hold the same mesh, or a part of it.
#include <fmt/format.h>
#include <malloc.h>
#include <unistd.h>
#include <zlib.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>

#include "benchmarks/report.h"
#include "kaustik/base/file.h"
#include "kaustik/geometry/ray_tracer.h"

namespace {

using namespace kaustik;

constexpr bench::Bar speed_bar{0.7, 1.0};
constexpr double most_memory = 1.3;
constexpr int repeats = 3;

/// A sheet of waves, with a normal and texture coordinates for each vertex.
struct Sheet {
  uint32_t side = 0;
  bool has_normals = true;

  uint64_t vertices() const { return uint64_t(side) * side; }
  uint64_t triangles() const { return 2 * uint64_t(side - 1) * (side - 1); }
  std::array<float, 8> vertex(uint64_t i) const {
    const float u = float(i % side) / float(side - 1), v = float(i / side) / float(side - 1);
    const float x = 40 * u, y = 40 * v, slope = 0.2f * std::cos(x) * std::cos(y);
    const Vec3f n = normalize(Vec3f(-slope, 0.2f * std::sin(x) * std::sin(y), 1));
    return {x, y, 0.2f * std::sin(x) * std::cos(y), n.x, n.y, n.z, u, v};
  }
  std::array<uint32_t, 3> triangle(uint64_t i) const {
    const uint64_t cell = i / 2;
    const auto a = uint32_t(cell / (side - 1) * side + cell % (side - 1));
    return i % 2 == 0 ? std::array{a, a + 1, a + side + 1} : std::array{a, a + side + 1, a + side};
  }
};

void put(std::string& to, const auto& value) {
  to.append(reinterpret_cast<const char*>(&value), sizeof(value));
}

/// Flushes what is put together whenever it is long.
class Output {
 public:
  explicit Output(const std::string& path) : file_(path, std::ios::binary) {}
  ~Output() { file_ << text; }
  void flush_if_long() {
    if (text.size() < (1 << 20)) return;
    file_ << text;
    text.clear();
  }
  std::string text;

 private:
  std::ofstream file_;
};

void write_ply(const std::string& path, const Sheet& sheet) {
  Output out(path);
  out.text = fmt::format(
      "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\nproperty float "
      "y\nproperty float z\n{}property float u\nproperty float v\nelement face {}\nproperty list "
      "uchar int vertex_indices\nend_header\n",
      sheet.vertices(),
      sheet.has_normals ? "property float nx\nproperty float ny\nproperty float nz\n" : "",
      sheet.triangles());
  for (uint64_t i = 0; i < sheet.vertices(); ++i, out.flush_if_long()) {
    const std::array<float, 8> vertex = sheet.vertex(i);
    for (size_t j = 0; j < 8; ++j)
      if (sheet.has_normals || j < 3 || j > 5) put(out.text, vertex[j]);
  }
  for (uint64_t i = 0; i < sheet.triangles(); ++i, out.flush_if_long()) {
    put(out.text, uint8_t(3));
    put(out.text, sheet.triangle(i));
  }
}

void write_obj(const std::string& path, const Sheet& sheet) {
  Output out(path);
  for (uint64_t i = 0; i < sheet.vertices(); ++i, out.flush_if_long()) {
    const std::array<float, 8> v = sheet.vertex(i);
    fmt::format_to(std::back_inserter(out.text),
                   "v {:.6f} {:.6f} {:.6f}\nvn {:.5f} {:.5f} {:.5f}\nvt {:.6f} {:.6f}\n", v[0],
                   v[1], v[2], v[3], v[4], v[5], v[6], v[7]);
  }
  for (uint64_t i = 0; i < sheet.triangles(); ++i, out.flush_if_long()) {
    const auto [a, b, c] = sheet.triangle(i);
    fmt::format_to(std::back_inserter(out.text), "f {0}/{0}/{0} {1}/{1}/{1} {2}/{2}/{2}\n", a + 1,
                   b + 1, c + 1);
  }
}

void write_serialized(const std::string& path, const Sheet& sheet) {
  std::string raw;
  put(raw, uint32_t(1 | 2 | 0x1000));
  raw.push_back('\0');
  put(raw, sheet.vertices());
  put(raw, sheet.triangles());
  for (const auto& [first, last] : {std::pair(0, 3), {3, 6}, {6, 8}})
    for (uint64_t i = 0; i < sheet.vertices(); ++i) {
      const std::array<float, 8> vertex = sheet.vertex(i);
      for (int j = first; j < last; ++j) put(raw, vertex[size_t(j)]);
    }
  for (uint64_t i = 0; i < sheet.triangles(); ++i) put(raw, sheet.triangle(i));
  uLongf size = compressBound(uLong(raw.size()));
  std::string packed(size, '\0');
  compress2(reinterpret_cast<Bytef*>(packed.data()), &size,
            reinterpret_cast<const Bytef*>(raw.data()), uLong(raw.size()), Z_DEFAULT_COMPRESSION);
  packed.resize(size);
  Output out(path);
  put(out.text, uint16_t(0x041c));
  put(out.text, uint16_t(4));
  out.text += packed;
  put(out.text, uint64_t(0));
  put(out.text, uint32_t(1));
}

double sequential_seconds(const std::string& path) {
  const InputFile file(path);
  std::vector<uint8_t> piece(1 << 20);
  std::vector<double> seconds;
  for (int i = 0; i < repeats; ++i)
    seconds.push_back(bench::seconds_of([&] {
      for (uint64_t at = 0; at < file.size(); at += piece.size()) file.read(at, piece);
    }));
  return bench::median(seconds);
}

/// Of the process, in bytes: "VmRSS" or "VmHWM".
double resident_bytes(const std::string& row) {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with(row + ":")) return 1024 * std::atof(line.c_str() + row.size() + 1);
  return 0;
}

/// A shape of the file, with the largest memory that making it took.
struct Loaded {
  std::shared_ptr<const Shape> shape;
  double seconds = 0, peak_bytes = 0;
};
Loaded load(const std::string& type, const std::string& path) {
  malloc_trim(0);
  std::ofstream("/proc/self/clear_refs") << 5;  // VmHWM begins anew
  const double before = resident_bytes("VmRSS");
  Loaded loaded;
  for (const ShapeType& row : shape_types()) {
    if (row.info.name != type) continue;
    Problems problems;
    const Arguments arguments(row.info, {{"filename", path, {}}}, {}, problems);
    loaded.seconds = bench::seconds_of([&] { loaded.shape = row.create(arguments); });
  }
  loaded.peak_bytes = resident_bytes("VmHWM") - before;
  return loaded;
}

double bytes_of(const TriangleMesh& mesh) {
  return double(mesh.positions.size() * sizeof(Vec3f) + mesh.normals.size() * sizeof(Vec3f) +
                mesh.uvs.size() * sizeof(Vec2f) + mesh.triangles.size() * 3 * sizeof(uint32_t));
}

void measure(const std::string& name, const std::string& type, const std::string& path,
             const bench::Bar& speed) {
  const double bytes = double(std::filesystem::file_size(path));
  const double sequential = sequential_seconds(path);
  std::vector<double> seconds;
  double memory = 0, final_bytes = 0;
  for (int i = 0; i < repeats; ++i) {
    const Loaded loaded = load(type, path);
    seconds.push_back(loaded.seconds);
    final_bytes = bytes_of(*loaded.shape->mesh());
    memory = std::max(memory, loaded.peak_bytes / final_bytes);
  }
  const double load_seconds = bench::median(seconds);
  bench::report(name + "-speed", sequential / load_seconds, "of sequential reading",
                fmt::format("{:.2f} GB/s of {:.0f} MB, {:.3f} s", bytes / sequential / 1e9,
                            bytes / 1e6, load_seconds),
                speed);
  bench::report(
      name + "-memory", memory, "of the mesh",
      fmt::format("{:.0f} MB that stay; asked: at most {}", final_bytes / 1e6, most_memory));
}

}  // namespace

int main(int argc, char** argv) {
  const double megabytes = argc > 1 ? std::atof(argv[1]) : 200;
  if (!(megabytes >= 1)) {
    fmt::print(stderr, "usage: mesh_load_bench [MEGABYTES], at least 1\n");
    return 2;
  }
  const std::string path =
      (std::filesystem::temp_directory_path() / fmt::format("kaustik_mesh_{}", ::getpid()))
          .string();
  // A vertex of 32 bytes has two triangles of 13.
  const auto sheet = [&](double share) {
    return Sheet{uint32_t(std::sqrt(share * megabytes * 1e6 / 58)) + 2};
  };
  write_ply(path, sheet(1));
  measure("mesh-ply", "ply", path, speed_bar);
  Sheet flat = sheet(1);
  flat.has_normals = false;
  write_ply(path, flat);
  measure("mesh-ply-smoothed", "ply", path, {});
  write_serialized(path, sheet(0.5));
  measure("mesh-serialized", "serialized", path, {});
  write_obj(path, sheet(0.25));
  measure("mesh-obj", "obj", path, {});
  std::filesystem::remove(path);
  return 0;
}
