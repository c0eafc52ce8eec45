// How fast files of meshes are read, beside what limits that on the same machine, and what it takes
// in memory beside the mesh that stays. All files are in the page cache.
//
// "-speed" is the reader: from the name of a file to the buffers of its mesh, which are memory that
// nothing has been written to before. "-shape" goes on to the shape that rays can be traced against
// but for Embree's structure: vertices are placed, normals scaled or made, triangles wound by them.
// "-memory" is the largest memory of the process up to the shape, less what it had before, beside
// the buffers of the shape.
//
// The limits:
// - of packed PLY files: "-speed" goes by copying the same bytes, in pieces and in all threads, to
//   memory in large pages that nothing has been written to: all that the reader does but to take
//   the numbers apart and test them. Beside it stand a plain read() by one thread into new memory
//   ("-filled"), and one into one megabyte over and over ("-reread"), which never leaves the
//   processor's cache: no reader that keeps anything comes near it;
// - of serialized ones: one thread unpacks them into one megabyte, over and over, by zlib;
// - of OBJ files: std::from_chars() finds the values of all their numbers, in all threads.
//
// `mesh_load_bench [MEGABYTES]`: of the packed PLY file, 200 if it is not told; the other files
// hold the same mesh, or a part of it.
#include <fmt/format.h>
#include <malloc.h>
#include <unistd.h>
#include <zlib.h>

#include <atomic>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <span>

#include "benchmarks/report.h"
#include "kaustik/base/file.h"
#include "kaustik/base/inflate.h"
#include "kaustik/base/memory.h"
#include "kaustik/base/parallel.h"
#include "kaustik/geometry/mesh_reader.h"
#include "kaustik/geometry/ray_tracer.h"

namespace {

using namespace kaustik;

constexpr bench::Bar speed_bar{0.7, 1.0};
constexpr double most_memory = 1.3;
constexpr int repeats = 5;

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

template <typename Body>
double median_seconds(const Body& body) {
  std::vector<double> seconds;
  for (int i = 0; i < repeats; ++i) seconds.push_back(bench::seconds_of(body));
  return bench::median(seconds);
}

double sequential_seconds(const std::string& path) {
  const InputFile file(path);
  std::vector<uint8_t> piece(1 << 20);
  return median_seconds([&] {
    for (uint64_t at = 0; at < file.size(); at += piece.size()) file.read(at, piece);
  });
}

double filling_seconds(const std::string& path) {
  const InputFile file(path);
  return median_seconds([&] {
    const std::unique_ptr<uint8_t[]> bytes(new uint8_t[file.size()]);
    file.read(0, {bytes.get(), file.size()});
  });
}

/// In all threads.
double copying_seconds(const std::string& path) {
  const InputFile file(path);
  constexpr size_t piece = size_t{1} << 18;
  return median_seconds([&] {
    UnsetVector<uint8_t> kept(file.size());
    parallel_blocks(kept.size(), piece, [&](size_t begin, size_t end, size_t) {
      const std::unique_ptr<uint8_t[]> bytes(new uint8_t[piece]);
      file.read(begin, {bytes.get(), end - begin});
      std::memcpy(kept.data() + begin, bytes.get(), end - begin);
    });
  });
}

/// Of a file with one mesh.
double inflating_seconds(const std::string& path) {
  const std::vector<uint8_t> bytes = read_file(path);
  std::vector<uint8_t> piece(1 << 20);
  return median_seconds([&] {
    Inflater inflater(std::span<const uint8_t>(bytes).subspan(4), Packing::zlib);
    while (inflater.fill(piece) == piece.size()) {
    }
  });
}

/// Goes over all numbers of a text; returns how many there are.
uint64_t count_numbers(std::string_view text) {
  uint64_t count = 0;
  double number = 0;
  uint32_t index = 0;
  bool in_face = false;
  for (const char *at = text.data(), *end = at + text.size(); at != end;) {
    const bool is_number = (*at >= '0' && *at <= '9') || *at == '-';
    if (*at == 'f' || *at == 'v') in_face = *at == 'f';
    const char* const next = !is_number ? at
                                        : (in_face ? std::from_chars(at, end, index).ptr
                                                   : std::from_chars(at, end, number).ptr);
    count += is_number ? 1 : 0;
    at = std::max(next, at + 1);
  }
  return count;
}

double number_seconds(const std::string& path) {
  const std::vector<uint8_t> bytes = read_file(path);
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  std::atomic<uint64_t> count{0};
  return median_seconds([&] {
    parallel_blocks(text.size(), size_t{1} << 18, [&](size_t begin, size_t end, size_t) {
      count += count_numbers(text.substr(begin, end - begin));
    });
  });
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

/// What reading a file is compared with.
struct Limit {
  std::string name;
  double seconds = 0;
};

MeshFile read(const std::string& type, const std::string& path) {
  if (type == "ply") return read_ply(path);
  return type == "obj" ? read_obj(path) : read_serialized(path, 0);
}

void measure(const std::string& name, const std::string& type, const std::string& path,
             const Limit& limit, const bench::Bar& speed = {}) {
  const double bytes = double(std::filesystem::file_size(path));
  const double reader_seconds = median_seconds([&] { read(type, path); });
  std::vector<double> seconds;
  double memory = 0, final_bytes = 0;
  for (int i = 0; i < repeats; ++i) {
    const Loaded loaded = load(type, path);
    seconds.push_back(loaded.seconds);
    final_bytes = bytes_of(*loaded.shape->mesh());
    memory = std::max(memory, loaded.peak_bytes / final_bytes);
  }
  const double shape_seconds = bench::median(seconds);
  const std::string unit = "of " + limit.name;
  const auto text = [&](double taken) {
    return fmt::format("{:.2f} GB/s of {:.0f} MB; {:.2f} GB/s, {:.3f} s",
                       bytes / limit.seconds / 1e9, bytes / 1e6, bytes / taken / 1e9, taken);
  };
  bench::report(name + "-speed", limit.seconds / reader_seconds, unit, text(reader_seconds), speed);
  const auto report_beside = [&](const std::string& what, double beside, const std::string& which) {
    bench::report(name + what, beside / reader_seconds, which,
                  fmt::format("{:.2f} GB/s", bytes / beside / 1e9));
  };
  if (type == "ply") {
    report_beside("-filled", filling_seconds(path), "of reading into new memory");
    report_beside("-reread", sequential_seconds(path), "of reading into one megabyte");
  }
  bench::report(name + "-shape", limit.seconds / shape_seconds, unit, text(shape_seconds));
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
  const auto copying = [&] { return Limit{"copying into new memory", copying_seconds(path)}; };
  write_ply(path, sheet(1));
  measure("mesh-ply", "ply", path, copying(), speed_bar);
  Sheet flat = sheet(1);
  flat.has_normals = false;
  write_ply(path, flat);
  measure("mesh-ply-smoothed", "ply", path, copying());
  write_serialized(path, sheet(0.5));
  measure("mesh-serialized", "serialized", path, {"zlib's inflating", inflating_seconds(path)});
  write_obj(path, sheet(0.5));
  measure("mesh-obj", "obj", path, {"finding the values of numbers", number_seconds(path)});
  std::filesystem::remove(path);
  return 0;
}
